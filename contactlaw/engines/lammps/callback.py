"""The C function that LAMMPS calls in every time step, compiled by numba.

LAMMPS passes the positions; the other arrays are fetched through its C interface in every step,
because LAMMPS may move them. Forces are added to LAMMPS's own array, and only for beads that touch
a plate: the array that ``fix external`` offers would be written, read and added for all beads in
every step, which takes longer than all the rest.
"""

import functools
import math
from typing import Any

import numpy as np
from numba import types

from contactlaw._jit import c_function, kernel
from contactlaw.engines.lammps.memory import (
    FIRST,
    HEAD,
    MINIMIZING,
    NO_STEPS,
    NOT_FINITE,
    OWNER,
    RADIUS,
    RESIZED,
    RETYPED,
    REWEIGHED,
    SHARED,
    TOO_FAST,
    WIDTH,
    extract,
    look,
    mark_error,
    matrix_at,
    record_error,
    running,
    show,
    thermo,
)
from contactlaw.engines.record import IMPACT, Kind
from contactlaw.stepping import Bead, Clock, Trouble, interact
from contactlaw.stepping.bead import touches
from contactlaw.stepping.contact import CONTACT, STATUS, WallScene
from contactlaw.stepping.friction import FRICTION
from contactlaw.stepping.loads import LOAD
from contactlaw.stepping.plate_rows import PLATE_ROW, SOLID, solid_mass
from contactlaw.stepping.rigid import BODY, turn
from contactlaw.walls.facet import FACET
from contactlaw.walls.frame import FRAME
from contactlaw.walls.grid import MARGIN
from contactlaw.walls.memory import array_at, carray
from contactlaw.walls.motion import move
from contactlaw.walls.surface import OVERLAP, ROOM, box, near

_SAME = 1e-6  # largest relative change of a radius or a mass that counts as rounding
_BODY = BODY.itemsize // 8
_EVERY = 100  # steps between looks at all beads, which happen in the first step of a run, too

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
def _head(history: Any, i: int) -> Any:
    """Return the HEAD row of a bead's history."""
    return array_at(int(history[i].ctypes.data), 1, HEAD)[0]


@kernel
def _look_at_all(
    shared: Any,
    clock: Clock,
    step: int,
    scene: WallScene,
    tags: Any,
    v: Any,
    radius: Any,
    mass: Any,
    kind: Any,
    mask: Any,
    history: Any,
    last: Any,
    bodies: Any,
) -> None:
    """Report beads that could jump through a wall in one step, or of another radius or density.

    A new bead in the row of a removed one does not inherit the last COR. A bead that has left the
    group has left the walls.
    """
    fastest = 0.0
    for frame in scene.frames:
        fastest = max(fastest, frame.fastest)
    per = shared.length / shared.time
    for i in range(len(radius)):
        speed = per * math.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + v[i, 2] ** 2) + fastest
        size, head = shared.length * radius[i], _head(history, i)
        if head.owner != tags[i]:
            last[i] = 0.0
        if not mask[i] & shared.group:
            _forget(history[i])
            continue
        row = scene.plate_rows[kind[i] - 1, 0]
        flies_through = row.law == 0 and row.passes != 0  # all walls, so a wall's own model is refused
        if not (speed * clock.dt < size or flies_through):
            code = TOO_FAST if speed < math.inf else NOT_FINITE
            mark_error(shared, step, tags[i], head, code, -1, speed, size)
        if head.owner == tags[i] and head.radius != 0.0 and not _same(size, head.radius):
            # `_check_sphere` misses a bead that has become so small that no wall is near it.
            mark_error(shared, step, tags[i], head, RESIZED, -1, size, head.radius)
            _forget(history[i])
        known = len(bodies) > 0 and bodies[i, 0] != 0.0  # a part of a body may have any mass
        if not known and (head.owner != tags[i] or head.radius == 0.0):  # `_check_sphere` has the others
            solid = solid_mass(row, size)
            if abs(shared.mass * mass[i] - solid) > SOLID * solid:
                code = Trouble.WRONG_MASS.value
                mark_error(shared, step, tags[i], head, code, -1, shared.mass * mass[i], solid)


@kernel
def _same(value: float, before: float) -> bool:
    """Whether a number is what it was, up to rounding; false for a NaN."""
    return abs(value - before) <= _SAME * before


@kernel
def _forget(row: Any) -> None:
    """End all contacts of a bead, without a record."""
    row[RADIUS:] = 0.0


@kernel
def _check_sphere(shared: Any, plate_rows: Any, step: int, head: Any, bead: Bead) -> None:
    """Report a bead whose radius, mass or type has changed since it began to touch walls."""
    tag, before = bead.number, int(head.kind)
    if not _same(bead.r, head.radius):
        mark_error(shared, step, tag, head, RESIZED, -1, bead.r, head.radius)
    elif not _same(bead.mass, head.mass):
        mark_error(shared, step, tag, head, REWEIGHED, -1, bead.mass, head.mass)
    elif bead.kind != before:
        now, then = plate_rows[bead.kind, 0], plate_rows[before, 0]
        if (now.law != 0 or now.passes != 0) and now.alike != then.alike:  # else the contact reports it
            mark_error(shared, step, tag, head, RETYPED, -1, bead.kind + 1.0, before + 1.0)


@kernel
def _keep_sphere(scene: WallScene, head: Any, row: Any, bead: Bead) -> None:
    """Store radius, mass and type of a bead that begins to touch walls; drop invalid contacts."""
    if head.error >= Trouble.STARTS_INSIDE.value:
        _forget(row)
    elif not touches(bead):
        head.radius = 0.0
    elif head.radius == 0.0:
        head.radius, head.mass, head.kind = bead.r, bead.mass, bead.kind
        head.softening, head.parcel = scene.softening, scene.parcel


@kernel
def _tick(shared: Any, clock: Clock, frames: Any) -> None:
    """Advance the walls' own clock by a step, and move the walls to their positions then."""
    if clock.dt != shared.tick:
        shared.base += shared.ticks * shared.tick
        shared.ticks, shared.tick = 0, clock.dt
    if clock.advancing:
        shared.ticks += 1
    move(frames, shared.base + shared.ticks * shared.tick, clock.dt)


def _each_step(memory: Any, step: int, n: int, tags: Any, positions: Any, forces: Any) -> None:
    """Add the force of the walls to all beads of this rank."""
    shared = carray(memory, 1, SHARED)[0]
    shared.calls += 1
    # At a set-up, no step of the run has elapsed. The step number may be reset, so it is not used.
    advancing = thermo(shared, shared.elapsed) > 0.0
    follows, shared.step = step == shared.step + 1, step
    if running(shared) == MINIMIZING or (advancing and not follows):
        record_error(shared, step, -1, NO_STEPS, -1, 0.0, 0.0)
        return
    length, seconds = shared.length, shared.time
    dt = array_at(shared.dt, 1, np.float64)[0] * seconds
    time = array_at(shared.atime, 1, np.float64)
    at_step = array_at(shared.atimestep, 1, np.int64)
    before = shared.before if shared.before > 0.0 else dt
    if advancing:
        shared.before = dt
    clock = Clock(time[0] * seconds + (step - at_step[0]) * dt, dt, before, advancing)
    scene = WallScene(
        array_at(shared.plate_rows, (shared.types, shared.plate_row_count), PLATE_ROW),
        array_at(shared.frames, shared.frame_count, FRAME),
        array_at(shared.facets, shared.facet_count, FACET),
        array_at(shared.found, ROOM, OVERLAP),
        array_at(shared.impacts, shared.capacity, IMPACT),
        array_at(shared.status, 1, STATUS),
        array_at(shared.loads, shared.walls, LOAD),
        array_at(shared.pressed, shared.facet_count, np.float64),
        shared.friction,
        shared.softening,
        shared.parcel,
    )
    if advancing and step % _EVERY == 0:  # on all ranks, also without beads
        show(shared, scene.loads, shared.base + shared.ticks * shared.tick)
    _tick(shared, clock, scene.frames)
    if shared.look != 0 and (step % _EVERY == 0 or not advancing):  # on all ranks, too
        look(shared)
    history_address = extract(shared, shared.history)
    if n == 0 or history_address == 0:  # 0: a command has removed the fix of the history
        return
    v = matrix_at(extract(shared, shared.v), n, 3)
    radius = array_at(extract(shared, shared.radius), n, np.float64)
    mass = array_at(extract(shared, shared.rmass), n, np.float64)
    kind = array_at(extract(shared, shared.type), n, np.int32)
    mask = array_at(extract(shared, shared.mask), n, np.int32)
    history = matrix_at(history_address, n, shared.columns)
    last = array_at(extract(shared, shared.last), n, np.float64)
    omega = matrix_at(extract(shared, shared.omega), n, 3)
    torque, sliding = v, 0
    if shared.friction > 0.0:
        torque = matrix_at(extract(shared, shared.torque), n, 3)
        sliding = shared.places
    bodies, count = v, 0
    if shared.look != 0:
        bodies, count = matrix_at(extract(shared, shared.body), n, _BODY), 1
    if step % _EVERY == 0 or not advancing:
        known = bodies[: count * n]
        _look_at_all(shared, clock, step, scene, tags, v, radius, mass, kind, mask, history, last, known)
    for i in range(count * n):
        if advancing and step % _EVERY != 0 and bodies[i, 0] != 0.0:  # a look has the axes of this step
            spin = omega[i, 0] / seconds, omega[i, 1] / seconds, omega[i, 2] / seconds
            turn(array_at(int(bodies[i].ctypes.data), 1, BODY)[0], spin, dt)
    x, force = carray(positions[0], (n, 3)), matrix_at(extract(shared, shared.f), n, 3)
    per, status, loads = length / seconds, scene.status[0], shared.bead_loads
    x0, y0, z0, x1, y1, z1 = box(scene.frames)
    for i in range(n):
        if not mask[i] & shared.group:
            continue
        centre = x[i, 0] * length, x[i, 1] * length, x[i, 2] * length
        reach = MARGIN * radius[i] * length
        if not (
            z0 - reach <= centre[2] <= z1 + reach
            and x0 - reach <= centre[0] <= x1 + reach
            and y0 - reach <= centre[1] <= y1 + reach
            and near(scene.frames, centre, radius[i] * length)
        ):
            continue
        row, head = history[i], _head(history, i)
        if head.owner != tags[i]:
            row[OWNER:] = 0.0
            head.owner, head.columns, last[i] = tags[i], shared.columns, 0.0
        first = int(row.ctypes.data) + 8 * FIRST
        bead = Bead(
            tags[i],
            kind[i] - 1,
            centre,
            (v[i, 0] * per, v[i, 1] * per, v[i, 2] * per),
            (omega[i, 0] / seconds, omega[i, 1] / seconds, omega[i, 2] / seconds),
            radius[i] * length,
            mass[i] * shared.mass,
            loads[0],
            loads[1],
            array_at(first, shared.places, CONTACT),
            array_at(first + 8 * WIDTH * shared.places, sliding, FRICTION),
        )
        if head.radius != 0.0:
            _check_sphere(shared, scene.plate_rows, step, head, bead)
        if not head.error >= Trouble.STARTS_INSIDE.value:
            recorded, loads[:] = status.impacts, 0.0
            interact(scene, clock, bead, array_at(int(bodies[i].ctypes.data), count, BODY))
            for k in range(3):
                force[i, k] += loads[0, k] * seconds**2 / (shared.mass * length)
                if sliding > 0:
                    torque[i, k] += loads[1, k] * seconds**2 / (shared.mass * length**2)
            for n in range(recorded, status.impacts):
                what = scene.impacts[n].kind
                if what == Kind.IMPACT.value or what == Kind.OF_BODY.value:  # other kinds have no COR
                    last[i] = scene.impacts[n].restitution
            if status.trouble != 0:
                mark_error(shared, step, tags[i], head, status.trouble, status.wall, status.value, status.limit)
                head.error = max(head.error, status.worst)
                status.trouble = status.worst = 0
        _keep_sphere(scene, head, row, bead)


@functools.cache
def callback() -> Any:
    """Return the C function for ``fix external``, compiled or from the disk cache."""
    return c_function(_SIGNATURE, _each_step, cache=True)
