"""What runs in every time step: a C function made by numba, which LAMMPS calls by its address.

LAMMPS hands over the positions; the other arrays are fetched through its C interface, every time,
for they move. Forces are added to LAMMPS's own, and only for beads that touch a plate: the array
which ``fix external`` offers for them would be written, read and added for all beads in every step,
and that takes longer than all the rest.
"""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np
from numba import types

from contactlaw._jit import c_function, kernel
from contactlaw.engines.lammps.contact import NEAR, Bead, Clock, hand_over, interact
from contactlaw.engines.lammps.memory import (
    NOT_FINITE,
    SHARED,
    TOO_FAST,
    array_at,
    carray,
    complain,
    extract,
    matrix_at,
    thermo,
)
from contactlaw.engines.lammps.plate import ROW

_EVERY = 100  # steps between looks for beads that fly further than their radius in a step

_pointer: Any = types.CPointer
_SIGNATURE = types.void(
    types.voidptr,  # memory of the attachment
    types.int64,  # time step
    types.int32,  # beads of this rank
    _pointer(types.int32),  # their IDs
    _pointer(_pointer(types.float64)),  # positions
    _pointer(_pointer(types.float64)),  # forces that the fix would add; its group is empty
)


@kernel
def _look_for_jumps(
    shared: Any, clock: Clock, tags: Any, v: Any, radius: Any, history: Any
) -> None:
    """Complain of beads that could be on the other side of a plate after one step."""
    for i in range(len(radius)):
        speed = math.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + v[i, 2] ** 2)
        if not speed * clock.dt < radius[i]:
            code = TOO_FAST if speed < math.inf else NOT_FINITE
            complain(shared, clock.step, tags[i], history[i], code, -1, speed, radius[i])


def _each_step(memory: Any, step: int, n: int, tags: Any, positions: Any, forces: Any) -> None:
    """Add the force of the plates to all beads of this rank."""
    shared = carray(memory, 1, SHARED)[0]
    shared.calls += 1
    dt = array_at(shared.dt, 1, np.float64)[0]
    time, at_step = (
        array_at(shared.atime, 1, np.float64),
        array_at(shared.atimestep, 1, np.int64),
    )
    # No step of a run has passed in a set-up; the number of the step can be reset at will.
    advancing = thermo(shared, shared.elapsed) > 0.0
    before = shared.before if shared.before > 0.0 else dt
    if advancing:
        shared.before = dt
    if n == 0:
        return
    clock = Clock(step, time[0] + (step - at_step[0]) * dt, dt, before, advancing)
    v = matrix_at(extract(shared, shared.v), n, 3)
    radius = array_at(extract(shared, shared.radius), n, np.float64)
    mass = array_at(extract(shared, shared.rmass), n, np.float64)
    history = matrix_at(extract(shared, shared.history), n, shared.columns)
    omega, torque = v, v
    if shared.friction > 0.0:
        omega = matrix_at(extract(shared, shared.omega), n, 3)
        torque = matrix_at(extract(shared, shared.torque), n, 3)
    if step % _EVERY == 0:
        _look_for_jumps(shared, clock, tags, v, radius, history)
    x, force = carray(positions[0], (n, 3)), matrix_at(extract(shared, shared.f), n, 3)
    plates = array_at(shared.plates, shared.plate_count, ROW)
    # Local numbers: the compiler cannot know that nothing below changes `shared`.
    count = shared.plate_count
    x0, y0, z0 = shared.low[0], shared.low[1], shared.low[2]
    x1, y1, z1 = shared.high[0], shared.high[1], shared.high[2]
    for i in range(n):
        reach = NEAR * radius[i]
        if (
            x[i, 2] > z1 + reach
            or x[i, 2] < z0 - reach
            or x[i, 0] > x1 + reach
            or x[i, 0] < x0 - reach
            or x[i, 1] > y1 + reach
            or x[i, 1] < y0 - reach
        ):
            continue
        bead = Bead(
            tags[i], x[i], v[i], omega[i], torque[i], force[i], history[i], radius[i], mass[i]
        )
        if count > 1 and advancing:
            hand_over(shared, plates, bead)
        for p in range(count):
            interact(shared, clock, plates, p, bead)


@functools.cache
def callback() -> Any:
    """Return the C function for ``fix external``, compiled or from the disk cache."""
    return c_function(_SIGNATURE, _each_step, cache=True)
