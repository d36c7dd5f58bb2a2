"""Shapes of contacts: how compression, force and speed go with time, from the table.

A contact is followed through its root compression q: from touch up to the largest one and, on the
unloading curve, down to separation. A shape is the list of times and speeds at which q passes given
shares of its largest value. Between two of these states runs the cubic through both (Hermite), with
the slopes that the equation of motion gives: dd/dt = u - lam f, du/dt = -f. With 24 states on
either side of the top the force is within 3e-5 of its peak, up to lam = 5, and within 6e-5 where
the loading curve has corners.

Times and speeds at given shares are smooth in lam and ln chi. They need fewer nodes than COR does:
the grid here is coarser than the table's, with the same segments between kinks.

Legend: d compression, q its root, f force, u speed of the sphere, t time; w_m, lam, y as in
`contactlaw.equation.zener`, chi = w_m/y; all on Hertz's scale.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.force import BlendedLaw, UnloadingCurve
from contactlaw.equation.legs import NO_CURVE
from contactlaw.equation.outcome import History, Outcome
from contactlaw.table import lookup, splines
from contactlaw.table.axes import TableGrid

Singles = NDArray[np.float32]

STATES = 24  # on either side of the top
# Sines of even steps: dense at the top, where q hardly changes with time.
SHARES = np.sin(0.5 * math.pi * np.arange(1, STATES + 1) / STATES)
SIZE = 2 * STATES - 1  # states between touch and separation, which are known themselves
ROWS = 41  # nodes along lam, uniform in x = lam/(lam + c)
STEP = 0.08  # largest distance of two nodes in ln chi
COARSER = 3  # factor on distances in ln k


def pack(grid: TableGrid, states: Singles) -> Shapes:
    """Fit splines through shapes, (2, SIZE) at each node."""
    flat = states.reshape(*grid.shape, 2 * SIZE).astype(np.float64)
    fitted = splines.surface(flat, grid).astype(np.float32)
    whole = fitted.reshape(*fitted.shape[:2], -1, 2 * SIZE)
    return Shapes(splines.header(grid), whole)


class Shapes(NamedTuple):
    """Splines through the shapes at the nodes of a grid, as kernels take them."""

    header: Array  # see `contactlaw.table.lookup`
    coefficients: Singles  # (rows, columns, layers, 2 SIZE): times [T_H], then speeds [V0]


@kernel
def _states(shapes: Shapes, lam: float, log_chi: float, strength: float, out: Array) -> None:
    """Put times and speeds of one contact, between touch and separation, into out (2 SIZE,)."""
    x, at = lam / (lam + shapes.header[lookup.STRETCH]), lookup.at_strength(shapes.header, strength)
    row, column, s, t = lookup.locate(shapes.header, x, lookup.like(log_chi, lookup.stretched(shapes.header, x, at)))
    a, b, c = lookup.weights(s), lookup.weights(t), lookup.layer_weights(at)
    for n in range(out.size):
        out[n] = 0.0
    layers = min(shapes.coefficients.shape[2], 4)
    for k in range(16 * layers):
        i, j, m = k // (4 * layers), k // layers % 4, k % layers
        weight = a[i] * b[j] * c[m] / 216.0
        values = shapes.coefficients[row + i, column + j, at.layer + m]
        for n in range(out.size):
            out[n] += weight * values[n]


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
def sample(law: Array, shapes: Shapes, found: Outcome, out: History) -> None:
    """Sample contacts at even times from touch to separation, for outcomes inside the table."""
    samples = out.time.shape[1]
    inner = np.empty(2 * SIZE)
    t, u, d = np.empty(SIZE + 2), np.empty(SIZE + 2), np.empty(SIZE + 2)
    for n in range(out.time.shape[0]):
        e, end = found.restitution[n], found.contact_time[n]
        w_m, lam, y = (found.elastic_compression[n], found.inelasticity[n], found.yield_ratio[n])
        own = force.at_strength(law, found.strength[n])
        log_chi, strength = math.log(w_m / y) if y < math.inf else 0.0, found.strength[n]
        _states(shapes, lam, log_chi, strength, inner)
        t[0], t[SIZE + 1], u[0], u[SIZE + 1] = 0.0, end, 1.0, -e
        for k in range(SIZE):  # to assign to a slice takes the compiler a second
            t[k + 1], u[k + 1] = inner[k], inner[SIZE + k]
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
