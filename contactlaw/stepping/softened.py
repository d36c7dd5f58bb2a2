"""Softened contacts: springs of a lower modulus, with which a bead leaves as from the true impact.

A modulus that is s times lower makes a contact s^0.4 times longer, and so allows as much longer
time steps. The spring knows no speed: it loads as K x^1.5 with K lower by s, and unloads as

    F = Fm ((x - dr)/(dm - dr))^1.5,    dr = (1 - e^2) dm,

so that of the work that was put into it the share e^2 comes back, whatever the masses and speeds. e
is the COR of the true impact, which `contactlaw.stepping.bounce` carries out at the first touch.
There is no plate in this motion: what the waves take is in e. In the last step the bead is given
exactly the energy that is left (`contactlaw.stepping.energy.settling_force`).

A bead that comes down again before it has left its dent loads along the last unloading curve, and
has the COR of its new speed. On this curve the contact is damped, because the bead would otherwise
bounce in the dent for ever.

The tangential force of an impact is the normal force times a constant, the ratio of the impulses of
the true impact. A contact that lasts, or that several forces share, has a tangential spring with
Coulomb's limit.

Legend: K stiffness, x overlap, dm the largest one, dr the residual one, Fm force at dm, u speed
towards the wall, h time step, m mass.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from contactlaw._errors import ArgumentError
from contactlaw._jit import kernel
from contactlaw.equation.tangential import POINT
from contactlaw.physical.arguments import number
from contactlaw.physical.vectors import dot, norm, plus, put, scaled, vector
from contactlaw.stepping.energy import settling_force
from contactlaw.walls.facet import Point

# Least share of the work that the spring gives back: a steeper unloading curve would need shorter
# steps. Any excess energy is removed in the last step.
_LEAST_SHARE = 0.02
DEEPEST_OVERLAP = 0.02  # [radius] of softened contacts; ten times that of steel at 1 m/s
# Largest change of the speed in the last step, over the larger of approach and rebound speed. A
# spring that gives back at least 2 % of its work lets no bead leave at less than 0.14 of its speed.
MOST_SETTLED = 0.2
_DAMPING = 0.5  # ratio of damping in a dent
_MOST_DAMPING = 0.5  # [m/h] beyond which it would make a step unstable
FASTER = 1.25  # [speed at which the COR was asked for] from which a struck bead asks again
# A contact that has just begun is BOUNCING: its tangential force is that of the true impact. Once
# the bead touches something else, is struck or stays, it is HELD by a tangential spring. If it has
# come down again in its dent, it is DAMPED as well, and its last step settles no energy.
BOUNCING, HELD, DAMPED = 0.0, 1.0, 2.0


def check_softening(softening: Any, parcel: Any) -> None:
    """Refuse numbers that are not finite, or below 1."""
    for name, value in (("softening", softening), ("parcel", parcel)):
        if not 1.0 <= number(name, value) < math.inf:
            raise ArgumentError(name, value, "must be finite and at least 1, which is a true contact or bead")


# What a softened contact keeps of the true impact, in columns of its own.
SOFTENED = (
    "restitution",
    "asked_speed",  # at which the true impact was carried out [m/s]; 0: not yet
    "true_time",  # its contact time [s]
    "true_force",  # its peak force [N]
    "plastic_share",  # of the energy that is lost
    "wave_share",  # of the energy that is lost
    "true_flags",
    "stored",  # work put into the spring up to dm [J]
    "lasting",  # BOUNCING, HELD or DAMPED
)


class Push(NamedTuple):
    """Normal force of a softened contact."""

    force: float  # [N]
    largest: float  # dm [m]
    damped: bool


@kernel
def must_ask(begins: bool, deepens: bool, u: float, asked_speed: float) -> bool:
    """Whether the true impact is to be carried out: at first touch, and anew if another bead struck this one.

    `deepens` says that the overlap is larger than ever in this contact, at the speed u.
    """
    return begins or (deepens and u > FASTER * asked_speed)


@kernel
def stored_work(
    stiffness: float, largest: float, undisturbed: bool, left: float, mass: float, u: float, force: float, h: float
) -> float:
    """Work that has been put into a spring up to its largest overlap [J].

    An undisturbed bead puts in what it still has, and `left`, the energy it has lost up to here.
    With velocity Verlet, u^2 becomes the product of the speeds half a step before and after.
    """
    if undisturbed:
        return left + 0.5 * mass * u * (u - h * force / mass)
    return 0.4 * stiffness * largest * largest * math.sqrt(largest)


@kernel
def residual(largest: float, restitution: float) -> float:
    """Overlap at which an unloading contact ends [m]."""
    return largest * (1.0 - max(restitution * restitution, _LEAST_SHARE))


@kernel
def push(stiffness: float, mass: float, largest: float, restitution: float, x: float, u: float, h: float) -> Push:
    """Force of the spring at an overlap."""
    if x >= largest:
        return Push(stiffness * math.sqrt(x) * x, x, False)
    left = residual(largest, restitution)
    if not x > left:
        return Push(0.0, largest, False)
    share = (x - left) / (largest - left)
    force = stiffness * largest * math.sqrt(largest) * share * math.sqrt(share)
    if not u > 0.0:
        return Push(force, largest, False)
    slope = 1.5 * force / (x - left)
    damping = min(2.0 * _DAMPING * math.sqrt(mass * slope), _MOST_DAMPING * mass / h)
    return Push(force + damping * u, largest, True)


class SoftState(NamedTuple):
    """A softened contact between two steps, all zero where the bodies are apart."""

    force: Any  # [N]
    kick: Any  # force to add in this step alone, which settles the energy of an impact [N]
    largest: Any  # dm [m]
    overlap: Any  # x [m]; below 0 a gap
    work: Any  # of the force on the bead in this contact [J]
    stored: Any  # work put into the spring up to dm [J]
    lost: Any  # part of it that earlier impacts in the same dent have lost [J]
    damped: Any  # 1.0 once the bead has come down again in its dent


@kernel(cache=True)
def advance_softened(
    stiffness: float, mass: float, restitution: float, state: SoftState, overlap: float, step: float
) -> SoftState:
    """State at the end of a step [s], from the overlap [m] at its end and the COR of the impact.

    The force to apply is the sum of the state's `force` and `kick`. `stiffness` is K of the
    softened contact [N/m^1.5], `mass` that of the bead [kg]. A gap is an overlap below 0. Until the
    bead comes back, the COR does not matter, so it may follow from the speed of the second step.
    """
    path = overlap - state.overlap
    u = path / step
    now = push(stiffness, mass, state.largest, restitution, overlap, u, step)
    work, lost, damped = state.work, state.lost, state.damped
    if now.force > 0.0 and state.force == 0.0:  # a new impact, perhaps in the dent of another
        work, lost, damped = 0.0, (1.0 - restitution * restitution) * state.stored, 0.0
    damped = 1.0 if now.damped else damped
    if state.largest > 0.0 or state.overlap < 0.0:
        work -= 0.5 * (state.force + now.force) * path
    if state.work == 0.0:  # the gap before the first step was unknown: its path follows from the second's
        work -= 0.5 * state.force * (path + step * step * state.force / mass)
    stored, kick = state.stored, 0.0
    if now.largest > state.largest:
        stored = stored_work(stiffness, now.largest, damped == 0.0, lost - work, mass, u, now.force, step)
    if now.force == 0.0 and state.force > 0.0 and damped == 0.0:
        missing = lost - (1.0 - restitution * restitution) * stored - work
        approach = math.sqrt(2.0 * max(stored - lost, 0.0) / mass)
        kick = settling_force(missing, mass, u, approach, step, MOST_SETTLED)
    if not overlap > 0.0:
        return SoftState(0.0, kick, 0.0, overlap, 0.0, 0.0, 0.0, 0.0)
    return SoftState(now.force, kick, now.largest, overlap, work, stored, lost, damped)


@kernel
def keep_drag(row: Any, drag: Point, slip: Point) -> None:
    """Keep the direction of sliding, and the tangential impulse of the true impact over the normal one.

    That is against the sliding, but for a rigid body, which may turn.
    """
    row.width, size = norm(drag), norm(slip)
    for i in range(3):
        row.along[i] = slip[i] / size if size > 0.0 else 0.0
        row.stretch[3 + i] = -drag[i] / row.width if row.width > 0.0 else 0.0


@kernel
def tangential_push(
    row: Any,
    lasting: float,
    restitution: float,
    friction: float,
    kappa: float,
    x: float,
    largest: float,
    f: float,
    mass: float,
    n: Point,
    slip: Point,
    h: float,
) -> Point:
    """Tangential force on a bead [N], from its normal force f in this step.

    A step h of 0 gives the last step's force again. ``row.width`` is the ratio of both forces in an
    impact. ``row.stretch`` has the force of the spring of a contact that lasts, and the direction
    against the tangential force of an impact.
    """
    if h == 0.0:
        return vector(row.force)
    if lasting == BOUNCING:
        against = row.stretch[3], row.stretch[4], row.stretch[5]
        force = scaled(-f * row.width, plus(against, -dot(against, n), n))
        put(row.stretch, force)
        put(row.force, force)
        return force
    slip = plus(slip, -dot(slip, n), n)
    left = residual(largest, restitution) if x < largest else 0.0
    k = kappa * 1.5 * f / (x - left) if f > 0.0 and x > left else 0.0
    # A spring that softens keeps its stretch and so gives up a part of its force.
    share = min(k / row.stiffness, 1.0) if row.stiffness > 0.0 else 1.0
    row.stiffness = k
    stretched = scaled(share, vector(row.stretch))
    stretched = plus(plus(stretched, -dot(stretched, n), n), -k * h, slip)
    damping = 0.0
    if lasting == DAMPED:
        damping = min(2.0 * _DAMPING * math.sqrt(mass / POINT * k), _MOST_DAMPING * mass / POINT / h)
    force = plus(stretched, -damping, slip)
    size, most = norm(force), friction * max(f, 0.0)  # the last step may pull
    if size > most:
        force = stretched = scaled(most / size, force)
    put(row.stretch, stretched)
    put(row.force, force)
    return force
