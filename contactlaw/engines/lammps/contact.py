"""One bead near walls in one time step: contacts, force, friction, record.

Legend: r radius, x overlap of the sphere with the undeformed wall, u speed towards the wall, n
normal from the wall to the bead, s height over the facet's plane.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.engines.lammps import ledger, memory
from contactlaw.engines.lammps.geometry import (
    Bead,
    Point,
    Touch,
    nearest,
    seen,
    velocity,
)
from contactlaw.engines.lammps.ledger import dot
from contactlaw.engines.lammps.memory import (
    ALONE,
    DISPLACEMENT,
    DURATION,
    FACET,
    FIRST,
    FORCE,
    KICK,
    LARGEST,
    MOBILITY,
    OVERLAP,
    OWNER,
    POWER,
    PUSH,
    SHARING,
    SPEED,
    SPRING,
    STIFFENING,
    TIED,
    TOLD,
    UNEVEN,
    WALL_WORK,
    WAVE,
    WORK,
    array_at,
    complain,
    slot_of,
    touches,
)
from contactlaw.engines.lammps.surface import join, on_it, overlaps, slope, touch_of
from contactlaw.engines.record import IMPACT
from contactlaw.equation import force
from contactlaw.equation.numbers import PlateConstants
from contactlaw.equation.waves import CONTACT_TIME, Waves
from contactlaw.physical.validity import Limits, flags_of
from contactlaw.softsphere import FEWEST_STEPS, Spring, State, impact, resized
from contactlaw.table.lookup import THINNEST

Array = NDArray[np.float64]

_AT_REST = 1e-3  # [r] that a bead may overlap which is put down on a wall
# times its approach speed: a bead in contact that has been hit, not one that falls on
_FASTER = 1.01
_RIGHT = 1e-6  # cosine of an angle that counts as a right one
_SOLID = 1e-6  # a bead's mass may differ so much, relatively, from that of a sphere of the model


class Clock(NamedTuple):
    """Where the simulation is."""

    step: int
    now: float  # [s]
    dt: float  # [s]
    before: float  # the last step [s]
    advancing: bool  # else a set-up, which asks for the forces of the last step again


class Walls(NamedTuple):
    """What beads may touch: the kernel's arrays, and one for the facets that a bead overlaps."""

    sheets: Any
    frames: Any
    facets: Any
    found: Any


class Contact(NamedTuple):
    """A bead's contact with a facet."""

    facet: int
    wall: int  # number of the plate or mesh
    triangle: int
    touch: Touch
    point: Point  # [m]
    v: Point  # of the bead relative to the wall, half a step before [m/s]
    w: Point  # of the wall [m/s]
    along: Point  # force on the bead over that of the law: the normal, if nothing is shared


@kernel
def _contact(walls: Walls, bead: Bead, facet: int, touch: Touch, along: Point) -> Contact:
    row, point = walls.facets[facet], nearest(touch, bead)
    frame = walls.frames[row.frame]
    before, v = velocity(frame, frame.half_rate, point), bead.v
    u = (v[0] - before[0], v[1] - before[1], v[2] - before[2])
    w = velocity(frame, frame.rate, point)
    return Contact(facet, row.wall, row.triangle, touch, point, u, w, along)


@kernel
def _place_in(walls: Walls, bead: Bead, n: int) -> Contact:
    """Contact with a facet of the list, less what it shares with another.

    By Hertz's law, the energy at the pass is as (x_pass/x)^2.5 to that of the contact, and the
    force as the power 1.5; under other laws the shares are the same.
    """
    row = walls.found[n]
    along = (row.nx, row.ny, row.nz)
    if row.shared > 0.0:
        share = row.shared / row.x
        share *= math.sqrt(share)
        less = slope(walls.frames, walls.facets, bead, walls.found[row.one], walls.found[row.other])
        along = (
            along[0] - share * less[0], along[1] - share * less[1], along[2] - share * less[2]
        )  # fmt: skip
    return _contact(walls, bead, row.facet, touch_of(row), along)


@kernel
def _check_step(shared: Any, clock: Clock, bead: Bead, wall: int, spring: Spring, u: float) -> None:
    """Refuse a step that is too long for an impact at this speed."""
    limit = CONTACT_TIME * impact(spring, u).time / FEWEST_STEPS
    if clock.dt > limit:
        complain(shared, clock.step, bead.tag, bead.history, memory.STEP_TOO_LARGE, wall, u, limit)


@kernel
def _begin(
    shared: Any,
    clock: Clock,
    bead: Bead,
    wall: int,
    at: int,
    spring: Spring,
    x: float,
    u: float,
    sheet: Any,
) -> None:
    """Start a contact, or the next one of a bead that comes back before it has parted."""
    row = bead.history
    first = u > 0.0 and row[at + LARGEST] == 0.0
    row[at + DURATION] = min(x / u, clock.dt) if first else 0.0
    row[at + SPEED], row[at + WAVE], row[at + WORK], row[at + WALL_WORK] = u, 0.0, 0.0, 0.0
    if not abs(bead.mass - spring.mass) <= _SOLID * spring.mass:
        complain(shared, clock.step, bead.tag, row, memory.WRONG_MASS, wall, bead.mass, spring.mass)
    if u > 0.0:
        _check_step(shared, clock, bead, wall, spring, u)
        lam = impact(spring, u).inelasticity
        if not THINNEST * bead.r <= sheet.thickness:
            ratio = bead.r / sheet.thickness
            complain(shared, clock.step, bead.tag, row, memory.FOIL, wall, ratio, 1.0 / THINNEST)
        elif lam > sheet.largest:
            complain(shared, clock.step, bead.tag, row, memory.TOO_THIN, wall, lam, sheet.largest)


@kernel
def _partner(row: Array, shared: Any, at: int) -> int:
    """Slot of another contact that a tied one has shared its force with, else 0."""
    if row[at + TIED] != SHARING:
        return 0
    for k in range(shared.slots):
        slot = FIRST + k * shared.width
        if slot != at and row[slot + FORCE] > 0.0 and row[slot + TIED] == SHARING:
            return int(slot)
    return 0


@kernel
def _power(row: Array, shared: Any, at: int, v: Point) -> float:
    """Power of the other contacts on a bead of this velocity [W]."""
    power = 0.0
    for k in range(shared.slots):
        slot = FIRST + k * shared.width
        if slot != at and row[slot + FORCE] > 0.0:
            power += dot((row[slot + PUSH], row[slot + PUSH + 1], row[slot + PUSH + 2]), v)
    return power


@kernel
def _kinked(held: Point, n: Point, v: Point, dt: float, distance: float) -> bool:
    """Whether the normal has turned by more than the bead's way explains."""
    size = math.sqrt(dot(held, held))
    turn = 0.0
    for k in range(3):
        turn += (held[k] / size - n[k]) ** 2
    return turn * distance * distance > 4.0 * dot(v, v) * dt * dt


@kernel
def _end(
    law: Array,
    shared: Any,
    clock: Clock,
    bead: Bead,
    sheet: Any,
    contact: Contact,
    at: int,
    spring: Spring,
    last: State,
    u: float,
    heir: int,
) -> Point:
    """Put a contact whose force has ended in this step into the record; the force that it lacks.

    One that has grown together with another leaves its account to that, and no record.
    """
    row, scale, v = bead.history, spring.scale, contact.v
    unit = spring.stiffness * scale * math.sqrt(scale)  # F_Y
    if last.stiffening > 0.0:
        unit *= last.stiffening
    dm = last.largest_compression / scale
    lost, other = force.loss(law, dm) * unit * scale, force.other_loss(law, dm) * unit * scale
    if heir > 0:
        row[heir + TOLD] += row[at + TOLD] - lost
        for column in (WAVE, WORK, WALL_WORK):
            row[heir + column] += row[at + column]
        return 0.0, 0.0, 0.0
    told, row[at + TOLD] = row[at + TOLD], lost
    if not row[at + SPEED] > 0.0:  # it was put there and then left
        return 0.0, 0.0, 0.0
    missing = told - lost - row[at + WAVE] - row[at + WORK]
    steps, partner = row[at + DURATION] / clock.dt, _partner(row, shared, at)
    kick, leaves = (0.0, 0.0, 0.0), -u
    if partner > 0:  # what one has too much the other has too little
        row[partner + WORK] -= missing
    elif row[at + TIED] != ALONE:
        others = _power(row, shared, at, v)
        more = ledger.scaled(missing, bead.mass, v, others, clock.dt, steps)
        pull = more * bead.mass / clock.dt
        kick, leaves = (pull * v[0], pull * v[1], pull * v[2]), -u * (1.0 + more)
    else:
        pull = ledger.settle(missing, bead.mass, u, row[at + SPEED], clock.dt, steps)
        touch = contact.touch
        kick = pull * touch.nx, pull * touch.ny, pull * touch.nz
        leaves = pull * clock.dt / bead.mass - u
    n = shared.record_count
    if n == shared.record_capacity:
        complain(shared, clock.step, bead.tag, row, memory.TOO_MANY_RECORDS, contact.wall, 0.0, n)
        return kick
    touch = contact.touch
    if not touch.face and u < 0.0 and row[at + TIED] == ALONE:
        around = ledger.turning(bead.r, row[at + OVERLAP], touch.x, u, clock.dt)
        leaves = ledger.free_speed(leaves, around, bead.r, touch.x)
    since = 0.0
    if u < 0.0:  # between the steps, where the compression was down to the residual one
        gap = force.residual(law, dm) * scale + last.plate_displacement - touch.x
        since = min(max(gap / -u, 0.0), clock.dt)
    record = array_at(shared.records, shared.record_capacity, IMPACT)[n]
    record.time = clock.now - row[at + DURATION]
    record.bead, record.other = bead.tag, -1
    record.plate, record.triangle = contact.wall, contact.triangle
    record.x, record.y, record.z = contact.point
    record.approach_speed, record.restitution = row[at + SPEED], leaves / row[at + SPEED]
    bead.last[0] = record.restitution
    record.contact_time = row[at + DURATION] - since
    record.peak_force = force.loading(law, math.sqrt(dm)) * unit
    # a contact that goes on where another has dented the bead loses what is left of the loop
    share = 1.0 - other / lost if lost > 0.0 else 0.0
    record.plastic_energy, record.wave_energy = share * (lost - told), row[at + WAVE]
    record.other_energy = (1.0 - share) * (lost - told)
    record.wall_work = row[at + WALL_WORK]  # and what this step does, see `_press`
    record.flags = _flags(
        bead, sheet, spring, record.approach_speed, record.contact_time,
        last.largest_compression, record.peak_force,
    )  # fmt: skip
    shared.record_count = n + 1
    return kick


@kernel
def _flags(
    bead: Bead,
    sheet: Any,
    spring: Spring,
    speed: float,
    contact_time: float,
    compression: float,
    force: float,
) -> int:
    """Limits of the model that an impact exceeds."""
    limits = Limits(
        sheet.slender, sheet.slowness, sheet.always, sheet.yielded, sheet.trusted, sheet.fastest,
        sheet.swiftest, sheet.share, sheet.deepest, sheet.bending, sheet.damage, sheet.untried,
    )  # fmt: skip
    way = impact(spring, speed).compression
    return flags_of(limits, bead.r, sheet.thickness, way, contact_time, compression, force)


@kernel
def _normal(
    law: Array,
    shared: Any,
    clock: Clock,
    bead: Bead,
    sheet: Any,
    contact: Contact,
    at: int,
    touching: bool,
    heir: int,
) -> None:
    """Advance a contact by a step; its slot is empty afterwards if the bodies have parted."""
    row, v, touch = bead.history, contact.v, contact.touch
    n, along = (touch.nx, touch.ny, touch.nz), contact.along
    u = -dot(v, n)
    side = math.copysign(contact.facet + 1.0, touch.s)
    if row[at + FACET] == 0.0:
        # no deeper than a step's way; on an edge the way is not along the normal
        deepest = math.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2) * clock.dt + _AT_REST * bead.r
        # (but a bead may come from one surface deep into the next)
        if touch.x > deepest and not touching:
            complain(shared, clock.step, bead.tag, row, memory.STARTS_INSIDE, contact.wall,
                     touch.x, deepest)  # fmt: skip
    elif touch.face and side != row[at + FACET]:
        complain(shared, clock.step, bead.tag, row, memory.CROSSED, contact.wall, u, 0.0)
    waves = Waves(
        sheet.eta, sheet.eta_h, sheet.eta4, sheet.beyond, sheet.steepest, sheet.bulk_factor,
        sheet.p1, sheet.p2, sheet.p3, sheet.p4, sheet.p5,
    )  # fmt: skip
    plate = PlateConstants(
        sheet.inelasticity, sheet.transit, sheet.reach, sheet.saturated, waves
    )  # fmt: skip
    unit = Spring(
        sheet.mass, sheet.stiffness, sheet.mobility, sheet.scale, sheet.relaxation, sheet.ratio,
        plate,
    )  # fmt: skip
    spring = resized(unit, bead.r)
    last = State(
        row[at + DISPLACEMENT], row[at + LARGEST], row[at + FORCE], row[at + MOBILITY],
        row[at + STIFFENING],
    )  # fmt: skip
    state, kick = ledger.step(law, spring, last, touch.x, u, clock.dt, clock.before)
    held, power_0 = (0.0, 0.0, 0.0), 0.0
    if last.force > 0.0:
        held, power_0 = (row[at + PUSH], row[at + PUSH + 1], row[at + PUSH + 2]), row[at + POWER]
        if row[at + KICK] == 0.0 and _kinked(held, n, v, clock.dt, bead.r - touch.x):
            row[at + TIED] = max(row[at + TIED], UNEVEN)
    if state.force > 0.0 and last.force == 0.0:
        _begin(shared, clock, bead, contact.wall, at, spring, touch.x, u, sheet)
    else:
        first = 0.0 < row[at + DURATION] < clock.before
        if not touch.face and last.force > 0.0 and first and row[at + TIED] == ALONE:
            # the second step: the first one does not know how fast the normal turns
            around = ledger.turning(bead.r, row[at + OVERLAP], touch.x, u, clock.dt)
            row[at + SPEED] = ledger.free_speed(row[at + SPEED], around, bead.r, row[at + OVERLAP])
        row[at + DURATION] += clock.dt
        if u > _FASTER * max(row[at + SPEED], 0.0):
            row[at + SPEED] = u
            _check_step(shared, clock, bead, contact.wall, spring, u)
        elif clock.dt > clock.before and row[at + SPEED] > 0.0:
            _check_step(shared, clock, bead, contact.wall, spring, row[at + SPEED])
    row[at + WAVE] += ledger.wave_energy(spring, last, state, clock.dt)
    push = state.force + kick
    pushes = push * along[0], push * along[1], push * along[2]
    power = dot(pushes, contact.w)
    row[at + WORK] += ledger.work(
        spring.mass, held, pushes, bead.v, power_0, power, clock.dt, clock.before
    )
    if state.force == 0.0 and last.force > 0.0:
        pushes = _end(law, shared, clock, bead, sheet, contact, at, spring, last, u, heir)
        kick = dot(pushes, n)
    row[at + DISPLACEMENT] = state.plate_displacement
    row[at + LARGEST] = state.largest_compression
    row[at + FORCE] = state.force
    row[at + MOBILITY], row[at + STIFFENING] = state.mobility, state.stiffening
    row[at + FACET], row[at + OVERLAP] = side, touch.x
    if touch.x <= 0.0:
        row[at : at + (shared.width if kick == 0.0 else SPRING)] = 0.0
    if kick != 0.0:
        row[at + FACET] = side  # also of a bead that has parted: a set-up asks for the force again
    row[at + KICK] = kick
    row[at + PUSH], row[at + PUSH + 1], row[at + PUSH + 2] = pushes
    row[at + POWER] = power


@kernel
def _slide(
    clock: Clock, bead: Bead, friction: float, contact: Contact, at: int, modulus: float
) -> Point:
    """Force of a tangential spring, k = 8 G* sqrt(r d) with Coulomb's limit."""
    touch, r, v, omega = contact.touch, bead.r, contact.v, bead.omega
    nx, ny, nz = touch.nx, touch.ny, touch.nz
    row = bead.history
    spring = row[at + SPRING : at + SPRING + 3]
    k = modulus * math.sqrt(r * max(touch.x - row[at + DISPLACEMENT], 0.0))
    push, kick = row[at + FORCE], row[at + KICK]
    parted = push == 0.0 and kick != 0.0
    if clock.advancing:
        # the sphere's point of contact is at -r n from its centre
        gx = spring[0] + clock.dt * (v[0] - r * (omega[1] * nz - omega[2] * ny))
        gy = spring[1] + clock.dt * (v[1] - r * (omega[2] * nx - omega[0] * nz))
        gz = spring[2] + clock.dt * (v[2] - r * (omega[0] * ny - omega[1] * nx))
        along = gx * nx + gy * ny + gz * nz
        gx, gy, gz = gx - along * nx, gy - along * ny, gz - along * nz
        pull, most = k * math.sqrt(gx * gx + gy * gy + gz * gz), friction * push
        share = 1.0 if push > 0.0 or parted else 0.0
        if push > 0.0 and pull > most:
            share = most / pull
        spring[0], spring[1], spring[2] = share * gx, share * gy, share * gz
    if parted:  # a contact that ends slides
        size = math.sqrt(spring[0] ** 2 + spring[1] ** 2 + spring[2] ** 2)
        k = friction * kick / size if size > 0.0 else 0.0
    elif kick != 0.0:
        k *= 1.0 + kick / push
    return -k * spring[0], -k * spring[1], -k * spring[2]


@kernel
def _press(
    shared: Any,
    clock: Clock,
    walls: Walls,
    bead: Bead,
    contact: Contact,
    at: int,
    held: bool,
    heir: int = 0,
) -> None:
    """Add the force of one contact to a bead, and keep the bead's history."""
    facet, row, touch = walls.facets[contact.facet], bead.history, contact.touch
    sheet = walls.sheets[bead.kind * shared.sheet_count + facet.sheet]
    if sheet.law == 0:
        complain(shared, clock.step, bead.tag, row, memory.NO_MODEL, contact.wall,
                 bead.kind + 1.0, 0.0)  # fmt: skip
        return
    recorded = shared.record_count
    if clock.advancing:
        law = array_at(sheet.law, sheet.law_size, np.float64)
        _normal(law, shared, clock, bead, sheet, contact, at, held, heir)
    if row[at + FORCE] == 0.0 and row[at + KICK] == 0.0:
        return
    n = (touch.nx, touch.ny, touch.nz)
    push = row[at + PUSH : at + PUSH + 3]
    pull = (0.0, 0.0, 0.0)
    if shared.friction > 0.0:
        pull = _slide(clock, bead, shared.friction, contact, at, sheet.tangential)
        arm = -bead.r * shared.time**2 / (shared.mass * shared.length**2)
        bead.torque[0] += arm * (n[1] * pull[2] - n[2] * pull[1])
        bead.torque[1] += arm * (n[2] * pull[0] - n[0] * pull[2])
        bead.torque[2] += arm * (n[0] * pull[1] - n[1] * pull[0])
    scale = shared.time**2 / (shared.mass * shared.length)
    work = 0.0
    for k in range(3):
        both = push[k] + pull[k]
        bead.force[k] += scale * both
        work += both * contact.w[k]
    if clock.advancing:
        row[at + WALL_WORK] += clock.dt * work
        if shared.record_count > recorded:  # with the last push
            records = array_at(shared.records, shared.record_capacity, IMPACT)
            records[recorded].wall_work += clock.dt * work


@kernel
def _place_of(found: Any, count: int, facet: int) -> int:
    """Place of a facet in the list of those that a bead overlaps, else -1."""
    for n in range(count):
        if found[n].facet == facet:
            return n
    return -1


@kernel
def _home(walls: Walls, bead: Bead, facet: int, count: int, overlap: float, way: float) -> int:
    """Place in the list of what a contact with a facet goes on with, else -1.

    From a facet that is suddenly far, behind a periodic boundary, it goes on with what the bead
    overlaps as deeply, within its way of a step; else it is -2.
    """
    found = walls.found
    at = _place_of(found, count, facet)
    if at >= 0:
        return int(found[at].surface)
    row = walls.facets[facet]
    touch = seen(walls.frames[row.frame], row, bead)
    if touch.x > -bead.r:
        point = nearest(touch, bead)
        for n in range(count):
            if on_it(walls.frames, walls.facets, found[n], point, bead.r):
                return int(found[n].surface)
        return -1
    best = -2
    for n in range(count):
        apart = abs(found[n].x - overlap)
        if found[n].surface == n and apart <= way:
            best, way = n, apart
    return best


@kernel
def _hand_over(shared: Any, clock: Clock, walls: Walls, bead: Bead, count: int) -> None:
    """Let contacts go along with a bead that crosses from facet to facet."""
    row, found, v = bead.history, walls.found, bead.v
    way = math.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2) * clock.dt + _AT_REST * bead.r
    for k in range(shared.slots):
        at = FIRST + k * shared.width
        if row[at + FACET] == 0.0:
            continue
        facet = int(abs(row[at + FACET])) - 1
        home = _home(walls, bead, facet, count, row[at + OVERLAP], way)
        if home == -2:
            row[at : at + shared.width] = 0.0
        elif home >= 0 and slot_of(row, shared, found[home].facet) == 0:
            row[at + FACET] = math.copysign(found[home].facet + 1.0, found[home].s)


@kernel
def _part(
    shared: Any, clock: Clock, walls: Walls, bead: Bead, facet: int, at: int, count: int
) -> None:
    """End a contact: the bead is off the facet, or it is one with another now."""
    one, row = walls.facets[facet], bead.history
    n, heir = _place_of(walls.found, count, facet), 0
    if n >= 0:
        heir = slot_of(row, shared, walls.found[walls.found[n].surface].facet)
        heir = 0 if heir == at else heir
    if heir > 0:
        row[heir + TIED] = SHARING
    t = seen(walls.frames[one.frame], one, bead)
    if t.x > -bead.r:  # else it was taken away
        t = Touch(min(t.x, 0.0), t.s, t.nx, t.ny, t.nz, t.face)
        contact = _contact(walls, bead, facet, t, (t.nx, t.ny, t.nz))
        _press(shared, clock, walls, bead, contact, at, True, heir)
    else:
        row[at : at + shared.width] = 0.0


@kernel
def _begin_all(shared: Any, clock: Clock, walls: Walls, bead: Bead, count: int, held: bool) -> None:
    """Begin contacts, the deepest first; without an empty slot, in place of a shallower one.

    So the force has no jump where a contact takes the place of another.
    """
    row, found = bead.history, walls.found
    for _ in range(count):
        new = -1
        for n in range(count):
            if found[n].surface == n and (new < 0 or found[n].x > found[new].x):
                if slot_of(row, shared, found[n].facet) == 0:
                    new = n
        if new < 0:
            return
        at = slot_of(row, shared, -1)
        if at == 0:
            least = math.inf
            for k in range(shared.slots):
                slot = FIRST + k * shared.width
                n = _place_of(found, count, int(abs(row[slot + FACET])) - 1)
                x = found[n].x if n >= 0 else 0.0  # it has ended in this step
                if x < least:
                    least, at = x, slot
            if not found[new].x > least:
                shared.unserved += 1
                return
            _part(shared, clock, walls, bead, int(abs(row[at + FACET])) - 1, at, count)
            row[at : at + shared.width] = 0.0
        _press(shared, clock, walls, bead, _place_in(walls, bead, new), at, held)
        if found[new].shared > 0.0:
            row[at + TIED] = SHARING


@kernel
def _company(row: Array, shared: Any) -> float:
    """Whether contacts press a bead that work on each other; those at right angles do not.

    The scheme of a contact takes its own force for all that moves the bead along its normal.
    """
    for k in range(shared.slots):
        at = FIRST + k * shared.width
        if not row[at + FORCE] > 0.0:
            continue
        one = row[at + PUSH], row[at + PUSH + 1], row[at + PUSH + 2]
        for j in range(k):
            to = FIRST + j * shared.width
            if row[to + FORCE] > 0.0:
                other = row[to + PUSH], row[to + PUSH + 1], row[to + PUSH + 2]
                if abs(dot(one, other)) > _RIGHT * row[at + FORCE] * row[to + FORCE]:
                    return UNEVEN
    return ALONE


@kernel
def interact(shared: Any, clock: Clock, walls: Walls, bead: Bead) -> None:
    """Add the force of the walls to a bead, and keep the bead's history."""
    found, row = walls.found, bead.history
    count = overlaps(walls.frames, walls.facets, bead, found)
    if count == 0 and not (row[OWNER] == bead.tag and touches(row, shared)):
        return
    if row[OWNER] != bead.tag:
        row[:] = 0.0
        row[OWNER], bead.last[0] = bead.tag, 0.0
    sharing = join(bead.r, found, count)
    if clock.advancing:
        _hand_over(shared, clock, walls, bead, count)
    held, tie = touches(row, shared), ALONE
    if count > 1:  # most beads have one contact, and their slots are far from each other in memory
        tie = SHARING if sharing else _company(row, shared)
    for k in range(shared.slots):
        at = FIRST + k * shared.width
        if row[at + FACET] == 0.0:
            continue
        facet = int(abs(row[at + FACET])) - 1
        n = _place_of(found, count, facet)
        if n >= 0 and found[n].surface == n:
            row[at + TIED] = max(row[at + TIED], tie)
            _press(shared, clock, walls, bead, _place_in(walls, bead, n), at, held)
        elif clock.advancing or row[at + KICK] != 0.0:
            _part(shared, clock, walls, bead, facet, at, count)
    if clock.advancing:
        _begin_all(shared, clock, walls, bead, count, held)
