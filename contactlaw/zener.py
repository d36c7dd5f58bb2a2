"""The modified Zener model, solved: one impact of a sphere on a plate, without units.

Legend. The law's scale: compressions in d_Y, forces in F_Y, time in T_Y = sqrt(m d_Y/F_Y).
Hertz's scale, in which the results are given: speeds in V0, time in T_H, compressions in V0 T_H,
forces in m V0/T_H.

    d   compression, w in Hertz's scale      u      speed of the sphere towards the plate
    f   contact force                        lam    inelasticity parameter lambda, Eq. 2
    dm  largest compression, w_m             y      yield compression, d_Y/(V0 T_H)
    q   root compression, sqrt(d - dr)       beta   plate mobility in the law's scale, lam y^(1/4)
    dr  residual compression, Eq. 17         j      integral of f^2 dt; the wave took 2 beta j/u0^2

The equation is Eq. 1 of Peng et al. 2021 in its first-order form,

    du/dt = -f,    dd/dt = u - beta f,    d(0) = 0,  u(0) = u0 = y^(-5/4).

A force that starts like d^1.5 has no second derivative at d = 0, where a Runge-Kutta method would
lose its order. So q replaces d (dr = 0 while loading) and ds = dt/(2 q) replaces dt. Nothing is
approximated, and for Hertz, f = q^3, the equation becomes polynomial:

    dq/ds = u - beta f,    du/ds = -2 q f,    dt/ds = 2 q,    dj/ds = 2 q f^2
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.laws import Functions

Array = NDArray[np.float64]

_MAX_STEPS = 200_000

OK, TOO_MANY_STEPS, BAD_INPUT = 0, 1, 2  # status of a solution
MESSAGES = {
    TOO_MANY_STEPS: f"more than {_MAX_STEPS} steps; the plate is far thinner than the model allows",
    BAD_INPUT: "lambda must be finite and >= 0, the yield compression finite and > 0",
}

_LANDED = (
    1e-9  # an event is met to this; compression and time are stationary there, so err by its square
)
# events: end of loading; a root compression is reached; a time is
_NONE, _TURN, _LEVEL, _TIME = 0, 1, 2, 3


class Solution(NamedTuple):
    """One impact in Hertz's scale; energies as shares of the initial kinetic energy."""

    status: int
    steps: int
    restitution: float
    loading_time: float  # until the largest compression
    contact_time: float
    peak_force: float
    peak_compression: float
    residual_compression: float
    plastic_fraction: float
    wave_fraction: float
    wave_rate: float  # wave_fraction / lam, which has a limit at lam = 0


class _State(NamedTuple):
    """A point of the trajectory, with the rates there."""

    q: float
    u: float
    t: float
    j: float
    dq: float  # dq/ds
    du: float  # du/ds
    f: float


class _Branch(NamedTuple):
    """Loading, or the unloading curve with the parameters a and b."""

    loading: bool
    a: float
    b: float


class _Scale(NamedTuple):
    """Size of q, u and t in one impact, against which errors and events are measured."""

    q: float
    u: float
    t: float
    per_q: float  # 1/(q tolerance)
    per_u: float  # 1/(u tolerance)


@kernel
def _rates(
    law: Functions, beta: float, branch: _Branch, q: float, u: float
) -> tuple[float, float, float]:
    """dq/ds, du/ds and the force."""
    f = law.loading(q) if branch.loading else law.unloading(q, branch.a, branch.b)
    return u - beta * f, -2.0 * q * f, f


@kernel
def _step(
    law: Functions, beta: float, branch: _Branch, state: _State, h: float, scale: _Scale
) -> tuple[_State, float]:
    """One step of the 5(4) pair of Dormand & Prince, J. Comput. Appl. Math. 6 (1980) 19.

    Its last rates are the first ones of the next step. The error is in units of the tolerance.
    """
    q, u = state.q, state.u
    a1, b1, f1 = state.dq, state.du, state.f
    q2, u2 = q + h * (1 / 5 * a1), u + h * (1 / 5 * b1)
    a2, b2, f2 = _rates(law, beta, branch, q2, u2)
    q3 = q + h * (3 / 40 * a1 + 9 / 40 * a2)
    u3 = u + h * (3 / 40 * b1 + 9 / 40 * b2)
    a3, b3, f3 = _rates(law, beta, branch, q3, u3)
    q4 = q + h * (44 / 45 * a1 - 56 / 15 * a2 + 32 / 9 * a3)
    u4 = u + h * (44 / 45 * b1 - 56 / 15 * b2 + 32 / 9 * b3)
    a4, b4, f4 = _rates(law, beta, branch, q4, u4)
    q5 = q + h * (19372 / 6561 * a1 - 25360 / 2187 * a2 + 64448 / 6561 * a3 - 212 / 729 * a4)
    u5 = u + h * (19372 / 6561 * b1 - 25360 / 2187 * b2 + 64448 / 6561 * b3 - 212 / 729 * b4)
    a5, b5, f5 = _rates(law, beta, branch, q5, u5)
    q6 = q + h * (
        9017 / 3168 * a1 - 355 / 33 * a2 + 46732 / 5247 * a3 + 49 / 176 * a4 - 5103 / 18656 * a5
    )
    u6 = u + h * (
        9017 / 3168 * b1 - 355 / 33 * b2 + 46732 / 5247 * b3 + 49 / 176 * b4 - 5103 / 18656 * b5
    )
    a6, b6, f6 = _rates(law, beta, branch, q6, u6)
    w1, w3, w4, w5, w6 = h * 35 / 384, h * 500 / 1113, h * 125 / 192, h * -2187 / 6784, h * 11 / 84
    q7 = q + (w1 * a1 + w3 * a3 + w4 * a4 + w5 * a5 + w6 * a6)
    u7 = u + (w1 * b1 + w3 * b3 + w4 * b4 + w5 * b5 + w6 * b6)
    a7, b7, f7 = _rates(law, beta, branch, q7, u7)
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
    return _State(q7, u7, t, j, a7, b7, f7), error


@kernel
def _gap(event: int, state: _State, level: float, until: float, scale: _Scale) -> float:
    """How far an event is off, in units of its scale; its sign changes there."""
    if event == _TURN:
        return state.dq / scale.u
    return (level - state.q) / scale.q if event == _LEVEL else (until - state.t) / scale.t


@kernel
def _guess(event: int, state: _State, trial: _State, h: float, level: float, until: float) -> float:
    """Step to an event between two points, by the cubic through q or t and its rate at both."""
    value, rise, rate, last = state.q, trial.q - state.q, state.dq, trial.dq
    if event == _TIME:  # dt/ds = 2 q
        value, rise, rate, last = state.t, trial.t - state.t, 2.0 * state.q, 2.0 * trial.q
        level = until
    c1, c2 = h * rate, 3.0 * rise - h * (2.0 * rate + last)
    c3 = h * (rate + last) - 2.0 * rise
    if event == _TURN:  # root of c1 + 2 c2 x + 3 c3 x^2, without cancellation
        return h * c1 / (math.sqrt(max(0.0, c2 * c2 - 3.0 * c1 * c3)) - c2)
    x = (level - value) / rise
    for _ in range(3):
        x -= (((c3 * x + c2) * x + c1) * x - (level - value)) / ((3 * c3 * x + 2 * c2) * x + c1)
    return h * x


@kernel
def _phase(
    law: Functions,
    beta: float,
    branch: _Branch,
    state: _State,
    h: float,
    scale: _Scale,
    level: float,
    until: float,
) -> tuple[_State, int, float, int]:
    """Integrate loading to its end or to the kink `level`; unloading to q = level = 0.

    Or to the time `until`, if that is before. Returns the point reached, the event, a step to go
    on with and the number of steps. An event is met by shortening the step that passes it: regula
    falsi with Illinois' weights.
    """
    event, following = _NONE, h
    a = b = gap_a = gap_b = 0.0  # steps on either side of the event, and how far off they end
    for steps in range(1, _MAX_STEPS):
        trial, error = _step(law, beta, branch, state, h, scale)
        if event == _NONE:
            if error > 1.0:
                h *= max(0.2, 0.9 / math.sqrt(math.sqrt(error)))  # a power is slower than a step
                continue
            if branch.loading and trial.dq < 0.0:
                event = _TURN
            elif (trial.q > level) if branch.loading else (trial.q < level):
                event = _LEVEL
            elif trial.t > until:
                event = _TIME
            else:
                state = trial
                h *= min(5.0, 0.9 / math.sqrt(math.sqrt(max(error, 1e-30))))
                continue
            following = h
        else:
            gap = _gap(event, trial, level, until, scale)
            if abs(gap) > _LANDED:
                if gap * gap_b < 0.0:
                    a, gap_a = b, gap_b
                else:
                    gap_a *= 0.5
                b, gap_b = h, gap
                h = b - gap_b * (b - a) / (gap_b - gap_a)
                continue
            if event == _TURN and trial.q > level:
                event = _LEVEL  # the step went over the kink before it turned: land there instead
            elif event != _TIME and trial.t > until:
                event = _TIME
            else:
                return trial, event, following, steps
        a, gap_a = 0.0, _gap(event, state, level, until, scale)
        b, gap_b = h, _gap(event, trial, level, until, scale)
        h = _guess(event, state, trial, h, level, until)
    return state, event, h, _MAX_STEPS


@kernel
def _touch(law: Functions, beta: float, scale: _Scale) -> _State:
    """First touch."""
    dq, du, f = _rates(law, beta, _Branch(True, 0.0, 0.0), 0.0, scale.u)
    return _State(0.0, scale.u, 0.0, 0.0, dq, du, f)


@kernel
def _load(law: Functions, beta: float, scale: _Scale, h: float) -> tuple[_State, float, int]:
    """From first touch to the largest compression, landing on each kink (the last is inf)."""
    state, steps = _touch(law, beta, scale), 0
    for kink in law.kinks:
        state, event, h, more = _phase(
            law, beta, _Branch(True, 0.0, 0.0), state, h, scale, math.sqrt(kink), math.inf
        )
        steps += more
        if event == _TURN or state.dq <= 0.0:
            break
    return state, h, steps


@kernel
def _turn(law: Functions, beta: float, top: _State) -> tuple[_Branch, _State]:
    """Unloading curve from the largest compression, and the state with its root compression."""
    dm = top.q * top.q
    q = math.sqrt(dm - law.residual(dm))
    branch = _Branch(False, *law.unloading_curve(dm))
    dq, du, f = _rates(law, beta, branch, q, top.u)
    return branch, _State(q, top.u, top.t, top.j, dq, du, f)


@kernel
def _scale(y: float, rtol: float) -> tuple[_Scale, float]:
    """Scales of an impact in the law's units, and a first step that the error control accepts."""
    y4 = math.sqrt(math.sqrt(y))
    q, u = 1.0 / (y4 * y4), 1.0 / (y * y4)
    return _Scale(q, u, y4, 1.0 / (q * rtol), 1.0 / (u * rtol)), 0.7 * rtol**0.2 * y4**3


@kernel
def solve(law: Functions, lam: float, y: float, rtol: float) -> Solution:
    """One impact: lam >= 0, y = d_Y/(V0 T_H) > 0, both finite; rtol the error allowed per step."""
    if not (0.0 <= lam < math.inf and 0.0 < y < math.inf):
        return Solution(BAD_INPUT, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    scale, h = _scale(y, rtol)
    y4 = math.sqrt(math.sqrt(y))
    beta = lam * y4
    top, h, steps = _load(law, beta, scale, h)
    dm = top.q * top.q
    branch, top = _turn(law, beta, top)
    end, _, _, more = _phase(law, beta, branch, top, h, scale, 0.0, math.inf)
    wave_rate = 2.0 * y4 * end.j / scale.u**2
    return Solution(
        OK if max(steps, more) < _MAX_STEPS else TOO_MANY_STEPS,
        steps + more,
        min(-end.u / scale.u, 1.0),  # the error of a step may lift it above
        top.t / y4,
        end.t / y4,
        law.loading(math.sqrt(dm)) * y * math.sqrt(y),
        dm * y,
        law.residual(dm) * y,
        2.0 * law.dissipation(dm) / scale.u**2,
        lam * wave_rate,
        wave_rate,
    )


@kernel
def history(law: Functions, lam: float, y: float, rtol: float, time: Array, out: Array) -> None:
    """Contact at rising times [T_H] into out (3, n): force, compression, speed of the sphere.

    For lam and y that `solve` has solved. After the end of contact the state at its end holds.
    """
    scale, h = _scale(y, rtol)
    beta = lam * scale.t
    branch, state, kink, residual = _Branch(True, 0.0, 0.0), _touch(law, beta, scale), 0, 0.0
    for n in range(time.size):
        until, event = time[n] * scale.t, _NONE
        while event != _TIME and state.t < until:
            level = math.sqrt(law.kinks[kink]) if branch.loading else 0.0
            state, event, h, _ = _phase(law, beta, branch, state, h, scale, level, until)
            if branch.loading and event == _LEVEL and state.dq > 0.0:
                kink += 1
            elif branch.loading and event != _TIME:
                residual = law.residual(state.q * state.q)
                branch, state = _turn(law, beta, state)
            elif event == _LEVEL:
                break  # parted
        out[0, n] = state.f * y * math.sqrt(y)
        out[1, n] = (residual + state.q * state.q) * y
        out[2, n] = state.u / scale.u


@kernel
def histories(
    law: Functions, duration: Array, lam: Array, y: Array, rtol: float, out: Array
) -> None:
    """Contacts at even times into out (4, n, samples): see `contactlaw.shapes.sample`."""
    last = out.shape[2] - 1
    states = np.empty((3, last + 1))
    for n in range(lam.size):
        for i in range(last + 1):
            out[0, n, i] = i * duration[n] / last
        # an elastic law has y = inf; any scale does for it
        history(law, lam[n], y[n] if y[n] < math.inf else 1.0, rtol, out[0, n], states)
        out[1, n], out[2, n] = states[0], states[1]
        out[3, n] = 1.0 - states[2]
        out[1, n, last] = 0.0


@kernel
def shape(law: Functions, lam: float, y: float, rtol: float, shares: Array, out: Array) -> int:
    """Find when, and how fast, q passes given shares of its largest value.

    Times [T_H] and speeds [V0] into out (2, 2 n): up the rising shares, of which the last is 1, and
    down to 0, separation.
    """
    if not (0.0 <= lam < math.inf and 0.0 < y < math.inf):
        return BAD_INPUT
    scale, h = _scale(y, rtol)
    beta = lam * scale.t
    top, _, steps = _load(law, beta, scale, h)
    branch, state, kink = _Branch(True, 0.0, 0.0), _touch(law, beta, scale), 0
    for n in range(shares.size - 1):
        q = shares[n] * top.q
        while state.q < q and steps < _MAX_STEPS:
            level = min(q, math.sqrt(law.kinks[kink]))
            state, _, h, more = _phase(law, beta, branch, state, h, scale, level, math.inf)
            kink += level < q
            steps += more
        out[0, n], out[1, n] = state.t / scale.t, state.u / scale.u
    last = shares.size - 1
    out[0, last], out[1, last] = top.t / scale.t, top.u / scale.u
    branch, state = _turn(law, beta, top)
    whole = state.q
    for n in range(last, -1, -1):
        q = shares[n - 1] * whole if n > 0 else 0.0
        state, _, h, more = _phase(law, beta, branch, state, h, scale, q, math.inf)
        steps += more
        out[0, 2 * last + 1 - n], out[1, 2 * last + 1 - n] = state.t / scale.t, state.u / scale.u
    return OK if steps < _MAX_STEPS else TOO_MANY_STEPS


@kernel
def elastic_compression(hertz: Functions, lam: float, rtol: float) -> tuple[int, float]:
    """Status and w_m(lam): largest compression [V0 T_H] under Hertz's law (Fig. 4 of the paper)."""
    if not 0.0 <= lam < math.inf:
        return BAD_INPUT, 0.0
    scale, h = _scale(1.0, rtol)
    state, _, steps = _load(hertz, lam, scale, h)
    return (OK if steps < _MAX_STEPS else TOO_MANY_STEPS), state.q * state.q


@kernel
def _fields(one: Solution, w_m: float, out: Array, n: int) -> None:
    """Put an impact into column n of out (5, :)."""
    out[0, n] = one.restitution
    out[1, n] = one.contact_time
    out[2, n] = one.wave_rate
    out[3, n] = one.peak_compression / w_m
    out[4, n] = w_m


@kernel
def solve_all(
    law: Functions, hertz: Functions, lam: Array, y: Array, rtol: float, out: Array
) -> tuple[int, int]:
    """Many impacts into out (5, n); status and index of the first failure.

    Rows: COR, contact time, wave rate, largest compression over w_m, w_m. An elastic law has
    y = inf.
    """
    for n in range(lam.size):
        scale = y[n] if y[n] < math.inf else 1.0  # the law's scale: any does for an elastic one
        one = solve(law, lam[n], scale, rtol)
        status, w_m = one.status, one.peak_compression
        if status == OK and w_m > law.kinks[0] * scale:  # loading left Hertz's curve
            status, w_m = elastic_compression(hertz, lam[n], rtol)
        if status != OK:
            return status, n
        _fields(one, w_m, out, n)
    return OK, 0


@kernel
def solve_overloads(
    law: Functions, hertz: Functions, lam: Array, chi: Array, rtol: float, out: Array
) -> tuple[int, int]:
    """`solve_all` at given overloads chi = w_m/y; equal neighbours in lam share their w_m."""
    status, w_m = OK, 0.0
    for n in range(lam.size):
        if n == 0 or lam[n] != lam[n - 1]:
            status, w_m = elastic_compression(hertz, lam[n], rtol)
        if status != OK:
            return status, n
        one = solve(law, lam[n], w_m / chi[n], rtol)
        if one.status != OK:
            return one.status, n
        _fields(one, w_m, out, n)
    return OK, 0


@kernel
def contact_state(law: Functions, w: Array, y: Array, out: Array) -> None:
    """Peak force, residual compression and plastic share at largest compressions w, into (3, n)."""
    for n in range(w.size):
        if w[n] <= y[n]:  # every law is Hertz's below yield; y may be inf here
            out[0, n], out[1, n], out[2, n] = w[n] * math.sqrt(w[n]), 0.0, 0.0
            continue
        dm = w[n] / y[n]
        y_root = math.sqrt(y[n])
        out[0, n] = law.loading(math.sqrt(dm)) * y[n] * y_root
        out[1, n] = law.residual(dm) * y[n]
        out[2, n] = 2.0 * law.dissipation(dm) * y[n] * y[n] * y_root
