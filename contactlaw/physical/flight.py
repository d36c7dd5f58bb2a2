"""Flight of a sphere in still air: its height, its time, and the speeds at both ends.

A drop is the second half of a flight. Legend: s square root of the distance from the apex over the
height, w half the square of the speed.
"""

import warnings
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._readable import percent

GRAVITY = 9.80665  # [m/s2] standard gravity
_AIR, _VISCOSITY = 1.204, 1.82e-5  # [kg/m3, Pa s] dry air, 20 degrees, 1013 hPa; Lemmon, Jacobsen 2004
NO_AIR = 1e30  # [kg/m3] density of a sphere that the air does not slow
_STEPS = 64  # of half a flight, even; speeds are within 1e-7, or 5e-6 of one that loses 97 % in air
_ROUNDS = 8  # of Newton's method
_SAID = 0.01  # share of a speed from which the work of the air is said


class Flight(NamedTuple):
    """Flights from a level and back to it, in SI units."""

    height: Array
    time: Array
    up: Array  # speed at which the sphere takes off
    down: Array  # speed at which it arrives, also after a drop from the height


def of_height(height: ArrayLike, radius: ArrayLike = 1.0, density: ArrayLike = NO_AIR) -> Flight:
    """Flights to some heights, of spheres of a radius and a density; by default without air.

    The drag is that of Clift and Gauvin (1971), for Reynolds numbers up to 3e5; buoyancy and added
    mass are those of a sphere.

    Examples
    --------
    >>> float(of_height(0.3).down.round(4)), float(of_height(0.3, 1e-3, 2500.0).down.round(4))
    (2.4257, 2.3763)
    """
    h, r, rho = np.broadcast_arrays(*(np.asarray(one, dtype=np.float64) for one in (height, radius, density)))
    with np.errstate(invalid="ignore"):
        up, rise = _half(h, r, rho, -1.0)
        down, fall = _half(h, r, rho, 1.0)
    if (lost := np.isnan(fall) & np.isfinite(h)).any():
        reason = "such a bead has fallen at its terminal speed for long, by far slower than without air: give the speed"
        raise ArgumentError("radius", r[lost].flat[0], reason)
    return Flight(h, rise + fall, up, down)


def of_time(time: ArrayLike, radius: ArrayLike = 1.0, density: ArrayLike = NO_AIR) -> Flight:
    """Flights of some durations, as `of_height`."""
    t = np.asarray(time, dtype=np.float64)
    height = GRAVITY * t**2 / 8.0
    for _ in range(_ROUNDS):  # the time is concave in the height, with this slope
        found = of_height(height, radius, density)
        step = (found.time - t) / (1.0 / found.up + 1.0 / found.down)
        height = np.maximum(found.height - step, 0.1 * found.height)
        if not (np.abs(step) > 1e-10 * height).any():
            break
    return of_height(height, radius, density)


def _half(height: Array, radius: Array, density: Array, sign: float) -> tuple[Array, Array]:
    """Speed at the foot of the half of a flight below its apex, and its time; the sign is 1 down."""
    inert = density + 0.5 * _AIR
    weight = GRAVITY * (density - _AIR) / inert

    def slope(s: float, w: Array) -> Array:
        v = np.sqrt(2.0 * w)
        re = 2.0 * radius * v * _AIR / _VISCOSITY
        drag = 24.0 * (1.0 + 0.15 * re**0.687) + 0.42 * re**2.16 / (re**1.16 + 42500.0)  # C_D Re
        return 2.0 * height * s * (weight - sign * 0.1875 * _VISCOSITY * drag * v / (radius**2 * inert))

    d = 1.0 / _STEPS
    w = np.zeros(height.shape)
    duration = np.sqrt(2.0 * height / weight)  # Simpson's rule of 2 h s / v, of which this is the start
    for n in range(1, _STEPS + 1):
        s = (n - 1) * d
        k1 = slope(s, w)
        k2 = slope(s + 0.5 * d, w + 0.5 * d * k1)
        k3 = slope(s + 0.5 * d, w + 0.5 * d * k2)
        w = w + d / 6.0 * (k1 + 2.0 * (k2 + k3) + slope(s + d, w + d * k3))
        factor = 1.0 if n == _STEPS else 2.0 + 2.0 * (n % 2)
        duration = duration + factor * 2.0 * height * n * d / np.sqrt(2.0 * w)
    return np.sqrt(2.0 * w), duration * d / 3.0


def say_air(ratio: Array) -> None:
    """Warn if speeds differ by more than 1 % from those without air, of which they are this share."""
    share = float(np.max(np.abs(np.nan_to_num(ratio, nan=1.0) - 1.0), initial=0.0))
    if share > _SAID:
        warnings.warn(
            f"the air changes the speeds by up to {percent(share)}, which is taken into account", stacklevel=5
        )
