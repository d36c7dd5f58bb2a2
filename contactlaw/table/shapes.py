"""Shapes of contacts: how force, compression and speed go with time, from the table.

A contact is followed through its root compression q: from touch up to the largest one and, on the
unloading curve, down to separation. A shape is the list of times, speeds of the sphere and forces at
which q passes given shares of its largest value. Between two of these states the speed is the cubic
through both (Hermite) with the rates -f, and its derivative is the force; the compression is the
cubic with the rates of the equation of motion, dd/dt = u - lam f.

What happens at given shares is smooth in the coordinates of a table. It needs fewer nodes than COR
does: the grid here is coarser than the table's, but its strengths are closer.

Legend: d compression, q its root, f force, u speed of the sphere, t time; lam as in
`contactlaw.equation.zener`; all on Hertz's scale.
"""

from __future__ import annotations

import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation import force, zener
from contactlaw.equation.notes import coefficients, cubic
from contactlaw.equation.outcome import History, Outcome
from contactlaw.laws import Law
from contactlaw.table import lookup, sweep
from contactlaw.table.grid import Grid, ladder_of
from contactlaw.table.lookup import field

STATES = 16  # on either side of the top
# Sines of even steps: dense at the top, where q hardly changes with time.
SHARES = np.sin(0.5 * math.pi * np.arange(1, STATES + 1) / STATES)
SIZE = 2 * STATES - 1  # states between touch and separation, which are known themselves
FIELDS = 3 * SIZE  # times [T_H], speeds [V0] and forces [m V0/T_H]
_ROWS, _BELOW, _BEYOND, _AFTER = 20, 4, 56, 16  # cells along lambda, up to yield, to the law's end and beyond
_APART = 0.015  # largest distance of rungs in ln k


def build(law: Law, grid: Grid, rtol: float) -> Array:
    """Solve shapes at nodes and fit splines."""
    after = _AFTER * (grid.axes.after > 0.0)
    coarse = grid.with_axes(rows=_ROWS, below=_BELOW, beyond=max(_BEYOND, grid.axes.beyond), after=after)
    coarse = coarse.on_ladder(law, ladder_of(law, _APART))

    def states(out: Outcome) -> Array:
        found = zener.shape(law.at_any_strength, out, rtol, SHARES)
        return np.hstack([one[:, :-1] for one in (found.time, found.speed, found.force)])

    return sweep.at_nodes(law, coarse, rtol, states)


@kernel(cache=True)
def sample(law: Array, shapes: Array, found: Outcome, out: History) -> None:
    """Sample contacts at even times from touch to separation, for outcomes inside the table."""
    samples, head = out.time.shape[1], lookup.head_of(shapes)
    (t, f, d), u = np.zeros((3, SIZE + 2)), np.ones(SIZE + 2)
    for n in range(out.time.shape[0]):
        lam, y, i = found.inelasticity[n], found.yield_ratio[n], 0
        top, left = found.compression_ratio[n] * found.elastic_compression[n], 0.0
        own = force.at_strength(law, found.strength[n])
        if top > y * force.leaves_hertz(own):
            left = force.unloading(own, top / y).residual * y
        at, on = lookup.place_at(shapes, head, lam, y, found.strength[n], True)
        for k in range(SIZE):
            t[k + 1] = field(shapes, head.axes, k, at, on)
            u[k + 1] = field(shapes, head.axes, SIZE + k, at, on)
            f[k + 1] = field(shapes, head.axes, 2 * SIZE + k, at, on)
        for k in range(STATES):
            square = SHARES[k] * SHARES[k]
            d[k + 1], d[SIZE - k] = top * square, left + (top - left) * square
        t[SIZE + 1], u[SIZE + 1], d[SIZE + 1] = found.contact_time[n], -found.restitution[n], left
        for k in range(SIZE + 1):
            span, rise = t[k + 1] - t[k], u[k + 1] - u[k]
            rate, last = -span * f[k], -span * f[k + 1]
            c2, c3 = coefficients(rise, rate, last)
            before, after = span * (u[k] - lam * f[k]), span * (u[k + 1] - lam * f[k + 1])
            while i < samples and (out.time[n, i] < t[k + 1] or k == SIZE):
                z = (out.time[n, i] - t[k]) / span
                slope = rate + z * (2.0 * c2 + 3.0 * z * c3)
                out.force[n, i] = max(-slope / span, 0.0) + 0.0  # without the sign of -0.0
                out.impulse[n, i] = 1.0 - u[k] - cubic(rise, rate, last, z)
                out.compression[n, i] = max(d[k] + cubic(d[k + 1] - d[k], before, after, z), 0.0)
                i += 1
