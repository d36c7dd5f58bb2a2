"""Integration along one contact: steps, and landing on the event that ends a leg.

A sphere that has flattened far on a compliant plate need not rebound. Where the force falls more
slowly than the elastic compression that is left, with an exponent below 2, the contact becomes ever
stiffer beside the plate: the energy that is left goes into the plate, and the sphere stays. As that
energy falls to what throws the sphere off with `LEAST_RESTITUTION` of its impact speed, the plate is
held, see `contactlaw.equation.motion`, and the sphere leaves with such a speed. The less energy is
left, the finer are the steps, so that they resolve it.

Legend, as in `contactlaw.equation.motion`: d compression, dm the largest, q root compression,
u speed, t time, s the variable of integration, y yield compression.
"""

import math
from typing import NamedTuple

from contactlaw._jit import kernel
from contactlaw.equation import legs, motion
from contactlaw.equation.legs import CUBIC, PIECES, POWER, Leg
from contactlaw.equation.motion import ScaledContact, ScaledState
from contactlaw.equation.notes import coefficients, share_at

MAX_STEPS = 200_000
# Events are met to this share of their scale. The compression at the end of loading and the time at
# separation are stationary, so they err only by its square.
_LANDED = 1e-9
# Size of the smallest restitution; tables err by ten times as much.
LEAST_RESTITUTION = 1e-7
# Steps get finer in proportion to the largest restitution that is still possible, from this one on.
_FINER_FROM = 1e-2
NONE, TURN, LEVEL = range(3)  # no event; end of loading; the level at which a leg ends is reached


class Scale(NamedTuple):
    """Size of q, u and t in one impact, against which errors and events are measured."""

    q: float
    u: float
    t: float
    per_q: float  # 1/(q tolerance)
    per_u: float  # 1/(u tolerance)


@kernel
def _gap(event: int, state: ScaledState, level: float, scale: Scale) -> float:
    """Distance to an event in units of its scale; its sign changes at the event."""
    return state.dq / scale.u if event == TURN else (level - state.q) / scale.q


@kernel
def _guess(event: int, state: ScaledState, trial: ScaledState, h: float, level: float) -> float:
    """Step to an event between two points, from the cubic through q and its rates there."""
    rise, rate, last = trial.q - state.q, h * state.dq, h * trial.dq
    if event == LEVEL:
        return h * share_at(rise, rate, last, level - state.q)
    # root of the cubic's derivative, without cancellation
    c2, c3 = coefficients(rise, rate, last)
    return h * rate / (math.sqrt(max(0.0, c2 * c2 - 3.0 * rate * c3)) - c2)


@kernel(inline=True)
def _step(
    contact: ScaledContact, leg: Leg, kind: int, state: ScaledState, h: float, scale: Scale
) -> tuple[ScaledState, float]:
    """One step of the 5(4) pair of Dormand & Prince, J. Comput. Appl. Math. 6 (1980) 19.

    The rates at its end are the first ones of the next step. The error is in tolerances.
    """
    q, u, a1, b1, f1 = state.q, state.u, state.dq, state.du, state.f
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
    q6 = q + h * (9017 / 3168 * a1 - 355 / 33 * a2 + 46732 / 5247 * a3 + 49 / 176 * a4 - 5103 / 18656 * a5)
    u6 = u + h * (9017 / 3168 * b1 - 355 / 33 * b2 + 46732 / 5247 * b3 + 49 / 176 * b4 - 5103 / 18656 * b5)
    a6, b6, f6 = motion.rates(contact, leg, kind, q6, u6)
    w1, w3, w4, w5, w6 = (h * 35 / 384, h * 500 / 1113, h * 125 / 192, h * -2187 / 6784, h * 11 / 84)
    q7 = q + (w1 * a1 + w3 * a3 + w4 * a4 + w5 * a5 + w6 * a6)
    u7 = u + (w1 * b1 + w3 * b3 + w4 * b4 + w5 * b5 + w6 * b6)
    a7, b7, f7 = motion.rates(contact, leg, kind, q7, u7)
    t = state.t + 2.0 * (w1 * q + w3 * q3 + w4 * q4 + w5 * q5 + w6 * q6)
    # of the waves, over the plate's mobility: it takes the power f v
    work = state.work + 2.0 * (
        w1 * q * f1 * f1 + w3 * q3 * f3 * f3 + w4 * q4 * f4 * f4 + w5 * q5 * f5 * f5 + w6 * q6 * f6 * f6
    )
    error_q = (71 / 57600 * a1 - 71 / 16695 * a3 + 71 / 1920 * a4 - 17253 / 339200 * a5 + 22 / 525 * a6) - 1 / 40 * a7
    error_u = (71 / 57600 * b1 - 71 / 16695 * b3 + 71 / 1920 * b4 - 17253 / 339200 * b5 + 22 / 525 * b6) - 1 / 40 * b7
    error = h * max(abs(error_q) * scale.per_q, abs(error_u) * scale.per_u)
    return ScaledState(q7, u7, t, work, a7, b7, f7), error


@kernel(inline=True)
def _follow(
    contact: ScaledContact, leg: Leg, kind: int, state: ScaledState, h: float, scale: Scale, once: bool
) -> tuple[ScaledState, int, float, int]:
    """Follow a leg of one kind up to an event; the compiler makes a separate loop for each kind.

    Choosing the kind within the step would make a step 50 % slower.
    """
    loading, level = legs.is_loading(leg), leg.level
    event, following = NONE, h
    a = b = gap_a = gap_b = 0.0  # step lengths on either side of the event, and their gaps
    for steps in range(1, MAX_STEPS):
        trial, error = _step(contact, leg, kind, state, h, scale)
        if event == NONE:
            if kind == POWER and abs(trial.u) < _FINER_FROM * scale.u:
                possible = math.sqrt(motion.left(leg, trial.q, trial.u, trial.f) + contact.least) / scale.u
                error *= max(_FINER_FROM / possible, 1.0)
            if not error <= 1.0:  # NaN, too: the step was so long that it overflowed
                h *= max(0.2, 0.9 / math.sqrt(math.sqrt(error)))  # pow is slower than a step
                continue
            if loading and trial.dq < 0.0:
                event = TURN
            elif (trial.q > level) if loading else (trial.q < level):
                event = LEVEL
            else:
                state = trial
                h *= min(5.0, 0.9 / math.sqrt(math.sqrt(max(error, 1e-30))))
                if once:
                    return state, NONE, h, steps
                continue
            following = h
        else:
            gap = _gap(event, trial, level, scale)
            if abs(gap) > _LANDED:
                if gap * gap_b < 0.0:
                    a, gap_a = b, gap_b
                else:
                    gap_a *= 0.5
                b, gap_b = h, gap
                h = b - gap_b * (b - a) / (gap_b - gap_a)
                continue
            if event == TURN and trial.q > level:
                event = LEVEL  # loading ends beyond the kink: land on the kink first
            else:
                return trial, event, following, steps
        a, gap_a = 0.0, _gap(event, state, level, scale)
        b, gap_b = h, _gap(event, trial, level, scale)
        h = _guess(event, state, trial, h, level)
    return state, event, h, MAX_STEPS


@kernel
def follow(
    contact: ScaledContact, leg: Leg, state: ScaledState, h: float, scale: Scale, once: bool
) -> tuple[ScaledState, int, float, int]:
    """Integrate a leg to its level or the end of loading, whichever comes first; if `once`, by one step.

    Returns the point reached, the event, the next step length and the number of steps. An event is
    met by shortening the step that passes it: regula falsi with Illinois' weights.
    """
    if leg.kind == CUBIC:
        return _follow(contact, leg, CUBIC, state, h, scale, once)
    if leg.kind == POWER:
        return _follow(contact, leg, POWER, state, h, scale, once)
    return _follow(contact, leg, PIECES, state, h, scale, once)


@kernel
def after(contact: ScaledContact, leg: Leg, turns: bool, state: ScaledState) -> tuple[Leg, ScaledState]:
    """Next leg, and the state on it, after a leg that ended where the motion turns, or at its level."""
    residual, q = leg.residual, state.q
    if turns:
        leg = legs.down(contact.law, q * q)
    else:
        leg = legs.up(contact.law, leg.last + 1)
    if leg.residual != residual:
        q = math.sqrt(max(q * q + (residual - leg.residual), 0.0))
    return leg, motion.start(contact, leg, q, state.u, state.t, state.work)


@kernel
def scale_of(y: float, rtol: float) -> tuple[Scale, float]:
    """Scales of an impact in the law's units, and a first step that the error control accepts."""
    y4 = math.sqrt(math.sqrt(y))
    q, u = 1.0 / (y4 * y4), 1.0 / (y * y4)
    scale = Scale(q, u, y4, 1.0 / (q * rtol), 1.0 / (u * rtol))
    return scale, 0.7 * rtol**0.2 * y4**3
