"""A bed: beads on walls of sheet that move. Each scene of this kind is a class with its walls."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from dem_demo.kit.beads import Floats

if TYPE_CHECKING:
    import h5py

    from contactlaw import Material
    from contactlaw.walls import Mesh

ENGINE, EXTRAS = "lammps", "demo,lammps"  # the one engine here that knows meshes

Corners = tuple[tuple[float, float, float], tuple[float, float, float]]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Bed(ABC):
    """Beads on walls of sheet, and how long they are watched.

    Attributes
    ----------
    radius : ndarray, shape (N,)
        Radii of the beads [m].
    position : ndarray, shape (N, 3)
        Of their centres at the start [m]; z points up.
    velocity : ndarray, shape (3,)
        Of all of them at the start [m/s].
    thickness : float
        Of the walls' sheet [m].
    sphere_material, plate_material : Material
        Materials of the beads and of the sheet.
    friction : float
        Coulomb's coefficient, of beads on the walls and on each other.
    duration : float
        Simulated time [s].
    seed : int
        Seed that the beads were drawn with.
    NAME, SCHEMA : str, int
        Of the scene, and number of its record's form.
    AXES : str
        What the columns of impacts mean in its record.
    NUMBERS : tuple of str
        Numbers of the scene that its record has as attributes.
    FRAME_RATE : float
        Recorded frames per second [1/s].
    """

    NAME: ClassVar[str]
    SCHEMA: ClassVar[int]
    AXES: ClassVar[str]
    NUMBERS: ClassVar[tuple[str, ...]]
    FRAME_RATE: ClassVar[float]

    radius: Floats
    position: Floats
    velocity: Floats
    thickness: float
    sphere_material: Material
    plate_material: Material
    friction: float
    duration: float
    seed: int

    @property
    def frames(self) -> int:
        """Frames after the first one, which shows the start."""
        return round(self.duration * self.FRAME_RATE)

    @property
    def mass(self) -> Floats:
        """Masses of the beads [kg]."""
        from contactlaw.physical.materials import sphere_mass

        return sphere_mass(self.sphere_material.density, self.radius)

    @property
    def types(self) -> NDArray[np.int64]:
        """The engine's type of each bead, from 1."""
        return np.ones(self.radius.size, dtype=int)

    @property
    @abstractmethod
    def top_speed(self) -> float:
        """Largest speed [m/s] of a bead that falls on a wall, relative to it."""

    @property
    @abstractmethod
    def box(self) -> Corners:
        """Lower and upper corner [m] of the space in which beads are followed."""

    @abstractmethod
    def meshes(self, thickness: float, folder: Path) -> list[Mesh]:
        """Make the moving walls, of a thickness [m]; their files are in a folder."""

    def write_files(self, folder: Path) -> None:
        """Write the files that the walls are read from, where there are any."""
        return

    @abstractmethod
    def write_walls(self, file: h5py.File) -> None:
        """Write the walls into a record."""

    @staticmethod
    @abstractmethod
    def read_walls(file: h5py.File) -> Mapping[str, Any]:
        """Read what the scene has of its walls beside its numbers."""


def check(
    scene: type[Bed], *, beads: int, seed: int, duration: float,
    positive: Mapping[str, tuple[float, str]], not_negative: Mapping[str, tuple[float, str]],
) -> None:  # fmt: skip
    """Refuse numbers that no bed has; each of the mappings has a value and its unit by its name."""
    if not beads >= 1:
        raise ValueError(f"beads: at least one is needed, got {beads!r}")
    if seed < 0:
        raise ValueError(f"seed: must not be negative, got {seed!r}")
    for name, (value, unit) in positive.items():
        if not 0.0 < value < math.inf:
            raise ValueError(f"{name}: must be positive and finite [{unit}], got {value!r}")
    for name, (value, unit) in not_negative.items():
        if not 0.0 <= value < math.inf:
            raise ValueError(f"{name}: must be finite and not negative [{unit}], got {value!r}")
    frame = 1.0 / scene.FRAME_RATE
    if not frame <= duration < math.inf:
        raise ValueError(
            f"duration: must be finite and at least one frame, {frame:g} s, got {duration!r}"
        )
