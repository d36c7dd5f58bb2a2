"""A bed: beads on moving walls of sheet metal. Each scene of this kind is a subclass."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from contactlaw import ArgumentError
from dem_demo.kit.beads import Floats

if TYPE_CHECKING:
    import h5py

    from contactlaw import Material
    from contactlaw.walls import Mesh

EXTRAS = "demo,lammps"

Corners = tuple[tuple[float, float, float], tuple[float, float, float]]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Bed(ABC):
    """Beads on walls of sheet metal, and the time that is simulated."""

    NAME: ClassVar[str]
    SCHEMA: ClassVar[int]  # version of the layout of its record
    NUMBERS: ClassVar[tuple[str, ...]]  # fields that the record stores as attributes of the file
    FRAME_RATE: ClassVar[float]  # recorded frames per second [1/s]

    radius: Floats  # of the beads, shape (N,) [m]
    position: Floats  # of their centres at the start, shape (N, 3) [m]; z points up
    velocity: Floats  # of all at the start, shape (3,) [m/s]
    thickness: float  # of the walls [m]
    sphere_material: Material
    plate_material: Material
    friction: float  # Coulomb's coefficient, of beads on the walls and on each other
    duration: float  # [s]
    seed: int  # that the beads were drawn with

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
        """Make the moving walls, of a thickness [m], from the mesh files in a folder if any."""

    def write_files(self, folder: Path) -> None:
        """Write the mesh files of the walls, if the scene has any."""
        return

    @abstractmethod
    def write_walls(self, file: h5py.File) -> None:
        """Write the walls into a record."""

    @staticmethod
    @abstractmethod
    def read_walls(file: h5py.File) -> Mapping[str, Any]:
        """Read the fields of the scene that `write_walls` has written."""


def check(
    scene: type[Bed],
    *,
    beads: int,
    seed: int,
    duration: float,
    positive: Mapping[str, tuple[float, str]],
    not_negative: Mapping[str, tuple[float, str]],
) -> None:
    """Refuse numbers out of range; the mappings give the value and the unit of each name."""
    if not beads >= 1:
        raise ArgumentError("beads", beads, "at least one is needed")
    if seed < 0:
        raise ArgumentError("seed", seed, "must not be negative")
    for name, (value, unit) in positive.items():
        if not 0.0 < value < math.inf:
            raise ArgumentError(name, value, f"must be positive and finite [{unit}]")
    for name, (value, unit) in not_negative.items():
        if not 0.0 <= value < math.inf:
            raise ArgumentError(name, value, f"must be finite and not negative [{unit}]")
    frame = 1.0 / scene.FRAME_RATE
    if not frame <= duration < math.inf:
        reason = f"must be finite and at least one frame, {frame:g} s"
        raise ArgumentError("duration", duration, reason)
