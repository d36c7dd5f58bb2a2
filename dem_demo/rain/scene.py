"""The scene of the rain: a row of nozzles above a row of plates. Its speeds span the yield speed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contactlaw import ArgumentError
from dem_demo.kit.scene import GRAVITY, Facts, Floats, Scene, check

if TYPE_CHECKING:
    from dem_demo.kit.run import Run

# Dimensions of the scene, chosen for clear figures.
WIDTH, GAP = 0.060, 0.020  # [m], width of a plate, and distance to the next
_LARGEST = 0.05  # [m], largest radius of a bead that suits plates of this size
MARGIN = 0.012  # [m]: nozzles keep off the edges, so that few beads miss the plates
HEIGHT = 0.2  # [m], height of the nozzles above the plates
_TILT = 40.0  # [degrees], of the nozzles of a rain with friction
_STEEPEST = 75.0  # [degrees], largest tilt: such nozzles are already 0.7 m beside the plates
SIDEWAYS = 0.05  # [m/s], largest sideways speed: beads wander over to the next plate or the gap
EMISSION = 0.75  # share of the duration in which beads are emitted; the rest is for bounces
# Steps in which the fastest falling bead crosses the smallest radius. Beads that strike each other
# may be faster: up to twice that speed, no bead can jump through a plate.
_STEPS_PER_RADIUS = 2.0

GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
# Of n successive multiples of GOLDEN modulo 1, no two are closer than SPACING / n (Hurwitz).
SPACING = GOLDEN**2


@dataclass(frozen=True, eq=False, kw_only=True)
class Shower(Scene):
    """Beads in the order of their emission, and plates, whose upper faces have the height 0.

    Nothing holds the plates at their ends. Beads on each other have no friction.
    """

    NAME, FRAME_RATE, WALL = "rain", 200.0, "plates"
    PAGE = {  # noqa: RUF012
        "heading": "Beads rain on plates",
        "lede": "How a bead rebounds from a plate depends on the plate's thickness, on the bead and on its "
        "speed. Particle simulations mostly take one number for all of it, the coefficient of "
        "restitution (COR): rebound speed over impact speed. Here every collision has its own COR.",
        "others": "",
    }

    emission_time: Floats  # when each bead leaves its nozzle [s], ascending

    @property
    def ends(self) -> Floats:
        """Left and right end of each plate, shape (n, 2) [m]."""
        left = (WIDTH + GAP) * np.arange(len(self.plates), dtype=float)
        return np.column_stack((left, left + WIDTH))

    @property
    def floor(self) -> float:
        """Height [m] below which a bead is gone: it has missed the plates for good."""
        return -max((h for h in self.plates if h < math.inf), default=0.0) - 0.02

    @property
    def top_speed(self) -> float:
        """Largest speed [m/s] of a bead that falls from the nozzles to the floor."""
        fall = self.position[:, 1] - self.floor
        return float(np.sqrt((self.velocity**2).sum(axis=1) + 2.0 * GRAVITY * fall).max())

    @property
    def steps_per_frame(self) -> int:
        """Engine steps from frame to frame, so many that no bead jumps through a plate."""
        safe = float(self.radius.min()) / (_STEPS_PER_RADIUS * self.top_speed)
        return math.ceil(1.0 / (self.FRAME_RATE * safe))

    @property
    def time_step(self) -> float:
        """Engine step [s]."""
        return 1.0 / (self.FRAME_RATE * self.steps_per_frame)

    def from_edge(self, rows: NDArray[np.void]) -> Floats:
        """Distance [m] of impacts on plates from the nearest edge of the plate."""
        left, right = self.ends[rows["plate"]].T
        distance: Floats = np.minimum(rows["x"] - left, right - rows["x"])
        return distance.clip(0.0)  # rounding may put a contact with the rim beside the plate

    def title(self) -> tuple[str, str]:
        """Beads and plates; duration."""
        return f"{self.beads}, on {self.sheet}", f"{self.duration:g} s"

    def facts(self, run: Run[Any]) -> Facts:
        """Impacts of two beads."""
        rows = run.record.impacts[run.record.impacts["other"] >= 0]
        found = [("impacts of bead on bead", f"{rows.size}")]
        if rows.size:
            found += [("mean speed of these", f"{rows['approach_speed'].mean():.2f} m/s")]
            found += [("COR of these", f"{rows['restitution'].min():.3f} - {rows['restitution'].max():.3f}")]
        return found


def rain(
    *,
    beads: int = 600,
    plates: tuple[float, ...] = (0.5e-3, 0.7e-3, 1e-3, 1.5e-3, 2e-3),
    sphere: str = "gamma-alumina",
    plate: str = "glass",
    radius: tuple[float, float] = (0.5e-3, 0.9e-3),  # at most 1.8 times the thickness, where the model holds
    speed: tuple[float, float] = (0.5, 15.0),  # gamma-alumina on glass yields from 7.4 m/s
    friction: float = 0.0,
    tilt: float | None = None,
    duration: float = 2.4,
    seed: int = 1,
) -> Shower:
    """Draw a rain of beads on a row of plates.

    Examples
    --------
    >>> scene = rain(beads=10, seed=3)
    >>> scene.radius.shape, len(scene.plates)
    ((10,), 5)
    """
    from contactlaw import material

    check(Shower, beads=beads, seed=seed, duration=duration, positive={}, not_negative={"friction": (friction, "1")})
    for name, (low, high), unit, least in (
        ("radius", radius, "m", "positive"),
        ("speed", speed, "m/s", "not negative"),
    ):
        if not 0.0 <= low <= high < math.inf or (low == 0.0 and least == "positive"):
            reason = f"needs MIN,MAX [{unit}], {least}, finite and ascending, got {low!r},{high!r}"
            raise ArgumentError(name, None, reason)
    if radius[1] > _LARGEST:
        reason = f"{radius[1]:g} m is above {_LARGEST} m; with units: 1mm,2mm"
        raise ArgumentError("radius", None, reason)
    for thickness in plates:
        if not thickness > 0.0:
            raise ArgumentError("plates", thickness, "thickness must be positive [m], or inf")
    if tilt is None:
        tilt = _TILT if friction else 0.0
    if not 0.0 <= tilt <= _STEEPEST:
        raise ArgumentError("tilt", tilt, f"must lie between 0 and {_STEEPEST:g} degrees")
    period, down = EMISSION * duration, math.cos(math.radians(tilt))
    _check_crowd(beads, len(plates), radius[1], speed[0] * down, period)
    rng = np.random.default_rng(seed)
    time = (np.arange(beads) + rng.random(beads)) * (period / beads)
    # Multiples of the golden ratio: beads that are close in time are far apart in space.
    place = (rng.random() + GOLDEN * np.arange(beads)) % 1.0 * len(plates)
    on = np.minimum(np.floor(place), len(plates) - 1)
    x = on * (WIDTH + GAP) + MARGIN + (place - on) * (WIDTH - 2.0 * MARGIN)
    thrown = rng.uniform(*speed, beads)
    velocity = np.column_stack((rng.uniform(-SIDEWAYS, SIDEWAYS, beads), -down * thrown))
    size: Floats = rng.uniform(*radius, beads)
    # Nozzles point to the left and to the right in turn, and are moved sideways so that a bead
    # lands where it does without tilt. None is emitted into another, of tilted ones hardly any.
    along = math.sin(math.radians(tilt)) * thrown * np.where(np.arange(beads) % 2, -1.0, 1.0)
    fall = velocity[:, 1] + np.sqrt(velocity[:, 1] ** 2 + 2.0 * GRAVITY * (HEIGHT - size))
    velocity[:, 0] += along
    return Shower(
        radius=size,
        position=np.column_stack((x - along * fall / GRAVITY, np.full(beads, HEIGHT))),
        velocity=velocity,
        emission_time=time,
        plates=plates,
        sphere_material=material(sphere),
        plate_material=material(plate),
        friction=friction,
        duration=duration,
        seed=seed,
    )


def _check_crowd(n: int, plates: int, radius: float, speed: float, period: float) -> None:
    """Refuse more beads than the nozzles can emit without overlap."""
    fall = 2.0 * radius
    clear = (math.sqrt(speed**2 + 2.0 * GRAVITY * fall) - speed) / GRAVITY
    together = SPACING * plates * (WIDTH - 2.0 * MARGIN) / fall
    most = max(0, math.floor((together - 2.0) * period / clear))
    if n > most:
        raise ArgumentError(
            "beads",
            None,
            f"{n} within {period:g} s would be emitted into each other; at most {most} of this "
            "size and speed fit, more with a longer duration",
        )
