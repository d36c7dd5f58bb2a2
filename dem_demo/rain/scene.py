"""The scene of a rain: beads, plates, materials and duration."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactlaw import ArgumentError
from dem_demo.kit.beads import GRAVITY, Floats
from dem_demo.rain import defaults

if TYPE_CHECKING:
    from contactlaw import Material

# Steps in which the fastest falling bead crosses the smallest radius. Beads that strike each other
# may be faster: up to twice that speed, no bead can jump through a plate.
STEPS_PER_RADIUS = 2.0


@dataclass(frozen=True, slots=True)
class Plate:
    """A horizontal plate, seen from its edge; nothing holds it at its ends."""

    thickness: float  # [m]; inf is a half-space
    x0: float  # left and right end [m]
    x1: float
    y: float = 0.0  # height of its upper face [m]

    def __post_init__(self) -> None:
        """Refuse impossible numbers."""
        if not self.thickness > 0.0:
            raise ArgumentError("plates", self.thickness, "thickness must be positive [m], or inf")


@dataclass(frozen=True, slots=True, eq=False)
class Beads:
    """Beads in the order of their emission; every field has one row per bead."""

    radius: Floats  # [m]
    emission_time: Floats  # when each leaves the nozzle row [s], ascending
    position: Floats  # of the centre at that time, (x, y) [m]
    velocity: Floats  # at that time, (x, y) [m/s]

    def mass(self, density: float) -> Floats:
        """Masses of the beads as spheres [kg], from their density [kg/m3]."""
        from contactlaw.physical.materials import sphere_mass

        return sphere_mass(density, self.radius)


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Beads that fall on plates, and the time that is simulated."""

    beads: Beads
    plates: Sequence[Plate]
    sphere_material: Material
    plate_material: Material
    duration: float  # [s]
    seed: int  # that the beads were drawn with
    frame_rate: float = defaults.FRAME_RATE  # recorded frames per second [1/s]
    friction: float = 0.0  # Coulomb's coefficient on plates; beads on each other have none

    def __post_init__(self) -> None:
        """Refuse a scene without plates or time."""
        if not self.plates:
            raise ArgumentError("plates", None, "at least one thickness is needed [m]")
        if not 1.0 / self.frame_rate <= self.duration < math.inf:
            reason = f"must be finite and at least one frame, {1.0 / self.frame_rate:g} s"
            raise ArgumentError("duration", self.duration, reason)
        if not 0.0 <= self.friction < math.inf:
            raise ArgumentError("friction", self.friction, "must be finite and not negative")

    @property
    def frames(self) -> int:
        """Frames after the first one, which shows the start."""
        return round(self.duration * self.frame_rate)

    @property
    def floor(self) -> float:
        """Height [m] below which a bead is gone: it has missed the plates for good."""
        thick = max((p.thickness for p in self.plates if p.thickness < math.inf), default=0.0)
        return min(p.y for p in self.plates) - thick - 0.02

    @property
    def top_speed(self) -> float:
        """Largest speed [m/s] of a bead that falls from the nozzles to the floor."""
        fall = self.beads.position[:, 1] - self.floor
        speed = np.sqrt((self.beads.velocity**2).sum(axis=1) + 2.0 * GRAVITY * fall)
        return float(speed.max())

    @property
    def steps_per_frame(self) -> int:
        """Engine steps from frame to frame, so many that no bead jumps through a plate."""
        safe = float(self.beads.radius.min()) / (STEPS_PER_RADIUS * self.top_speed)
        return math.ceil(1.0 / (self.frame_rate * safe))

    @property
    def time_step(self) -> float:
        """Engine step [s]."""
        return 1.0 / (self.frame_rate * self.steps_per_frame)
