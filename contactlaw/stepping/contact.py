"""One contact of a bead with a wall in one time step: normal force, friction, energies, record.

Legend: r radius, x overlap of the sphere with the undeformed wall, u speed towards the wall, n
normal from the wall to the bead, s height of the bead's centre over the facet's plane.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel, tuple_of
from contactlaw.equation.corrections import CONTACT_TIME
from contactlaw.equation.tangential import POINT
from contactlaw.physical.kind import Kind
from contactlaw.physical.oblique import Sliding, sliding, surface_velocity
from contactlaw.physical.responses import CYLINDER, SPHERE
from contactlaw.physical.scaling import from_rim, wave_rate
from contactlaw.physical.validity import Validity, curved_flags, edge_flags, flags_of, layer_flags
from contactlaw.physical.vectors import cross, divided, dot, norm, plus, put, scaled, vector
from contactlaw.stepping import energy
from contactlaw.stepping.bounce import bounce
from contactlaw.stepping.edge import REACH, EdgeEcho, place_of
from contactlaw.stepping.friction import clear_friction, tangential_force
from contactlaw.stepping.loads import bear
from contactlaw.stepping.plate_rows import SOLID, limits_of, modelled_mass, spring_of
from contactlaw.stepping.rigid import answer
from contactlaw.stepping.softened import (
    BOUNCING,
    DAMPED,
    HELD,
    MOST_SETTLED,
    SOFTENED,
    keep_drag,
    must_ask,
    push,
    stored_work,
    tangential_push,
)
from contactlaw.stepping.spring import FEWEST_STEPS, PARTED, RELAXATION, Spring, State, at_largest, impact
from contactlaw.stepping.trouble import Trouble
from contactlaw.table.lookup import THINNEST
from contactlaw.walls.edges import nearest_edge
from contactlaw.walls.facet import Point, Touch, nearest, to_frame, velocity
from contactlaw.walls.memory import array_at
from contactlaw.walls.profile import Bend, bending
from contactlaw.walls.surface import wall_ends

AT_REST = 1e-3  # [r] overlap with which a bead may be put down on a wall
# A touching bead that is 1 % faster than when it arrived was struck by another: a new impact.
_FASTER = 1.01

# State of a contact between two steps. All fields are float64, so that an engine can keep them in
# any array of numbers that it stores with its beads.
CONTACT = np.dtype(
    [
        (name, "f8")
        for name in (
            "facet",  # its number from 1, negative for a bead opposite to its normal; 0: an empty row
            *State._fields,
            # time since first touch [s]: a sum of steps, so that a run in pieces gives the same bits
            "duration",
            "approach_speed",  # [m/s]
            "wave_energy",  # energy that the plate has taken [J]
            "reported_loss",  # energy lost in the contact that the record already holds [J]
            "overlap",  # [m]
            "work",  # work of the normal force on the bead, in the frame of the wall [J]
            "wall_work",  # work that the wall's motion does on the bead [J]
            "extra_force",  # correction added to `force` in this step alone [N]
            "disturbance",  # ALONE, UNEVEN or SHARING
            "wall_power",  # power of the normal force at the wall's velocity [W]
            "sliding_speed",  # of the contact point along the wall at first touch [m/s]
            "arrival",  # FREE, ON_EDGE, SLIDING or HIT_BACK
            *SOFTENED,
        )
    ]
    + [("push", "f8", 3)]  # force on the bead without friction [N]
)
NO_CONTACT = np.zeros(1, CONTACT)

# A contact is ALONE on one smooth surface, UNEVEN if it crossed a kink or another one pressed at
# the same time, and SHARING if it has shared its force with another one.
ALONE, UNEVEN, SHARING = 0.0, 1.0, 2.0
# A bead arrives FREE on a surface or ON_EDGE of it, or SLIDING while another wall presses on it; or
# it was leaving and is HIT_BACK by a plate that returns from its edge.
FREE, ON_EDGE, SLIDING, HIT_BACK = 0.0, 1.0, 2.0, 3.0
_COUPLED = int(Validity.COUPLED)
_LASTING = 50.0  # [contact times of an elastic bead]; impacts on the thinnest plates take 23
# Above 16 rad in a contact six exponentials would add energy, so the frequency is capped there. This changes
# the COR by up to 8e-4, since a wall that swings faster hardly moves. Contact times of slower beads count as
# those at the second number [m/s].
_SWINGS, _SLOWEST = 16.0, 1e-3
_WORK = 0.02  # [energy of the approach] work of others on a bead that counts as a strike
_ROUNDING = 1e-6  # [speed of the approach] a bead that leaves faster by more than it was struck


# What the kernels report to their caller, who clears it.
STATUS = np.dtype(
    [
        (name, "i8")
        for name in (
            "impacts",  # number of impacts in the record
            "left_out",  # contacts left out because no row was empty, counted in every step
            "trouble",  # the first `Trouble`, 0 without any
            "worst",  # the `Trouble` with the largest number
            "wall",  # wall, wrong value and its limit are those of the first `Trouble`
        )
    ]
    # overlap: the deepest of softened contacts [r]; speed: of the approach in that impact [m/s]
    + [(name, "f8") for name in ("value", "limit", "overlap", "speed")]
)


class Clock(NamedTuple):
    """Time and steps of a simulation."""

    now: float  # [s]
    dt: float  # the step that ends now [s]
    before: float  # the step before that [s]
    advancing: bool  # False if an engine asks for the last step's forces again, as at a set-up


class WallScene(NamedTuple):
    """Walls that beads may touch, as `contactlaw.stepping.WallContacts` makes them."""

    plate_rows: Any
    frames: Any
    facets: Any
    found: Any  # scratch rows for the facets that a bead overlaps
    impacts: Any  # rows of the record
    status: Any
    loads: Any  # rows of LOAD, one for each wall
    friction: float  # Coulomb's coefficient [-]
    softening: float  # by which the moduli of the contacts are divided; 1: true contacts
    parcel: float  # radius of a bead over that of the true beads that it stands for


class Bead(NamedTuple):
    """A bead in SI units; kernels add to its force and torque, and update its contacts."""

    number: float  # its ID
    kind: int  # its type, from 0
    x: Point
    v: Point  # velocity half a step before
    omega: Point
    r: float
    mass: float
    force: Any
    torque: Any
    contacts: Any  # rows of CONTACT
    friction: Any  # as many rows of FRICTION; none without friction


class NearestEdge(NamedTuple):
    """The edge of a wall that is nearest to a contact, or how the wall swings back far from edges."""

    place: int  # its row of the plate's responses
    rate: float  # as of `EdgeEcho` [1/s]
    distance: float  # [m]; inf without any


class Contact(NamedTuple):
    """A bead's contact with a facet."""

    facet: int
    plate_row: int
    wall: int  # number of the plate or mesh
    triangle: int
    touch: Touch
    n: Point  # its normal
    point: Point  # [m]
    v: Point  # velocity of the bead relative to the wall, half a step before [m/s]
    w: Point  # velocity of the wall [m/s]
    along: Point  # vector that the law's force is multiplied by; the normal, if none is shared
    touching: bool  # whether the bead was on a wall before this step
    merged_into: int  # row of the contact that this one has merged into, else -1
    bend: Bend
    mass: float  # that answers at the contact [kg]
    answer: Point  # of a rigid body, as in `contactlaw.stepping.rigid`; zero of a free bead [1/kg]
    of_body: bool  # whether the bead is a part of a rigid body


@kernel
def contact_of(
    scene: WallScene, bead: Bead, body: Any, facet: int, touch: Touch, along: Point, touching: bool, merged_into: int
) -> Contact:
    """Contact of a bead with a facet, with the velocities at the point of touch."""
    row, point = scene.facets[facet], nearest(touch, bead.x, bead.r)
    frame = scene.frames[row.frame]
    n = touch.nx, touch.ny, touch.nz
    answers = answer(body, n, n, bead.r)
    per = dot(answers, n)
    return Contact(
        facet,
        row.plate_row,
        row.wall,
        row.triangle,
        touch,
        n,
        point,
        plus(bead.v, -1.0, velocity(frame, frame.half_rate, point)),
        velocity(frame, frame.rate, point),
        along,
        touching,
        merged_into,
        bending(row, to_frame(frame, bead.x), bead.r, bead.r / scene.parcel),
        1.0 / per if per > 0.0 else bead.mass,
        answers,
        per > 0.0,
    )


@kernel
def report_trouble(scene: WallScene, trouble: Trouble, wall: int, value: float, limit: float) -> None:
    """Record a trouble if it is the first, and the largest trouble number so far."""
    status, code = scene.status[0], trouble.value
    if status.trouble == 0:
        status.trouble, status.wall, status.value, status.limit = code, wall, value, limit
    status.worst = max(status.worst, code)


@kernel
def _stretched(scene: WallScene) -> float:
    """Contact time over that of a true contact."""
    return math.pow(scene.softening, 0.4) if scene.softening > 1.0 else 1.0


@kernel
def _check_step(law: Array, scene: WallScene, clock: Clock, contact: Contact, spring: Spring, u: float) -> None:
    """Refuse a step that is too long for an impact at this speed on a plate.

    In a hollow wall a contact is shorter, by 3 % for a cylinder of 4 radii: `time_step` knows none.
    """
    limit = _stretched(scene) * CONTACT_TIME * impact(law, spring, u).time / FEWEST_STEPS
    if contact.bend.ratio > 1.0:
        limit *= contact.bend.ratio**0.2
    if clock.dt > limit:
        report_trouble(scene, Trouble.STEP_TOO_LARGE, contact.wall, u, limit)


@kernel
def _slip(bead: Bead, contact: Contact) -> Sliding:
    """Speeds of a bead's surface relative to the wall, half a step before."""
    return sliding(contact.v, bead.omega, contact.n, (0.0, 0.0, 0.0), bead.r)


@kernel
def _over_edge(scene: WallScene, bead: Bead, contact: Contact) -> bool:
    """Whether the wall ends at a contact's point."""
    return not contact.touch.face and wall_ends(scene.frames, scene.facets, contact.facet, contact.point, bead.r)


@kernel
def _begin(
    law: Array, scene: WallScene, clock: Clock, bead: Bead, contact: Contact, k: int, spring: Spring, u: float
) -> None:
    """Start an impact: of a new contact, or of a bead that returns before it has left the wall."""
    row, wall, touch = bead.contacts[k], contact.wall, contact.touch
    x = touch.x - row.plate_displacement
    plate_row = scene.plate_rows[bead.kind, contact.plate_row]
    first = u > 0.0 and row.largest_compression == 0.0
    row.duration = min(x / u, clock.dt) if first else 0.0
    row.approach_speed, row.wave_energy, row.work, row.wall_work = u, 0.0, 0.0, 0.0
    row.sliding_speed = _slip(bead, contact).size
    row.arrival = ON_EDGE if _over_edge(scene, bead, contact) else FREE
    if contact.touching and _presses_elsewhere(bead, k):
        row.arrival = SLIDING
    solid = modelled_mass(plate_row, bead.r)
    if not (contact.of_body or abs(bead.mass - solid) <= SOLID * solid):
        report_trouble(scene, Trouble.WRONG_MASS, wall, bead.mass, solid)
    if u > 0.0:
        lam = impact(law, spring, u).inelasticity
        ratio = bead.r / scene.parcel / plate_row.thickness
        if not THINNEST * ratio <= 1.0:
            report_trouble(scene, Trouble.FOIL, wall, ratio, 1.0 / THINNEST)
        elif lam > plate_row.largest:
            report_trouble(scene, Trouble.TOO_THIN, wall, lam, plate_row.largest)
        _check_step(law, scene, clock, contact, spring, u)


@kernel
def _sharing_row(bead: Bead, k: int) -> int:
    """Row of another contact that shares its force, if contact k does so too, else -1."""
    if bead.contacts[k].disturbance == SHARING:
        for j in range(len(bead.contacts)):
            other = bead.contacts[j]
            if j != k and other.force > 0.0 and other.disturbance == SHARING and other.approach_speed > 0.0:
                return j
    return -1


@kernel
def _presses_elsewhere(bead: Bead, k: int) -> bool:
    """Whether a contact except k presses the bead."""
    for j in range(len(bead.contacts)):
        if j != k and bead.contacts[j].force > 0.0:
            return True
    return False


@kernel
def _power(bead: Bead, k: int, v: Point) -> float:
    """Power of all contacts except k on a bead of velocity v [W]."""
    power = 0.0
    for j in range(len(bead.contacts)):
        other = bead.contacts[j]
        if j != k and other.force > 0.0:
            power += dot(vector(other.push), v)
    return power


@kernel
def _normal_jumped(held: Point, n: Point, v: Point, dt: float, distance: float) -> bool:
    """Whether the normal has turned by more than the bead's motion in the step explains."""
    turn = plus(divided(held, norm(held)), -1.0, n)
    return dot(turn, turn) * distance * distance > 4.0 * dot(v, v) * dt * dt


@kernel
def _kind_of(scene: WallScene, bead: Bead, contact: Contact, row: Any, lost: float, leaves: float, long: float) -> int:
    """Say what a contact was that has ended; several may hold, and the first one counts.

    `lost` is the energy that the record says is lost, `leaves` the speed away from the wall, and
    `long` the time that no impact lasts.
    """
    # Another wall pressed on the bead when it came to this one.
    if row.arrival == SLIDING:
        return Kind.SLIDING_ON.value
    # The wall ends under the bead, and did not at first touch.
    if row.arrival == FREE and _over_edge(scene, bead, contact):
        return Kind.OVER_EDGE.value
    # It has lasted far longer than an impact with this speed.
    if row.duration > long:
        return Kind.RESTING.value
    # Another contact shared the force, or the losses do not explain the speed: others did work.
    came = 0.5 * contact.mass * row.approach_speed * row.approach_speed
    others = lost + 0.5 * contact.mass * leaves * abs(leaves) - came
    # Friction may make a point of a body leave faster.
    faster = leaves > (1.0 + _ROUNDING) * row.approach_speed and not contact.of_body
    if row.disturbance == SHARING or faster or not abs(others) <= _WORK * came:
        return Kind.STRUCK.value
    return Kind.OF_BODY.value if contact.of_body else Kind.IMPACT.value


@kernel
def _end(
    law: Array,
    scene: WallScene,
    clock: Clock,
    bead: Bead,
    body: Any,
    contact: Contact,
    k: int,
    spring: Spring,
    last: State,
    u: float,
    edge: NearestEdge,
) -> Point:
    """Record an impact whose force ended in this step; return the force that settles its energy.

    A contact that has merged into another adds its energies to that one and is not recorded.
    """
    row, v, touch = bead.contacts[k], contact.v, contact.touch
    plate_row = scene.plate_rows[bead.kind, contact.plate_row]
    softened = scene.softening > 1.0
    ended = at_largest(law, spring, last)
    scale, unit = ended.scale, ended.unit
    lost, other = ended.lost * unit * scale, ended.other * unit * scale
    if softened:
        lost = (1.0 - row.restitution * row.restitution) * row.stored
    if contact.merged_into >= 0:
        to = bead.contacts[contact.merged_into]
        to.reported_loss += row.reported_loss - lost
        to.wave_energy += row.wave_energy
        to.work += row.work
        to.wall_work += row.wall_work
        if len(bead.friction) > 0:
            bead.friction[contact.merged_into].work += bead.friction[k].work
        if not to.approach_speed > 0.0:  # the bead has not arrived there: it is this impact that goes on
            to.approach_speed, to.sliding_speed, to.arrival = row.approach_speed, row.sliding_speed, row.arrival
            to.asked_speed, to.true_time, to.true_force = row.asked_speed, row.true_time, row.true_force
            to.plastic_share, to.wave_share, to.true_flags = row.plastic_share, row.wave_share, row.true_flags
            to.lasting = HELD
        return 0.0, 0.0, 0.0
    reported, row.reported_loss = row.reported_loss, lost
    # The bead did not arrive: it was put down in contact.
    put_down = not (row.approach_speed > 0.0 or row.arrival == HIT_BACK)
    if put_down and row.disturbance != SHARING:
        return 0.0, 0.0, 0.0
    missing = reported - lost - row.wave_energy - row.work
    steps, sharing = row.duration / clock.dt, _sharing_row(bead, k)
    due, extra, leaves, size, damped = missing, (0.0, 0.0, 0.0), -u, 0.0, 0.0
    if sharing >= 0:  # the other contact has the energy that this one lacks
        bead.contacts[sharing].work -= missing
        missing = 0.0
    elif softened and row.lasting == DAMPED:
        damped, missing = missing, 0.0
    elif row.disturbance != ALONE and not contact.of_body:
        more = energy.settling_share(missing, bead.mass, v, _power(bead, k, v), clock.dt, steps)
        size = more * bead.mass / clock.dt
        extra, leaves = scaled(size, v), -u * (1.0 + more)
    else:
        if softened and body is not None and row.lasting == BOUNCING and contact.of_body:
            # A body turns further than in the true impact, which throws its point up by this at most.
            up, reach = row.restitution * row.approach_speed, norm(vector(body[0].arm)) + bead.r
            if abs(up + u) <= dot(bead.omega, bead.omega) * reach * row.duration:
                due = 0.5 * contact.mass * (up * up - u * u)
        most = MOST_SETTLED if softened else energy.largest_correction(steps)
        size = energy.settling_force(due, contact.mass, u, row.approach_speed, clock.dt, most)
        extra = scaled(size, contact.n)
        leaves = size * clock.dt / contact.mass - u
    if put_down:
        if sharing >= 0 and len(bead.friction) > 0:
            bead.friction[sharing].work += bead.friction[k].work
        return extra
    scheme = missing
    if size != 0.0:
        scheme, missing = missing - due, 0.0
    if not touch.face and u < 0.0 and row.disturbance == ALONE:
        leaves = energy.free_speed(leaves, touch.x, bead.r, row.overlap, touch.x, u, clock.dt)
    n = scene.status[0].impacts
    if n == len(scene.impacts):
        report_trouble(scene, Trouble.TOO_MANY_IMPACTS, contact.wall, 0.0, n)
        return extra
    scene.status[0].impacts = n + 1
    since = 0.0
    if u < 0.0:  # time since the compression fell to the residual one, within this step
        gap = ended.residual * scale + last.plate_displacement - touch.x
        since = min(max(gap / -u, 0.0), clock.dt)
    record = scene.impacts[n]
    record.time = clock.now - row.duration
    record.bead, record.other, record.material = bead.number, -1, bead.kind
    record.plate, record.triangle = contact.wall, contact.triangle
    record.x, record.y, record.z = contact.point
    record.approach_speed, record.restitution = row.approach_speed, leaves / row.approach_speed
    record.contact_time = row.duration - since
    record.peak_force = ended.peak * unit / scene.parcel**3  # of one of the true beads
    # earlier impacts of the same contact have reported a part of the loss already
    gone, wave = lost - reported, row.wave_energy
    if softened:
        record.contact_time, record.peak_force = row.true_time, row.true_force
        plastic, wave = row.plastic_share * gone, row.wave_share * gone
        record.other_energy = gone - plastic - wave + damped
    else:
        share = 1.0 - other / lost if lost > 0.0 else 0.0
        plastic = share * gone
        record.other_energy = (1.0 - share) * gone
    record.plastic_energy, record.wave_energy = plastic, wave
    record.scheme_energy = scheme  # with this error of the steps, the energies of a run add up
    record.sliding_speed, record.wall_work = row.sliding_speed, row.wall_work
    record.radius, record.mass, record.thickness = bead.r / scene.parcel, contact.mass, plate_row.thickness
    record.parcel, record.wall_start, record.run, record.run_start = scene.parcel, 0.0, 0, 0.0
    expected = impact(law, spring, abs(row.approach_speed))
    total = gone + row.wave_energy + missing  # damping is no part of an impact
    bent = curved_flags(contact.bend.ratio)
    if body is not None and contact.of_body:
        total -= body[0].coupled
        if abs(body[0].coupled) > _WORK * 0.5 * contact.mass * row.approach_speed * row.approach_speed:
            bent |= _COUPLED
    long = _LASTING * _stretched(scene) * CONTACT_TIME * expected.time
    record.kind = _kind_of(scene, bead, contact, row, total, leaves, long)
    if softened:
        record.flags = int(row.true_flags) | bent
        return extra
    if edge.rate > 0.0 and row.wave_energy < 0.0:  # a returning plate has driven the bead
        record.kind = Kind.STRUCK.value
    # Whether the plate comes back later is not known here; the strike will have a row of its own.
    # Flagged is a plate that recedes before the bead.
    recedes = 1.0 if edge.rate > 0.0 and leaves < 0.0 else 0.0
    record.flags = bent | _flags(
        plate_row,
        record.radius,
        expected.compression,
        record.contact_time,
        last.largest_compression,
        record.peak_force,
        edge.distance,
        recedes,
    )
    return extra


@kernel
def clear_contact(bead: Bead, k: int) -> None:
    """Empty the row of a contact."""
    bead.contacts[k] = NO_CONTACT[0]
    if len(bead.friction) > 0:
        clear_friction(bead.friction[k])


@kernel
def _flags(
    row: Any, r: float, scale: float, time: float, deepest: float, force: float, distance: float, recedes: float
) -> Any:
    """Limits that an impact exceeds on the plate of a row, at this distance [m] from an edge."""
    flags = flags_of(limits_of(row), r, row.thickness, scale, time, deepest, force)
    flags |= edge_flags(r, row.thickness, deepest, distance, recedes)
    return flags | layer_flags(row.top, row.softest, row.pitch, row.wave_of_all, r, deepest, time)


@kernel
def _lasting(spring: Spring, speed: float) -> Any:
    """Contact time of an elastic bead that hits a half-space at this speed [s]."""
    return spring.relaxation / RELAXATION * math.pow(max(speed, _SLOWEST), -0.2)


@kernel
def _near_edge(scene: WallScene, bead: Bead, contact: Contact, spring: Spring, speed: float) -> NearestEdge:
    """Edge that is nearest to a contact, and how it acts there; far from edges, how the wall swings back."""
    facet, plate_row = scene.facets[contact.facet], scene.plate_rows[bead.kind, contact.plate_row]
    if plate_row.thickness == math.inf:
        return NearestEdge(0, 0.0, math.inf)
    place, swing = plate_row.swing_place, plate_row.swing
    bend = contact.bend
    if bend.around != 0.0:
        place, swing = SPHERE if bend.along != 0.0 else CYLINDER, plate_row.shell_speed * abs(bend.around)
    if swing > 0.0:
        swing = min(swing, _SWINGS / _lasting(spring, speed))
    if facet.edge_count == 0:
        return NearestEdge(place, swing, math.inf)
    path, thickness = plate_row.wave_path, plate_row.thickness
    # Slow impacts last twice as long as those at 1 m/s, and the more the plate gives way, the
    # longer: the bead is then slowed in the time m alpha.
    long = 2.0 * spring.relaxation / RELAXATION + 4.0 * spring.mass * spring.mobility
    reach = math.sqrt(REACH * path * thickness * long)
    p = to_frame(scene.frames[facet.frame], contact.point)
    # At an edge nearer than that, an impact is flagged.
    distance, kind, hole = nearest_edge(facet, p, max(reach, thickness, bead.r / scene.parcel))
    if not distance < reach:
        return NearestEdge(place, swing, distance)
    away = from_rim(path, thickness, distance, hole, _lasting(spring, speed) / CONTACT_TIME)
    return NearestEdge(place_of(kind, away, hole, thickness), wave_rate(path, thickness, away), distance)


@kernel
def _ask(
    law: Array,
    scene: WallScene,
    bead: Bead,
    body: Any,
    contact: Contact,
    k: int,
    spring: Spring,
    state: State,
    begins: bool,
    u: float,
) -> None:
    """Let a softened contact know the true impact: at first touch, and of a bead that was struck."""
    row, status, x = bead.contacts[k], scene.status[0], contact.touch.x
    if x > status.overlap * bead.r:
        status.overlap, status.speed = x / bead.r, row.approach_speed
    deepens = state.largest_compression > row.largest_compression
    if state.force == 0.0 or not must_ask(begins, deepens, u, row.asked_speed):
        return
    if not u > 0.0:  # a bead that was put down
        row.restitution, row.lasting = 1.0, HELD
        row.asked_speed = row.true_time = row.true_force = row.plastic_share = row.wave_share = row.true_flags = 0.0
        return
    plate_row = scene.plate_rows[bead.kind, contact.plate_row]
    edge = _near_edge(scene, bead, contact, spring, u)
    near = EdgeEcho(plate_row.responses[edge.place], edge.rate)
    n, rows, mu, kappa = contact.n, bead.friction[k : k + 1], scene.friction, plate_row.tangential
    came = surface_velocity(contact.v, bead.omega, bead.r, n)
    if not begins:  # what friction has done so far stays, because a spring holds now
        rows = bead.friction[0:0]
    true = bounce(law, spring, came, n, near, mu, kappa, rows, body, bead.r)
    if len(rows) > 0:
        keep_drag(rows[0], true.drag, _slip(bead, contact).along)
    force = true.peak_force / scene.parcel**3  # of one of the true beads
    scale = impact(law, spring, u).compression
    r, time, deepest = bead.r / scene.parcel, true.contact_time, true.compression
    flags = _flags(plate_row, r, scale, time, deepest, force, edge.distance, true.recedes)
    # In a dent that an earlier impact has left, no energy may come back that has been lost.
    row.restitution = true.restitution if row.stored == 0.0 else min(true.restitution, row.restitution)
    if begins:
        row.reported_loss = (1.0 - row.restitution * row.restitution) * row.stored
    lasting = BOUNCING if begins and row.arrival != SLIDING and row.disturbance == ALONE else HELD
    row.lasting = lasting if begins else max(lasting, row.lasting)
    row.asked_speed, row.true_time, row.true_force = u, true.contact_time, force
    row.plastic_share, row.wave_share, row.true_flags = true.plastic_share, true.wave_share, float(flags)


# Inlined into its one caller, because a call would write its arguments, some 250 numbers, to memory.
@kernel(inline=True)
def _advance(
    law: Array, scene: WallScene, clock: Clock, bead: Bead, body: Any, contact: Contact, k: int, spring: Spring
) -> None:
    """Advance a contact by a step; its row is empty afterwards if the bodies have parted."""
    row, v, touch = bead.contacts[k], contact.v, contact.touch
    n, u = contact.n, -dot(v, contact.n)
    if contact.bend.ratio < 0.0:
        report_trouble(scene, Trouble.TOO_WIDE, contact.wall, bead.r, -contact.bend.ratio)
    side = math.copysign(contact.facet + 1.0, touch.s)
    if row.facet == 0.0:
        # The overlap is at most the path of a step, which on an edge is not along the normal.
        deepest = norm(v) * clock.dt + AT_REST * bead.r
        # A bead that was on a wall already may begin deep in the next surface.
        if touch.x > deepest and not contact.touching:
            report_trouble(scene, Trouble.STARTS_INSIDE, contact.wall, touch.x, deepest)
    elif touch.face and side != row.facet:
        report_trouble(scene, Trouble.CROSSED, contact.wall, abs(u), 0.0)
    plate_row = scene.plate_rows[bead.kind, contact.plate_row]
    last, softened = tuple_of(State, row), scene.softening > 1.0
    moved = (dot(v, v) - u * u) * row.duration * row.duration
    if last.force == 0.0 and not softened and moved > 2.0 * bead.r * last.largest_compression > 0.0:
        # The bead has hopped off its dent: it meets a new surface, at the depth of the dent.
        dent = at_largest(law, spring, last)
        row.plate_displacement += dent.residual * dent.scale
        row.largest_compression = row.mobility = row.stiffening = row.strength = row.reported_loss = 0.0
        last = tuple_of(State, row)
    edge = NearestEdge(0, 0.0, math.inf)
    if not softened:
        edge = _near_edge(scene, bead, contact, spring, max(row.approach_speed, u))
    near = EdgeEcho(plate_row.responses[edge.place], edge.rate)
    k_soft, extra = spring.stiffness / scene.softening, 0.0
    if softened:
        now = push(k_soft, spring.mass, row.largest_compression, row.restitution, touch.x, u, clock.dt)
        if now.damped:
            row.lasting = DAMPED
        elif row.disturbance != ALONE or _presses_elsewhere(bead, k):  # at a right angle only friction is shared
            row.lasting = max(row.lasting, HELD)
        state = tuple_of(State, PARTED, largest_compression=now.largest, force=now.force)
    else:
        state, extra = energy.step(law, spring, last, touch.x, u, clock.dt, clock.before, near)
    held, power_0 = (0.0, 0.0, 0.0), 0.0
    if last.force > 0.0:
        held, power_0 = vector(row.push), row.wall_power
        if row.extra_force == 0.0 and _normal_jumped(held, n, v, clock.dt, bead.r - touch.x):
            row.disturbance = max(row.disturbance, UNEVEN)
    if state.force > 0.0 and last.force == 0.0:
        _begin(law, scene, clock, bead, contact, k, spring, u)
        if edge.rate > 0.0 and u < 0.0 < last.largest_compression:
            row.arrival = HIT_BACK
        if len(bead.friction) > 0:  # of a bead that returns before it has left the wall
            clear_friction(bead.friction[k])
        if body is not None and contact.of_body:
            body[0].coupled = 0.0
    else:
        first = 0.0 < row.duration < clock.before
        if not touch.face and last.force > 0.0 and first and row.disturbance == ALONE:
            # How fast the normal turns is first known in the second step.
            arrived, x = row.approach_speed, row.overlap
            row.approach_speed = energy.free_speed(arrived, x, bead.r, x, touch.x, u, clock.dt)
        row.duration += clock.dt
        if u > _FASTER * max(row.approach_speed, 0.0):
            row.approach_speed = u
            _check_step(law, scene, clock, contact, spring, u)
        elif clock.dt > clock.before and row.approach_speed > 0.0:
            _check_step(law, scene, clock, contact, spring, row.approach_speed)
    if softened:
        _ask(law, scene, bead, body, contact, k, spring, state, last.force == 0.0, u)
    else:
        row.wave_energy += energy.wave_energy(spring, last, state, clock.dt, near)
    pressed = state.force + extra
    pushes = scaled(pressed, contact.along)
    power = dot(pushes, contact.w)
    row.work += energy.work(spring.mass, held, pushes, bead.v, power_0, power, clock.dt, clock.before)
    if softened and state.largest_compression > last.largest_compression:
        undisturbed = row.lasting != DAMPED and row.disturbance == ALONE
        most, left = state.largest_compression, row.reported_loss - row.work
        row.stored = stored_work(k_soft, most, undisturbed, left, spring.mass, u, state.force, clock.dt)
    if state.force == 0.0 and last.force > 0.0:
        pushes = _end(law, scene, clock, bead, body, contact, k, spring, last, u, edge)
        extra = dot(pushes, n)
    row.plate_displacement = state.plate_displacement
    row.largest_compression = state.largest_compression
    row.force = state.force
    row.mobility, row.stiffening, row.strength = state.mobility, state.stiffening, state.strength
    row.x1, row.y1, row.x2, row.y2 = state.x1, state.y1, state.x2, state.y2
    row.x3, row.y3, row.x4, row.y4 = state.x3, state.y3, state.x4, state.y4
    row.x5, row.y5, row.x6, row.y6 = state.x5, state.y5, state.x6, state.y6
    row.facet, row.overlap = side, touch.x
    if touch.x <= 0.0:
        bead.contacts[k] = NO_CONTACT[0]
    if extra != 0.0:
        row.facet = side  # kept after parting too, because a set-up asks for this force again
    row.extra_force, row.wall_power = extra, power
    put(row.push, pushes)


@kernel
def _complete(record: Any, clock: Clock, bead: Bead, contact: Contact, k: int, drag: Point, torque: Point) -> None:
    """Complete a row of the record with what follows from the forces of the contact's last step."""
    omega, n = bead.omega, contact.n
    per = 0.0 if contact.of_body else clock.dt / bead.mass  # of a body it is small, and left out
    turn = per / (0.4 * bead.r * bead.r)  # of a solid sphere
    v = plus(plus(contact.v, per, vector(bead.contacts[k].push)), per, drag)
    spin = plus(omega, turn, torque)
    left = sliding(v, spin, n, (0.0, 0.0, 0.0), bead.r)
    record.spin_x, record.spin_y, record.spin_z = spin
    record.sliding_speed_after, record.friction_energy = left.size, 0.0
    if len(bead.friction) > 0:
        slid = bead.friction[k]
        if record.sliding_speed > 0.0:
            record.sliding_speed_after = dot(left.along, vector(slid.along))
        # The second half of the last step's force acts in the next step.
        slip = surface_velocity(bead.v, omega, bead.r, n)
        after = dot(drag, slip) + POINT * per * dot(drag, drag)
        record.friction_energy = -slid.work - 0.5 * clock.dt * after


@kernel
def _finish_work(clock: Clock, bead: Bead, k: int) -> None:
    """Add the work of friction's last force in this step, by the velocity and normal before it."""
    push, slid = vector(bead.contacts[k].push), bead.friction[k]
    if norm(push) > 0.0:
        slip, drag = surface_velocity(bead.v, bead.omega, bead.r, divided(push, norm(push))), vector(slid.force)
        slid.work += energy.work(bead.mass / POINT, drag, (0.0, 0.0, 0.0), slip, 0.0, 0.0, clock.dt, clock.before)


@kernel
def apply_contact(scene: WallScene, clock: Clock, bead: Bead, body: Any, contact: Contact, k: int) -> None:
    """Add the force of one contact to a bead, and update the row of the contact."""
    row, touch = bead.contacts[k], contact.touch
    plate_row = scene.plate_rows[bead.kind, contact.plate_row]
    if plate_row.law == 0:
        report_trouble(scene, Trouble.NO_MODEL, contact.wall, bead.kind + 1.0, 0.0)
        return
    law = array_at(plate_row.law, plate_row.law_size, np.float64)
    spring = spring_of(plate_row, bead.r, scene.parcel, contact.bend.ratio, contact.mass)
    recorded, rough = scene.status[0].impacts, len(bead.friction) > 0
    before = row.largest_compression
    if clock.advancing:
        if rough and (row.force > 0.0 or row.extra_force != 0.0):
            _finish_work(clock, bead, k)
        _advance(law, scene, clock, bead, body, contact, k, spring)
    ended = scene.status[0].impacts > recorded
    n, drag, torque = contact.n, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if row.force != 0.0 or row.extra_force != 0.0:
        if rough:
            slip = surface_velocity(contact.v, bead.omega, bead.r, n)
            kappa, h, slid = plate_row.tangential, clock.dt if clock.advancing else 0.0, bead.friction[k]
            x, most = touch.x, row.largest_compression
            if scene.softening > 1.0:
                f, lasting, e = row.force + row.extra_force, row.lasting, row.restitution
                drag = tangential_push(slid, lasting, e, scene.friction, kappa, x, most, f, bead.mass, n, slip, h)
            else:
                state, speed, extra = tuple_of(State, row), row.approach_speed, row.extra_force
                drag = tangential_force(
                    slid, scene.friction, kappa, law, spring, state, before, x, speed, n, slip, h, extra
                )
            torque = scaled(-bead.r, cross(n, drag))
            if clock.advancing:
                if body is not None and contact.of_body:
                    body[0].coupled += clock.dt * contact.mass * dot(contact.v, n) * dot(contact.answer, drag)
                slip = surface_velocity(bead.v, bead.omega, bead.r, n)
                slid.work += clock.dt * (0.5 * dot(drag, slip) - dot(drag, contact.w))
        both = plus(vector(row.push), 1.0, drag)
        for i in range(3):
            if not abs(both[i]) < math.inf:
                report_trouble(scene, Trouble.NO_FORCE, contact.wall, row.approach_speed, bead.r)
            bead.force[i] += both[i]
            bead.torque[i] += torque[i]
        work = dot(both, contact.w)
        if clock.advancing:
            frame = scene.frames[scene.facets[contact.facet].frame]
            bear(scene.loads[contact.wall], frame, contact.point, both, work, clock.dt)
            row.wall_work += clock.dt * work
            if ended:  # the row of the record has been written without this step's work
                scene.impacts[recorded].wall_work += clock.dt * work
    if ended:
        _complete(scene.impacts[recorded], clock, bead, contact, k, drag, torque)
    if clock.advancing and rough and row.facet == 0.0:
        clear_friction(bead.friction[k])
