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
# may be faster: up to three times that speed, no bead can jump through a plate.
STEPS_PER_RADIUS = 3.0


@dataclass(frozen=True, slots=True)
class Plate:
    """A horizontal plate, seen from its edge; nothing holds it at its ends.

    Parameters
    ----------
    thickness : float
        Thickness [m]; ``inf`` is a half-space.
    x0, x1 : float
        Left and right end of the plate [m].
    y : float, optional
        Height of its upper face [m].

    Examples
    --------
    >>> Plate(thickness=1e-3, x0=0.0, x1=0.06).x1
    0.06
    """

    thickness: float
    x0: float
    x1: float
    y: float = 0.0

    def __post_init__(self) -> None:
        """Refuse impossible numbers."""
        if not self.thickness > 0.0:
            raise ArgumentError("plates", self.thickness, "thickness must be positive [m], or inf")
        if not (math.isfinite(self.y) and -math.inf < self.x0 < self.x1 < math.inf):
            reason = f"needs finite x0 < x1 and y [m], got {self.x0!r}, {self.x1!r}, {self.y!r}"
            raise ArgumentError("plate", None, reason)


@dataclass(frozen=True, slots=True, eq=False)
class Beads:
    """Beads in the order of their emission; every field has one row per bead.

    Parameters
    ----------
    radius : ndarray, shape (N,)
        Radii [m].
    emission_time : ndarray, shape (N,)
        When each bead leaves the nozzle row [s], ascending.
    position, velocity : ndarray, shape (N, 2)
        Position [m] and velocity [m/s] of the centre at that time, (x, y).
    """

    radius: Floats
    emission_time: Floats
    position: Floats
    velocity: Floats

    def __post_init__(self) -> None:
        """Refuse arrays that do not fit together or hold impossible values."""
        n = self.radius.size
        shapes = [a.shape for a in (self.radius, self.emission_time, self.position, self.velocity)]
        if n == 0 or shapes != [(n,), (n,), (n, 2), (n, 2)]:
            reason = f"need arrays of shape (N,), (N,), (N, 2), (N, 2), got {shapes}"
            raise ArgumentError("beads", None, reason)
        everything = np.column_stack((self.emission_time, self.position, self.velocity))
        if not (np.isfinite(everything).all() and (np.diff(self.emission_time) >= 0.0).all()):
            reason = "values must be finite, and emission times ascending"
            raise ArgumentError("beads", None, reason)
        if not ((self.radius > 0.0) & (self.radius < math.inf)).all():
            raise ArgumentError("radius", self.radius.min(), "must be positive and finite [m]")

    def mass(self, density: float) -> Floats:
        """Masses of the beads as spheres [kg], from their density [kg/m3]."""
        from contactlaw.physical.materials import sphere_mass

        return sphere_mass(density, self.radius)


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Beads that fall on plates, and the time that is simulated.

    Parameters
    ----------
    beads : Beads
        The beads.
    plates : sequence of Plate
        The plates.
    sphere_material, plate_material : Material
        Materials of the beads and of the plates.
    duration : float
        Simulated time [s].
    seed : int
        Seed that the beads were drawn with.
    frame_rate : float, optional
        Recorded frames per second [1/s].
    rows : int, optional
        Rows of nozzles, one behind the other.
    friction : float, optional
        Coulomb's coefficient of friction of beads on plates [-]; beads on each other have none.
    """

    beads: Beads
    plates: Sequence[Plate]
    sphere_material: Material
    plate_material: Material
    duration: float
    seed: int
    frame_rate: float = defaults.FRAME_RATE
    rows: int = 1
    friction: float = 0.0

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
