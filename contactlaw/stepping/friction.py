"""Tangential force of a contact: a spring that slides.

The spring is that of LAMMPS's ``mindlin``, k = 8 G* sqrt(r d), without damping, and slides at
Coulomb's limit. `FRICTION` is its state between two steps.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlaw._jit import kernel
from contactlaw.walls.facet import Point

FRICTION = np.dtype([("stretch", "f8", 3)])  # elongation of the tangential spring [m]


def check_friction(friction: Any) -> None:
    """Refuse a coefficient of friction that is no finite number of 0 or more."""
    if not isinstance(friction, int | float | np.number) or isinstance(friction, bool):
        raise TypeError(f"friction: expected a number, got {friction!r}")
    if not 0.0 <= friction < math.inf:
        raise ValueError(f"friction: must be finite and not negative, got {friction!r}")


@kernel
def tangential_force(
    row: Any, friction: float, stiffness: float, n: Point, slip: Point, dt: float, force: float,
    extra: float,
) -> Point:  # fmt: skip
    """Tangential force on a bead [N], from the velocity of its surface relative to the wall.

    `force` is the normal force and `extra` its correction in this step; a contact with `extra`
    alone has just ended. A step dt of 0 gives the force of the last step again.
    """
    stretch = row.stretch
    ended = force == 0.0 and extra != 0.0
    if dt > 0.0:
        x, y, z = stretch[0] + dt * slip[0], stretch[1] + dt * slip[1], stretch[2] + dt * slip[2]
        along = x * n[0] + y * n[1] + z * n[2]
        x, y, z = x - along * n[0], y - along * n[1], z - along * n[2]
        size, most = stiffness * math.sqrt(x * x + y * y + z * z), friction * force
        share = 1.0 if force > 0.0 or ended else 0.0
        if force > 0.0 and size > most:
            share = most / size
        stretch[0], stretch[1], stretch[2] = share * x, share * y, share * z
    if ended:  # a contact that has just ended slides
        size = math.sqrt(stretch[0] ** 2 + stretch[1] ** 2 + stretch[2] ** 2)
        stiffness = friction * extra / size if size > 0.0 else 0.0
    elif extra != 0.0:
        stiffness *= 1.0 + extra / force
    return -stiffness * stretch[0], -stiffness * stretch[1], -stiffness * stretch[2]


@kernel
def surface_velocity(v: Point, omega: Point, r: float, n: Point) -> Point:
    """Velocity of a sphere's surface at -r n from its centre [m/s]."""
    return (
        v[0] - r * (omega[1] * n[2] - omega[2] * n[1]),
        v[1] - r * (omega[2] * n[0] - omega[0] * n[2]),
        v[2] - r * (omega[0] * n[1] - omega[1] * n[0]),
    )
