"""A scene: beads, what they fall on, and the time that is simulated. Each kind is a subclass."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from contactlaw import ArgumentError

if TYPE_CHECKING:
    from contactlaw import Material
    from dem_demo.kit.run import Run

Floats = NDArray[np.float64]
Facts = list[tuple[str, str]]

GRAVITY = 9.80665  # [m/s2], standard gravity
WAITING, FLYING, GONE = 0, 1, 2  # a bead's status in a frame


@dataclass(frozen=True, eq=False, kw_only=True)
class Scene(ABC):
    """Beads, materials, and what a scene says of itself on its page."""

    NAME: ClassVar[str]
    FRAME_RATE: ClassVar[float]  # recorded frames per second [1/s]
    WALL: ClassVar[str]  # what the beads hit, in words
    PAGE: ClassVar[Mapping[str, str]]  # texts of the page: heading, lede, others (files beside the page)

    radius: Floats  # of the beads, shape (N,) [m]
    position: Floats  # of their centres at the start, shape (N, d) [m]; the last axis points up
    velocity: Floats  # at the start, shape (N, d) [m/s]
    plates: tuple[float, ...]  # thickness of each wall [m]; inf is a half-space
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
        from contactlaw.reporting.limits import label

        thickness = f"{label(self.plates[0])} " if len(self.plates) == 1 else ""
        return f"{thickness}{self.plate_material.name}"

    @property
    def subject(self) -> str:
        """Beads and walls, for the subtitles of figures."""
        return f"{self.radius.size} beads of {self.sphere_material.name} on {self.sheet}"

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
