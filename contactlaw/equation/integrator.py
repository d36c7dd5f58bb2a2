"""Integration along one contact: a step, and landing on what ends a stretch of the way.

Legend. The law's scale: compressions in d_Y, forces in F_Y, time in T_Y = sqrt(m d_Y/F_Y).

    d   compression                          u      speed of the sphere towards the plate
    f   contact force                        lam    inelasticity parameter lambda, Eq. 2
    dm  largest compression                  y      yield compression, d_Y/(V0 T_H)
    q   root compression, sqrt(d - dr)       beta   plate mobility in the law's scale, lam y^(1/4)
    dr  residual compression, Eq. 17         j      integral of f^2 dt; the wave took 2 beta j/u0^2

The equation is Eq. 1 of Peng et al. 2021 in its first-order form,

    du/dt = -f,    dd/dt = u - beta f,    d(0) = 0,  u(0) = u0 = y^(-5/4).

A force that starts like d^1.5 has no second derivative at d = 0, where a Runge-Kutta method would
lose its order. So q replaces d (dr = 0 while loading) and ds = dt/(2 q) replaces dt. Nothing is
approximated, and for Hertz, f = q^3, the equation becomes polynomial:

    dq/ds = u - beta f,    du/ds = -2 q f,    dt/ds = 2 q,    dj/ds = 2 q f^2

The way of a contact is cut into legs, on each of which the force is one smooth function of q: up
the loading curve from kink to kink, then down the unloading curve. A capped law's goes down in up
to three parts: its unloading curve, the loading curve from kink to kink, its unloading curve.

A sphere that has flattened far on a plate that gives way easily need not come back. Where the force
falls more slowly than the compression that is left, with an exponent below 2, the contact becomes
ever stiffer beside the plate, what is left goes into the plate, and the sphere never leaves. Once
all that is left could throw it off with no more than `SPENT` of the speed that it came with, the
sphere is turned back, the plate held, and it is. A restitution below that is rounded up to it.
To know what is left, steps err less the less it is.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.force import Curve

Array = NDArray[np.float64]

MAX_STEPS = 200_000
_LANDED = (
    1e-9  # an event is met to this; compression and time are stationary there, so err by its square
)
SPENT = 1e-9  # restitution that is not told from less
LATE = 1e-2  # restitution out of reach, at which, and at each of its powers, steps get finer
# events: end of loading; a root compression is reached; a time is; the energy left is spent
NONE, TURN, LEVEL, TIME, _OVER = 0, 1, 2, 3, 4
_CUBIC, _PIECES, _POWER = 0, 1, 2  # how a leg's force is given
_UP, _ABOVE, _ALONG, _BELOW = 0, 1, 2, 3  # loading; parts of unloading


class State(NamedTuple):
    """A point of the trajectory, with the rates there."""

    q: float
    u: float
    t: float
    j: float
    dq: float  # dq/ds
    du: float  # du/ds
    f: float


class Leg(NamedTuple):
    """A stretch of the way on which the force is one smooth function of q."""

    part: int
    level: float  # root compression at which it ends
    residual: float  # d = residual + q^2
    kind: int
    first: int  # pieces of the loading curve
    last: int
    c0: float  # of a cubic
    c1: float
    c2: float
    c3: float
    exponent: float  # of a power, with the stiffness c3


class Scale(NamedTuple):
    """Size of q, u and t in one impact, against which errors and events are measured."""

    q: float
    u: float
    t: float
    per_q: float  # 1/(q tolerance)
    per_u: float  # 1/(u tolerance)
    over: float  # square of the speed that may be left to leave with: below, event _OVER


Force = Callable[[Array, Leg, float], float]


@kernel
def _along_loading(law: Array, part: int, first: int, last: int, level: float) -> Leg:
    """Leg on pieces of the loading curve."""
    row = force.row_of(law, first)
    degree, at = int(law[row + force.DEGREE]), int(law[row + force.AT])
    if (
        last == first
        and degree <= 3
        and law[row + force.SCALE] == 1.0
        and law[row + force.OFFSET] == 0.0
    ):
        c1 = law[at + 1] if degree > 0 else 0.0
        c2 = law[at + 2] if degree > 1 else 0.0
        c3 = law[at + 3] if degree > 2 else 0.0
        return Leg(part, level, 0.0, _CUBIC, first, last, law[at], c1, c2, c3, 3.0)
    return Leg(part, level, 0.0, _PIECES, first, last, 0.0, 0.0, 0.0, 0.0, 3.0)


@kernel
def _on_unloading_curve(part: int, curve: Curve, level: float) -> Leg:
    """Leg on the unloading curve."""
    kind = _CUBIC if curve.exponent == 3.0 else _POWER
    return Leg(
        part, level, curve.residual, kind, 0, 0, 0.0, 0.0, 0.0, curve.stiffness, curve.exponent
    )


@kernel
def _up(law: Array, first: int) -> Leg:
    """Leg of loading from a kink, the first of whose pieces is given, to the next."""
    following = int(law[force.row_of(law, first) + force.NEXT])
    level = force.start_of(law, following)
    return _along_loading(law, _UP, first, following - 1, level)


@kernel
def _down(law: Array, curve: Curve, below: float) -> Leg:
    """Leg of unloading along the loading curve, from below a root compression to a kink or cap."""
    k = 0
    while force.start_of(law, k + 1) < below:
        k += 1
    first = int(law[force.row_of(law, k) + force.FIRST])
    low = 0.0 if curve.stiffness == 0.0 else math.sqrt(curve.cap_low)
    level = max(low, force.start_of(law, first))
    return _along_loading(law, _ALONG, first, k, level)


@kernel
def _first_down(law: Array, curve: Curve, dm: float) -> Leg:
    """Leg on which unloading from dm begins."""
    if curve.stiffness > 0.0 and curve.cap_low >= curve.cap_high:
        return _on_unloading_curve(_BELOW, curve, 0.0)
    if curve.stiffness > 0.0 and curve.cap_high < dm:
        level = math.sqrt(curve.cap_high - curve.residual)
        return _on_unloading_curve(_ABOVE, curve, level)
    return _down(law, curve, math.sqrt(dm))


@kernel
def _next_leg(law: Array, curve: Curve, leg: Leg) -> Leg:
    """Leg that follows on one that has ended at its level; the last one ends at level 0."""
    if leg.part == _UP:
        return _up(law, leg.last + 1)
    if leg.part == _ABOVE:
        return _down(law, curve, math.sqrt(curve.cap_high))
    if curve.stiffness > 0.0 and leg.level <= math.sqrt(curve.cap_low):
        return _on_unloading_curve(_BELOW, curve, 0.0)
    return _down(law, curve, leg.level)


@kernel
def _cubic(law: Array, leg: Leg, q: float) -> float:
    """Force on a leg that is a cubic: Hertz's law, the linear branch of MYC, most unloading."""
    return (leg.c0 + leg.c1 * q) + (q * q) * (leg.c2 + leg.c3 * q)


@kernel
def _power(law: Array, leg: Leg, q: float) -> float:
    """Force on an unloading curve of another exponent."""
    return force.power_force(leg.c3, leg.exponent, q)


@kernel
def _pieces(law: Array, leg: Leg, q: float) -> float:
    """Force on any stretch of a loading curve."""
    k = leg.first
    # a step on trial may pass the end of the leg on its way up: the law goes on there
    while q >= force.start_of(law, k + 1) and (k < leg.last or leg.part == _UP):
        k += 1
    return force.piece_force(law, k, q)


@kernel
def _left(leg: Leg, state: State) -> float:
    """Square of the speed that the sphere would leave with on an unloading curve, the plate held.

    The work of a force that falls as q^b is 2 f q^2/(b + 2).
    """
    return state.u * state.u + 4.0 * state.f * state.q * state.q / (leg.exponent + 2.0)


@kernel
def _gap(event: int, leg: Leg, state: State, level: float, until: float, scale: Scale) -> float:
    """How far an event is off, in units of its scale; its sign changes there."""
    if event == TURN:
        return state.dq / scale.u
    if event == _OVER:
        return 1.0 - _left(leg, state) / scale.over
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


def _following(force_at: Force) -> Callable[..., tuple[State, int, float, int]]:
    """Make `follow` for one kind of leg.

    The compiler makes a loop of its own of each: a choice within the step would cost half as much
    again as the step does.
    """

    @kernel
    def rates(law: Array, beta: float, leg: Leg, q: float, u: float) -> tuple[float, float, float]:
        """dq/ds, du/ds and the force."""
        f = force_at(law, leg, q)
        return u - beta * f, -2.0 * q * f, f

    @kernel(inline=True)
    def step(
        law: Array, beta: float, leg: Leg, state: State, h: float, scale: Scale
    ) -> tuple[State, float]:
        """One step of the 5(4) pair of Dormand & Prince, J. Comput. Appl. Math. 6 (1980) 19.

        Its last rates are the first ones of the next step. The error is in units of the tolerance.
        """
        q, u = state.q, state.u
        a1, b1, f1 = state.dq, state.du, state.f
        q2, u2 = q + h * (1 / 5 * a1), u + h * (1 / 5 * b1)
        a2, b2, f2 = rates(law, beta, leg, q2, u2)
        q3 = q + h * (3 / 40 * a1 + 9 / 40 * a2)
        u3 = u + h * (3 / 40 * b1 + 9 / 40 * b2)
        a3, b3, f3 = rates(law, beta, leg, q3, u3)
        q4 = q + h * (44 / 45 * a1 - 56 / 15 * a2 + 32 / 9 * a3)
        u4 = u + h * (44 / 45 * b1 - 56 / 15 * b2 + 32 / 9 * b3)
        a4, b4, f4 = rates(law, beta, leg, q4, u4)
        q5 = q + h * (19372 / 6561 * a1 - 25360 / 2187 * a2 + 64448 / 6561 * a3 - 212 / 729 * a4)
        u5 = u + h * (19372 / 6561 * b1 - 25360 / 2187 * b2 + 64448 / 6561 * b3 - 212 / 729 * b4)
        a5, b5, f5 = rates(law, beta, leg, q5, u5)
        q6 = q + h * (
            9017 / 3168 * a1 - 355 / 33 * a2 + 46732 / 5247 * a3 + 49 / 176 * a4 - 5103 / 18656 * a5
        )
        u6 = u + h * (
            9017 / 3168 * b1 - 355 / 33 * b2 + 46732 / 5247 * b3 + 49 / 176 * b4 - 5103 / 18656 * b5
        )
        a6, b6, f6 = rates(law, beta, leg, q6, u6)
        w1, w3, w4, w5, w6 = (
            h * 35 / 384,
            h * 500 / 1113,
            h * 125 / 192,
            h * -2187 / 6784,
            h * 11 / 84,
        )
        q7 = q + (w1 * a1 + w3 * a3 + w4 * a4 + w5 * a5 + w6 * a6)
        u7 = u + (w1 * b1 + w3 * b3 + w4 * b4 + w5 * b5 + w6 * b6)
        a7, b7, f7 = rates(law, beta, leg, q7, u7)
        t = state.t + 2.0 * (w1 * q + w3 * q3 + w4 * q4 + w5 * q5 + w6 * q6)
        # dj/ds = 2 q f^2 is -f du/ds
        j = state.j - (w1 * f1 * b1 + w3 * f3 * b3 + w4 * f4 * b4 + w5 * f5 * b5 + w6 * f6 * b6)
        error_q = (
            71 / 57600 * a1 - 71 / 16695 * a3 + 71 / 1920 * a4 - 17253 / 339200 * a5 + 22 / 525 * a6
        ) - 1 / 40 * a7
        error_u = (
            71 / 57600 * b1 - 71 / 16695 * b3 + 71 / 1920 * b4 - 17253 / 339200 * b5 + 22 / 525 * b6
        ) - 1 / 40 * b7
        error = h * max(abs(error_q) * scale.per_q, abs(error_u) * scale.per_u)
        return State(q7, u7, t, j, a7, b7, f7), error

    @kernel
    def follow(
        law: Array,
        beta: float,
        leg: Leg,
        state: State,
        h: float,
        scale: Scale,
        level: float,
        until: float,
    ) -> tuple[State, int, float, int]:
        """See `follow` of the module."""
        event, following = NONE, h
        a = b = gap_a = gap_b = 0.0  # steps on either side of the event, and how far off they end
        for steps in range(1, MAX_STEPS):
            trial, error = step(law, beta, leg, state, h, scale)
            if event == NONE:
                if error > 1.0:
                    h *= max(
                        0.2, 0.9 / math.sqrt(math.sqrt(error))
                    )  # a power is slower than a step
                    continue
                if leg.part == _UP and trial.dq < 0.0:
                    event = TURN
                elif (trial.q > level) if leg.part == _UP else (trial.q < level):
                    event = LEVEL
                elif trial.t > until:
                    event = TIME
                elif (
                    leg.part == _BELOW
                    and beta > 0.0
                    and trial.u * trial.u < scale.over
                    and _left(leg, trial) < scale.over
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
                    event = (
                        LEVEL  # the step went over the kink before it turned: land there instead
                    )
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

    return follow


_follow_cubic, _follow_power, _follow_pieces = map(_following, (_cubic, _power, _pieces))


@kernel
def _start(law: Array, beta: float, leg: Leg, q: float, u: float, t: float, j: float) -> State:
    """State on a leg, with the rates there."""
    if leg.kind == _CUBIC:
        f = _cubic(law, leg, q)
    elif leg.kind == _POWER:
        f = _power(law, leg, q)
    else:
        f = _pieces(law, leg, q)
    return State(q, u, t, j, u - beta * f, -2.0 * q * f, f)


@kernel
def _finer(scale: Scale, spent: float) -> Scale:
    """Scale for what is left once that is below the event's: its steps err as much less."""
    over = max(LATE * LATE * scale.over, spent)
    return Scale(scale.q, scale.u, scale.t, scale.per_q / LATE, scale.per_u / LATE, over)


@kernel
def follow(
    law: Array,
    beta: float,
    leg: Leg,
    state: State,
    h: float,
    scale: Scale,
    level: float,
    until: float,
) -> tuple[State, int, float, int]:
    """Integrate a leg to a level, or loading to its end, or to the time `until` if that is before.

    Returns the point reached, the event, a step to go on with and the number of steps. An event is
    met by shortening the step that passes it: regula falsi with Illinois' weights.
    """
    spent = (SPENT * scale.u) ** 2
    steps = 0
    while True:
        if leg.part == _BELOW:
            left = (1.0 - 1e-6) * _left(leg, state)  # an event is met to 1e-9
            while left < scale.over and scale.over > spent:
                scale = _finer(scale, spent)
            if left < spent:
                beta = 0.0
                state = _start(law, beta, leg, state.q, -abs(state.u), state.t, state.j)
        if leg.kind == _CUBIC:
            state, event, h, more = _follow_cubic(law, beta, leg, state, h, scale, level, until)
        elif leg.kind == _POWER:
            state, event, h, more = _follow_power(law, beta, leg, state, h, scale, level, until)
        else:
            state, event, h, more = _follow_pieces(law, beta, leg, state, h, scale, level, until)
        steps += more
        if event != _OVER:
            return state, event, h, steps


@kernel
def touch(law: Array, beta: float, scale: Scale) -> tuple[Leg, State]:
    """First touch, and the leg that begins there."""
    leg = _up(law, 0)
    return leg, _start(law, beta, leg, 0.0, scale.u, 0.0, 0.0)


@kernel
def onto(law: Array, beta: float, leg: Leg, residual: float, state: State) -> State:
    """Express a state in the root compression of a leg; that of its own had this residual."""
    q = state.q
    if leg.residual != residual:
        q = math.sqrt(max(q * q + (residual - leg.residual), 0.0))
    return _start(law, beta, leg, q, state.u, state.t, state.j)


@kernel
def after(
    law: Array, beta: float, curve: Curve, leg: Leg, event: int, state: State
) -> tuple[Curve, Leg, State]:
    """Leg, and state on it, that follow on one that has ended: by its level, or where it turned."""
    residual = leg.residual
    if leg.part == _UP and (event == TURN or state.dq <= 0.0):
        dm = state.q * state.q
        curve = force.unloading(law, dm)
        leg = _first_down(law, curve, dm)
    else:
        leg = _next_leg(law, curve, leg)
    return curve, leg, onto(law, beta, leg, residual, state)


@kernel
def is_loading(leg: Leg) -> bool:
    """Whether a leg is part of the loading curve on the way up."""
    return leg.part == _UP


@kernel
def has_parted(leg: Leg, event: int) -> bool:
    """Whether a leg that ended with this event was the last."""
    return leg.part != _UP and leg.level == 0.0 and event == LEVEL


@kernel
def load(law: Array, beta: float, scale: Scale, h: float) -> tuple[Leg, State, float, int]:
    """From first touch to the largest compression, landing on each kink."""
    leg, state = touch(law, beta, scale)
    total = 0
    while True:
        state, event, h, steps = follow(law, beta, leg, state, h, scale, leg.level, math.inf)
        total += steps
        if event != LEVEL or state.dq <= 0.0:
            return leg, state, h, total
        leg = _next_leg(law, NO_CURVE, leg)
        state = onto(law, beta, leg, 0.0, state)


NO_CURVE = Curve(0.0, 0.0, 3.0, 0.0, 0.0)
"""Before there is an unloading curve."""


@kernel
def scale_of(y: float, rtol: float) -> tuple[Scale, float]:
    """Scales of an impact in the law's units, and a first step that the error control accepts."""
    y4 = math.sqrt(math.sqrt(y))
    q, u = 1.0 / (y4 * y4), 1.0 / (y * y4)
    scale = Scale(q, u, y4, 1.0 / (q * rtol), 1.0 / (u * rtol), (LATE * u) ** 2)
    return scale, 0.7 * rtol**0.2 * y4**3
