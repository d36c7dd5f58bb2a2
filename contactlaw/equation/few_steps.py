"""Restitution near an edge in few steps, for loops that have no time for the integrator's.

Steps of the integrator are explicit and of fifth order, and each carries twelve numbers of memory
through seven stages. These are implicit: the trapezoidal rule in s, whose error is taken from its
difference to a rule of two steps, with the memory as in `contactlaw.equation.recall`. A step costs
a tenth, and 80 to 100 of them give the restitution within 5e-4. A contact that loads again beyond
its largest compression goes on along the loading curve.

Legend, as in `contactlaw.equation.motion`: q root compression, u speed, f force, t time, h step in
s, beta mobility, y yield compression; z memory.
"""

import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.edge import LONGEST, NO_MEMORY
from contactlaw.equation.force import BlendedLaw, UnloadingCurve
from contactlaw.equation.legs import NO_CURVE
from contactlaw.equation.recall import recalled, remembered

_ERROR = 5e-5  # of q in a step, over its scale
_FIRST = 0.05  # step, over that in which a free sphere would cover the scale of q
_SOLVED = 1e-2  # rest of a step's equation, over the error
_TURNED = 1e-3  # speed of q at the end of loading, over that of the impact: dm errs by its square
_PARTED = 1e-2  # q at separation, over its scale: the speed errs by its fifth power
_MOST = 2000  # steps


@kernel(inline=True)
def _force(law: BlendedLaw, loading: bool, curve: UnloadingCurve, q: float) -> float:
    if loading or curve.stiffness == 0.0:
        return float(force.loading(law, q))
    return float(force.unloading_force(law, curve, q))


@kernel
def restitution_near(law: BlendedLaw, response: Array, lam: float, y: float, coupling: float, rate: float) -> float:
    """Restitution of one impact near an edge, see `Edges`; NaN if steps do not get to its end."""
    unit = math.sqrt(math.sqrt(y))  # T_H in the law's scale
    q_scale, speed = 1.0 / (unit * unit), 1.0 / (y * unit)
    beta, pace, until, error = lam * unit, 0.5 * rate / unit, LONGEST * unit, _ERROR * q_scale
    q, u, f, t, dq, du = 0.0, speed, 0.0, 0.0, speed, 0.0
    ddq = ddu = last = 0.0  # second derivatives, and the step over which they are differences
    memory = NO_MEMORY
    loading, curve, dm = True, NO_CURVE, 0.0
    h = _FIRST * q_scale / speed
    for _ in range(_MOST):
        guess, guess_u = q + h * (dq + 0.5 * h * ddq), u + h * (du + 0.5 * h * ddu)
        time = h * (q + max(guess, 0.0))
        later = recalled(response, memory, f, pace * time)
        back, gain = beta * coupling * later.known, beta * (1.0 + coupling * later.per_force)
        x, before, gap_before = guess, q, 0.0
        for n in range(20):
            f_new = _force(law, loading, curve, x)
            u_new = u + 0.5 * h * (du - 2.0 * x * f_new)
            gap = q + 0.5 * h * (dq + u_new - gain * f_new - back) - x
            if abs(gap) < _SOLVED * error:
                break
            slope = (gap - gap_before) / (x - before) if n > 0 and x != before else -1.0
            before, gap_before = x, gap
            x -= gap / slope
        off = abs(x - guess) / error
        if off > 1.0:
            h *= max(0.2, 0.8 / np.cbrt(off))
            continue
        # both rules err by the third derivative, so that their difference gives it
        share = h / (3.0 * (h + last))
        x += share * (guess - x)
        u_new += share * (guess_u - u_new)
        f_new = _force(law, loading, curve, x)
        dq_new = u_new - gain * f_new - back
        turns, parts = loading and dq_new < 0.0, not loading and x < 0.0
        if turns and dq_new < -_TURNED * speed:
            h *= dq / (dq - dq_new)
            continue
        if parts and x < -_PARTED * q_scale:
            h *= q / (q - x)
            continue
        if parts:
            return min(max(-u_new / speed, 0.0), 1.0)
        memory = remembered(later, f_new)
        du_new = -2.0 * x * f_new
        ddq, ddu, last = (dq_new - dq) / h, (du_new - du) / h, h
        q, u, f, dq, du = x, u_new, f_new, dq_new, du_new
        t += time
        if t > until:
            return 0.0
        if turns:
            dm = q * q
            curve, loading = force.unloading(law, dm), False
            q = math.sqrt(dm - curve.residual)
            du = -2.0 * q * f
            ddq, ddu, last = du, 0.0, 0.0
        elif not loading and q * q + curve.residual > dm:
            q = math.sqrt(q * q + curve.residual)
            curve, loading = NO_CURVE, True
            du = -2.0 * q * f
        h *= min(2.0, 0.8 / np.cbrt(max(off, 1e-3)))
    return math.nan
