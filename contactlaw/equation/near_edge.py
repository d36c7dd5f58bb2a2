"""Impacts on a plate that remembers, as near an edge, in implicit steps.

The quickest rates of the plate's memory are a thousand times those of a contact, and explicit steps
would have to follow all of them. These steps are implicit: the trapezoidal rule in s, whose error is
taken from its difference to a rule of two steps, with the memory as in `contactlaw.equation.recall`.
A contact that loads again beyond its largest compression goes on along the loading curve.

Legend, as in `contactlaw.equation.motion`: d compression, q root compression, u speed, f force,
t time, h step in s, beta mobility, y yield compression; z memory.
"""

import math

import numpy as np

from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.edge import LONGEST, NO_MEMORY, Edges
from contactlaw.equation.force import BlendedLaw
from contactlaw.equation.legs import NO_CURVE
from contactlaw.equation.motion import ScaledState
from contactlaw.equation.notes import AT_TIMES, Notes, note
from contactlaw.equation.outcome import Solution, solution
from contactlaw.equation.recall import comes_back, recalled, remembered

# Errors of q in a step over its scale, with which the restitution is within 5e-4 and 3e-5.
QUICK, FINE = 5e-5, 5e-7
_FIRST = 0.05  # step, over that in which a free sphere would cover the scale of q
_SOLVED = 1e-2  # rest of a step's equation, over the error
_TURNED = 1e-3  # speed of q at the end of loading, over that of the impact: dm errs by its square
_PARTED = 1e-2  # q at separation, over its scale: the speed errs by its fifth power
_MOST = 50_000  # steps


@kernel
def follow(law: BlendedLaw, lam: float, y: float, edges: Edges, error: float, notes: Notes, n: int) -> Solution:
    """Follow impact n to its end, and note points of its path.

    The plate has all of the energy that is neither lost at the contact nor left to the sphere.
    """
    response, coupling, rate, y = edges.response[n], edges.coupling[n], edges.rate[n], force.solvable(law, y)
    unit = math.sqrt(math.sqrt(y))  # T_H in the law's scale
    q_scale, speed = 1.0 / (unit * unit), 1.0 / (y * unit)
    beta, pace, until, least = lam * unit, 0.5 * rate / unit, LONGEST * unit, error * q_scale
    q, u, f, t, dq, du = 0.0, speed, 0.0, 0.0, speed, 0.0
    ddq = ddu = last = 0.0  # second derivatives, and the step over which they are differences
    memory, noted = NO_MEMORY, 0
    loading, curve, dm, top = True, NO_CURVE, 0.0, 0.0
    h, ended, stays, steps = _FIRST * q_scale / speed, False, False, 0
    while steps < _MOST and not (ended or stays):
        steps += 1
        guess, guess_u = q + h * (dq + 0.5 * h * ddq), u + h * (du + 0.5 * h * ddu)
        time = h * (q + max(guess, 0.0))
        later = recalled(response, memory, f, pace * time)
        back, gain = beta * coupling * later.known, beta * (1.0 + coupling * later.per_force)
        x, before, gap_before = guess, q, 0.0
        for k in range(20):
            f_new = force.unloading_force(law, curve, x)
            u_new = u + 0.5 * h * (du - 2.0 * x * f_new)
            gap = q + 0.5 * h * (dq + u_new - gain * f_new - back) - x
            if abs(gap) < _SOLVED * least:
                break
            slope = (gap - gap_before) / (x - before) if k > 0 and x != before else -1.0
            before, gap_before = x, gap
            x -= gap / slope
        off = abs(x - guess) / least
        if off > 1.0:
            h *= max(0.2, 0.8 / np.cbrt(off))
            continue
        # both rules err by the third derivative, so that their difference gives it
        share = h / (3.0 * (h + last))
        x += share * (guess - x)
        u_new += share * (guess_u - u_new)
        f_new = force.unloading_force(law, curve, x)
        dq_new = u_new - gain * f_new - back
        turns, ended = loading and dq_new < 0.0, not loading and x < 0.0
        if turns and dq_new < -_TURNED * speed:
            h *= dq / (dq - dq_new)
            ended = False
            continue
        if ended and x < -_PARTED * q_scale:
            h *= q / (q - x)
            ended = False
            continue
        if ended:  # q is 0 before the end of the step
            time = h * q * q / (q - x)
        a, b = ScaledState(q, u, t, 0.0, dq, du, f), ScaledState(max(x, 0.0), u_new, t + time, 0.0, dq_new, 0.0, f_new)
        noted = note(AT_TIMES, notes, n, noted, notes.at.shape[1], law, curve, y, a, b, ended or b.t > until)
        turned = t + time * dq / (dq - dq_new) if turns else 0.0
        memory = remembered(later, f_new)
        du_new = -2.0 * x * f_new
        ddq, ddu, last = (dq_new - dq) / h, (du_new - du) / h, h
        q, u, f, dq, du = x, u_new, f_new, dq_new, du_new
        t += time
        stays = t > until
        if turns:
            dm, top = q * q, turned
            curve, loading = force.unloading(law, dm), False
            q = math.sqrt(dm - curve.residual)
            du = -2.0 * q * f
            ddq, ddu, last = du, 0.0, 0.0
        elif not loading and q * q + curve.residual > dm:
            q = math.sqrt(q * q + curve.residual)
            curve, loading = NO_CURVE, True
            du = -2.0 * q * f
        h *= min(2.0, 0.8 / np.cbrt(max(off, 1e-3)))
    if loading and q * q > dm:  # a sphere that stays may press harder than ever
        dm, top = q * q, t
    left = max(1.0 - 2.0 * y * y * math.sqrt(y) * force.deepest(law, dm).loss, 0.0)
    restitution = 0.0 if stays else min(max(-u / speed, 0.0), math.sqrt(left))
    if edges.again.size:
        again = stays or comes_back(response, memory, coupling, 2.0 * pace, u, beta, t)
        edges.again[n] = 1.0 if again else 0.0
    wave_rate = max(left - restitution * restitution, 0.0) / lam if lam > 0.0 else 0.0
    return solution(law, y, ended or stays, restitution, top / unit, t / unit, dm, lam, wave_rate)
