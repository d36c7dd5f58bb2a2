"""What the C header offers, as kernels in SI units: a bead on a plate, a step, a whole impact.

The header is made of them by `contactlaw.emit`, with the numbers of one pair of materials
(`Bodies`); their docstrings are its comments. Bad input gives NaN.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel, tuple_of
from contactlaw.answers.solver import RTOL
from contactlaw.equation import force, zener
from contactlaw.equation.edge import KINDS
from contactlaw.equation.force import at_strength
from contactlaw.equation.notes import AT_TIMES, TO_THE_END, Notes
from contactlaw.equation.numbers import Impact, Numbers, PairConstants, PlateConstants, mass_fits, numbers, solid_mass
from contactlaw.equation.outcome import OK, History, Solution
from contactlaw.equation.tangential import POINT, slide
from contactlaw.model import ImpactModel
from contactlaw.physical.oblique import FASTEST, rebound_of, sliding, unit
from contactlaw.physical.responses import response_of
from contactlaw.physical.scaling import constants_of, wave_path, wave_rate
from contactlaw.physical.strengths import COARSE, by_strength
from contactlaw.physical.validity import flags_of, limits_at, limits_by_strength, mass_flags
from contactlaw.physical.vectors import dot, plus
from contactlaw.stepping.bounce import bounce
from contactlaw.stepping.edge import EdgeEcho
from contactlaw.stepping.energy import Point
from contactlaw.stepping.friction import FRICTION, clear_friction, tangential_force
from contactlaw.stepping.softened import DAMPED, SoftState, advance_softened, keep_drag, tangential_push
from contactlaw.stepping.spring import Spring, State, advance, resized, unit_spring
from contactlaw.table import Table, lookup
from contactlaw.table.lookup import R_MAX, R_MIN, THINNEST, V_MAX, V_MIN

EDGES = len(KINDS)  # kinds of edges, numbered from 1; 0 is none
SAMPLES, SPRINGS = 401, 32  # of an oblique impact: times, springs across the contact


class Bodies(NamedTuple):
    """What a pair of materials fixes."""

    law: Any  # data of the force law, at any strength
    strongest: float  # ln of the strength up to which laws reach
    constants: PairConstants
    unit: Spring  # of a bead of radius 1 m on a plate of 1 m, with the moduli of the pair
    limits: Any  # by strength
    tangential_ratio: float
    responses: Any  # of a plate near edges of each kind, for steps
    wave_path: float  # sqrt(D/(rho2 H))/H of a plate [m/s]
    table: Any  # of COR, see `contactlaw.table.lookup`


class BeadSpring(NamedTuple):
    """One bead on one plate."""

    mass: float  # of the bead [kg]
    stiffness: float  # K in F = K d^1.5 [N/m^1.5]
    mobility: float  # speed of a thin plate per force [m/(s N)]
    scale: float  # yield compression, or the radius for a law that never yields [m]
    relaxation: float  # time in which the plate's displacement relaxes [s]
    ratio: float  # radius over thickness
    radius: float  # [m]
    edge_rate: float  # 1/tau of an edge near the contact [1/s]; 0 without
    edge: int  # kind of that edge
    plate: PlateConstants


class Answer(NamedTuple):
    """One impact."""

    restitution: float  # rebound speed over impact speed [1]
    contact_time: float  # from touch to separation [s]
    loading_time: float  # from touch to the largest compression [s]
    peak_force: float  # largest contact force [N]
    peak_compression: float  # largest approach of the bodies since touch [m]
    residual_compression: float  # left after the impact [m]
    plastic_fraction: float  # share lost to plastic flow at the contact [1]
    wave_fraction: float  # share carried off by waves in the plate [1]
    other_fraction: float  # share left in vibration and locked-in stress [1]
    inelasticity: float  # lambda of the modified Zener model [1]
    mass_ratio: float  # mass over that of a solid sphere [1]


class Collision(NamedTuple):
    """A bead after an impact."""

    status: int  # 1; 0 for a bead that recedes; -1 for bad input
    velocity: Point
    spin: Point


@kernel
def plain_log(v: float) -> float:
    """Logarithm."""
    return math.log(v)


@kernel
def plain_root(v: float) -> float:
    """Fifth root."""
    return math.pow(v, 0.2)


@kernel
def plain_exp(x: float) -> float:
    """Exponential."""
    return math.exp(x)


# What is quick in compiled Python by other ways than those of a language's library.
INSTEAD: dict[Any, Any] = {lookup.log: plain_log, lookup.fifth_root: plain_root, lookup.exp: plain_exp}
# Parameters for each value of which a kernel is written anew: what they are decides what it has.
FIXED = "goal", "samples", "springs"
NOTHING = Answer(*[math.nan] * len(Answer._fields))
BLOWN_UP = State(0.0, 0.0, math.nan)
SOFT_BLOWN_UP = SoftState(math.nan, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
SLIDING = np.dtype([*FRICTION.descr, ("largest_compression", "f8")])


def rounded(law: Array) -> Array:
    """Round the numbers of a law to 14 digits, and those of a ladder, which errs by more, to 9."""
    digits = 14 if law[force.PIECES] > 0.0 else 9
    return np.array([float(f"{one:.{digits}g}") for one in law])


def bodies_of(model: ImpactModel, table: Table | None) -> Bodies:
    """Numbers of a model's pair, and of a table if there is one.

    A table has nine decimals, one with a ladder of strengths five: it errs by more than that.
    """
    pair, law, packed = model.pair, model.force_law, None
    laws, known = by_strength(pair, law, COARSE), constants_of(pair, law)
    if table is not None:
        packed = lookup.with_plate(table.packed, known)
        axes = lookup.head_of(packed).axes
        begins = lookup.HEADER + lookup.RUNG * int(axes.rungs)
        packed = packed[: begins + int(axes.rungs * axes.size)].copy()  # COR alone
        packed[begins:] = packed[begins:].round(9 if axes.rungs == 1.0 else 5)
    return Bodies(
        rounded(laws),
        force.strongest(laws),
        # any yield compression for a law that never yields
        known._replace(yield_compression=min(known.yield_compression, 1.0)),
        unit_spring(model, 1.0),
        limits_by_strength(pair, law),
        pair.tangential_ratio,
        np.array([response_of(one, pair.plate.poissons_ratio, size="steps") for one in KINDS]),
        wave_path(pair.plate),
        packed,
    )


@kernel
def fits(radius: float, thickness: float) -> bool:
    """Whether a bead and a plate are of sizes that the model is for."""
    return R_MIN <= radius <= R_MAX and thickness >= R_MIN and THINNEST * radius <= thickness


@kernel
def on_plate(pair: Bodies, radius: float, thickness: float) -> Spring:
    """Spring of a bead of radius 1 m, on a plate of this thickness, in a bead of this radius."""
    unit, h = pair.unit, thickness
    if not fits(radius, thickness):
        radius = h = math.nan
    return tuple_of(Spring, unit, mobility=unit.mobility / (h * h), ratio=unit.ratio / h)


@kernel
def spring_of(pair: Bodies, radius: float, thickness: float) -> BeadSpring:
    """Return a bead of this radius on a plate of this thickness; all is NaN for bad input."""
    if not fits(radius, thickness):
        radius = math.nan
    one = resized(on_plate(pair, radius, thickness), radius)
    return tuple_of(BeadSpring, one, radius=radius, edge_rate=0.0, edge=0)


@kernel
def at_edge(pair: Bodies, bead: BeadSpring, edge: int, distance: float) -> BeadSpring:
    """Bead at this distance [m] from an edge of a kind."""
    rate = 0.0
    if not (0 <= edge <= EDGES and distance >= 0.0):
        rate = math.nan
    elif edge > 0 and bead.ratio > 0.0:  # the edge of a half-space is too far away
        rate = wave_rate(pair.wave_path, bead.radius / bead.ratio, distance)
    return tuple_of(BeadSpring, bead, edge_rate=rate, edge=edge)


@kernel
def contact_spring(pair: Bodies, bead: BeadSpring) -> Spring:
    """Spring of a bead on a plate, as steps take it."""
    return tuple_of(Spring, bead, solid=solid_mass(pair.unit, bead.radius))


@kernel
def after_step(pair: Bodies, bead: BeadSpring, state: State, overlap: float, dt: float) -> State:
    """State at the end of a step; its force is NaN where the simulation has blown up."""
    moved, largest = state.plate_displacement, state.largest_compression
    if not (
        -math.inf < overlap < math.inf
        and overlap <= 2.0 * bead.radius + moved
        and overlap <= moved + largest + V_MAX * dt
        and 0.0 < dt <= bead.relaxation
        and is_bead(bead)
        and largest >= 0.0
        and state.force >= 0.0
        and state.strength >= 0.0
    ):
        return BLOWN_UP
    new = advance(pair.law, contact_spring(pair, bead), state, overlap, dt, edge_of(pair, bead))
    return new if 0.0 <= new.force < math.inf else BLOWN_UP


@kernel
def after_softened(
    bead: BeadSpring, softening: float, restitution: float, state: SoftState, overlap: float, dt: float
) -> SoftState:
    """State of a softened contact at the end of a step; its force is NaN for bad input."""
    if not (
        1.0 <= softening < math.inf
        and 0.0 <= restitution <= 1.0
        and -math.inf < overlap <= 2.0 * bead.radius
        and 0.0 < dt <= bead.relaxation
        and is_bead(bead)
    ):
        return SOFT_BLOWN_UP
    new = advance_softened(bead.stiffness / softening, bead.mass, restitution, state, overlap, dt)
    return new if -math.inf < new.force + new.kick < math.inf else SOFT_BLOWN_UP


@kernel
def solid(speed: float, radius: float, thickness: float) -> Impact:
    """Impact of a solid sphere."""
    return Impact(speed, radius, thickness, 1.0)


@kernel
def of_mass(pair: Bodies, speed: float, radius: float, thickness: float, mass: float) -> Impact:
    """Impact of a bead of this mass [kg]."""
    return Impact(speed, radius, thickness, mass / solid_mass(pair.constants, radius))


@kernel
def is_valid(impact: Impact) -> bool:
    """Whether an impact is one that the model is for."""
    return V_MIN <= impact.speed <= V_MAX and fits(impact.radius, impact.thickness) and mass_fits(impact.mass)


@kernel
def numbers_of(pair: Bodies, impact: Impact) -> Numbers:
    """Dimensionless numbers of an impact, with the moduli at its own frequency."""
    return numbers(pair.constants, pair.law, impact)


@kernel
def solved(pair: Bodies, units: Numbers, goal: int, rtol: float) -> Solution:
    """Integrate an impact to a goal."""
    none = np.empty((0, 0))
    own = at_strength(pair.law, units.strength)
    notes = Notes(none, none, none, none, none)
    return zener.follow_impact(goal, own, units.inelasticity, units.yield_ratio, rtol, notes, 0)


@kernel
def in_si(one: Solution, units: Numbers, impact: Impact) -> Answer:
    """Solution in SI units; NaN where the integration has not come to its end."""
    if one.status != OK:
        return NOTHING
    return Answer(
        one.restitution,
        one.contact_time * units.time,
        one.loading_time * units.time,
        one.peak_force * units.force,
        one.peak_compression * units.compression,
        one.residual_compression * units.compression,
        one.plastic_fraction,
        one.wave_fraction,
        one.other_fraction,
        units.inelasticity,
        impact.mass,
    )


@kernel
def followed(pair: Bodies, impact: Impact, goal: int, rtol: float) -> Answer:
    """One impact, integrated; all members are NaN for bad input."""
    if not is_valid(impact):
        return NOTHING
    units = numbers_of(pair, impact)
    if not (0.0 <= units.inelasticity < math.inf and 0.0 < units.yield_ratio < math.inf):
        return NOTHING
    if units.strength > pair.strongest:
        return NOTHING
    return in_si(solved(pair, units, goal, rtol), units, impact)


@kernel
def rebound(pair: Bodies, speed: float, radius: float, thickness: float) -> Answer:
    """One impact, integrated with an error of RTOL a step; all members are NaN for bad input."""
    return followed(pair, solid(speed, radius, thickness), TO_THE_END, RTOL)


@kernel
def rebound_with_mass(pair: Bodies, speed: float, radius: float, thickness: float, mass: float) -> Answer:
    """Return the same for a bead of this mass [kg], from LIGHTEST to HEAVIEST of a solid sphere's.

    Flags take it as it is; near an edge, and in steps, set the mass of a spring.
    """
    impact = of_mass(pair, speed, radius, thickness, mass)
    return followed(pair, impact, TO_THE_END, RTOL)


@kernel
def restitution(pair: Bodies, speed: float, radius: float, thickness: float) -> float:
    """Rebound speed over impact speed, from the table; NaN outside the table and for bad input.

    That is numbers that are not positive, a speed above V_MAX m/s, a radius above R_MAX m, lengths
    below R_MIN m, a plate thinner than THINNEST radii.
    """
    return lookup.restitution_on_plate(pair.table, speed, radius, thickness, 1.0)


@kernel
def restitution_near(pair: Bodies, speed: float, radius: float, thickness: float, edge: int, distance: float) -> float:
    """COR at this distance [m] from an edge, by some 40 steps.

    It errs by up to 1.3e-3 up to lambda 2, from half of a thickness on. Without an edge it is that
    of `rebound`.
    """
    bead = at_edge(pair, spring_of(pair, radius, thickness), edge, distance)
    if bead.edge_rate == 0.0:
        return rebound(pair, speed, radius, thickness).restitution
    return restitution_of(pair, bead, speed)


@kernel
def restitution_of(pair: Bodies, bead: BeadSpring, speed: float) -> float:
    """COR of the bead of a spring, by some 40 steps: of its mass, and near its edge."""
    if not (V_MIN <= speed <= V_MAX and is_bead(bead)):
        return math.nan
    down, up = (0.0, 0.0, -speed), (0.0, 0.0, 1.0)
    return bounce(pair.law, contact_spring(pair, bead), down, up, edge_of(pair, bead), 0.0, 1.0).restitution


@kernel
def is_bead(bead: BeadSpring) -> bool:
    """Whether a bead has numbers that steps can take."""
    return (
        bead.relaxation > 0.0
        and bead.mass > 0.0
        and bead.stiffness > 0.0
        and bead.scale > 0.0
        and bead.mobility >= 0.0
        and bead.edge_rate >= 0.0
    )


@kernel
def edge_of(pair: Bodies, bead: BeadSpring) -> EdgeEcho:
    """Edge of a bead, as steps take it."""
    return EdgeEcho(pair.responses[max(bead.edge - 1, 0)], bead.edge_rate)


@kernel
def exceeded(pair: Bodies, hit: Answer, impact: Impact) -> Any:
    """Limits of the model that an impact exceeds; -1 for an impact that is NaN."""
    if not (hit.restitution >= 0.0 and is_valid(impact)):
        return -1
    units = numbers_of(pair, impact)
    return mass_flags(impact.mass) | flags_of(
        limits_at(pair.limits, units.strength),
        impact.radius,
        impact.thickness,
        units.compression,
        hit.contact_time,
        hit.peak_compression,
        hit.peak_force,
    )


@kernel
def flags_for(pair: Bodies, hit: Answer, speed: float, radius: float, thickness: float) -> Any:
    """Limits of the model that an answer to this impact exceeds; -1 for an impact that is NaN."""
    return exceeded(pair, hit, Impact(speed, radius, thickness, hit.mass_ratio))


@kernel
def rub(
    pair: Bodies,
    bead: BeadSpring,
    state: State,
    row: Any,
    overlap: float,
    dt: float,
    n: Point,
    velocity: Point,
    friction: float,
) -> Point:
    """Friction in the step that has just been taken; the row knows the compression before it."""
    up, before = dot(velocity, n), row.largest_compression
    slip = velocity[0] - up * n[0], velocity[1] - up * n[1], velocity[2] - up * n[2]
    row.largest_compression = state.largest_compression
    if state.force == 0.0:
        clear_friction(row)
        return 0.0, 0.0, 0.0
    spring = contact_spring(pair, bead)
    return tangential_force(
        row, friction, pair.tangential_ratio, pair.law, spring, state, before, overlap, -up, n, slip, dt, 0.0
    )


@kernel
def rub_softened(
    pair: Bodies,
    bead: BeadSpring,
    restitution: float,
    state: SoftState,
    rows: Any,
    dt: float,
    n: Point,
    velocity: Point,
    friction: float,
) -> None:
    """Friction of a softened contact in the step that has just been taken, in the first of some rows."""
    row, up, push = rows[0], dot(velocity, n), state.force + state.kick
    if push == 0.0:
        clear_friction(row)
        return
    if row.normal == 0.0 and up <= -V_MIN:  # the impact begins: it will end as the true one
        spring, near = contact_spring(pair, bead), edge_of(pair, bead)
        true = bounce(pair.law, spring, velocity, n, near, friction, pair.tangential_ratio, rows)
        keep_drag(row, true.drag, plus(velocity, -up, n))
        row.normal = -up
    tangential_push(
        row,
        state.damped * DAMPED,
        restitution,
        friction,
        pair.tangential_ratio,
        state.overlap,
        state.largest,
        push,
        bead.mass,
        n,
        velocity,
        dt,
    )


@kernel
def history(pair: Bodies, units: Numbers, end: float, notes: Notes) -> History:
    """Contact at even times from touch to an end, on Hertz's scale, in the arrays of the notes."""
    samples = notes.at.shape[1]
    own = at_strength(pair.law, units.strength)
    for n in range(samples):
        notes.at[0, n] = end * n / (samples - 1)
    zener.follow_impact(AT_TIMES, own, units.inelasticity, units.yield_ratio, RTOL, notes, 0)
    for n in range(samples):
        notes.speed[0, n] = 1.0 - notes.speed[0, n]
    return History(notes.at[0], notes.force[0], notes.compression[0], notes.speed[0])


@kernel
def rubbed(pair: Bodies, impact: Impact, size: float, friction: float, samples: int, springs: int) -> float:
    """Change of the contact point's speed along the plate in an impact [m/s]."""
    speed = impact.speed
    if not (speed * friction > 0.0 and size > 0.0):
        return 0.0
    at, time, velocity = np.empty((1, samples)), np.empty((1, samples)), np.empty((1, samples))
    force, compression = np.empty((1, samples)), np.empty((1, samples))
    after, stretch = np.empty(1), np.empty((springs, 1))
    units, psi = numbers_of(pair, impact), min(size / friction / speed, FASTEST)
    end = solved(pair, units, TO_THE_END, RTOL).contact_time
    path = history(pair, units, end, Notes(at, time, velocity, force, compression))
    path.force[samples - 1] = 0.0
    after[0] = psi
    own = at_strength(pair.law, units.strength)
    slide(own, units.yield_ratio, pair.tangential_ratio, path, after, stretch)
    return float(friction * speed * (psi - after[0]))


@kernel
def collided(
    pair: Bodies, v: Point, omega: Point, n: Point, w: Point, radius: float, thickness: float, friction: float
) -> Collision:
    """Velocity and spin after an impact on a plate that moves with w."""
    came, nan = sliding(v, omega, unit(n), w, radius), math.nan
    if came.speed < V_MIN and fits(radius, thickness) and friction >= 0.0:
        return Collision(0, v, omega)
    impact = solid(came.speed, radius, thickness)
    hit = followed(pair, impact, TO_THE_END, RTOL)
    if not (hit.restitution >= 0.0 and came.size < math.inf and 0.0 <= friction < math.inf):
        return Collision(-1, (nan, nan, nan), (nan, nan, nan))
    changed = rubbed(pair, impact, came.size, friction, SAMPLES, SPRINGS)
    most = friction * POINT * (1.0 + hit.restitution) * came.speed
    changed = min(changed, most)
    after, spin = rebound_of(v, omega, unit(n), came, radius, hit.restitution, changed)
    return Collision(1, after, spin)
