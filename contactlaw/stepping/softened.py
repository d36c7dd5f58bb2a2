"""Softened contacts: springs of a lower modulus, with which a bead leaves as from the true impact.

A modulus that is s times lower makes a contact s^0.4 times longer, and so allows as much longer
time steps. The spring knows no speed: it loads as K x^1.5 with K lower by s, and unloads as

    F = Fm ((x - dr)/(dm - dr))^1.5,    dr = (1 - e^2) dm,

so that of the work that was put into it the share e^2 comes back, whatever the masses and speeds. e
is the COR of the true impact, which `contactlaw.stepping.bounce` carries out at the first touch.
There is no plate in this motion: what the waves take is in e. In the last step the bead is given
exactly the energy that is left (`contactlaw.stepping.energy`).

A bead that touches again before it has left its dent loads along the last unloading curve, and asks
for the COR of the speed that it has now. On this curve a contact is damped, because it would
otherwise tremble for ever.

The tangential force of an impact is the normal force times a constant, the ratio of the impulses of
the true impact. A contact that lasts, or that several forces share, has a tangential spring with
Coulomb's limit.

Legend: K stiffness, x overlap, dm the largest one, dr the residual one, Fm force at dm, u speed
towards the wall, h time step, m mass.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from contactlaw._jit import kernel
from contactlaw.equation.tangential import POINT
from contactlaw.stepping.energy import dot
from contactlaw.stepping.spring import State
from contactlaw.walls.facet import Point

# Least share of the work that the spring gives back: unloading curves that are steeper would need
# shorter steps. What it gives back too much is taken in the last step.
_LEAST_SHARE = 0.02
_DAMPING = 0.5  # ratio of damping in a dent
_MOST_DAMPING = 0.5  # [m/h] beyond which it would make a step unstable
FASTER = 1.25  # [speed at which the COR was asked for] from which a struck bead asks again
# A contact is a FREE impact; or friction is HELD by a spring in it; or it is DAMPED, too, since the
# bead has come down again in its dent, and takes no energy from the last step.
FREE, HELD, DAMPED = 0.0, 1.0, 2.0


class Softened(NamedTuple):
    """What a softened contact keeps of the true impact; in the fields of `State` for the plate."""

    restitution: float
    speed: float  # at which the COR was asked for [m/s]; 0: not yet
    contact_time: float  # [s]
    peak_force: float  # [N]
    plastic_share: float  # of the energy that is lost
    wave_share: float  # of the energy that is lost
    flags: float
    stored: float  # work put into the spring up to dm [J]
    lasting: float  # FREE, HELD or DAMPED


class Push(NamedTuple):
    """Normal force of a softened contact."""

    force: float  # [N]
    largest: float  # dm [m]
    stiffness: float  # dF/dx [N/m]
    damped: bool


@kernel
def softened_of(state: State) -> Softened:
    """Read what the contact keeps."""
    return Softened(
        state.mobility, state.stiffening, state.strength, state.x1, state.y1, state.x2, state.y2, state.x3, state.y3
    )


@kernel
def keep(row: Any, soft: Softened) -> None:
    """Write what the contact keeps into its row."""
    row.mobility, row.stiffening, row.strength = soft.restitution, soft.speed, soft.contact_time
    row.x1, row.y1, row.x2, row.y2 = soft.peak_force, soft.plastic_share, soft.wave_share, soft.flags
    row.x3, row.y3 = soft.stored, soft.lasting


@kernel
def residual(largest: float, restitution: float) -> float:
    """Overlap at which an unloading contact ends [m]."""
    return largest * (1.0 - max(restitution * restitution, _LEAST_SHARE))


@kernel
def push(stiffness: float, mass: float, largest: float, restitution: float, x: float, u: float, h: float) -> Push:
    """Force of the spring at an overlap."""
    if x >= largest:
        root = stiffness * math.sqrt(x)
        return Push(root * x, x, 1.5 * root, False)
    left = residual(largest, restitution)
    if not x > left:
        return Push(0.0, largest, 0.0, False)
    share = (x - left) / (largest - left)
    force = stiffness * largest * math.sqrt(largest) * share * math.sqrt(share)
    slope = 1.5 * force / (x - left)
    if not u > 0.0:
        return Push(force, largest, slope, False)
    damping = min(2.0 * _DAMPING * math.sqrt(mass * slope), _MOST_DAMPING * mass / h)
    return Push(force + damping * u, largest, slope, True)


@kernel
def tangential_push(
    row: Any,
    soft: Softened,
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

    A step h of 0 gives the last step's force again. ``row.along`` is the ratio of both in an
    impact, a vector; ``row.stretch`` is the force of the spring of a contact that lasts.
    """
    if h == 0.0:
        return row.force[0], row.force[1], row.force[2]
    ax, ay, az = row.along[0], row.along[1], row.along[2]
    if soft.lasting == FREE:
        up = dot((ax, ay, az), n)
        force = f * (ax - up * n[0]), f * (ay - up * n[1]), f * (az - up * n[2])
        row.stretch[0], row.stretch[1], row.stretch[2] = force
        row.force[0], row.force[1], row.force[2] = force
        return force
    left = residual(largest, soft.restitution) if x < largest else 0.0
    k = kappa * 1.5 * f / (x - left) if f > 0.0 and x > left else 0.0
    # A spring that softens keeps its stretch and so gives up a part of its force.
    share = min(k / row.stiffness, 1.0) if row.stiffness > 0.0 else 1.0
    row.stiffness = k
    ax, ay, az = share * row.stretch[0], share * row.stretch[1], share * row.stretch[2]
    up, path = dot((ax, ay, az), n), k * h
    ax, ay, az = (ax - up * n[0] - path * slip[0], ay - up * n[1] - path * slip[1], az - up * n[2] - path * slip[2])
    damping = min(2.0 * _DAMPING * math.sqrt(mass / POINT * k), _MOST_DAMPING * mass / POINT / h)
    force = ax - damping * slip[0], ay - damping * slip[1], az - damping * slip[2]
    size, most = math.sqrt(dot(force, force)), friction * f
    if size > most:
        less = most / size
        force = force[0] * less, force[1] * less, force[2] * less
        ax, ay, az = force
    row.stretch[0], row.stretch[1], row.stretch[2] = ax, ay, az
    row.force[0], row.force[1], row.force[2] = force
    return force
