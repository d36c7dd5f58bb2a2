"""The modified Zener model, solved: what becomes of one impact of a sphere on a plate.

Results are on Hertz's scale: speeds in V0, time in T_H, compressions in V0 T_H, forces in m V0/T_H.

Legend, as in `contactlaw.equation.integrator`: lam inelasticity parameter lambda, y yield
compression, w compression, w_m that of an elastic impact; a law is its data.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation import force, integrator
from contactlaw.equation.force import HERTZ
from contactlaw.equation.integrator import LEVEL, MAX_STEPS, NO_CURVE, TIME
from contactlaw.equation.outcome import Extremes, History, Outcome

Array = NDArray[np.float64]

_CHUNK = 512  # impacts at a time: the scratch arrays stay in the first-level cache
OK, TOO_MANY_STEPS, BAD_INPUT = 0, 1, 2  # status of a solution
MESSAGES = {
    TOO_MANY_STEPS: f"more than {MAX_STEPS} steps; the plate is far thinner than the model allows",
    BAD_INPUT: "lambda must be finite and >= 0, the yield compression finite and > 0",
}


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
    other_fraction: float
    wave_fraction: float
    wave_rate: float  # wave_fraction / lam, which has a limit at lam = 0


@kernel(cache=True)
def solve(law: Array, lam: float, y: float, rtol: float) -> Solution:
    """One impact: lam >= 0, y = d_Y/(V0 T_H) > 0, both finite; rtol the error allowed per step."""
    if not (0.0 <= lam < math.inf and 0.0 < y < math.inf):
        return Solution(BAD_INPUT, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    scale, h = integrator.scale_of(y, rtol)
    y4 = math.sqrt(math.sqrt(y))
    beta = lam * y4
    leg, top, h, total = integrator.load(law, beta, scale, h)
    longest = total
    dm = top.q * top.q
    curve, leg, end = integrator.after(law, beta, NO_CURVE, leg, integrator.TURN, top)
    while True:
        end, event, h, steps = integrator.follow(law, beta, leg, end, h, scale, leg.level, math.inf)
        total, longest = total + steps, max(longest, steps)
        if event != LEVEL or integrator.has_parted(leg, event):
            break
        curve, leg, end = integrator.after(law, beta, curve, leg, event, end)
    wave_rate = 2.0 * y4 * end.j / scale.u**2
    other = force.other_loss(law, dm)
    return Solution(
        OK if longest < MAX_STEPS else TOO_MANY_STEPS,
        total,
        min(max(-end.u / scale.u, 0.0), 1.0),  # the error of a step may lift it beyond
        top.t / y4,
        end.t / y4,
        top.f * y * math.sqrt(y),
        dm * y,
        curve.residual * y,
        2.0 * (force.loss(law, dm) - other) / scale.u**2,
        2.0 * other / scale.u**2,
        lam * wave_rate,
        wave_rate,
    )


@kernel(cache=True)
def history(
    law: Array, lam: float, y: float, rtol: float, time: Array, f: Array, w: Array, u: Array
) -> None:
    """Force, compression and speed of the sphere at rising times [T_H] since first touch.

    For lam and y that `solve` has solved. After the end of contact the state at its end holds.
    """
    scale, h = integrator.scale_of(y, rtol)
    beta, parted = lam * scale.t, False
    curve = NO_CURVE
    leg, state = integrator.touch(law, beta, scale)
    for n in range(time.size):
        until = time[n] * scale.t
        while state.t < until and not parted:
            state, event, h, _ = integrator.follow(
                law, beta, leg, state, h, scale, leg.level, until
            )
            if event == TIME:
                break
            parted = event == integrator.NONE or integrator.has_parted(leg, event)
            if not parted:
                curve, leg, state = integrator.after(law, beta, curve, leg, event, state)
        f[n] = state.f * y * math.sqrt(y)
        w[n] = (leg.residual + state.q * state.q) * y
        u[n] = state.u / scale.u


@kernel(cache=True)
def history_of(law: Array, outcome: Outcome, n: int, rtol: float, out: History) -> None:
    """Contact n at even times from touch to separation."""
    last = out.time.shape[1] - 1
    for i in range(last + 1):
        out.time[n, i] = i * outcome.contact_time[n] / last
    # an elastic law has y = inf; any scale does for it
    y = outcome.yield_ratio[n] if outcome.yield_ratio[n] < math.inf else 1.0
    speed = out.impulse[n]
    history(
        law, outcome.inelasticity[n], y, rtol, out.time[n], out.force[n], out.compression[n], speed
    )
    for i in range(last + 1):
        out.impulse[n, i] = 1.0 - speed[i]
    out.force[n, last] = 0.0


@kernel(cache=True)
def histories(law: Array, outcome: Outcome, rtol: float, out: History) -> None:
    """Contacts at even times from touch to separation."""
    for n in range(out.time.shape[0]):
        history_of(law, outcome, n, rtol, out)


@kernel
def _seek(
    law: Array, beta: float, curve: force.Curve, leg: integrator.Leg, state: integrator.State,
    h: float, scale: integrator.Scale, target: float, rising: bool,
) -> tuple[force.Curve, integrator.Leg, integrator.State, float, int]:  # fmt: skip
    """Go on to a compression that is passed, up or down."""
    total = 0
    while total < MAX_STEPS:
        end = leg.level
        level = math.sqrt(max(target - leg.residual, 0.0))
        level = min(level, end) if rising else max(level, end)
        state, event, h, steps = integrator.follow(law, beta, leg, state, h, scale, level, math.inf)
        total += steps
        if level != end or end == 0.0:
            break
        curve, leg, state = integrator.after(law, beta, curve, leg, event, state)
        if rising != integrator.is_loading(leg):
            break
    return curve, leg, state, h, total


@kernel(cache=True)
def shape(
    law: Array, lam: float, y: float, rtol: float, shares: Array, time: Array, speed: Array
) -> int:
    """Find when, and how fast, q passes given shares of its largest value.

    Times [T_H] and speeds [V0], 2 n of each: up the rising shares, of which the last is 1, and down
    to 0, separation.
    """
    if not (0.0 <= lam < math.inf and 0.0 < y < math.inf):
        return BAD_INPUT
    scale, h = integrator.scale_of(y, rtol)
    beta = lam * scale.t
    top_leg, top, _, total = integrator.load(law, beta, scale, h)
    curve = NO_CURVE
    leg, state = integrator.touch(law, beta, scale)
    last = shares.size - 1
    for n in range(last):
        target = (shares[n] * top.q) ** 2
        curve, leg, state, h, steps = _seek(law, beta, curve, leg, state, h, scale, target, True)
        total += steps
        time[n], speed[n] = state.t / scale.t, state.u / scale.u
    time[last], speed[last] = top.t / scale.t, top.u / scale.u
    dm = top.q * top.q
    curve, leg, state = integrator.after(law, beta, NO_CURVE, top_leg, integrator.TURN, top)
    left = curve.residual
    for n in range(last, -1, -1):
        share = shares[n - 1] if n > 0 else 0.0
        target = left + share * share * (dm - left)
        curve, leg, state, h, steps = _seek(law, beta, curve, leg, state, h, scale, target, False)
        total += steps
        k = 2 * last + 1 - n
        time[k], speed[k] = state.t / scale.t, state.u / scale.u
    return OK if total < MAX_STEPS else TOO_MANY_STEPS


@kernel(cache=True)
def elastic_compression(law: Array, lam: float, rtol: float) -> tuple[int, float]:
    """Status and w_m(lam): largest compression [V0 T_H] of an impact that just yields.

    Under a law that is Hertz's up to yield that of any elastic impact (Fig. 4 of the paper). Under
    another it depends a little on the speed: it is the y that is its own largest compression.
    """
    if not 0.0 <= lam < math.inf:
        return BAD_INPUT, 0.0
    if force.is_hertz(law):
        scale, h = integrator.scale_of(1.0, rtol)
        _, state, _, steps = integrator.load(HERTZ.copy(), lam, scale, h)
        return (OK if steps < MAX_STEPS else TOO_MANY_STEPS), state.q * state.q
    y = 1.0
    for _ in range(100):
        scale, h = integrator.scale_of(y, rtol)
        _, state, _, steps = integrator.load(law, lam * scale.t, scale, h)
        if steps >= MAX_STEPS:
            return TOO_MANY_STEPS, 0.0
        grown = state.q * state.q
        y *= grown
        if abs(grown - 1.0) < 1e-11:
            break
    return OK, y


@kernel
def _put(one: Solution, w_m: float, out: Outcome, n: int) -> None:
    """Put an impact into the outcomes."""
    out.restitution[n] = one.restitution
    out.contact_time[n] = one.contact_time
    out.wave_rate[n] = one.wave_rate
    out.compression_ratio[n] = one.peak_compression / w_m
    out.elastic_compression[n] = w_m


@kernel(cache=True)
def solve_all(law: Array, rtol: float, out: Outcome) -> tuple[int, int]:
    """Impacts with the inelasticities and yield ratios of `out`; status, index of a failure."""
    leaves = force.leaves_hertz(law)
    for n in range(out.inelasticity.size):
        lam, y = out.inelasticity[n], out.yield_ratio[n]
        y = y if y < math.inf else 1.0  # the law's scale: any does for an elastic one
        one = solve(law, lam, y, rtol)
        status, w_m = one.status, one.peak_compression
        if status == OK and w_m > leaves * y:
            status, w_m = elastic_compression(law, lam, rtol)
        if status != OK:
            return status, n
        _put(one, w_m, out, n)
    return OK, 0


@kernel(cache=True)
def solve_overloads(law: Array, rtol: float, overload: Array, out: Outcome) -> tuple[int, int]:
    """`solve_all` at overloads chi = w_m/y; equal neighbours in lambda share their w_m."""
    status, w_m = OK, 0.0
    for n in range(out.inelasticity.size):
        lam = out.inelasticity[n]
        if n == 0 or lam != out.inelasticity[n - 1]:
            status, w_m = elastic_compression(law, lam, rtol)
        if status != OK:
            return status, n
        out.yield_ratio[n] = w_m / overload[n]
        one = solve(law, lam, out.yield_ratio[n], rtol)
        if one.status != OK:
            return one.status, n
        _put(one, w_m, out, n)
    return OK, 0


@kernel(cache=True)
def overload_at(law: Array, lam: float, w_m: float, dm: float, rtol: float) -> float:
    """Overload at which the largest compression is dm; NaN if the equation does not solve.

    By regula falsi with Illinois' weights, in logarithms, in which dm nearly follows the overload.
    """
    low, gap_low = math.log(dm), 0.0
    high, gap_high = low, 0.0
    found = low
    for n in range(100):
        beta_y = w_m / math.exp(found)
        scale, h = integrator.scale_of(beta_y, rtol)
        _, top, _, steps = integrator.load(law, lam * scale.t, scale, h)
        if steps >= MAX_STEPS:
            return math.nan
        gap = 2.0 * math.log(top.q) - math.log(dm)
        if abs(gap) < 1e-11:
            break
        if n == 0 or gap_low == 0.0 or gap_high == 0.0:  # not bracketed yet
            if gap < 0.0:
                low, gap_low = found, gap
            else:
                high, gap_high = found, gap
            if gap_low == 0.0 or gap_high == 0.0:
                found -= 1.5 * gap + math.copysign(1e-9, gap)
                continue
        elif gap < 0.0:
            low, gap_low, gap_high = found, gap, 0.5 * gap_high
        else:
            high, gap_high, gap_low = found, gap, 0.5 * gap_low
        found = high - gap_high * (high - low) / (gap_high - gap_low)
    return math.exp(found)


@kernel(cache=True)
def extremes(law: Array, outcome: Outcome, out: Extremes) -> None:
    """Peak force, residual compression and shares of the energy of impacts.

    Most laws are Hertz's below yield; y may be inf there. Those that are not are gathered: a choice
    in the loop would be predicted wrongly for half of them.
    """
    leaves = force.leaves_hertz(law)
    beyond = np.empty(_CHUNK, dtype=np.int64)
    room = np.empty((4, _CHUNK))
    dm, left, lost, other = room[0], room[1], room[2], room[3]
    for start in range(0, out.peak_force.size, _CHUNK):
        count = 0
        for n in range(start, min(start + _CHUNK, out.peak_force.size)):
            w = outcome.compression_ratio[n] * outcome.elastic_compression[n]
            out.peak_force[n] = w * math.sqrt(w)
            out.residual_compression[n] = 0.0
            out.plastic_fraction[n] = out.other_fraction[n] = 0.0
            beyond[count] = n
            dm[count] = w / outcome.yield_ratio[n]
            count += w > outcome.yield_ratio[n] * leaves
        for k in range(count):
            left[k], lost[k], other[k] = force.residual_and_losses(law, dm[k])
        for k in range(count):
            n = beyond[k]
            y = outcome.yield_ratio[n]
            unit = y * math.sqrt(y)  # F_Y
            out.peak_force[n] = force.loading(law, math.sqrt(dm[k])) * unit
            out.residual_compression[n] = left[k] * y
            out.plastic_fraction[n] = 2.0 * (lost[k] - other[k]) * y * unit
            out.other_fraction[n] = 2.0 * other[k] * y * unit
