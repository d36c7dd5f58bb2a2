"""A scene: beads, what they fall on, and the time that is simulated. Each kind is a subclass."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from contactlaw import ArgumentError

if TYPE_CHECKING:
    from contactlaw import Material
    from contactlaw.walls import Cylinder, Disc, Mesh
    from dem_demo.kit.run import Run

Floats = NDArray[np.float64]
Facts = list[tuple[str, str]]
Corners = tuple[tuple[float, float, float], tuple[float, float, float]]

GRAVITY = 9.80665  # [m/s2], standard gravity
WAITING, FLYING, GONE = 0, 1, 2  # a bead's status in a frame


@dataclass(frozen=True, eq=False, kw_only=True)
class Scene(ABC):
    """Beads, materials, and what a scene says of itself on its page."""

    NAME: ClassVar[str]
    FRAME_RATE: ClassVar[float]  # recorded frames per second [1/s]
    WALL: ClassVar[str]  # what the beads hit, in words
    # Texts of the page: heading, lede, alt (of the film), others (files beside the page).
    PAGE: ClassVar[Mapping[str, str]]

    radius: Floats  # of the beads, shape (N,) [m]
    position: Floats  # of their centres at the start, shape (N, d) [m]; the last axis points up
    velocity: Floats  # at the start, shape (N, d) [m/s]
    sphere_material: Material
    plate_material: Material
    friction: float  # Coulomb's coefficient
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
    def beads(self) -> str:
        """Number, material and radii of the beads, in words."""
        ends = " to ".join(f"{1e3 * end:.3g}" for end in (self.radius.min(), self.radius.max()))
        return f"{self.radius.size} beads of {self.sphere_material.name}, radius {ends} mm"

    @property
    def sheet(self) -> str:
        """What the walls are made of, in words."""
        return self.plate_material.name

    @property
    @abstractmethod
    def top_speed(self) -> float:
        """Largest speed [m/s] of a bead that falls on a wall, relative to it."""

    @abstractmethod
    def title(self) -> tuple[str, str]:
        """Title in two lines: beads and walls; duration or motion."""

    @abstractmethod
    def facts(self, run: Run[Any]) -> Facts:
        """Names and values of what only this kind of scene counts."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Bed(Scene):
    """Beads on moving walls of sheet metal, in three dimensions."""

    FLAT: ClassVar[str]  # where impacts have no COR of their own: "at a rim or a wall"
    FILM_RATE: ClassVar[float]  # frames per second of the film [1/s]
    DRIVE: ClassVar[tuple[str, str, int, float]] = "power", "mW", 6, 1e3  # of walls: column and factor of `Run.borne`

    thickness: float  # of the walls [m]
    softening: float  # by which the modulus of all contacts is divided; 1: true contacts

    @property
    def sheet(self) -> str:
        """What the walls are made of, in words."""
        from contactlaw.reporting.limits import label

        return f"{label(self.thickness)} {self.plate_material.name}"

    @property
    def groups(self) -> list[tuple[str, NDArray[np.bool_]]]:
        """Smaller and larger beads: words, and a mask of the beads."""
        small, size = self.small, self.radius * 1e3
        found = []
        for name, which in (("smaller", small), ("larger", ~small)):
            ends = sorted({f"{end:.2g}" for end in (size[which].min(), size[which].max())}) if which.any() else ["-"]
            found.append((f"{name} beads, radius {' to '.join(ends)} mm", which))
        return found

    @property
    @abstractmethod
    def small(self) -> NDArray[np.bool_]:
        """Which beads are the smaller ones."""

    @property
    @abstractmethod
    def box(self) -> Corners:
        """Lower and upper corner [m] of the space in which beads are followed."""

    @abstractmethod
    def meshes(self, thickness: float, folder: Path) -> Sequence[Mesh | Cylinder | Disc]:
        """Make the moving walls, of a thickness [m], from the mesh files in a folder if any."""

    def write_files(self, folder: Path) -> None:
        """Write the mesh files of the walls, if the scene has any."""
        return

    @abstractmethod
    def on_faces(self, rows: NDArray[np.void]) -> NDArray[np.bool_]:
        """Mask of contacts with a single wall, away from rims and seams.

        At a rim or a seam a bead may have several contacts at once, none of which has a COR of its
        own.
        """

    @property
    @abstractmethod
    def window(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top [m] of what is drawn, seen along y."""

    @property
    @abstractmethod
    def slice(self) -> tuple[float, float]:
        """Middle and half of the width [m] along y of what is drawn."""

    @abstractmethod
    def outline(self, time: float) -> Sequence[Floats]:
        """Lines (k, 2) [m] of the walls at a time [s], as seen along y."""


def check(
    scene: type[Scene],
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
