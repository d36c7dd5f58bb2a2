"""The energy ledger of a contact under velocity Verlet, and what makes it what the law says.

Velocity Verlet pushes a bead at whole steps only, but a contact begins and ends inside a step. The
force sets in as (t - t0)^1.5, and a sum over steps misses the integral of that by a zeta function
of the phase (Navot, J. Math. and Phys. 40, 1961, 271): the force of the first step is corrected by
it. Where the contact ends, the bead is given what its energy then lacks of what law and wave have
left it. The work is summed up just as Verlet's scheme does it, whatever other forces act, so that
an elastic bead keeps its energy to rounding.

Legend: x overlap, u speed towards the plate, m mass, r radius, s distance of the bead's centre from
the nearest point of the plate, h step, f force; 0 and 1 are the beginning and the end of a step.
u is that of the middle of the step, by the normal at its end.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.stepping.spring import FEWEST_STEPS, Spring, State, advance

Array = NDArray[np.float64]
Point = tuple[float, float, float]

# zeta(-3/2, 1 + t) for t from 0 to 1, within 1e-6: a least-squares fit
_ZETA = (-0.0254854, -0.3118187, -0.5477877, -0.1623330, 0.0284945, -0.0079223, 0.0013675)
# Largest change of the speed with which a bead leaves, over that speed or the one of its approach,
# times (steps per contact)^2.5: twice what the scheme errs without it
# (`contactlaw.softsphere.time_step`). If more energy is missing than that, another bead struck this
# one in between: it is left as it is. One that rolls over a corner may leave slowly after a hard
# approach.
_MOST = 1.8
# Largest relative change of the speed of a bead that went across kinks, times steps per contact: at
# the force's peak the push of a step is 2.9/steps of the momentum that an elastic bead comes with.
_KINKS = 3.0
# Overlap at the end of the step of first touch over the path in a step; an edge is round.
_ONE = 1.01


@kernel
def step(
    law: Array, spring: Spring, state: State, x: float, u: float, h: float, before: float
) -> tuple[State, float]:
    """State at the end of a step, and a force to add to the state's there and then only.

    Verlet's position differs from the sphere's by h^2 f/(12 m), see `contactlaw.softsphere`, and so
    does its speed. Where the step was another one before, the sphere must not jump: the change of
    position goes into the plate's displacement, that of the speed into the force to add.
    """
    f0, u2 = state.force, state.plate_displacement
    shift = (h - before) * (h + before) / (12.0 * spring.mass) if f0 > 0.0 else 0.0
    last = State(
        u2 - shift * f0, state.largest_compression, f0, state.mobility, state.stiffening
    )  # fmt: skip
    new = advance(law, spring, last, x, h)
    f1 = new.force
    if f1 > 0.0 and shift != 0.0:
        u2 = new.plate_displacement + shift * (f1 - f0)
        new = State(u2, new.largest_compression, f1, new.mobility, new.stiffening)
        return new, spring.mass * shift * (f1 - f0) / (h * h)
    if f1 > 0.0 and state.largest_compression == 0.0 and x <= _ONE * u * h and force.is_hertz(law):
        return new, _before_the_first(spring, x, u * h)
    return new, 0.0


@kernel
def _before_the_first(spring: Spring, x: float, way: float) -> Any:
    """Force that the sum over the steps of a contact lacks where it begins."""
    t, zeta = x / way, 0.0
    for coefficient in _ZETA[::-1]:
        zeta = zeta * t + coefficient
    return -(t * math.sqrt(t) + zeta) * spring.stiffness * way * math.sqrt(way)


@kernel
def wave_energy(spring: Spring, last: State, state: State, h: float) -> Any:
    """Energy that the plate takes in a step [J]."""
    mobility = state.mobility if state.stiffening > 0.0 else spring.mobility
    speed_0 = mobility * last.force - last.plate_displacement / spring.relaxation
    speed_1 = mobility * state.force - state.plate_displacement / spring.relaxation
    return 0.5 * h * (last.force * speed_0 + state.force * speed_1)


@kernel
def dot(a: Point, b: Point) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def work(
    mass: float, f0: Point, f1: Point, v: Point, power_0: float, power_1: float, h: float,
    before: float,
) -> Any:  # fmt: skip
    """Work of the forces on the bead in a step, less the wall's; half of that of either end [J].

    They are vectors, for the normal turns where the nearest point is on an edge, and jumps where
    the bead goes on from a facet to one that leans towards it.
    """
    # where the step changes, Verlet's force acts for half of either
    uneven = (h - before) * (h + before) * dot(f0, f0) / (8.0 * mass)
    return 0.5 * h * (dot(f0, v) + dot(f1, v) - power_0 - power_1) - uneven


@kernel
def settle(missing: float, m: float, u: float, approach: float, h: float, steps: float) -> float:
    """Force to add in the last step, for a bead that leaves with so much energy too little [N]."""
    square = u * u + 2.0 * missing / m
    if not (u < 0.0 and square > 0.0):
        return 0.0
    change, steps = math.sqrt(square) + u, max(steps, FEWEST_STEPS)
    if not abs(change) <= max(-u, approach) * _MOST / (steps * steps * math.sqrt(steps)):
        return 0.0
    return m * change / h


@kernel
def scaled(missing: float, m: float, v: Point, power: float, h: float, steps: float) -> float:
    """Share of its velocity to add to a bead whose contact went across kinks, or had company.

    A force that jumps within a step errs by up to half of its push of a step, in the direction of
    the jump: which may be that along which the bead does not leave. So all of the velocity changes.
    `power` is that of the contacts which still press: they, too, push the bead in this step.
    """
    twice = m * dot(v, v)
    one = 1.0 + 0.5 * power * h / twice
    square = one * one + 2.0 * missing / twice
    if not (one > 0.0 and square > 0.0):
        return 0.0
    share = math.sqrt(square) - one
    return share if abs(share) <= _KINKS / max(steps, FEWEST_STEPS) else 0.0


@kernel
def turning(r: float, x0: float, x1: float, u: float, h: float) -> float:
    """Square of the speed around an edge or a corner [m^2/s^2]."""
    way = 2.0 * r - x0 - x1 + u * h
    return max((x1 - x0 - u * h) * way, 0.0) / (h * h)


@kernel
def free_speed(u: float, turning: float, r: float, x: float) -> float:
    """Take a normal speed u at overlap x to overlap 0, along a free flight.

    Around an edge the normal turns during the contact. With speeds at one distance from the edge
    the energies of an impact add up, and an elastic bead has a COR of 1.
    """
    s = 1.0 - x / r
    return math.sqrt(u * u + turning * (1.0 - s * s))
