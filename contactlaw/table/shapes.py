"""Shapes of contacts: how compression, force and speed go with time, from the table.

A contact is followed through its root compression q: from touch up to the largest one and, on the
unloading curve, down to separation. A shape is the list of times and speeds at which q passes given
shares of its largest value. Between two of these states runs the cubic through both (Hermite), with
the slopes that the equation of motion gives: dd/dt = u - lam f, du/dt = -f.

Times and speeds at given shares are smooth in the coordinates of a table. They need fewer nodes than
COR does: the grid here is coarser than the table's, but its strengths are closer.

Legend: d compression, q its root, f force, u speed of the sphere, t time; w_m, lam, y as in
`contactlaw.equation.zener`; all on Hertz's scale.
"""

from __future__ import annotations

import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation import force, zener
from contactlaw.equation.force import BlendedLaw, UnloadingCurve
from contactlaw.equation.legs import NO_CURVE
from contactlaw.equation.outcome import History, Outcome
from contactlaw.laws import Law
from contactlaw.table import lookup, sweep
from contactlaw.table.grid import Grid, ladder_of
from contactlaw.table.lookup import field_at
from contactlaw.table.sweep import Progress

STATES = 16  # on either side of the top
# Sines of even steps: dense at the top, where q hardly changes with time.
SHARES = np.sin(0.5 * math.pi * np.arange(1, STATES + 1) / STATES)
SIZE = 2 * STATES - 1  # states between touch and separation, which are known themselves
_ROWS, _BELOW, _BEYOND, _AFTER = 20, 4, 56, 8  # cells along lambda, up to yield, to the law's end and beyond
_APART = 0.015  # largest distance of rungs in ln k


def build(law: Law, grid: Grid, rtol: float, progress: Progress) -> Array:
    """Solve shapes at nodes, times [T_H] and speeds [V0], and fit splines."""
    after = _AFTER * (grid.axes.after > 0.0)
    coarse = grid.with_axes(rows=_ROWS, below=_BELOW, beyond=max(_BEYOND, grid.axes.beyond), after=after)
    coarse = coarse.on_ladder(law, ladder_of(law, _APART))
    lam, y, strength = coarse.nodes()
    flat = lam.ravel(), y.ravel(), strength.ravel()
    states = np.empty((lam.size, 2 * SIZE))

    def solve(part: slice) -> None:
        lams, ys, strengths = (each[part] for each in flat)
        status, time, speed = zener.shape(law.at_any_strength, lams, ys, rtol, SHARES, strengths)
        if status.any():
            raise sweep.failure("shape", law, lams, ys, *zener.failure(status))
        states[part] = np.hstack((time[:, :-1], speed[:, :-1]))

    sweep.in_parts(solve, lam.size, progress)
    return coarse.packed(states.reshape(*lam.shape, 2 * SIZE))


@kernel
def _force(law: BlendedLaw, curve: UnloadingCurve, loading: bool, d: float, y: float) -> float:
    """Force at a compression; y = inf for a contact that follows Hertz's law."""
    if y == math.inf:
        return d * math.sqrt(d)
    if loading:
        return force.loading(law, math.sqrt(d / y)) * (y * math.sqrt(y))
    q = math.sqrt(max(d / y - curve.residual, 0.0))
    return force.unloading_force(law, curve, q) * (y * math.sqrt(y))


@kernel(cache=True)
def sample(law: Array, shapes: Array, found: Outcome, out: History) -> None:
    """Sample contacts at even times from touch to separation, for outcomes inside the table."""
    samples, head = out.time.shape[1], lookup.head_of(shapes)
    t, u, d = np.empty(SIZE + 2), np.empty(SIZE + 2), np.empty(SIZE + 2)
    for n in range(out.time.shape[0]):
        e, end = found.restitution[n], found.contact_time[n]
        w_m, lam, y = (found.elastic_compression[n], found.inelasticity[n], found.yield_ratio[n])
        own = force.at_strength(law, found.strength[n])
        at, on = lookup.place_at(shapes, head, lam, y, found.strength[n])
        t[0], t[SIZE + 1], u[0], u[SIZE + 1] = 0.0, end, 1.0, -e
        for k in range(SIZE):
            t[k + 1] = field_at(shapes, head.axes, k, at, on)
            u[k + 1] = field_at(shapes, head.axes, SIZE + k, at, on)
        top = found.compression_ratio[n] * w_m
        curve = NO_CURVE
        residual = 0.0
        if top <= y * force.leaves_hertz(own):
            y = math.inf
        else:
            curve = force.unloading(own, top / y)
            residual = curve.residual * y
        for k in range(STATES):
            d[k + 1] = top * SHARES[k] ** 2
            d[SIZE - k] = residual + (top - residual) * SHARES[k] ** 2
        d[0], d[SIZE + 1] = 0.0, residual
        step, i = end / (samples - 1), 0
        f0 = 0.0
        for k in range(SIZE + 1):
            loading = k < STATES
            f1 = _force(own, curve, k + 1 <= STATES, d[k + 1], y)
            span = t[k + 1] - t[k]
            # cubics in the share z of the span: d = d0 + z (p1 + z (p2 + z p3)), u likewise
            p1, last, rise = span * (u[k] - lam * f0), span * (u[k + 1] - lam * f1), d[k + 1] - d[k]
            p2, p3 = 3.0 * rise - 2.0 * p1 - last, p1 + last - 2.0 * rise
            r1, last, rise = -span * f0, -span * f1, u[k + 1] - u[k]
            r2, r3 = 3.0 * rise - 2.0 * r1 - last, r1 + last - 2.0 * rise
            f0 = f1
            while i < samples - 1 and i * step < t[k + 1]:
                z = (i * step - t[k]) / span
                compression = max(d[k] + z * (p1 + z * (p2 + z * p3)), 0.0 if loading else residual)
                speed = u[k] + z * (r1 + z * (r2 + z * r3))
                out.time[n, i] = i * step
                out.force[n, i] = _force(own, curve, loading, compression, y)
                out.compression[n, i] = compression
                out.impulse[n, i] = 1.0 - speed
                i += 1
        out.time[n, samples - 1], out.force[n, samples - 1] = end, 0.0
        out.compression[n, samples - 1], out.impulse[n, samples - 1] = residual, 1.0 + e
