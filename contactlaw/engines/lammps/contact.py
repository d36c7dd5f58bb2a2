"""One bead near one plate in one time step: geometry, force, friction, record.

Legend: r radius, x overlap of the sphere with the undeformed plate, u speed towards the plate,
n normal from the plate to the bead, s height over the plate's plane.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.engines.lammps import ledger, memory
from contactlaw.engines.lammps.memory import (
    DISPLACEMENT,
    DURATION,
    FIRST,
    FORCE,
    KICK,
    LARGEST,
    MOBILITY,
    OVERLAP,
    OWNER,
    PLATE,
    SPEED,
    SPRING,
    STIFFENING,
    TOLD,
    WAVE,
    WORK,
    array_at,
    complain,
    slot_of,
    touches,
)
from contactlaw.engines.record import IMPACT
from contactlaw.equation import force
from contactlaw.equation.waves import Waves
from contactlaw.physical.validity import Limits, flags_of
from contactlaw.softsphere import CONTACT_TIME, FEWEST_STEPS, Spring, State, resized

Array = NDArray[np.float64]

NEAR = 2.0  # [r] from the plate: from here on a bead's history is kept up to date
_AT_REST = 1e-3  # [r] that a bead may overlap which is put down on a plate
# times its approach speed: a bead in contact that has been hit, not one that falls on
_FASTER = 1.01
_SEAM = 1e-4  # [r] between plates that are one surface to a bead
_TIE = 1e-9  # [r] of overlap: rounding
_SOLID = 1e-6  # a bead's mass may differ so much, relatively, from that of a sphere of the model


class Clock(NamedTuple):
    """Where the simulation is."""

    step: int
    now: float  # [s]
    dt: float  # [s]
    before: float  # the last step [s]
    advancing: bool  # else a set-up, which asks for the forces of the last step again


class Bead(NamedTuple):
    """A bead: views of LAMMPS's arrays."""

    tag: int
    x: Any
    v: Any
    omega: Any
    torque: Any
    force: Any
    history: Any
    r: float
    mass: float


class Touch(NamedTuple):
    """Where a bead is with respect to a plate."""

    x: float
    s: float
    nx: float
    ny: float
    nz: float
    face: bool  # else the nearest point is on an edge


@kernel
def _geometry(plate: Any, bead: Bead) -> Touch:
    """Overlap and normal at the plate's nearest point; an overlap of -r where it is not near."""
    corner, a, b, normal = plate.corner, plate.a, plate.b, plate.normal
    px, py, pz = bead.x[0] - corner[0], bead.x[1] - corner[1], bead.x[2] - corner[2]
    s = px * normal[0] + py * normal[1] + pz * normal[2]
    if not abs(s) < NEAR * bead.r:
        return Touch(-bead.r, s, 0.0, 0.0, 0.0, False)
    along_a = px * a[0] + py * a[1] + pz * a[2]
    along_b = px * b[0] + py * b[1] + pz * b[2]
    at_a = min(max(along_a, 0.0), plate.length_a)
    at_b = min(max(along_b, 0.0), plate.length_b)
    if at_a == along_a and at_b == along_b:
        sign = math.copysign(1.0, s)
        return Touch(bead.r - abs(s), s, sign * normal[0], sign * normal[1], sign * normal[2], True)
    dx = px - at_a * a[0] - at_b * b[0]
    dy = py - at_a * a[1] - at_b * b[1]
    dz = pz - at_a * a[2] - at_b * b[2]
    distance = math.sqrt(dx * dx + dy * dy + dz * dz)
    return Touch(bead.r - distance, s, dx / distance, dy / distance, dz / distance, False)


@kernel
def _nearest(touch: Touch, bead: Bead) -> tuple[float, float, float]:
    """Point of a plate that is nearest to the bead's centre."""
    reach, x = bead.r - touch.x, bead.x
    return x[0] - reach * touch.nx, x[1] - reach * touch.ny, x[2] - reach * touch.nz


@kernel
def _has(plate: Any, point: tuple[float, float, float], margin: float) -> Any:
    """Whether a point is on a plate."""
    corner, a, b, normal = plate.corner, plate.a, plate.b, plate.normal
    px, py, pz = point[0] - corner[0], point[1] - corner[1], point[2] - corner[2]
    along_a = px * a[0] + py * a[1] + pz * a[2]
    along_b = px * b[0] + py * b[1] + pz * b[2]
    return (
        abs(px * normal[0] + py * normal[1] + pz * normal[2]) <= margin
        and -margin <= along_a <= plate.length_a + margin
        and -margin <= along_b <= plate.length_b + margin
    )


@kernel
def _order(touch: Touch, p: int, r: float) -> tuple[bool, int, int]:
    """Sort plates that share a point: face before edge, then the nearest, then the first."""
    return not touch.face, math.floor(-touch.x / (_TIE * r)), p


@kernel
def _home(plates: Any, p: int, touch: Touch, bead: Bead) -> int:
    """Plate that a contact with plate p belongs to: another one, if p goes on there without a gap.

    Where plates meet, the nearest points of all of them may be one, or one of them may be on a
    plate that comes nearer. The bead feels one surface.
    """
    point, q = _nearest(touch, bead), 0
    while q < len(plates):
        if q != p and _has(plates[q], point, _SEAM * bead.r):
            other = _geometry(plates[q], bead)
            if _order(other, q, bead.r) < _order(touch, p, bead.r):
                p, touch, q = q, other, -1
                point = _nearest(touch, bead)
        q += 1
    return p


@kernel
def hand_over(shared: Any, plates: Any, bead: Bead) -> None:
    """Let a bead that crosses from plate to plate take its contact along."""
    row = bead.history
    if row[OWNER] != bead.tag:
        return
    for k in range(shared.slots):
        at = FIRST + k * shared.width
        if row[at + PLATE] == 0.0:
            continue
        p = int(abs(row[at + PLATE])) - 1
        home = _home(plates, p, _geometry(plates[p], bead), bead)
        if home == p:
            continue
        touch, own = _geometry(plates[home], bead), slot_of(row, shared, home)
        # In a flat valley the bead presses on both already: then each contact ends by itself.
        if touch.x > 0.0 and (own == 0 or row[own + PLATE] == 0.0):
            row[at + PLATE] = math.copysign(home + 1.0, touch.s)


@kernel
def _check_step(shared: Any, clock: Clock, bead: Bead, p: int, spring: Spring, u: float) -> None:
    """Refuse a step that is too long for an impact at this speed."""
    shortest = CONTACT_TIME * (spring.mass / (spring.stiffness * math.sqrt(u))) ** 0.4
    limit = shortest / FEWEST_STEPS
    if clock.dt > limit:
        complain(shared, clock.step, bead.tag, bead.history, memory.STEP_TOO_LARGE, p, u, limit)


@kernel
def _begin(
    shared: Any, clock: Clock, bead: Bead, p: int, at: int, spring: Spring, x: float, u: float
) -> None:
    """Start a contact, or the next one of a bead that comes back before it has parted."""
    row = bead.history
    first = u > 0.0 and row[at + LARGEST] == 0.0
    row[at + DURATION] = min(x / u, clock.dt) if first else 0.0
    row[at + SPEED], row[at + WAVE], row[at + WORK] = u, 0.0, 0.0
    if not abs(bead.mass - spring.mass) <= _SOLID * spring.mass:
        complain(shared, clock.step, bead.tag, row, memory.WRONG_MASS, p, bead.mass, spring.mass)
    if u > 0.0:
        _check_step(shared, clock, bead, p, spring, u)


@kernel
def _end(
    law: Array,
    shared: Any,
    clock: Clock,
    bead: Bead,
    plate: Any,
    p: int,
    at: int,
    spring: Spring,
    last: State,
    touch: Touch,
    u: float,
) -> float:
    """Put a contact whose force has ended in this step into the record; the force that it lacks."""
    row, scale = bead.history, spring.scale
    unit = spring.stiffness * scale * math.sqrt(scale)  # F_Y
    if last.stiffening > 0.0:
        unit *= last.stiffening
    dm = last.largest_compression / scale
    lost, other = force.loss(law, dm) * unit * scale, force.other_loss(law, dm) * unit * scale
    told, row[at + TOLD] = row[at + TOLD], lost
    if not row[at + SPEED] > 0.0:  # it was put there and then left
        return 0.0
    missing = told - lost - row[at + WAVE] - row[at + WORK]
    kick = ledger.settle(missing, bead.mass, u, clock.dt, row[at + DURATION] / clock.dt)
    n = shared.record_count
    if n == shared.record_capacity:
        complain(shared, clock.step, bead.tag, row, memory.TOO_MANY_RECORDS, p, 0.0, n)
        return kick
    leaves = kick * clock.dt / bead.mass - u
    if not touch.face and u < 0.0:
        around = ledger.turning(bead.r, row[at + OVERLAP], touch.x, u, clock.dt)
        leaves = ledger.free_speed(leaves, around, bead.r, touch.x)
    since = 0.0
    if u < 0.0:  # between the steps, where the compression was down to the residual one
        gap = force.residual(law, dm) * scale + last.plate_displacement - touch.x
        since = min(max(gap / -u, 0.0), clock.dt)
    record = array_at(shared.records, shared.record_capacity, IMPACT)[n]
    record.time = clock.now - row[at + DURATION]
    record.bead, record.plate, record.other = bead.tag, p, -1
    record.x, record.y, record.z = _nearest(touch, bead)
    record.approach_speed, record.restitution = row[at + SPEED], leaves / row[at + SPEED]
    record.contact_time = row[at + DURATION] - since
    record.peak_force = force.loading(law, math.sqrt(dm)) * unit
    # a contact that goes on where another has dented the bead loses what is left of the loop
    share = 1.0 - other / lost if lost > 0.0 else 0.0
    record.plastic_energy, record.wave_energy = share * (lost - told), row[at + WAVE]
    record.other_energy = (1.0 - share) * (lost - told)
    record.flags = _flags(
        bead, plate, spring, record.approach_speed, record.contact_time,
        last.largest_compression, record.peak_force,
    )  # fmt: skip
    shared.record_count = n + 1
    return kick


@kernel
def _flags(
    bead: Bead,
    plate: Any,
    spring: Spring,
    speed: float,
    contact_time: float,
    compression: float,
    force: float,
) -> int:
    """Limits of the model that an impact exceeds."""
    scale = speed * (spring.mass / (spring.stiffness * math.sqrt(speed))) ** 0.4  # V0 T_H
    limits = Limits(
        plate.slender, plate.slowness, plate.always, plate.yielded, plate.trusted, plate.fastest,
        plate.swiftest, plate.share, plate.deepest, plate.bending, plate.damage,
    )  # fmt: skip
    return flags_of(limits, bead.r, plate.thickness, scale, contact_time, compression, force)


@kernel
def _normal(
    law: Array, shared: Any, clock: Clock, bead: Bead, plate: Any, p: int, at: int, touch: Touch
) -> None:
    """Advance a contact by a step; its slot is empty afterwards if the bodies have parted."""
    row, v = bead.history, bead.v
    u = -(v[0] * touch.nx + v[1] * touch.ny + v[2] * touch.nz)
    side = math.copysign(p + 1.0, touch.s)
    if row[at + PLATE] == 0.0:
        # no deeper than a step's way; on an edge the way is not along the normal
        deepest = math.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2) * clock.dt + _AT_REST * bead.r
        # (but in a flat valley a bead may come from one plate deep into the next)
        if touch.x > deepest and not touches(row, shared):
            complain(shared, clock.step, bead.tag, row, memory.STARTS_INSIDE, p, touch.x, deepest)
    elif touch.face and side != row[at + PLATE]:
        complain(shared, clock.step, bead.tag, row, memory.CROSSED, p, u, 0.0)
    waves = Waves(
        plate.eta, plate.eta_h, plate.eta4, plate.beyond, plate.steepest, plate.bulk_factor,
        plate.p1, plate.p2, plate.p3, plate.p4, plate.p5,
    )  # fmt: skip
    unit = Spring(
        plate.mass, plate.stiffness, plate.mobility, plate.scale, plate.relaxation,
        plate.transit, plate.bulk, plate.ratio, plate.radius, waves,
    )  # fmt: skip
    spring = resized(unit, bead.r)
    last = State(
        row[at + DISPLACEMENT], row[at + LARGEST], row[at + FORCE], row[at + MOBILITY],
        row[at + STIFFENING],
    )  # fmt: skip
    state, kick = ledger.step(law, spring, last, touch.x, u, clock.dt, clock.before)
    if state.force > 0.0 and last.force == 0.0:
        _begin(shared, clock, bead, p, at, spring, touch.x, u)
    else:
        if not touch.face and last.force > 0.0 and 0.0 < row[at + DURATION] < clock.before:
            # the second step: the first one does not know how fast the normal turns
            around = ledger.turning(bead.r, row[at + OVERLAP], touch.x, u, clock.dt)
            row[at + SPEED] = ledger.free_speed(row[at + SPEED], around, bead.r, row[at + OVERLAP])
        row[at + DURATION] += clock.dt
        if u > _FASTER * max(row[at + SPEED], 0.0):
            row[at + SPEED] = u
            _check_step(shared, clock, bead, p, spring, u)
        elif clock.dt > clock.before and row[at + SPEED] > 0.0:
            _check_step(shared, clock, bead, p, spring, row[at + SPEED])
    row[at + WAVE] += ledger.wave_energy(spring, last, state, clock.dt)
    held = last.force + row[at + KICK] if last.force > 0.0 else 0.0
    row[at + WORK] += ledger.work(
        spring, bead.r, held, state.force + kick, row[at + OVERLAP],
        touch.x, u, clock.dt, clock.before,
    )  # fmt: skip
    if state.force == 0.0 and last.force > 0.0:
        kick = _end(law, shared, clock, bead, plate, p, at, spring, last, touch, u)
    row[at + PLATE] = side
    row[at + DISPLACEMENT] = state.plate_displacement
    row[at + LARGEST] = state.largest_compression
    row[at + FORCE] = state.force
    row[at + MOBILITY], row[at + STIFFENING] = state.mobility, state.stiffening
    row[at + OVERLAP] = touch.x
    if touch.x <= 0.0:
        row[at : at + (shared.width if kick == 0.0 else SPRING)] = 0.0
    if kick != 0.0:
        row[at + PLATE] = side  # also of a bead that has parted: a set-up asks for the force again
    row[at + KICK] = kick


@kernel
def _slide(
    clock: Clock, bead: Bead, friction: float, touch: Touch, at: int, modulus: float
) -> None:
    """Add a spring's tangential force, k = 8 G* sqrt(r d) with Coulomb's limit."""
    nx, ny, nz, r, v, omega = touch.nx, touch.ny, touch.nz, bead.r, bead.v, bead.omega
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
    tx, ty, tz = -k * spring[0], -k * spring[1], -k * spring[2]
    bead.force[0] += tx
    bead.force[1] += ty
    bead.force[2] += tz
    bead.torque[0] -= r * (ny * tz - nz * ty)
    bead.torque[1] -= r * (nz * tx - nx * tz)
    bead.torque[2] -= r * (nx * ty - ny * tx)


@kernel
def interact(shared: Any, clock: Clock, plates: Any, p: int, bead: Bead) -> None:
    """Add the force of plate p to a bead, and keep the bead's history."""
    plate = plates[p]
    touch = _geometry(plate, bead)
    if not touch.x > (1.0 - NEAR) * bead.r:
        return
    if bead.history[OWNER] != bead.tag:
        bead.history[:] = 0.0
        bead.history[OWNER] = bead.tag
    at = slot_of(bead.history, shared, p)
    new = at == 0 or bead.history[at + PLATE] == 0.0
    if new and touch.x > 0.0 and len(plates) > 1 and _home(plates, p, touch, bead) != p:
        return
    if at == 0:
        if touch.x > 0.0:
            complain(shared, clock.step, bead.tag, bead.history, memory.TOO_MANY_PLATES, p, 0.0,
                     shared.slots)  # fmt: skip
        return
    if new and (touch.x <= 0.0 or not clock.advancing):
        return
    if clock.advancing:
        law = array_at(plate.law, plate.law_size, np.float64)
        _normal(law, shared, clock, bead, plate, p, at, touch)
    push = bead.history[at + FORCE] + bead.history[at + KICK]
    bead.force[0] += push * touch.nx
    bead.force[1] += push * touch.ny
    bead.force[2] += push * touch.nz
    if shared.friction > 0.0:
        _slide(clock, bead, shared.friction, touch, at, plate.tangential)
