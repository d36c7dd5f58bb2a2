"""The default scene: a row of nozzles above a row of plates."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from contactlaw import ArgumentError, Material, material
from dem_demo.kit.beads import GRAVITY, Floats
from dem_demo.rain import defaults
from dem_demo.rain.scene import Beads, Plate, Scene

# Dimensions of the scene, chosen for clear figures.
WIDTH, GAP = 0.060, 0.020  # [m], width of a plate, and distance to the next
_LARGEST = 0.05  # [m], largest radius of a bead that suits plates of this size
MARGIN = 0.012  # [m]: nozzles keep off the edges, so that few beads miss the plates
HEIGHT = 0.2  # [m], height of the nozzles above the plates
_STEEPEST = 75.0  # [degrees], largest tilt: such nozzles are already 0.7 m beside the plates
SIDEWAYS = 0.05  # [m/s], largest sideways speed: beads wander over to the next plate or the gap
EMISSION = 0.75  # share of the duration in which beads are emitted; the rest is for bounces

GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
# Of n successive multiples of GOLDEN modulo 1, no two are closer than SPACING / n (Hurwitz).
SPACING = GOLDEN**2


def rain(
    *,
    beads: int = defaults.BEADS,
    thicknesses: Sequence[float] = defaults.THICKNESSES,
    radius: tuple[float, float] = defaults.RADIUS,
    speed: tuple[float, float] = defaults.SPEED,
    duration: float = defaults.DURATION,
    seed: int = defaults.SEED,
    sphere: Material | str = defaults.SPHERE,
    plate: Material | str = defaults.PLATE,
    friction: float = 0.0,
    tilt: float = 0.0,
) -> Scene:
    """Draw a rain of beads on a row of plates.

    Examples
    --------
    >>> scene = rain(beads=10, seed=3)
    >>> scene.beads.radius.shape, len(scene.plates)
    ((10,), 5)
    """
    if beads < 1:
        raise ArgumentError("beads", beads, "at least one is needed")
    if seed < 0:
        raise ArgumentError("seed", seed, "must not be negative")
    _check_range("radius", radius, "m", positive=True)
    if radius[1] > _LARGEST:
        reason = f"{radius[1]:g} m is above {_LARGEST} m; with units: 1mm,2mm"
        raise ArgumentError("radius", None, reason)
    _check_range("speed", speed, "m/s", positive=False)
    pitch = WIDTH + GAP
    plates = tuple(Plate(h, i * pitch, i * pitch + WIDTH) for i, h in enumerate(thicknesses))
    sphere_material = sphere if isinstance(sphere, Material) else material(sphere)
    plate_material = plate if isinstance(plate, Material) else material(plate)
    if not 0.0 <= tilt <= _STEEPEST:
        raise ArgumentError("tilt", tilt, f"must lie between 0 and {_STEEPEST:g} degrees")
    if not 0.0 < duration < math.inf:
        raise ArgumentError("duration", duration, "must be positive and finite [s]")
    drops = _draw(beads, len(plates), radius, speed, EMISSION * duration, seed, tilt)
    return Scene(drops, plates, sphere_material, plate_material, duration, seed, friction=friction)


def _check_range(name: str, limits: tuple[float, float], unit: str, *, positive: bool) -> None:
    low, high = limits
    if not ((0.0 < low if positive else 0.0 <= low) and low <= high < math.inf):
        least = "positive" if positive else "not negative"
        reason = f"needs MIN,MAX [{unit}], {least}, finite and ascending, got {low!r},{high!r}"
        raise ArgumentError(name, None, reason)


def _draw(
    n: int, plates: int, radius: tuple[float, float], speed: tuple[float, float], period: float, seed: int, tilt: float
) -> Beads:
    """Draw times, places, sizes and speeds of beads.

    None is emitted into another, of tilted nozzles hardly any. These point to the left and to the
    right in turn, and are moved sideways so that a bead lands where it does without tilt.
    """
    down, aside = math.cos(math.radians(tilt)), math.sin(math.radians(tilt))
    _check_crowd(n, plates, radius[1], speed[0] * down, period)
    rng = np.random.default_rng(seed)
    time = (np.arange(n) + rng.random(n)) * (period / n)
    # Multiples of the golden ratio: beads that are close in time are far apart in space.
    place = (rng.random() + GOLDEN * np.arange(n)) % 1.0 * plates
    plate = np.minimum(np.floor(place), plates - 1)
    x = plate * (WIDTH + GAP) + MARGIN + (place - plate) * (WIDTH - 2.0 * MARGIN)
    thrown = rng.uniform(*speed, n)
    velocity = np.column_stack((rng.uniform(-SIDEWAYS, SIDEWAYS, n), -down * thrown))
    size: Floats = rng.uniform(*radius, n)
    if tilt:
        along = aside * thrown * np.where(np.arange(n) % 2, -1.0, 1.0)
        fall = velocity[:, 1] + np.sqrt(velocity[:, 1] ** 2 + 2.0 * GRAVITY * (HEIGHT - size))
        velocity[:, 0] += along
        x = x - along * fall / GRAVITY
    return Beads(size, time, np.column_stack((x, np.full(n, HEIGHT))), velocity)


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
