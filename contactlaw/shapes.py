"""Shapes of contacts: how compression, force and speed go with time, from the table.

A contact is followed through its root compression q: from touch up to the largest one and, on the
unloading curve, down to separation. A shape is the list of times and speeds at which q passes given
shares of its largest value. Between two of these states runs the cubic through both (Hermite), with
the slopes that the equation of motion gives: dd/dt = u - lam f, du/dt = -f. With 24 states on
either side of the top it holds the force to 2e-5 of its peak, up to lam = 5.

Times and speeds at given shares are smooth in lam and ln chi. They need fewer nodes than COR does:
the grid here is coarser than the table's, with the same segments between kinks.

Legend: d compression, q its root, f force, u speed of the sphere, t time; w_m, lam, y as in
`contactlaw.zener`, chi = w_m/y; all on Hertz's scale.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw import packing, zener
from contactlaw._jit import kernel
from contactlaw.laws import Functions
from contactlaw.lookup import weights

Array = NDArray[np.float64]
Singles = NDArray[np.float32]

STATES = 24  # on either side of the top
# Sines of even steps: dense at the top, where q hardly changes with time.
SHARES = np.sin(0.5 * math.pi * np.arange(1, STATES + 1) / STATES)
SIZE = 2 * STATES - 1  # states between touch and separation; at these two they are known
ROWS = 41  # nodes along lam, uniform in x = lam/(lam + c)
STEP = 0.08  # largest distance of two nodes in ln chi


class Shapes(NamedTuple):
    """Splines through the shapes at the nodes of a grid, as kernels take them."""

    stretch: float  # c in x = lam/(lam + c)
    rows_per_x: float
    start: Array  # first ln chi of each segment,
    per_log: Array  # its nodes per unit of ln chi,
    column: NDArray[np.int64]  # and its first column of coefficients
    coefficients: Singles  # (rows, columns, 2 SIZE): times [T_H], then speeds [V0]


def pack(stretch: float, lam_max: float, segments: tuple[Array, ...], values: Singles) -> Shapes:
    """Fit splines through shapes (rows, nodes of all segments, 2, SIZE)."""
    start, per_log, column = packing.blocks(segments).T
    flat = values.reshape(*values.shape[:2], 2 * SIZE).astype(np.float64)
    # a kernel reads one coefficient too many at the very end, with the weight 0, and needs no test
    coefficients = np.pad(packing.surface(flat, segments), ((0, 1), (0, 1), (0, 0)), mode="edge")
    return Shapes(
        stretch=stretch,
        rows_per_x=(ROWS - 1) * (lam_max + stretch) / lam_max,
        start=start.copy(),
        per_log=per_log.copy(),
        column=column.astype(np.int64),
        coefficients=coefficients.astype(np.float32),
    )


@kernel
def _states(shapes: Shapes, lam: float, log_chi: float, out: Array) -> None:
    """Put times and speeds of one contact, between touch and separation, into out (2 SIZE,)."""
    segment = 0
    for k in range(1, shapes.start.size):
        segment += log_chi > shapes.start[k]
    across = lam / (lam + shapes.stretch) * shapes.rows_per_x
    along = max(0.0, log_chi - shapes.start[segment]) * shapes.per_log[segment]
    row, cell = int(across), int(along)
    column = int(shapes.column[segment]) + cell
    a, b = weights(across - row), weights(along - cell)
    for n in range(out.size):
        out[n] = 0.0
    for k in range(out.size // SIZE * 8):  # 16, but not to the compiler, which would unroll it all
        weight = a[k // 4] * b[k % 4] / 36.0
        values = shapes.coefficients[row + k // 4, column + k % 4]
        for n in range(out.size):
            out[n] += weight * values[n]


@kernel
def _force(
    law: Functions, loading: bool, d: float, residual: float, y: float, a: float, b: float
) -> float:
    """Force at a compression; a contact that has not yielded has y = inf."""
    if y == math.inf:
        return d * math.sqrt(d)
    if loading:
        return law.loading(math.sqrt(d / y)) * (y * math.sqrt(y))
    return law.unloading(math.sqrt((d - residual) / y), a, b) * (y * math.sqrt(y))


@kernel
def sample(law: Functions, shapes: Shapes, fields: Array, out: Array) -> None:
    """Contacts at even times from touch to separation.

    fields (7, n): COR, contact time, wave rate, compression ratio, w_m, lam, y, inside the table;
    out (4, n, samples): time [T_H], force, compression, momentum that has passed [m V0].
    """
    samples = out.shape[2]
    inner = np.empty(2 * SIZE)
    t, u, d = np.empty(SIZE + 2), np.empty(SIZE + 2), np.empty(SIZE + 2)
    for n in range(fields.shape[1]):
        e, end, w_m, lam, y = fields[0, n], fields[1, n], fields[4, n], fields[5, n], fields[6, n]
        _states(shapes, lam, math.log(w_m / y) if y < math.inf else 0.0, inner)
        t[0], t[SIZE + 1], u[0], u[SIZE + 1] = 0.0, end, 1.0, -e
        for k in range(SIZE):  # a slice on the left takes the compiler a second
            t[k + 1], u[k + 1] = inner[k], inner[SIZE + k]
        top = fields[3, n] * w_m
        residual = a = b = 0.0
        if top <= y:
            y = math.inf
        else:
            residual = law.residual(top / y) * y
            a, b = law.unloading_curve(top / y)
        for k in range(STATES):
            d[k + 1] = top * SHARES[k] ** 2
            d[SIZE - k] = residual + (top - residual) * SHARES[k] ** 2
        d[0], d[SIZE + 1] = 0.0, residual
        step, i = end / (samples - 1), 0
        f0 = 0.0
        for k in range(SIZE + 1):
            loading = k < STATES
            f1 = _force(law, k + 1 <= STATES, d[k + 1], residual, y, a, b)
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
                out[0, n, i] = i * step
                out[1, n, i] = _force(law, loading, compression, residual, y, a, b)
                out[2, n, i] = compression
                out[3, n, i] = 1.0 - speed
                i += 1
        out[0, n, samples - 1], out[1, n, samples - 1] = end, 0.0
        out[2, n, samples - 1], out[3, n, samples - 1] = residual, 1.0 + e


@kernel
def deviations(
    law: Functions, shapes: Shapes, fields: Array, rtol: float, samples: int, out: Array
) -> None:
    """Largest difference from the solver's force, over its peak, of each contact into out (n,)."""
    ours, exact = np.empty((4, 1, samples)), np.empty((3, samples))
    for n in range(out.size):
        sample(law, shapes, fields[:, n : n + 1], ours)
        zener.history(law, fields[5, n], fields[6, n], rtol, ours[0, 0], exact)
        worst = peak = 0.0
        for i in range(samples):
            worst = max(worst, abs(ours[1, 0, i] - exact[0, i]))
            peak = max(peak, exact[0, i])
        out[n] = worst / peak
