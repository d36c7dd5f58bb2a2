"""One time step of an engine: the walls and all beads of a process, from its arrays, in its units.

Numba compiles `begin` and `step` for `contactlaw.engines.lammps`; `contactlaw.export` writes them in
C for LAMMPS's fix. The step's number, messages, sums over processes and the axes of rigid bodies
stay outside.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._jit import kernel
from contactlaw.physical.kind import Kind
from contactlaw.physical.vectors import divided, norm, scaled, vector
from contactlaw.stepping.bead import MOST_CONTACTS, apply_walls, touches
from contactlaw.stepping.contact import CONTACT, Bead, Clock, WallScene, clear_contact
from contactlaw.stepping.friction import FRICTION
from contactlaw.stepping.plate_rows import SOLID, modelled_mass
from contactlaw.stepping.rigid import BODY
from contactlaw.stepping.trouble import Trouble
from contactlaw.walls.facet import Point
from contactlaw.walls.grid import MARGIN
from contactlaw.walls.memory import array_at
from contactlaw.walls.motion import move
from contactlaw.walls.surface import box, near

BODY_BYTES = BODY.itemsize
SAME = 1e-6  # largest relative change of a radius or a mass that counts as rounding
ROWS = 2 * MOST_CONTACTS  # of the record that one bead may need in a step

# A bead's history, of numbers that an engine stores and moves with it: this row, then the CONTACT
# rows, then, with friction, the FRICTION rows. An engine may give a new bead the row of a removed
# one without emptying it: `owner` shows whose row it is.
HEAD = np.dtype(
    # error: a `Trouble`, which ends the run, 0 without one; owner: number of the bead; layout: LAYOUT
    # and how many numbers the history has; start: of the walls' motion [s], as in RUN, for restarts
    [(name, "f8") for name in ("error", "owner", "layout", "start")]
    # the bead as it was when it began to touch walls, in SI units; a radius of 0: it touches none
    + [(name, "f8") for name in ("radius", "mass", "kind", "softening", "parcel")]
    + [("force", "f8", 3), ("torque", "f8", 3)]  # of the last step, in the engine's units
)
FIRST, WIDTH, SLIDING = (dtype.itemsize // 8 for dtype in (HEAD, CONTACT, FRICTION))

LAYOUT = 2000  # of these columns; histories of version 0.3 have numbers below 1000 in its place

# What lasts from step to step. Walls move by a clock of their own, because an engine's may round
# differently in a run in pieces, or be reset: `ticks` steps of length `tick` since `base`.
RUN = np.dtype(
    [(name, "f8") for name in ("length", "time", "mass")]  # the engine's units, in SI
    # before: the step before [s]; start: time at which moving walls are where they were given [s]; ahead:
    # how far the engine's clock is ahead of the walls'; energy: the sum that beads give to walls, in the engine's units
    + [(name, "f8") for name in ("base", "tick", "before", "start", "ahead", "energy")]
    + [(name, "i8") for name in ("ticks", "group", "accounts")]  # group: bits of the beads; accounts: whether to sum
    + [("low", "f8", 3), ("period", "f8", 3)]  # of the box, in the engine's units; 0: not periodic
    + [(name, "f8") for name in ("error", "bead", "wall", "value", "limit")]  # the first error; 0: none
    + [("forces", "f8", (2, 3))]  # force and torque on a bead
)


class Beads(NamedTuple):
    """An engine's arrays of the beads of a process, in its units."""

    n: int
    tag: Any
    kind: Any  # types, from 1
    mask: Any  # bits of the groups
    x: Any
    v: Any  # half a step before
    omega: Any
    radius: Any
    mass: Any
    force: Any
    torque: Any
    last: Any  # COR of each bead's last impact
    history: int  # address of the first bead's HEAD
    bytes: int  # from the HEAD of a bead to that of the next
    places: int  # rows of CONTACT of a bead
    bodies: Any  # address of rows of BODY, 0 without any; None in engines that have none


@kernel
def body_of(bodies: Any, i: int) -> Any:
    """Row of the body that a bead is a part of."""
    if bodies is None:
        return None
    return array_at(bodies + BODY_BYTES * i, 1 if bodies != 0 else 0, BODY)


@kernel
def _same(value: float, before: float) -> bool:
    """Whether a number is what it was, up to rounding; false for a NaN."""
    return abs(value - before) <= SAME * before


@kernel
def fail(run: Any, head: Any, bead: float, code: int, wall: int, value: float, limit: float) -> None:
    """Keep an error if it is the first, and mark the bead."""
    head.error = max(head.error, code)
    if run.error == 0.0:
        run.error, run.bead, run.wall, run.value, run.limit = code, bead, wall, value, limit


@kernel
def _forget(head: Any, bead: Bead) -> None:
    """End all contacts of a bead, without a record."""
    head.radius = 0.0
    for k in range(3):
        head.force[k] = head.torque[k] = 0.0
    for k in range(len(bead.contacts)):
        clear_contact(bead, k)


@kernel
def _bead_of(scene: WallScene, run: Any, beads: Beads, i: int, centre: Point) -> Bead:
    """One bead in SI units."""
    first = beads.history + beads.bytes * i + 8 * FIRST
    sliding = beads.places if scene.friction > 0.0 else 0
    return Bead(
        float(beads.tag[i]),
        beads.kind[i] - 1,
        centre,
        scaled(run.length / run.time, vector(beads.v[i])),
        divided(vector(beads.omega[i]), run.time),
        beads.radius[i] * run.length,
        beads.mass[i] * run.mass,
        run.forces[0],
        run.forces[1],
        array_at(first, beads.places, CONTACT),
        array_at(first + 8 * WIDTH * beads.places, sliding, FRICTION),
    )


@kernel
def _head_of(run: Any, beads: Beads, i: int, bead: Bead) -> Any:
    """Head of a bead's history; a new bead in the row of a removed one does not inherit that."""
    head = array_at(beads.history + beads.bytes * i, 1, HEAD)[0]
    head.layout, head.start = LAYOUT + beads.bytes // 8, run.start
    if head.owner != bead.number:
        _forget(head, bead)
        head.owner, beads.last[i] = bead.number, 0.0
    return head


@kernel
def _wrapped(x: float, low: float, period: float, length: float) -> float:
    """Coordinate of a bead [m], inside of the box where that is periodic."""
    if period > 0.0:
        x -= period * math.floor((x - low) / period)
    return length * x


@kernel
def _look_at_all(scene: WallScene, run: Any, clock: Clock, beads: Beads) -> None:
    """Report beads that could jump through a wall in one step, or of another radius or density.

    A bead that has left the group has left the walls.
    """
    fastest = 0.0
    for f in range(len(scene.frames)):
        fastest = max(fastest, scene.frames[f].fastest)
    for i in range(beads.n):
        bead = _bead_of(scene, run, beads, i, (0.0, 0.0, 0.0))
        head, tag, size, speed = _head_of(run, beads, i, bead), bead.number, bead.r, norm(bead.v) + fastest
        if not beads.mask[i] & run.group:
            _forget(head, bead)
            continue
        row = scene.plate_rows[bead.kind, 0]
        flies_through = row.law == 0 and row.passes != 0  # all walls, so a wall's own model is refused
        if not (speed * clock.dt < size or flies_through):
            code = Trouble.TOO_FAST.value if speed < math.inf else Trouble.NOT_FINITE.value
            fail(run, head, tag, code, -1, speed, size)
        if head.radius != 0.0 and not _same(size, head.radius):
            # `_check` misses a bead that has become so small that no wall is near it.
            fail(run, head, tag, Trouble.RESIZED.value, -1, size, head.radius)
            _forget(head, bead)
        body, solid = body_of(beads.bodies, i), modelled_mass(row, size)
        free = body is None or len(body) == 0 or body[0].inverse_mass == 0.0  # a part of a body may have any mass
        if free and head.radius == 0.0 and abs(bead.mass - solid) > SOLID * solid:  # `_check` has the others
            fail(run, head, tag, Trouble.WRONG_MASS.value, -1, bead.mass, solid)


@kernel
def _check(scene: WallScene, run: Any, head: Any, bead: Bead) -> None:
    """Report a bead whose radius, mass or type has changed since it began to touch walls."""
    before = int(head.kind)
    if not _same(bead.r, head.radius):
        fail(run, head, bead.number, Trouble.RESIZED.value, -1, bead.r, head.radius)
    elif not _same(bead.mass, head.mass):
        fail(run, head, bead.number, Trouble.REWEIGHED.value, -1, bead.mass, head.mass)
    elif head.softening != scene.softening or head.parcel != scene.parcel:
        fail(run, head, bead.number, Trouble.CLASH.value, -1, head.softening, head.parcel)
    elif bead.kind != before:
        now, then = scene.plate_rows[bead.kind, 0], scene.plate_rows[before, 0]
        if (now.law != 0 or now.passes != 0) and now.alike != then.alike:  # else the contact reports it
            fail(run, head, bead.number, Trouble.RETYPED.value, -1, bead.kind + 1.0, before + 1.0)


@kernel
def _keep(scene: WallScene, head: Any, bead: Bead) -> None:
    """Store radius, mass and type of a bead that begins to touch walls; drop invalid contacts."""
    if head.error >= Trouble.STARTS_INSIDE.value:
        _forget(head, bead)
    elif not touches(bead):
        head.radius = 0.0
    elif head.radius == 0.0:
        head.radius, head.mass, head.kind = bead.r, bead.mass, float(bead.kind)
        head.softening, head.parcel = scene.softening, scene.parcel


@kernel
def _tick(run: Any, clock: Clock, frames: Any) -> None:
    """Advance the walls' own clock by a step, and move the walls to their positions then."""
    if clock.dt != run.tick:
        run.base += run.ticks * run.tick
        run.ticks, run.tick = 0, clock.dt
    if clock.advancing:
        run.ticks += 1
    now = run.base + run.ticks * run.tick
    if abs(clock.now - now - run.ahead) > 0.5 * clock.dt:  # the engine's clock has been reset
        run.ahead = clock.now - now
    move(frames, now - run.start, clock.dt)


@kernel
def enclose(run: Any, clock: Clock, low: Any, high: Any, periodic: Any) -> None:
    """Take over the engine's box; refuse a periodic one that deforms during a run."""
    for k in range(3):
        before, run.period[k] = run.period[k], (high[k] - low[k]) * periodic[k]
        run.low[k] = low[k]
        if clock.advancing and run.period[k] != before and run.error == 0.0:
            run.error, run.bead, run.wall = Trouble.DEFORMED.value, -1.0, -1.0


@kernel
def _apply(scene: WallScene, run: Any, beads: Beads, i: int) -> None:
    """Add the walls' force and torque to the engine's arrays, in its units."""
    square, unit = run.time * run.time, run.mass * run.length
    for k in range(3):
        run.forces[0, k] = run.forces[0, k] * square / unit
        run.forces[1, k] = run.forces[1, k] * square / (unit * run.length)
        beads.force[i, k] += run.forces[0, k]
        if scene.friction > 0.0:
            beads.torque[i, k] += run.forces[1, k]


@kernel
def _account(run: Any, clock: Clock, beads: Beads, head: Any, i: int) -> None:
    """Add the energy that a bead has given to the walls, after `_apply`."""
    # v and omega are of the middle of the step: Verlet's scheme has them after a half of its force.
    dt, given = clock.dt / run.time, 0.0
    per = 0.25 * dt / beads.mass[i]
    turn = per / (0.4 * beads.radius[i] * beads.radius[i])
    for k in range(3):
        force, held, torque, twist = run.forces[0, k], head.force[k], run.forces[1, k], head.torque[k]
        given += (held + force) * (beads.v[i, k] + per * (force - held))
        given += (twist + torque) * (beads.omega[i, k] + turn * (torque - twist))
        head.force[k], head.torque[k] = force, torque
    if clock.advancing:
        run.energy -= 0.5 * dt * given


@kernel
def begin(scene: WallScene, runs: Any, clock: Clock, beads: Beads, looks: bool) -> None:
    """Move the walls, and look at all beads if it is time to: the first part of a step."""
    _tick(runs[0], clock, scene.frames)
    if looks:
        _look_at_all(scene, runs[0], clock, beads)


@kernel
def step(scene: WallScene, runs: Any, clock: Clock, beads: Beads, first: int) -> int:
    """Add the force of the walls to all beads from `first` on, and return their number.

    Where the record is full, the number of the bead is returned for which it has no room: empty it,
    and call again from that bead on.
    """
    run, status = runs[0], scene.status[0]
    x0, y0, z0, x1, y1, z1 = box(scene.frames)
    # Most beads are far from all walls: they are left out with few reads of memory.
    group, length, low, period = run.group, run.length, vector(run.low), vector(run.period)
    for i in range(first, beads.n):
        if not beads.mask[i] & group:
            continue
        size = beads.radius[i] * length
        reach, z = MARGIN * size, _wrapped(beads.x[i, 2], low[2], period[2], length)
        if not z0 - reach <= z <= z1 + reach:
            continue
        x = _wrapped(beads.x[i, 0], low[0], period[0], length)
        y = _wrapped(beads.x[i, 1], low[1], period[1], length)
        centre = x, y, z
        if not (x0 - reach <= x <= x1 + reach and y0 - reach <= y <= y1 + reach and near(scene.frames, centre, size)):
            continue
        if status.impacts + ROWS > len(scene.impacts):
            return i
        bead = _bead_of(scene, run, beads, i, centre)
        head = _head_of(run, beads, i, bead)
        if head.radius != 0.0:
            _check(scene, run, head, bead)
        if not head.error >= Trouble.STARTS_INSIDE.value:
            recorded = status.impacts
            for k in range(3):
                run.forces[0, k] = run.forces[1, k] = 0.0
            apply_walls(scene, clock, bead, body_of(beads.bodies, i))
            _apply(scene, run, beads, i)
            if run.accounts != 0:
                _account(run, clock, beads, head, i)
            for n in range(recorded, status.impacts):
                row = scene.impacts[n]
                row.wall_start = run.start + run.ahead
                if row.kind == Kind.IMPACT.value or row.kind == Kind.OF_BODY.value:  # other kinds have no COR
                    beads.last[i] = row.restitution
            if status.trouble != 0:
                fail(run, head, bead.number, status.trouble, status.wall, status.value, status.limit)
                head.error = max(head.error, status.worst)
                status.trouble = status.worst = 0
        _keep(scene, head, bead)
    return beads.n
