"""What walls bear: force, torque and power of each."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._jit import kernel
from contactlaw.physical.vectors import cross, plus, vector
from contactlaw.walls.facet import Point

# Integrals over time of what a wall bears.
LOAD = np.dtype([("force", "f8", 3), ("torque", "f8", 3), ("power", "f8")])
NUMBERS = LOAD.itemsize // 8


class Loads(NamedTuple):
    """Means over a time, with a row for each wall in the order in which they were given."""

    duration: float  # [s]
    force: Array  # of the beads on the wall, shape (walls, 3) [N]
    torque: Array  # of these forces about the centre of the wall's rotation, else the origin [N m]
    power: Array  # that the wall gives to the beads by its motion, shape (walls,) [W]


@kernel
def bear(load: Any, frame: Any, point: Point, force: Point, power: float, dt: float) -> None:
    """Add what a wall bears in a step by the force on a bead at a point."""
    # The hub of walls that do not turn is the origin.
    torque = cross(plus(point, -1.0, vector(frame.hub)), force)
    for i in range(3):
        load.force[i] -= dt * force[i]
        load.torque[i] -= dt * torque[i]
    load.power += dt * power


def means(sums: Array, duration: float) -> Loads:
    """Means over a time [s], from the numbers of LOAD of each wall, shape (walls, NUMBERS)."""
    if not duration > 0.0:
        raise ArgumentError("duration", duration, "loads are means over time: simulate some steps first")
    rows = sums / duration
    return Loads(duration, rows[:, :3], rows[:, 3:6], rows[:, 6])
