"""Interpolation in the table: cubic splines on uniform nodes, and the kernels that read them.

A table holds functions of the inelasticity lambda and of ln chi, the logarithm of the overload.
Along lambda the nodes are uniform in x = lambda/(lambda + c); along ln chi they are uniform within
each segment between two kinks, and each segment has a spline of its own, so no spline runs across
a kink. Splines are kept as coefficients of uniform cubic B-splines: two more than there are nodes.
Where ln chi < 0 the contact is elastic and the values at ln chi = 0 hold.

Legend: lam inelasticity, chi overload, w_m largest elastic compression [V0 T_H], c_* the factors
that a pair of materials puts before the powers of speed, radius and thickness.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel

Array = NDArray[np.float64]

# Input beyond these is a mistake: no continuum below 1 nm, no bead above 1 km [m], and no contact
# is quasi-static above the speed of every wave in a solid [m/s].
R_MIN, R_MAX, V_MAX = 1e-9, 1e3, 1e5


class Splines(NamedTuple):
    """A table made ready for interpolation; plain numbers and arrays that a kernel can take."""

    stretch: float  # c in x = lam/(lam + c)
    nodes_per_x: float
    lam_max: float
    elastic_per_x: float
    starts: Array  # ln chi at which the segments begin
    nodes_per_log: Array  # nodes per unit of ln chi in each segment
    cells: NDArray[np.int64]  # cells of each segment
    columns: NDArray[np.int64]  # first coefficient of each segment
    log_chi_max: float
    log_elastic: Array  # (m + 2,) coefficients of ln w_m
    restitution: Array  # (n + 2, columns)
    others: Array  # (n + 2, columns, 3): contact time, wave rate, compression ratio


class Factors(NamedTuple):
    """What a contact brings into an impact beside its speed V [m/s].

    lam = inelasticity V^(1/5);  ln chi = log_overload + (4/5) ln V + ln w_m(lam).
    """

    inelasticity: float
    log_overload: float


def spline_coefficients(values: Array) -> Array:
    """Coefficients of the cubic B-spline through uniform nodes along axis 0, not-a-knot ends."""
    n = len(values)
    if n < 5:
        raise ValueError(f"values: a spline with not-a-knot ends needs at least 5 nodes, got {n}")
    matrix = np.zeros((n + 2, n + 2))
    rows = np.arange(1, n + 1)
    for offset, weight in ((-1, 1 / 6), (0, 4 / 6), (1, 1 / 6)):
        matrix[rows, rows + offset] = weight
    # not-a-knot: the third derivative does not jump at the node next to the end
    matrix[0, :5] = matrix[-1, -5:] = (-1.0, 4.0, -6.0, 4.0, -1.0)
    right = np.zeros((n + 2, *values.shape[1:]))
    right[1:-1] = values
    flat = np.asarray(np.linalg.solve(matrix, right.reshape(n + 2, -1)), dtype=np.float64)
    return flat.reshape(right.shape)


@kernel(cache=True)
def _weights(t: float) -> tuple[float, float, float, float]:
    """Uniform cubic B-splines at t in [0, 1] of a cell (de Boor, A Practical Guide to Splines)."""
    s = 1.0 - t
    w0 = s * s * s / 6.0
    w3 = t * t * t / 6.0
    w1 = 2.0 / 3.0 - 0.5 * t * t * (1.0 + s)
    return w0, w1, 1.0 - w0 - w1 - w3, w3


@kernel(cache=True)
def log_elastic_compression(splines: Splines, lam: float) -> float:
    """Logarithm of w_m."""
    position = lam / (lam + splines.stretch) * splines.elastic_per_x
    i = min(int(position), splines.log_elastic.size - 4)
    w0, w1, w2, w3 = _weights(position - i)
    c = splines.log_elastic
    value: float = w0 * c[i] + w1 * c[i + 1] + w2 * c[i + 2] + w3 * c[i + 3]
    return value


@kernel(cache=True)
def _locate(splines: Splines, lam: float, log_chi: float) -> tuple[int, float, int, float]:
    """Row and column of the first of 4 x 4 coefficients, and the place within the cell."""
    x = lam / (lam + splines.stretch) * splines.nodes_per_x
    i = min(int(x), splines.restitution.shape[0] - 4)
    segment = 0
    while segment + 1 < splines.starts.size and log_chi > splines.starts[segment + 1]:
        segment += 1
    y = max(0.0, log_chi - splines.starts[segment]) * splines.nodes_per_log[segment]
    j = min(int(y), splines.cells[segment] - 1)
    return i, x - i, splines.columns[segment] + j, y - j


@kernel(cache=True)
def restitution_at(splines: Splines, lam: float, log_chi: float) -> float:
    """COR; NaN outside the table."""
    if not (0.0 <= lam <= splines.lam_max and log_chi <= splines.log_chi_max):
        return math.nan
    i, s, j, t = _locate(splines, lam, log_chi)
    a0, a1, a2, a3 = _weights(s)
    b0, b1, b2, b3 = _weights(t)
    c = splines.restitution
    value: float = (
        a0 * (b0 * c[i, j] + b1 * c[i, j + 1] + b2 * c[i, j + 2] + b3 * c[i, j + 3])
        + a1
        * (b0 * c[i + 1, j] + b1 * c[i + 1, j + 1] + b2 * c[i + 1, j + 2] + b3 * c[i + 1, j + 3])
        + a2
        * (b0 * c[i + 2, j] + b1 * c[i + 2, j + 1] + b2 * c[i + 2, j + 2] + b3 * c[i + 2, j + 3])
        + a3
        * (b0 * c[i + 3, j] + b1 * c[i + 3, j + 1] + b2 * c[i + 3, j + 2] + b3 * c[i + 3, j + 3])
    )
    return value


@kernel(cache=True)
def others_at(splines: Splines, lam: float, log_chi: float) -> tuple[float, float, float]:
    """Contact time [T_H], wave rate and compression over w_m; lam and ln chi inside the table."""
    i, s, j, t = _locate(splines, lam, log_chi)
    a = _weights(s)
    b = _weights(t)
    time = wave = ratio = 0.0
    for k in range(4):
        for n in range(4):
            weight = a[k] * b[n]
            time += weight * splines.others[i + k, j + n, 0]
            wave += weight * splines.others[i + k, j + n, 1]
            ratio += weight * splines.others[i + k, j + n, 2]
    return time, wave, ratio


@kernel(cache=True)
def restitution(splines: Splines, factors: Factors, speed: float) -> float:
    """COR at one speed; NaN where the speed is no positive number and outside the table."""
    if not 0.0 < speed <= V_MAX:
        return math.nan
    log_speed = math.log(speed)
    lam = factors.inelasticity * math.exp(0.2 * log_speed)
    if not 0.0 <= lam <= splines.lam_max:
        return math.nan
    log_chi = factors.log_overload + 0.8 * log_speed + log_elastic_compression(splines, lam)
    return restitution_at(splines, lam, log_chi)


@kernel(cache=True)
def restitutions(
    splines: Splines, factors: Factors, speed: Array, radius: Array, thickness: Array, out: Array
) -> int:
    """COR of many spheres on plates; factors hold for R/H = 1. Returns how many are NaN."""
    bad = 0
    for n in range(out.size):
        ratio = radius[n] / thickness[n]
        one = Factors(factors.inelasticity * ratio * ratio, factors.log_overload)
        out[n] = restitution(splines, one, speed[n])
        if not (R_MIN <= radius[n] <= R_MAX and thickness[n] >= R_MIN):
            out[n] = math.nan
        bad += math.isnan(out[n])
    return bad


@kernel(cache=True)
def fields(splines: Splines, lam: Array, yield_ratio: Array, clamp: bool, out: Array) -> int:
    """COR, contact time, wave rate, compression ratio, w_m into out (5, n); how many are outside.

    yield_ratio is y = w_m/chi. Outside the table, `clamp` takes the border, else COR is NaN.
    """
    outside = 0
    for n in range(lam.size):
        inside_lam = min(lam[n], splines.lam_max)
        log_w = log_elastic_compression(splines, inside_lam)
        log_chi = log_w - math.log(yield_ratio[n])
        inside_chi = min(log_chi, splines.log_chi_max)
        if not (inside_lam == lam[n] and inside_chi == log_chi):
            outside += 1
            if not clamp:
                out[:, n] = math.nan
                continue
        out[0, n] = restitution_at(splines, inside_lam, inside_chi)
        out[1, n], out[2, n], out[3, n] = others_at(splines, inside_lam, inside_chi)
        out[4, n] = math.exp(log_w)
    return outside


@kernel(cache=True)
def yield_speeds(splines: Splines, inelasticity: Array, log_overload: float, out: Array) -> None:
    """Speeds at which chi = 1 into out; NaN where lambda leaves the table before.

    inelasticity is lambda at unit speed. d(ln chi)/d(ln V) lies between 2/3 and 4/5, so a step
    with slope 3/4 contracts by 0.12 at least.
    """
    for n in range(out.size):
        log_speed = -1.25 * log_overload
        for _ in range(30):  # 0.12^30 is far below rounding
            lam = inelasticity[n] * math.exp(0.2 * log_speed)
            if not lam <= splines.lam_max:
                break
            log_chi = log_overload + 0.8 * log_speed + log_elastic_compression(splines, lam)
            log_speed -= log_chi / 0.75
        out[n] = math.exp(log_speed) if lam <= splines.lam_max else math.nan
