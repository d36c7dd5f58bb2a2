"""Solutions of the modified Zener model for impacts of a sphere on a plate.

Results are on Hertz's scale: speeds in V0, time in T_H, compressions in V0 T_H, forces in m V0/T_H.

All integrations go through `_integrate`, whose arguments say how far to go and which points to
note. The integrator takes seconds to compile, and each kernel that Python calls is compiled with
everything that it calls.

Legend, as in `contactlaw.equation.motion`: lam inelasticity parameter lambda, y yield compression,
w compression, w_m that of an elastic impact, s strength; a law is its data.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._jit import at_first_as_python, kernel
from contactlaw.equation import elastic, force, integrator, legs, motion, near_edge, outcome
from contactlaw.equation.edge import Edges
from contactlaw.equation.force import BlendedLaw
from contactlaw.equation.integrator import LEVEL, MAX_STEPS, NONE, TURN
from contactlaw.equation.motion import ScaledContact
from contactlaw.equation.notes import AT_COMPRESSIONS, AT_TIMES, TO_THE_END, TO_THE_TOP, Notes, note
from contactlaw.equation.outcome import BAD_INPUT as BAD_INPUT
from contactlaw.equation.outcome import OK as OK
from contactlaw.equation.outcome import TOO_MANY_STEPS as TOO_MANY_STEPS
from contactlaw.equation.outcome import History, Outcome, Solution, solution

_CLOSE = 1e-11  # size of ln(largest compression over the one that is sought)
MESSAGES = {
    TOO_MANY_STEPS: f"more than {MAX_STEPS} steps; thickness is far below what the model allows, or the force jumps",
    BAD_INPUT: "lambda must be >= 0, the yield compression > 0, both of a size that can be",
}


_NO_NOTES = Notes(*np.empty((5, 0, 0)))


@kernel(cache=True)
def _integrate(
    goal: int, laws: Array, lam: Array, y: Array, s: Array, rtol: float, notes: Notes, out: Array, edges: Edges | None
) -> None:
    """Integrate impacts: lam >= 0, y = d_Y/(V0 T_H) > 0, rtol the error allowed per step.

    The solution of each goes into a column of out, in the order of `Solution`.
    """
    for n in range(lam.size):
        out[0, n] = BAD_INPUT
        if 0.0 <= lam[n] < math.inf and y[n] > 0.0:
            law = force.at_strength(laws, s[n])
            if edges is None:
                found = follow_impact(goal, law, lam[n], y[n], rtol, notes, n)
            else:
                found = near_edge.follow(law, lam[n], y[n], edges, near_edge.FINE, notes, n)
            for k in range(len(found)):
                out[k, n] = found[k]
                if out[0, n] == OK and not abs(found[k]) < math.inf:
                    out[0, n] = BAD_INPUT


@kernel
def follow_impact(goal: int, law: BlendedLaw, lam: float, y: float, rtol: float, notes: Notes, n: int) -> Solution:
    """Integrate one impact, and note points of its path in row n."""
    y = force.solvable(law, y)
    scale, h = integrator.scale_of(y, rtol)
    contact = ScaledContact(law, lam * scale.t, (integrator.LEAST_RESTITUTION * scale.u) ** 2)
    leg, curve = legs.up(law, legs.FIRST), legs.NO_CURVE
    top = state = motion.start(contact, leg, 0.0, scale.u, 0.0, 0.0)
    total, noted, marks, going = 0, 0, notes.at.shape[1], True
    while going:
        loading = legs.is_loading(leg)
        reached, event, h, steps = integrator.follow(contact, leg, state, h, scale, goal >= AT_TIMES)
        total += steps
        turns = loading and event != NONE and (event == TURN or reached.dq <= 0.0)
        # absurd impacts overflow: no event comes after a time that is infinite or no number
        going = total < MAX_STEPS and not (event == LEVEL and not loading) and reached.t < math.inf
        if goal >= AT_TIMES:
            most = marks // 2 if goal == AT_COMPRESSIONS and loading else marks
            ends = not going or (turns and goal == AT_COMPRESSIONS)
            noted = note(goal, notes, n, noted, most, law, curve, y, state, reached, ends)
        going, state = going and (noted < marks or marks == 0), reached
        if turns:
            top, going = state, going and goal != TO_THE_TOP
        if going and event != NONE:
            leg, state = integrator.after(contact, leg, turns, state)
            curve = force.unloading(law, top.q * top.q) if turns else curve
    return solution(
        law,
        y,
        total < MAX_STEPS,
        min(max(-state.u / scale.u, 0.0), 1.0),  # a step's error may put it outside
        top.t / scale.t,
        state.t / scale.t,
        top.q * top.q,
        lam,
        2.0 * scale.t * state.work / scale.u**2,
    )


# Python takes 25 ms for an impact, the compiler six seconds and more.
_integrate_few = at_first_as_python(_integrate, 3.0)


def _run(
    goal: int,
    law: Array,
    lam: ArrayLike,
    y: ArrayLike,
    rtol: float,
    notes: Notes = _NO_NOTES,
    few: bool = False,
    edges: Edges | None = None,
    strength: ArrayLike = 0.0,
) -> Solution:
    """Integrate impacts, broadcasting; y is arbitrary for a law that never yields."""
    arguments = (np.array(values, np.float64, ndmin=1) for values in (lam, y, strength))
    lams, ys, s = (each.copy() for each in np.broadcast_arrays(*arguments))
    out = np.zeros((len(Solution._fields), lams.size))
    integrate = _integrate_few if few else _integrate
    integrate(goal, law, lams, ys, s, rtol, notes, out, edges)
    return Solution(*out)


def failure(status: Array) -> tuple[int, int]:
    """Status and index of the first impact that has not solved; OK and 0 if all have."""
    status = np.append(status, OK)  # there may be no impacts
    n = int(np.argmax(status != OK))
    return int(status[n]), n


def solve(law: Array, lam: float, y: float, rtol: float, strength: float = 0.0) -> Solution:
    """Solve one impact: lam >= 0, finite, y = d_Y/(V0 T_H) > 0; rtol error per step."""
    solutions = _run(TO_THE_END, law, lam, y, rtol, strength=strength)
    return Solution(*(each.item() for each in solutions))


def histories(law: Array, outcome: Outcome, rtol: float, out: History, edges: Edges | None = None) -> None:
    """Contacts at the times of `out`, which rise to that of separation; beyond it the values stay."""
    notes = Notes(out.time, np.empty_like(out.time), out.impulse, out.force, out.compression)
    lam, y, s = outcome.inelasticity, outcome.yield_ratio, outcome.strength
    status, n = failure(_run(AT_TIMES, law, lam, y, rtol, notes, edges=edges, strength=s).status)
    if status != OK:
        raise RuntimeError(f"the contact of impact {n} did not solve: {MESSAGES[status]}")
    out.impulse[:] = 1.0 - out.impulse
    out.force[:, -1] = 0.0


def shape(law: Array, found: Outcome, rtol: float, shares: Array) -> Notes:
    """Find when, how fast and with which force q passes given shares of its largest value in solved impacts.

    There are 2 n points for n rising shares up to 1, first while loading, then back down to 0,
    separation.
    """
    turned = outcome.extremes(found.strength.size)
    extremes(law, found, turned)
    w, left = (found.compression_ratio * found.elastic_compression)[:, None], turned.residual_compression[:, None]
    inner = shares[:-1] ** 2
    falling = left + (w - left) * inner[::-1]
    at = np.hstack([w * inner, np.full_like(w, math.inf), falling, np.zeros_like(w)])
    notes = Notes(at, *np.zeros((4, *at.shape)))
    _run(AT_COMPRESSIONS, law, found.inelasticity, found.yield_ratio, rtol, notes, strength=found.strength)
    return notes


def elastic_compression(law: Array, lam: ArrayLike, strength: ArrayLike = 0.0) -> Any:
    """Largest compression w_m [V0 T_H] of impacts that just yield, see `contactlaw.equation.elastic`."""
    lams, strengths = (np.array(values, np.float64) for values in np.broadcast_arrays(lam, strength))
    w_m = np.empty(lams.shape)
    elastic.fill(law, lams.ravel(), strengths.ravel(), w_m.reshape(-1))
    return w_m if w_m.shape else w_m.item()


def solve_all(law: Array, rtol: float, out: Outcome, few: bool = False, edges: Edges | None = None) -> tuple[int, int]:
    """Solve the impacts with the inelasticities and yield ratios of `out`; see `failure`.

    A few impacts need no compiled integrator, if their last digits do not matter.
    """
    lam, s = out.inelasticity, out.strength
    solutions = _run(TO_THE_END, law, lam, out.yield_ratio, rtol, few=few, edges=edges, strength=s)
    out.restitution[:], out.contact_time[:] = solutions.restitution, solutions.contact_time
    out.wave_rate[:] = solutions.wave_rate
    out.elastic_compression[:] = elastic_compression(law, lam, s)  # of an endless plate, near edges, too
    out.compression_ratio[:] = solutions.peak_compression / out.elastic_compression
    return failure(solutions.status)


def overload_at(
    law: Array, lam: Any, w_m: Any, dm: Any, rtol: float, few: bool = False, strength: ArrayLike = 0.0
) -> Any:
    """Overload at which the largest compression is dm; NaN if the equation does not solve.

    By the secant method in logarithms, since ln dm is nearly ln chi.
    """

    def gap(log_chi: Array) -> Array:
        y = w_m / np.exp(log_chi)
        solutions = _run(TO_THE_TOP, law, lam, y, rtol, few=few, strength=strength)
        reached = np.log(solutions.peak_compression.reshape(y.shape) / (y * dm))
        return np.where(solutions.status.reshape(y.shape) == OK, reached, math.nan)

    at = np.log(np.broadcast_to(dm, np.shape(lam)))
    slope = np.ones_like(at)
    gap_at = gap(at)
    for _ in range(100):
        step = np.where(abs(gap_at) > _CLOSE, -gap_at / slope, 0.0)
        if not step.any():
            break
        at, before, gap_at = at + step, gap_at, gap(at + step)
        np.divide(gap_at - before, step, out=slope, where=(step != 0.0) & (gap_at != before))
    overload = np.where(abs(gap_at) <= _CLOSE, np.exp(at), math.nan)
    return overload if overload.shape else overload.item()


@kernel(cache=True)
def extremes(laws: Array, outcome: Outcome, out: Solution) -> None:
    """Solutions of outcomes, with the peak force, residual compression and losses that follow from the law.

    Contacts that follow Hertz's law need no yield compression, which is inf for an elastic law.
    """
    leaves = force.leaves_hertz(force.at_strength(laws, 0.0))
    for n in range(outcome.restitution.size):
        deepest, y = outcome.compression_ratio[n] * outcome.elastic_compression[n], outcome.yield_ratio[n]
        e, time, lam, rate = (
            outcome.restitution[n],
            outcome.contact_time[n],
            outcome.inelasticity[n],
            outcome.wave_rate[n],
        )
        found = Solution(0.0, e, math.nan, time, deepest * math.sqrt(deepest), deepest, 0.0, 0.0, lam * rate, 0.0, rate)
        if deepest > y * leaves:
            own = force.at_strength(laws, outcome.strength[n])
            found = solution(own, y, True, e, math.nan, time, deepest / y, lam, rate)
        for k in range(len(found)):
            out[k][n] = found[k]
