"""Energies of a contact under velocity Verlet, and the forces that correct the scheme's errors.

Velocity Verlet applies forces at whole steps only, but a contact begins and ends inside a step. The
force begins as (t - t0)^1.5, and a sum over steps misses its integral by a zeta function of the
phase (Navot, J. Math. and Phys. 40, 1961, 271): the force of the first step is corrected by that.
In its last step, a contact gives the bead what it lacks of the energy that the losses have left.
The work is summed up exactly as Verlet's scheme does it, whatever other forces act, so that an
elastic bead keeps its energy to rounding.

Legend: x overlap, u speed towards the plate, m mass, r radius, s distance of the bead's centre from
the nearest point of the plate, h step, f force; 0 and 1 are the beginning and the end of a step.
u is that of the middle of the step, by the normal at its end.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel, tuple_of
from contactlaw.equation import force
from contactlaw.physical.vectors import dot
from contactlaw.stepping.edge import EdgeEcho, weighted
from contactlaw.stepping.spring import FEWEST_STEPS, Spring, State, advance, memory_of, returning

Point = tuple[float, float, float]

# zeta(-3/2, 1 + t) for t from 0 to 1, within 1e-6, highest power first: a least-squares fit
_ZETA = np.array([0.0013675, -0.0079223, 0.0284945, -0.1623330, -0.5477877, -0.3118187, -0.0254854])
# Largest correction of the rebound speed, times (steps per contact)^2.5: twice the scheme's error
# (`contactlaw.softsphere.time_step`). If more energy is missing, another bead struck this one, and
# its speed is not corrected. The correction is relative to the larger of the rebound and the
# approach speed, because a bead that rolls over a corner may leave slowly.
_LARGEST_CORRECTION = 1.8
# Largest relative correction of the speed of a bead that crossed kinks, times steps per contact. At
# the peak of Hertz's force the impulse of a step is 3.7/steps of the momentum of the approach.
_LARGEST_KINK_CORRECTION = 3.0
# Largest overlap after the first step of a contact over the path in that step; on an edge it may
# be a little above 1, because the normal turns.
_FIRST_OVERLAP = 1.01


@kernel
def step(
    law: Array, spring: Spring, state: State, x: float, u: float, h: float, before: float, near: EdgeEcho | None = None
) -> tuple[State, float]:
    """State at the end of a step, and a force to add to the state's in this step alone.

    Verlet's position differs from the sphere's by h^2 f/(12 m), see `contactlaw.softsphere`, and so
    does its speed. If the step changes, the sphere must not jump: the change of position goes into
    the plate's displacement, that of the speed into the force to add.
    """
    f0, u2 = state.force, state.plate_displacement
    shift = (h - before) * (h + before) / (12.0 * spring.mass) if f0 > 0.0 else 0.0
    last = tuple_of(State, state, plate_displacement=u2 - shift * f0)
    new = advance(law, spring, last, x, h, near)
    f1 = new.force
    if f1 > 0.0 and shift != 0.0:
        u2 = new.plate_displacement + shift * (f1 - f0)
        moved = tuple_of(State, new, plate_displacement=u2)
        return moved, spring.mass * shift * (f1 - f0) / (h * h)
    first = f1 > 0.0 and state.largest_compression == 0.0
    if first and x - u2 <= _FIRST_OVERLAP * u * h and force.is_hertz(force.at_strength(law, 0.0)):
        return new, _first_step_correction(spring, x - u2, u * h)
    return new, 0.0


@kernel
def _first_step_correction(spring: Spring, x: float, path: float) -> Any:
    """Correction of the force in the first step, because a contact begins inside that [N]."""
    t, zeta = x / path, 0.0
    for k in range(_ZETA.size):
        zeta = zeta * t + _ZETA[k]
    return -(t * math.sqrt(t) + zeta) * spring.stiffness * path * math.sqrt(path)


@kernel
def wave_energy(spring: Spring, last: State, state: State, h: float, near: EdgeEcho | None = None) -> Any:
    """Energy that the plate takes in a step, less what it gives back [J]."""
    mobility = state.mobility if state.stiffening > 0.0 else spring.mobility
    speed_0 = mobility * last.force - last.plate_displacement / spring.relaxation
    speed_1 = mobility * state.force - state.plate_displacement / spring.relaxation
    if near is not None and near.rate > 0.0:
        thin = returning(spring, mobility)
        speed_0 += thin * weighted(near, memory_of(last))
        speed_1 += thin * weighted(near, memory_of(state))
    return 0.5 * h * (last.force * speed_0 + state.force * speed_1)


@kernel
def work(mass: float, f0: Point, f1: Point, v: Point, power_0: float, power_1: float, h: float, before: float) -> Any:
    """Work of the forces at the two ends of a step on the bead, less that of the wall [J].

    The forces are vectors, because the normal turns while the nearest point is on an edge and jumps
    where the bead crosses to a facet that leans towards it.
    """
    # If the step changes, Verlet's f0 acts for half of the last step and half of the new one.
    uneven = (h - before) * (h + before) * dot(f0, f0) / (8.0 * mass)
    return 0.5 * h * (dot(f0, v) + dot(f1, v) - power_0 - power_1) - uneven


@kernel
def largest_correction(steps: float) -> float:
    """Largest correction of the rebound speed, over the larger of rebound and approach speed."""
    steps = max(steps, FEWEST_STEPS)
    return _LARGEST_CORRECTION / (steps * steps * math.sqrt(steps))


@kernel
def settling_force(missing: float, m: float, u: float, approach: float, h: float, most: float) -> float:
    """Force in the last step that gives a rebounding bead its missing energy [N].

    `most` is the largest change of the speed, over the larger of rebound and approach speed.
    """
    change = math.sqrt(max(u * u + 2.0 * missing / m, 0.0)) + u
    return m * change / h if u < 0.0 and abs(change) <= most * max(approach, -u) else 0.0


@kernel
def settling_share(missing: float, m: float, v: Point, power: float, h: float, steps: float) -> float:
    """Relative change of the velocity that gives a bead of an UNEVEN contact its missing energy.

    A force that jumps within a step errs by up to half of its impulse in that step, along the jump,
    and the bead may leave in another direction. So all components of the velocity are scaled.
    `power` is that of the other contacts, which still press the bead in this step [W].
    """
    twice = m * dot(v, v)
    one = 1.0 + 0.5 * power * h / twice
    square = one * one + 2.0 * missing / twice
    if not (one > 0.0 and square > 0.0):
        return 0.0
    share = math.sqrt(square) - one
    return share if abs(share) <= _LARGEST_KINK_CORRECTION / max(steps, FEWEST_STEPS) else 0.0


@kernel
def free_speed(speed: float, x: float, r: float, x0: float, x1: float, u: float, h: float) -> float:
    """Speed along the normal at overlap 0, in free flight, of a bead with this speed at overlap x.

    Around an edge or a corner the normal turns during the contact. Approach and rebound are compared
    at the same distance from the edge, so that an elastic bead has a COR of 1. The tangential speed
    follows from the overlaps x0 and x1 at the ends of a step.
    """
    s, path = 1.0 - x / r, 2.0 * r - x0 - x1 + u * h
    tangential_square = max((x1 - x0 - u * h) * path, 0.0) / (h * h)
    return math.sqrt(speed * speed + tangential_square * (1.0 - s * s))
