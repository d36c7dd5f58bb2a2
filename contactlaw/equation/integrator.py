"""Integration along one contact: a step, and landing on what ends a stretch of the way.

A sphere that has flattened far on a plate that gives way easily need not come back. Where the force
falls more slowly than the compression that is left, with an exponent below 2, the contact becomes
ever stiffer beside the plate, what is left goes into the plate, and the sphere never leaves. Once
all that is left could throw it off with no more than `SPENT` of the speed that it came with, the
sphere is turned back, the plate held, and it is. A restitution below that is rounded up to it.
To know what is left, steps err less the less it is. Where the steps would be too many, a series
takes their place (`contactlaw.equation.creep`).

Legend, as in `contactlaw.equation.motion`: d compression, dm the largest, q root compression,
u speed, t time, s the variable of integration, y yield compression.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation import force, legs, losses, motion, plate
from contactlaw.equation.creep import creep, left
from contactlaw.equation.force import Curve
from contactlaw.equation.legs import CUBIC, PIECES, POWER, Leg
from contactlaw.equation.motion import Contact, State

Array = NDArray[np.float64]

MAX_STEPS = 200_000
_LANDED = (
    1e-9  # an event is met to this; compression and time are stationary there, so err by its square
)
SPENT = 1e-9  # restitution that is not told from less
LATE = 1e-2  # restitution out of reach, at which, and at each of its powers, steps get finer
# events: end of loading; a root compression is reached; a time is; the energy left is spent
NONE, TURN, LEVEL, TIME, _OVER = range(5)


class Scale(NamedTuple):
    """Size of q, u and t in one impact, against which errors and events are measured."""

    q: float
    u: float
    t: float
    per_q: float  # 1/(q tolerance)
    per_u: float  # 1/(u tolerance)
    over: float  # square of the speed that may be left to leave with: below, event _OVER


@kernel
def _gap(event: int, leg: Leg, state: State, level: float, until: float, scale: Scale) -> float:
    """How far an event is off, in units of its scale; its sign changes there."""
    if event == TURN:
        return state.dq / scale.u
    if event == _OVER:
        return 1.0 - left(leg, state) / scale.over
    return (level - state.q) / scale.q if event == LEVEL else (until - state.t) / scale.t


@kernel
def _guess(event: int, state: State, trial: State, h: float, level: float, until: float) -> float:
    """Step to an event between two points, by the cubic through q or t and its rate at both."""
    value, rise, rate, last = state.q, trial.q - state.q, state.dq, trial.dq
    if event == TIME:  # dt/ds = 2 q
        value, rise, rate, last = state.t, trial.t - state.t, 2.0 * state.q, 2.0 * trial.q
        level = until
    c1, c2 = h * rate, 3.0 * rise - h * (2.0 * rate + last)
    c3 = h * (rate + last) - 2.0 * rise
    if event == TURN:  # root of c1 + 2 c2 x + 3 c3 x^2, without cancellation
        return h * c1 / (math.sqrt(max(0.0, c2 * c2 - 3.0 * c1 * c3)) - c2)
    secant = x = (level - value) / rise
    for _ in range(3):
        x -= (((c3 * x + c2) * x + c1) * x - (level - value)) / ((3 * c3 * x + 2 * c2) * x + c1)
    return h * (x if 0.0 < x < 1.0 else secant)  # next to a turn it may leave the step


@kernel(inline=True)
def _step(
    contact: Contact, leg: Leg, kind: int, state: State, h: float, scale: Scale
) -> tuple[State, float]:
    """One step of the 5(4) pair of Dormand & Prince, J. Comput. Appl. Math. 6 (1980) 19.

    Its last rates are the first ones of the next step. The error is in units of the tolerance.
    """
    q, u = state.q, state.u
    a1, b1, f1 = state.dq, state.du, state.f
    q2, u2 = q + h * (1 / 5 * a1), u + h * (1 / 5 * b1)
    a2, b2, _ = motion.rates(contact, leg, kind, q2, u2)
    q3 = q + h * (3 / 40 * a1 + 9 / 40 * a2)
    u3 = u + h * (3 / 40 * b1 + 9 / 40 * b2)
    a3, b3, f3 = motion.rates(contact, leg, kind, q3, u3)
    q4 = q + h * (44 / 45 * a1 - 56 / 15 * a2 + 32 / 9 * a3)
    u4 = u + h * (44 / 45 * b1 - 56 / 15 * b2 + 32 / 9 * b3)
    a4, b4, f4 = motion.rates(contact, leg, kind, q4, u4)
    q5 = q + h * (19372 / 6561 * a1 - 25360 / 2187 * a2 + 64448 / 6561 * a3 - 212 / 729 * a4)
    u5 = u + h * (19372 / 6561 * b1 - 25360 / 2187 * b2 + 64448 / 6561 * b3 - 212 / 729 * b4)
    a5, b5, f5 = motion.rates(contact, leg, kind, q5, u5)
    q6 = q + h * (
        9017 / 3168 * a1 - 355 / 33 * a2 + 46732 / 5247 * a3 + 49 / 176 * a4 - 5103 / 18656 * a5
    )
    u6 = u + h * (
        9017 / 3168 * b1 - 355 / 33 * b2 + 46732 / 5247 * b3 + 49 / 176 * b4 - 5103 / 18656 * b5
    )
    a6, b6, f6 = motion.rates(contact, leg, kind, q6, u6)
    w1, w3, w4, w5, w6 = (
        h * 35 / 384,
        h * 500 / 1113,
        h * 125 / 192,
        h * -2187 / 6784,
        h * 11 / 84,
    )
    q7 = q + (w1 * a1 + w3 * a3 + w4 * a4 + w5 * a5 + w6 * a6)
    u7 = u + (w1 * b1 + w3 * b3 + w4 * b4 + w5 * b5 + w6 * b6)
    a7, b7, f7 = motion.rates(contact, leg, kind, q7, u7)
    t = state.t + 2.0 * (w1 * q + w3 * q3 + w4 * q4 + w5 * q5 + w6 * q6)
    work = losses.gathered(
        state.work,
        w1, losses.power(q, f1), w3, losses.power(q3, f3), w4, losses.power(q4, f4),
        w5, losses.power(q5, f5), w6, losses.power(q6, f6),
    )  # fmt: skip
    error_q = (
        71 / 57600 * a1 - 71 / 16695 * a3 + 71 / 1920 * a4 - 17253 / 339200 * a5 + 22 / 525 * a6
    ) - 1 / 40 * a7
    error_u = (
        71 / 57600 * b1 - 71 / 16695 * b3 + 71 / 1920 * b4 - 17253 / 339200 * b5 + 22 / 525 * b6
    ) - 1 / 40 * b7
    error = h * max(abs(error_q) * scale.per_q, abs(error_u) * scale.per_u)
    return State(q7, u7, t, work, a7, b7, f7), error


@kernel(inline=True)
def _follow(
    contact: Contact, leg: Leg, kind: int, state: State, h: float, scale: Scale, level: float,
    until: float,
) -> tuple[State, int, float, int]:  # fmt: skip
    """See `follow`; the compiler makes a loop of its own of each kind of leg.

    A choice within the step would cost half as much again as the step does.
    """
    loading = legs.is_loading(leg)
    event, following = NONE, h
    a = b = gap_a = gap_b = 0.0  # steps on either side of the event, and how far off they end
    for steps in range(1, MAX_STEPS):
        trial, error = _step(contact, leg, kind, state, h, scale)
        if event == NONE:
            if error > 1.0:
                h *= max(0.2, 0.9 / math.sqrt(math.sqrt(error)))  # a power is slower than a step
                continue
            if loading and trial.dq < 0.0:
                event = TURN
            elif (trial.q > level) if loading else (trial.q < level):
                event = LEVEL
            elif trial.t > until:
                event = TIME
            elif (
                legs.unloads(leg)
                and plate.moves(contact.plate)
                and trial.u * trial.u < scale.over
                and left(leg, trial) < scale.over
            ):
                event = _OVER
            else:
                state = trial
                h *= min(5.0, 0.9 / math.sqrt(math.sqrt(max(error, 1e-30))))
                continue
            following = h
        else:
            gap = _gap(event, leg, trial, level, until, scale)
            if abs(gap) > _LANDED:
                if gap * gap_b < 0.0:
                    a, gap_a = b, gap_b
                else:
                    gap_a *= 0.5
                b, gap_b = h, gap
                h = b - gap_b * (b - a) / (gap_b - gap_a)
                continue
            if event == TURN and trial.q > level:
                event = LEVEL  # the step went over the kink before it turned: land there instead
            elif event != TIME and trial.t > until:
                event = TIME
            else:
                return trial, event, following, steps
        a, gap_a = 0.0, _gap(event, leg, state, level, until, scale)
        b, gap_b = h, _gap(event, leg, trial, level, until, scale)
        if event == _OVER:
            h *= gap_a / (gap_a - gap_b)
        else:
            h = _guess(event, state, trial, h, level, until)
    return state, event, h, MAX_STEPS


@kernel
def _finer(scale: Scale, spent: float) -> Scale:
    """Scale for what is left once that is below the event's: its steps err as much less."""
    over = max(LATE * LATE * scale.over, spent)
    return Scale(scale.q, scale.u, scale.t, scale.per_q / LATE, scale.per_u / LATE, over)


@kernel
def follow(
    contact: Contact, leg: Leg, state: State, h: float, scale: Scale, level: float, until: float
) -> tuple[State, int, float, int]:
    """Integrate a leg to a level, or loading to its end, or to the time `until` if that is before.

    Returns the point reached, the event, a step to go on with and the number of steps. An event is
    met by shortening the step that passes it: regula falsi with Illinois' weights.
    """
    spent = (SPENT * scale.u) ** 2
    steps = 0
    while True:
        if legs.unloads(leg):
            if plate.moves(contact.plate):
                state = creep(contact, leg, state, level, until, spent)
            over = (1.0 - 1e-6) * left(leg, state)  # an event is met to 1e-9
            while over < scale.over and scale.over > spent:
                scale = _finer(scale, spent)
            if over < spent:
                contact = Contact(contact.law, plate.HELD)
                state = motion.start(contact, leg, state.q, -abs(state.u), state.t, state.work)
        if leg.kind == CUBIC:
            state, event, h, more = _follow(contact, leg, CUBIC, state, h, scale, level, until)
        elif leg.kind == POWER:
            state, event, h, more = _follow(contact, leg, POWER, state, h, scale, level, until)
        else:
            state, event, h, more = _follow(contact, leg, PIECES, state, h, scale, level, until)
        steps += more
        if event != _OVER or more == MAX_STEPS:
            return state, event, h, steps


@kernel
def _onto(contact: Contact, leg: Leg, residual: float, state: State) -> State:
    """Express a state in the root compression of a leg; that of its own had this residual."""
    q = state.q
    if leg.residual != residual:
        q = math.sqrt(max(q * q + (residual - leg.residual), 0.0))
    return motion.start(contact, leg, q, state.u, state.t, state.work)


@kernel
def after(
    contact: Contact, curve: Curve, leg: Leg, event: int, state: State
) -> tuple[Curve, Leg, State]:
    """Leg, and state on it, that follow on one that has ended: by its level, or where it turned."""
    residual = leg.residual
    if legs.is_loading(leg) and (event == TURN or state.dq <= 0.0):
        dm = state.q * state.q
        curve = force.unloading(contact.law, dm)
        leg = legs.first_down(contact.law, curve, dm)
    else:
        leg = legs.following(contact.law, curve, leg)
    return curve, leg, _onto(contact, leg, residual, state)


@kernel
def scale_of(y: float, rtol: float) -> tuple[Scale, float]:
    """Scales of an impact in the law's units, and a first step that the error control accepts."""
    y4 = math.sqrt(math.sqrt(y))
    q, u = 1.0 / (y4 * y4), 1.0 / (y * y4)
    scale = Scale(q, u, y4, 1.0 / (q * rtol), 1.0 / (u * rtol), (LATE * u) ** 2)
    return scale, 0.7 * rtol**0.2 * y4**3
