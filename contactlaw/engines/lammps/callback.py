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
from contactlaw.engines.lammps.contact import Clock, Walls, interact
from contactlaw.engines.lammps.geometry import Bead
from contactlaw.engines.lammps.grid import MARGIN
from contactlaw.engines.lammps.memory import (
    ERROR,
    KIND,
    MASS,
    MINIMIZING,
    NO_STEPS,
    NOT_FINITE,
    OWNER,
    RADIUS,
    RESIZED,
    RETYPED,
    REWEIGHED,
    SHARED,
    STARTS_INSIDE,
    TOO_FAST,
    array_at,
    carray,
    complain,
    extract,
    keep,
    matrix_at,
    running,
    thermo,
    touches,
)
from contactlaw.engines.lammps.motion import place
from contactlaw.engines.lammps.surface import OVERLAP, ROOM, near
from contactlaw.engines.lammps.walls import FACET, FRAME, SHEET

_SAME = 1e-6  # relative change of a radius or a mass that is rounding
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
    shared: Any, clock: Clock, walls: Walls, tags: Any, v: Any, radius: Any, history: Any, last: Any
) -> None:
    """Complain of beads that could be on the other side of a wall after one step.

    And forget the impacts of beads that are no more, whose rows new ones have taken.
    """
    fastest = 0.0
    for frame in walls.frames:
        fastest = max(fastest, frame.fastest)
    per = shared.length / shared.time
    for i in range(len(radius)):
        speed = per * math.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + v[i, 2] ** 2) + fastest
        size = shared.length * radius[i]
        if not speed * clock.dt < size:
            code = TOO_FAST if speed < math.inf else NOT_FINITE
            complain(shared, clock.step, tags[i], history[i], code, -1, speed, size)
        if history[i, OWNER] != tags[i]:
            last[i] = 0.0
        elif history[i, RADIUS] != 0.0 and not _same(size, history[i, RADIUS]):
            # a bead that has become so small that no wall is near it
            complain(shared, clock.step, tags[i], history[i], RESIZED, -1, size, history[i, RADIUS])
            _forget(history[i])


@kernel
def _same(value: float, before: float) -> bool:
    """Whether a number is what it was; false for no number."""
    return abs(value - before) <= _SAME * before


@kernel
def _forget(row: Any) -> None:
    """End all contacts of a bead, without a record."""
    row[RADIUS:] = 0.0


@kernel
def _check_sphere(
    shared: Any, sheets: Any, step: int, tag: int, row: Any, r: float, mass: float, kind: int
) -> None:
    """Complain of a bead that touches walls and is no more the sphere that began to touch them."""
    before = int(row[KIND])
    if not _same(r, row[RADIUS]):
        complain(shared, step, tag, row, RESIZED, -1, r, row[RADIUS])
    elif not _same(mass, row[MASS]):
        complain(shared, step, tag, row, REWEIGHED, -1, mass, row[MASS])
    elif kind != before:
        now, then = sheets[kind * shared.sheet_count], sheets[before * shared.sheet_count]
        if now.law != 0 and now.alike != then.alike:  # without a model the contact itself says so
            complain(shared, step, tag, row, RETYPED, -1, kind + 1.0, before + 1.0)


@kernel
def _keep_sphere(shared: Any, tag: int, row: Any, r: float, mass: float, kind: int) -> None:
    """Remember a bead that has begun to touch walls; forget contacts that mean nothing any more."""
    if row[OWNER] != tag:
        return
    if row[ERROR] >= STARTS_INSIDE:
        _forget(row)
    elif not touches(row, shared):
        row[RADIUS] = 0.0
    elif row[RADIUS] == 0.0:
        row[RADIUS], row[MASS], row[KIND] = r, mass, kind


@kernel
def _tick(shared: Any, clock: Clock, frames: Any) -> None:
    """Let the walls' own clock go on by a step, and put the walls to where they are then."""
    if clock.dt != shared.tick:
        shared.base += shared.ticks * shared.tick
        shared.ticks, shared.tick = 0, clock.dt
    if clock.advancing:
        shared.ticks += 1
    time = shared.base + shared.ticks * shared.tick
    for frame in frames:
        if frame.moves != 0:
            place(frame, time, clock.dt)


@kernel
def _box(frames: Any) -> tuple[float, float, float, float, float, float]:
    """Box around all walls, where they are now: three lowest coordinates, three highest."""
    low, high = np.full(3, math.inf), np.full(3, -math.inf)
    for frame in frames:
        small, large, turn = frame.low, frame.high, frame.turn
        for k in range(3):
            if frame.moves == 0:
                a, b = small[k], large[k]
            else:
                a = b = frame.hub[k] + frame.shift[k]
                for m in range(3):
                    one = turn[3 * k + m] * (small[m] - frame.hub[m])
                    other = turn[3 * k + m] * (large[m] - frame.hub[m])
                    a, b = a + min(one, other), b + max(one, other)
            low[k], high[k] = min(low[k], a), max(high[k], b)
    return low[0], low[1], low[2], high[0], high[1], high[2]


def _each_step(memory: Any, step: int, n: int, tags: Any, positions: Any, forces: Any) -> None:
    """Add the force of the walls to all beads of this rank."""
    shared = carray(memory, 1, SHARED)[0]
    shared.calls += 1
    # No step of a run has passed in a set-up; the number of the step can be reset at will.
    advancing = thermo(shared, shared.elapsed) > 0.0
    follows, shared.step = step == shared.step + 1, step
    if running(shared) == MINIMIZING or (advancing and not follows):
        keep(shared, step, -1, NO_STEPS, -1, 0.0, 0.0)
        return
    length, seconds = shared.length, shared.time
    dt = array_at(shared.dt, 1, np.float64)[0] * seconds
    time, at_step = (
        array_at(shared.atime, 1, np.float64),
        array_at(shared.atimestep, 1, np.int64),
    )
    before = shared.before if shared.before > 0.0 else dt
    if advancing:
        shared.before = dt
    clock = Clock(step, time[0] * seconds + (step - at_step[0]) * dt, dt, before, advancing)
    walls = Walls(
        array_at(shared.sheets, shared.types * shared.sheet_count, SHEET),
        array_at(shared.frames, shared.frame_count, FRAME),
        array_at(shared.facets, shared.facet_count, FACET),
        array_at(shared.overlaps, ROOM, OVERLAP),
    )
    _tick(shared, clock, walls.frames)
    history_address = extract(shared, shared.history)
    if n == 0 or history_address == 0:  # 0: a command has taken it away
        return
    v = matrix_at(extract(shared, shared.v), n, 3)
    radius = array_at(extract(shared, shared.radius), n, np.float64)
    mass = array_at(extract(shared, shared.rmass), n, np.float64)
    kind = array_at(extract(shared, shared.type), n, np.int32)
    history = matrix_at(history_address, n, shared.columns)
    last = array_at(extract(shared, shared.last), n, np.float64)
    omega, torque = v, v
    if shared.friction > 0.0:
        omega = matrix_at(extract(shared, shared.omega), n, 3)
        torque = matrix_at(extract(shared, shared.torque), n, 3)
    if step % _EVERY == 0:
        _look_for_jumps(shared, clock, walls, tags, v, radius, history, last)
    x, force = carray(positions[0], (n, 3)), matrix_at(extract(shared, shared.f), n, 3)
    per = length / seconds
    x0, y0, z0, x1, y1, z1 = _box(walls.frames)
    for i in range(n):
        centre, reach = (
            (x[i, 0] * length, x[i, 1] * length, x[i, 2] * length),
            MARGIN * radius[i] * length,
        )
        if (
            centre[2] > z1 + reach
            or centre[2] < z0 - reach
            or centre[0] > x1 + reach
            or centre[0] < x0 - reach
            or centre[1] > y1 + reach
            or centre[1] < y0 - reach
        ):
            continue
        if not near(walls.frames, centre, radius[i] * length):
            continue
        row, r, heavy = history[i], radius[i] * length, mass[i] * shared.mass
        if row[OWNER] == tags[i] and row[RADIUS] != 0.0:
            _check_sphere(shared, walls.sheets, step, tags[i], row, r, heavy, kind[i] - 1)
        bead = Bead(
            tags[i],
            kind[i] - 1,
            centre,
            (v[i, 0] * per, v[i, 1] * per, v[i, 2] * per),
            (omega[i, 0] / seconds, omega[i, 1] / seconds, omega[i, 2] / seconds),
            r,
            heavy,
            force[i],
            torque[i],
            row,
            last[i : i + 1],
        )
        if not row[ERROR] >= STARTS_INSIDE:
            interact(shared, clock, walls, bead)
        _keep_sphere(shared, tags[i], row, r, heavy, kind[i] - 1)


@functools.cache
def callback() -> Any:
    """Return the C function for ``fix external``, compiled or from the disk cache."""
    return c_function(_SIGNATURE, _each_step, cache=True)
