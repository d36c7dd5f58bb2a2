"""Interpolation in the table: the kernels that read its splines.

A table holds functions of the inelasticity lambda and of ln chi, the logarithm of the overload, on
the nodes that `contactlaw.table.grid` places. Splines are kept as coefficients of uniform cubic
B-splines, two more than there are nodes: they need the least memory, and a table that stays in the
CPU's cache is a fast one. Below the first segment the values at its beginning hold. With x =
lambda/(lambda + c), ln w_m is a polynomial in x, and so is ln chi along each curved kink, one that
is not a line of constant chi.

A table of a pair whose strength k grows with the rate of strain has a third axis, ln k, with layers
of nodes in segments. Up to yield all layers have the same ln chi. Beyond, ln chi is stretched so
that the law's range, which is shorter in stronger pairs, ends where that of slow impacts does: then
the kinks at yield and at the end of the range lie at one place in all layers.

All of it is packed into one array of float64, because a kernel that takes one array and a few
numbers is called from Python in a third of a microsecond. The array begins with a header:

    STRETCH      c                        CURVED        1 if there are curved kinks
    X_MAX        x of the largest lambda  COR_AT        where the coefficients of COR begin
    LOG_CHI_MAX  largest ln chi           OTHERS_AT     where those of the other fields begin
    NODES_PER_X  1/(distance of nodes)    LAYERS        coefficients along ln k; 0: no third axis
    COLUMNS      coefficients in a row    STRENGTHS     number of segments in ln k
    SEGMENTS     number of segments n     STRENGTHS_AT  where they begin

    C_LAM, C_CHI     see below; these and the following belong to a pair, see `with_plate`
    RATE, LOG_RATE   C in k = 1 + C ln(rate/rate0); ln(rate/rate0) at 1 /s
    TRANSIT on       of the plate, see `PlateConstants`

then, at HEADER, the polynomial's coefficients, n blocks and the polynomials of curved kinks:

    START, END   ln chi at lambda = 0     COLUMN     first column of coefficients
    PER_LOG      cells per unit of ln chi GRADED     1 if nodes are uniform in the root
    CELLS        nodes less one           LINE       where the polynomial of the start is, or 0

and the segments in ln k, with polynomials in t, -1 at LOW and 1 at HIGH:

    LOW, HIGH    ln k at the ends         LAYER_CELLS  layers of nodes less one
    LAYER        first of its layers      ROWS_AT      rows of polynomials:

LATER, the logarithm of the growth of d_Y, and the powers of z = 2 x/x_max - 1, from STRETCHED on in
the factor by which ln chi is stretched, from ELASTIC on in ln w_m less that of slow impacts.

Legend: v speed, lam inelasticity, chi overload, w_m largest elastic compression [V0 T_H]. Powers:
lam = c_lam V^(1/5) (R/H)^2, ln chi = c_chi + (4/5) ln V + ln w_m; the two constants belong to a
pair of materials and a law, `contactlaw.physical.scaling` has them.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation.corrections import PlateCorrections, is_thin
from contactlaw.equation.numbers import (
    NO_RATE,
    RATE_POWER,
    ModulusGrowth,
    PairConstants,
    PlateConstants,
    inelasticity_of,
    of_mass,
    plate_stiffening,
    relaxed,
    relaxes,
    with_saturation,
)
from contactlaw.equation.outcome import Outcome

Integers = NDArray[np.int32]
Four = tuple[float, float, float, float]
Six = tuple[float, float, float, float, float, float]

# Input outside these limits is a mistake. Sizes [m]: there is no continuum below 1 nm, and no bead
# above 1 km. Speeds [m/s]: no contact is quasi-static above the speed of every wave in a solid, and
# below 1e-30 m/s squares begin to underflow.
R_MIN, R_MAX, V_MAX = 1e-9, 1e3, 1e5
V_MIN = 1e-30
# Smallest H/R, whatever the law and the speed. A plate thinner than that is a foil, and nothing is
# known of impacts on it: finite elements reach R/H = 5.8, the flags begin there. For materials of
# the catalogue at 0.01 to 100 m/s lambda exceeds 6 on thicker plates already, from R/H = 1.4 to 60.
THINNEST = 0.01

STRETCH, X_MAX, LOG_CHI_MAX, NODES_PER_X, COLUMNS = range(5)
SEGMENTS, CURVED, COR_AT, OTHERS_AT, LAYERS, STRENGTHS, STRENGTHS_AT = range(5, 12)
C_LAM, C_CHI, RATE, LOG_RATE, TRANSIT, REACH, SATURATED, WAVES = range(12, 20)
GROWTH = WAVES + len(PlateCorrections._fields)
HEADER = GROWTH + len(ModulusGrowth._fields)  # where the series of ln w_m begins
DEGREE = 20  # degree of ln w_m in x: within 4e-12 at the nodes
START, END, PER_LOG, CELLS, COLUMN, GRADED, LINE, BLOCK = range(8)
BLOCKS = HEADER + DEGREE + 1
LOW, HIGH, LAYER_CELLS, LAYER, ROWS_AT = range(5)
TERMS = 6  # powers of t in the rows of strength
LATER, STRETCHED, ELASTIC, ROWS = 0, 1, 5, 15
STRENGTH = ROWS_AT + ROWS * TERMS
_CHUNK = 512  # impacts at a time: the scratch arrays stay in the first-level cache
NO_MASSES = np.empty(0)


def with_plate(table: Array, pair: PairConstants) -> Array:
    """Copy a table and put in the constants of a pair."""
    table, plate, log_time = table.copy(), pair.plate, math.log(pair.time)
    share = pair.yield_compression
    c_chi = math.log(pair.time / share) if share < math.inf else -math.inf
    table[[C_LAM, C_CHI]] = plate.inelasticity, c_chi
    if plate.rate.slope > 0.0:
        table[[RATE, LOG_RATE]] = plate.rate.slope, math.log(plate.rate.per_speed / share)
    table[TRANSIT:WAVES] = plate.transit, plate.x_at_one, plate.saturated
    table[WAVES:GROWTH] = plate.corrections
    table[GROWTH:HEADER] = plate.growth._replace(log_time=plate.growth.log_time - log_time)
    return table


@kernel
def plate_of(table: Array) -> PlateConstants:
    """Read the constants of the plate; `log_time` is for T_H of a sphere of 1 m at 1 m/s as 1."""
    w, k, r = table, WAVES, GROWTH
    corrections = PlateCorrections(
        w[k], w[k + 1], w[k + 2], w[k + 3], w[k + 4], w[k + 5], w[k + 6], w[k + 7], w[k + 8], w[k + 9], w[k + 10]
    )
    growth = ModulusGrowth(w[r], w[r + 1], w[r + 2], w[r + 3], w[r + 4], w[r + 5])
    return PlateConstants(w[C_LAM], w[TRANSIT], w[REACH], w[SATURATED], corrections, growth, NO_RATE)


def lam_max(table: Array) -> float:
    """Largest inelasticity of a table."""
    return float(table[STRETCH] * table[X_MAX] / (1.0 - table[X_MAX]))


def _root_series() -> tuple[float, ...]:
    """Taylor coefficients of f(z) = ((1 + z)/(1 - z))^(1/5), from (1 - z^2) f' = (2/5) f."""
    c = [1.0, 0.4]
    for n in range(1, 19):
        c.append((0.4 * c[n] + (n - 1) * c[n - 1]) / (n + 1))
    return tuple(c)


ROOT = _root_series()
_ABOVE = np.int64((1024 << 52) - 0x3FE6A09E667F3BCD)  # 1024 exponents less sqrt(1/2), in bits
_TWO_52 = np.int64(0x433 << 52)  # bits of 2^52
_LN_2_HIGH, _LN_2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10  # from fdlibm
_FACTORIALS = tuple(1.0 / math.factorial(n) for n in range(14))
_ROOTS_OF_TWO = 2.0 ** (np.arange(-1024, 3072) / 5)  # 2^(k/5), for any 12 bits of an exponent


@kernel
def log_and_root(v: float) -> tuple[float, float]:
    """Logarithm and fifth root of V_MIN <= v <= V_MAX, to rounding; garbage for other v, no crash.

    v = 2^k m with m within [sqrt(1/2), sqrt(2)) and z = (m - 1)/(m + 1), |z| < 0.172: the series of
    2 artanh z = ln m and of m^(1/5) do not wait for each other, and contain no call, so that loops
    over them become vector instructions.
    """
    bits = np.float64(v).view(np.int64)
    # k + 1024, from the exponent of v/sqrt(1/2); unsigned, since vectors have no signed shift
    biased = np.uint64(bits + _ABOVE) >> np.uint64(52)
    signed = np.int64(biased)
    exponent = np.int64(signed + _TWO_52).view(np.float64) - (2.0**52 + 1024.0)  # k as a float
    m = np.int64(bits - ((signed - np.int64(1024)) << np.int64(52))).view(np.float64)
    z = (m - 1.0) / (m + 1.0)
    w = z * z
    w2 = w * w
    w4 = w2 * w2
    w8 = w4 * w4
    odd = (2.0 + w * (2 / 3)) + (2 / 5 + w * (2 / 7)) * w2  # next term of ln m: 1e-17
    odd += ((2 / 9 + w * (2 / 11)) + (2 / 13 + w * (2 / 15)) * w2) * w4
    odd += (2 / 17 + w * (2 / 19)) * w8
    c = ROOT  # next term of the root: 2e-17
    root = (c[0] + c[1] * z) + (c[2] + c[3] * z) * w
    root += ((c[4] + c[5] * z) + (c[6] + c[7] * z) * w) * w2
    root += ((c[8] + c[9] * z) + (c[10] + c[11] * z) * w) * w4
    root += ((c[12] + c[13] * z) + (c[14] + c[15] * z) * w) * (w4 * w2)
    root += ((c[16] + c[17] * z) + (c[18] + c[19] * z) * w) * w8
    return exponent * math.log(2.0) + z * odd, root * _ROOTS_OF_TWO[biased]


@kernel
def exp(x: float) -> float:
    """Exponential of x within 1e-15, for |x| < 700; without a call, as `log_and_root`.

    x = k ln 2 + r, |r| < 0.35: the series of exp(r), and k into the bits of the exponent.
    """
    shifted = x * (1.0 / math.log(2.0)) + 1.5 * 2.0**52  # rounds to a whole number, in the last bits
    k = shifted - 1.5 * 2.0**52
    r = (x - k * _LN_2_HIGH) - k * _LN_2_LOW
    r2 = r * r
    r4 = r2 * r2
    c = _FACTORIALS
    low = (c[0] + c[1] * r) + (c[2] + c[3] * r) * r2
    middle = (c[4] + c[5] * r) + (c[6] + c[7] * r) * r2
    high = (c[8] + c[9] * r) + (c[10] + c[11] * r) * r2
    series = low + (middle + (high + (c[12] + c[13] * r) * r4) * r4) * r4
    bits = np.float64(shifted).view(np.int64) << np.int64(52)
    return np.int64(np.float64(series).view(np.int64) + bits).view(np.float64)


@kernel
def weights(t: float) -> tuple[float, float, float, float]:
    """Six times the uniform cubic B-splines at t in [0, 1] (de Boor 1978, chapter IX).

    All four with the same operations, zeros and all, so that one vector instruction does four.
    """
    return (
        ((-1.0 * t + 3.0) * t - 3.0) * t + 1.0,
        ((3.0 * t - 6.0) * t + 0.0) * t + 4.0,
        ((-3.0 * t + 3.0) * t + 3.0) * t + 1.0,
        ((1.0 * t + 0.0) * t + 0.0) * t + 0.0,
    )


@kernel
def series_at(table: Array, k: int) -> tuple[float, ...]:
    """Coefficients that begin at k, as a tuple: no later write to an array can change them."""
    c = table
    return (
        (c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], c[k + 6])
        + (c[k + 7], c[k + 8], c[k + 9], c[k + 10], c[k + 11], c[k + 12], c[k + 13])
        + (c[k + 14], c[k + 15], c[k + 16], c[k + 17], c[k + 18], c[k + 19], c[k + 20])
    )


@kernel
def evaluate(c: tuple[float, ...], t: float) -> float:
    """Power series of degree 20 by Estrin's scheme: 7 products deep where Horner's has 20."""
    t2 = t * t
    t4 = t2 * t2
    t8 = t4 * t4
    p0 = (c[0] + c[1] * t) + (c[2] + c[3] * t) * t2
    p1 = (c[4] + c[5] * t) + (c[6] + c[7] * t) * t2
    p2 = (c[8] + c[9] * t) + (c[10] + c[11] * t) * t2
    p3 = (c[12] + c[13] * t) + (c[14] + c[15] * t) * t2
    p4 = (c[16] + c[17] * t) + (c[18] + c[19] * t) * t2 + c[20] * t4
    return (p0 + p1 * t4) + ((p2 + p3 * t4) + p4 * t8) * t8


@kernel
def log_elastic(table: Array, x: float) -> float:
    """Logarithm of w_m at x."""
    return evaluate(series_at(table, HEADER), 2.0 / table[X_MAX] * x - 1.0)


@kernel(inline=True)
def _row_at(table: Array, at: int, row: int) -> Six:
    """Coefficients of a row of the segment in ln k that begins at `at`."""
    k, c = at + ROWS_AT + row * TERMS, table
    return c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5]


@kernel(inline=True)
def _powers(c: Six, t: float) -> float:
    """Polynomial in t."""
    square = t * t
    return (c[0] + c[1] * t) + ((c[2] + c[3] * t) + (c[4] + c[5] * t) * square) * square


@kernel(inline=True)
def _place_in(table: Array, at: int) -> tuple[float, float, float]:
    """Where a segment in ln k ends, its middle, and 2 over its length."""
    low, high = table[at + LOW], table[at + HIGH]
    return high, 0.5 * (low + high), 2.0 / (high - low)


@kernel(inline=True)
def _four_rows(table: Array, at: int, row: int) -> tuple[Six, Six, Six, Six]:
    """Four rows, to be read before a loop: in it the table might be what is written."""
    return (
        _row_at(table, at, row),
        _row_at(table, at, row + 1),
        _row_at(table, at, row + 2),
        _row_at(table, at, row + 3),
    )


@kernel(inline=True)
def _sum_of(c: tuple[Six, Six, Six, Six], z: float, t: float) -> float:
    """Cubic in z whose coefficients are polynomials in t."""
    low, high = _powers(c[0], t) + _powers(c[1], t) * z, _powers(c[2], t) + _powers(c[3], t) * z
    return low + high * (z * z)


@kernel(inline=True)
def _elastic_rows(table: Array, at: int) -> Any:
    """Rows of ln w_m less that of a slow impact."""
    c = _four_rows(table, at, ELASTIC), _four_rows(table, at, ELASTIC + 4)
    return c[0], c[1], _row_at(table, at, ELASTIC + 8), _row_at(table, at, ELASTIC + 9)


@kernel(inline=True)
def _elastic(c: Any, z: float, t: float) -> float:
    """Ln w_m less that of a slow impact, from its rows."""
    fourth = (z * z) * (z * z)
    last = _powers(c[2], t) + _powers(c[3], t) * z
    return _sum_of(c[0], z, t) + (_sum_of(c[1], z, t) + last * fourth) * fourth


class Strength(NamedTuple):
    """What the strength of an impact changes in a lookup."""

    at: int  # entry of its segment
    t: float
    later: float  # ln of the growth of the yield compression
    layer: int  # first of four
    place: float  # within the cell


@kernel
def at_strength(table: Array, strength: float) -> Strength:
    """Look a strength up along the third axis; that of a table without one is all zero."""
    if table[LAYERS] == 0.0:
        return Strength(0, 0.0, 0.0, 0, 0.0)
    at = int(table[STRENGTHS_AT])
    last = at + (int(table[STRENGTHS]) - 1) * STRENGTH
    while at < last and strength > table[at + HIGH]:
        at += STRENGTH
    high, middle, per = _place_in(table, at)
    t, cells = per * (min(strength, high) - middle), table[at + LAYER_CELLS]
    along = (0.5 + 0.5 * t) * cells
    cell = min(int(max(0.0, along)), int(cells) - 1)
    later = _powers(_row_at(table, at, LATER), t)
    return Strength(at, t, later, int(table[at + LAYER]) + cell, along - cell)


@kernel(inline=True)
def layer_weights(at: Strength) -> Four:
    """Six times the weights of the layers at a strength; a table without layers has one."""
    return (6.0, 0.0, 0.0, 0.0) if at.at == 0 else weights(at.place)


@kernel(inline=True)
def strongest(table: Array) -> float:
    """Ln of the largest strength of a table; infinite without a third axis."""
    if table[LAYERS] == 0.0:
        return math.inf
    last = int(table[STRENGTHS_AT]) + (int(table[STRENGTHS]) - 1) * STRENGTH
    most: float = table[last + HIGH] * (1.0 + 1e-12)
    return most


@kernel(inline=True)
def log_strength(slope: float, log_rate: float) -> float:
    """Ln of the strength from that of the rate over the one from which on it grows."""
    return log_and_root(1.0 + slope * max(log_rate, 0.0))[0]


@kernel
def log_elastic_at(table: Array, x: float, strength: Strength) -> float:
    """Logarithm of w_m at x and at a strength."""
    log_w = log_elastic(table, x)
    if strength.at == 0:
        return log_w
    rows = _elastic_rows(table, strength.at)
    return log_w + _elastic(rows, 2.0 / table[X_MAX] * x - 1.0, strength.t)


@kernel(inline=True)
def stretched(table: Array, x: float, strength: Strength) -> float:
    """Factor by which ln chi beyond yield is stretched."""
    if strength.at == 0:
        return 1.0
    rows = _four_rows(table, strength.at, STRETCHED)
    return _sum_of(rows, 2.0 / table[X_MAX] * x - 1.0, strength.t)


@kernel(inline=True)
def like(log_chi: float, factor: float) -> float:
    """Ln chi, stretched by a factor beyond yield."""
    return log_chi * factor if log_chi > 0.0 else log_chi


@kernel(cache=True)
def yield_ratios(table: Array, log_chi: Array, out: Outcome) -> None:
    """Write the yield ratios of impacts inside the table from their ln chi."""
    for n in range(log_chi.size):
        x = out.inelasticity[n] / (out.inelasticity[n] + table[STRETCH])
        log_w = log_elastic_at(table, x, at_strength(table, out.strength[n]))
        out.yield_ratio[n] = math.exp(log_w - log_chi[n])


@kernel(cache=True)
def log_elastic_compression(table: Array, lam: float, strength: float) -> float:
    """Logarithm of w_m at an inelasticity inside the table."""
    return log_elastic_at(table, lam / (lam + table[STRETCH]), at_strength(table, strength))


@kernel(inline=True)
def _along(log_chi: float, low: float, per_log: float, cells: float, graded: float) -> float:
    """Place along ln chi in a segment that begins at `low`, in cells."""
    place = max(0.0, log_chi - low) * per_log
    return math.sqrt(place * cells) if graded > 0.0 else place


@kernel
def _start(table: Array, block: int, t: float) -> float:
    """Ln chi of the kink at which a segment begins, at t = 2 x/x_max - 1."""
    line = int(table[block + LINE])
    return table[block + START] if line == 0 else evaluate(series_at(table, line), t)


@kernel
def locate(table: Array, x: float, log_chi: float) -> tuple[int, int, float, float]:
    """Row and column of the first of 4 x 4 coefficients, and the place within the cell."""
    t = 2.0 / table[X_MAX] * x - 1.0
    block, last = BLOCKS, BLOCKS + (int(table[SEGMENTS]) - 1) * BLOCK
    low = table[block + START]
    while block < last:
        high = _start(table, block + BLOCK, t)
        if not log_chi > high:
            break
        block, low = block + BLOCK, high
    per_log, cells = table[block + PER_LOG], table[block + CELLS]
    if table[CURVED] > 0.0:
        high = table[block + END] if block == last else _start(table, block + BLOCK, t)
        per_log = cells / (high - low)
    along = _along(log_chi, low, per_log, cells, table[block + GRADED])
    across = x * table[NODES_PER_X]
    # rounding may put a point on a curved kink a little into the next segment
    row, cell = int(across), min(int(along), int(cells))
    return row, int(table[block + COLUMN]) + cell, across - row, along - cell


@kernel
def locate_all(table: Array, x: Array, log_chi: Array, first: Integers, along: Array, low: Array, high: Array) -> None:
    """`locate` for many places, in loops of one operation that become vector instructions.

    `first` gets row times columns + column, `x` and `along` the places within the cell. `low` and
    `high` are scratch.
    """
    n, scale = x.size, 2.0 / table[X_MAX]
    for k in range(int(table[SEGMENTS])):
        block = BLOCKS + k * BLOCK
        start, per_log = table[block + START], table[block + PER_LOG]
        cells, graded = table[block + CELLS], table[block + GRADED]
        column = np.int32(table[block + COLUMN])
        line = int(table[block + LINE])
        if line > 0:
            series = series_at(table, line)
            for i in range(n):
                low[i] = evaluate(series, scale * x[i] - 1.0)
        else:
            for i in range(n):
                low[i] = start
        next_line = int(table[block + BLOCK + LINE]) if k + 1 < int(table[SEGMENTS]) else 0
        if next_line > 0:
            series = series_at(table, next_line)
            for i in range(n):
                high[i] = cells / (evaluate(series, scale * x[i] - 1.0) - low[i])
        elif line > 0:
            for i in range(n):
                high[i] = cells / (table[block + END] - low[i])
        else:
            for i in range(n):
                high[i] = per_log
        if graded > 0.0:
            for i in range(n):
                place = math.sqrt(max(0.0, log_chi[i] - low[i]) * high[i] * cells)
                cell = np.int32(min(place, cells))
                here = (log_chi[i] > low[i]) | (k == 0)
                along[i] = place - cell if here else along[i]
                first[i] = column + cell if here else first[i]
        else:
            for i in range(n):
                place = max(0.0, log_chi[i] - low[i]) * high[i]
                cell = np.int32(min(place, cells))
                here = (log_chi[i] > low[i]) | (k == 0)
                along[i] = place - cell if here else along[i]
                first[i] = column + cell if here else first[i]
    nodes_per_x, columns = table[NODES_PER_X], np.int32(table[COLUMNS])
    for i in range(n):
        across = x[i] * nodes_per_x
        row = np.int32(across)
        x[i] = across - row
        first[i] += row * columns


@kernel(inline=True)
def _flat(table: Array, p: np.uint64, step: np.uint64, s: float, t: float) -> float:
    """One field from its 16 coefficients, which begin at p; four along ln chi are in one vector.

    Indices are unsigned: no test for a negative one.
    """
    a0, a1, a2, a3 = weights(s)
    b0, b1, b2, b3 = weights(t)
    q = p + step
    r = q + step
    o = r + step
    i, j, k = np.uint64(1), np.uint64(2), np.uint64(3)
    c0 = a0 * table[p] + a1 * table[q] + a2 * table[r] + a3 * table[o]
    c1 = a0 * table[p + i] + a1 * table[q + i] + a2 * table[r + i] + a3 * table[o + i]
    c2 = a0 * table[p + j] + a1 * table[q + j] + a2 * table[r + j] + a3 * table[o + j]
    c3 = a0 * table[p + k] + a1 * table[q + k] + a2 * table[r + k] + a3 * table[o + k]
    value: float = (b0 * c0 + b1 * c1 + b2 * c2 + b3 * c3) * (1.0 / 36.0)
    return value


@kernel(inline=True)
def _four(table: Array, p: np.uint64, step: np.uint64, b: Four) -> Four:
    """Sum along ln chi for four layers, whose coefficients lie side by side."""
    q = p + step
    r = q + step
    o = r + step
    i, j, k = np.uint64(1), np.uint64(2), np.uint64(3)
    return (
        b[0] * table[p] + b[1] * table[q] + b[2] * table[r] + b[3] * table[o],
        b[0] * table[p + i] + b[1] * table[q + i] + b[2] * table[r + i] + b[3] * table[o + i],
        b[0] * table[p + j] + b[1] * table[q + j] + b[2] * table[r + j] + b[3] * table[o + j],
        b[0] * table[p + k] + b[1] * table[q + k] + b[2] * table[r + k] + b[3] * table[o + k],
    )


@kernel(inline=True)
def _field(table: Array, p: np.uint64, row: np.uint64, column: np.uint64, s: float, t: float, place: float) -> float:
    """One field of a table with layers, from its 64 coefficients, which begin at p."""
    a, b, w = weights(s), weights(t), weights(place)
    c, d = _four(table, p, column, b), _four(table, p + row, column, b)
    e, f = _four(table, p + row + row, column, b), _four(table, p + row + row + row, column, b)
    four = (
        w[0] * (a[0] * c[0] + a[1] * d[0] + a[2] * e[0] + a[3] * f[0]),
        w[1] * (a[0] * c[1] + a[1] * d[1] + a[2] * e[1] + a[3] * f[1]),
        w[2] * (a[0] * c[2] + a[1] * d[2] + a[2] * e[2] + a[3] * f[2]),
        w[3] * (a[0] * c[3] + a[1] * d[3] + a[2] * e[3] + a[3] * f[3]),
    )
    return ((four[0] + four[1]) + (four[2] + four[3])) * (1.0 / 216.0)


@kernel(inline=True)
def _share(value: float) -> float:
    """COR from its spline, which may pass 1 by its error: engines refuse that."""
    return min(max(value, 0.0), 1.0)


@kernel(inline=True)
def is_valid(speed: float, radius: float, thickness: float) -> bool:
    """Whether an impact is in its limits; without a branch, so that loops become vectors."""
    valid = (speed >= V_MIN) & (speed <= V_MAX) & (thickness >= R_MIN)
    return valid & (radius >= R_MIN) & (radius <= R_MAX) & (THINNEST * radius <= thickness)


class _Contact(NamedTuple):
    """What plate, frequency and mass make of an impact."""

    x: float
    stiffer: float  # to be taken from ln chi
    root: float  # V^(1/5) exp(eta) g^(2/5) over mass^(2/5)


@kernel(inline=True)
def _contact(
    plate: PlateConstants,
    stretch: float,
    log_speed: float,
    root: float,
    radius: float,
    thickness: float,
    mass: float,
    later: float,
    thin: bool,
    usual: bool,
) -> _Contact:
    """Coordinate x of an impact, and what is to be taken from ln chi.

    Loops over many impacts say of all of them whether the plate is thin and whether they are usual,
    without losses and of a solid sphere: then they become vector instructions.
    """
    stiffer, slower = later, 1.0
    if not usual:
        pair = of_mass(PairConstants(plate, 1.0, 1.0, 1.0), mass)
        plate, slower = pair.plate, pair.time
        stiffer -= math.log(slower)
        if relaxes(plate):
            log_time = log_and_root(radius)[0] - 0.2 * log_speed + math.log(slower)
            plate, root, growth = relaxed(plate, root, log_time)
            stiffer += (0.4 + plate.growth.yield_power) * growth
    if thin:  # one division: lam/(lam + c) with lam = c_lam V^(1/5) (R/H)^2
        above = plate.inelasticity * root * radius * radius
        x = above / (above + stretch * (thickness * thickness))
        return _Contact(x, stiffer, root / slower)
    ratio = radius / thickness
    eta = plate_stiffening(plate, root, ratio)
    factor = exp(eta)
    lam = inelasticity_of(plate, root, ratio, factor)
    return _Contact(lam / (lam + stretch), stiffer + eta, root * factor / slower)


class Place(NamedTuple):
    """Place of an impact in a table."""

    x: float  # NaN for bad input, and outside the table
    log_chi: float  # of the slow impact like it
    strength: float
    layer: int
    between: float


_NOWHERE = Place(math.nan, math.nan, 0.0, 0, 0.0)


@kernel
def place_of(table: Array, speed: float, radius: float, thickness: float, mass: float) -> Place:
    """Place of an impact in the table; NaN where the speed is not in its limits, and outside."""
    if not V_MIN <= speed <= V_MAX:
        return _NOWHERE
    log_speed, root = log_and_root(speed)
    plate, strength = plate_of(table), 0.0
    if table[LAYERS] > 0.0:
        log_rate = table[LOG_RATE] + RATE_POWER * log_speed - log_and_root(radius)[0]
        strength = log_strength(table[RATE], log_rate)
    at = at_strength(table, strength)
    if table[LAYERS] > 0.0:
        plate = with_saturation(plate, plate.saturated * exp(0.25 * at.later))
    usual = not relaxes(plate) and mass == 1.0
    one = _contact(
        plate, table[STRETCH], log_speed, root, radius, thickness, mass, at.later, is_thin(plate.corrections), usual
    )
    if not 0.0 <= one.x <= table[X_MAX]:
        return _NOWHERE
    log_chi = table[C_CHI] + (0.8 * log_speed - one.stiffer) + log_elastic_at(table, one.x, at)
    log_chi = like(log_chi, stretched(table, one.x, at))
    if not (log_chi <= table[LOG_CHI_MAX] and strength <= strongest(table)):
        return _NOWHERE
    return Place(one.x, log_chi, strength, at.layer, at.place)


@kernel
def field_at(table: Array, at: Place, field: int) -> float:
    """Value of a field at a place in the table."""
    row, column, s, t = locate(table, at.x, at.log_chi)
    step, layers, p = int(table[COLUMNS]), int(table[LAYERS]), int(table[COR_AT])
    p += field * (int(table[OTHERS_AT]) - p)
    if layers == 0:
        return _flat(table, np.uint64(p + row * step + column), np.uint64(step), s, t)
    p += layers * (row * step + column) + at.layer
    rows, columns = np.uint64(layers * step), np.uint64(layers)
    return _field(table, np.uint64(p), rows, columns, s, t, at.between)


@kernel
def cor_at(table: Array, at: Place) -> float:
    """COR at a place in the table."""
    return _share(field_at(table, at, 0))


@kernel(cache=True)
def restitution_on_plate(table: Array, speed: float, radius: float, thickness: float, mass: float) -> float:
    """COR of one sphere on a plate; NaN for bad input and outside the table.

    The mass is over that of a solid sphere.
    """
    if not is_valid(speed, radius, thickness):
        return math.nan
    at = place_of(table, speed, radius, thickness, mass)
    return cor_at(table, at) if at.x == at.x else math.nan


@kernel(cache=True)
def solid_on_plate(table: Array, speed: float, radius: float, thickness: float) -> float:
    """`restitution_on_plate` of a solid sphere."""
    return restitution_on_plate(table, speed, radius, thickness, 1.0)


@kernel
def _grow(table: Array, strength: Array, later: Array) -> None:
    """Ln of the growth of the yield compression of many impacts."""
    for n in range(int(table[STRENGTHS])):
        at = int(table[STRENGTHS_AT]) + n * STRENGTH
        low, rows, (high, middle, per) = table[at], _row_at(table, at, LATER), _place_in(table, at)
        for i in range(later.size):
            value = _powers(rows, per * (min(strength[i], high) - middle))
            later[i] = value if (strength[i] > low) | (n == 0) else later[i]


@kernel
def _add_elastic(table: Array, strength: Array, x: Array, more: Array, log_w: Array) -> None:
    """`log_elastic_at` of many impacts, from their `log_elastic`; `more` is scratch."""
    scale = 2.0 / table[X_MAX]
    for n in range(int(table[STRENGTHS])):
        at = int(table[STRENGTHS_AT]) + n * STRENGTH
        low, rows, (high, middle, per) = table[at], _elastic_rows(table, at), _place_in(table, at)
        for i in range(x.size):
            t = per * (min(strength[i], high) - middle)
            value = _elastic(rows, scale * x[i] - 1.0, t)
            more[i] = value if (strength[i] > low) | (n == 0) else more[i]
    for i in range(x.size):
        log_w[i] += more[i]


@kernel
def _stretch(table: Array, strength: Array, x: Array, factor: Array, log_chi: Array) -> None:
    """Stretch ln chi of many impacts beyond yield; `factor` is scratch."""
    scale = 2.0 / table[X_MAX]
    for n in range(int(table[STRENGTHS])):
        at = int(table[STRENGTHS_AT]) + n * STRENGTH
        low, (high, middle, per) = table[at], _place_in(table, at)
        rows = _four_rows(table, at, STRETCHED)
        for i in range(x.size):
            t = per * (min(strength[i], high) - middle)
            value = _sum_of(rows, scale * x[i] - 1.0, t)
            factor[i] = value if (strength[i] > low) | (n == 0) else factor[i]
    for i in range(x.size):
        log_chi[i] = like(log_chi[i], factor[i])


@kernel
def _locate_layers(table: Array, strength: Array, first: Integers, layer: Integers, place: Array) -> None:
    """Turn indices in a table without layers into those with, and find places between layers."""
    for n in range(int(table[STRENGTHS])):
        at = int(table[STRENGTHS_AT]) + n * STRENGTH
        low, high, cells = table[at + LOW], table[at + HIGH], table[at + LAYER_CELLS]
        per, begins = cells / (high - low), np.int32(table[at + LAYER])
        for i in range(first.size):
            along = max(0.0, per * (min(strength[i], high) - low))
            cell = np.int32(min(along, cells - 1.0))
            here = (strength[i] > low) | (n == 0)
            place[i] = along - cell if here else place[i]
            layer[i] = begins + cell if here else layer[i]
    layers = np.int32(table[LAYERS])
    for i in range(first.size):
        first[i] = first[i] * layers + layer[i]


@kernel
def _coordinates(
    table: Array,
    speed: Array,
    radius: Array,
    thickness: Array,
    mass: Array,
    x: Array,
    log_chi: Array,
    log_w: Array,
    root: Array,
    strength: Array,
    later: Array,
    more: Array,
) -> None:
    """Coordinates of impacts as `place_of` has them, and root as in `_Contact`.

    `later` and `more` are scratch.
    """
    stretch, scale, rated = table[STRETCH], 2.0 / table[X_MAX], table[LAYERS] > 0.0
    for i in range(x.size):
        log_chi[i], root[i] = log_and_root(speed[i])
    if rated:
        rate, log_rate = table[RATE], table[LOG_RATE]
        for i in range(x.size):
            later[i] = RATE_POWER * log_chi[i] - log_and_root(radius[i])[0]
        for i in range(x.size):
            strength[i] = log_strength(rate, log_rate + later[i])
        _grow(table, strength, later)
    plate = plate_of(table)
    thin, usual = is_thin(plate.corrections), not relaxes(plate) and mass.size == 0
    if usual and not rated and thin:
        for i in range(x.size):
            x[i] = _contact(plate, stretch, 0.0, root[i], radius[i], thickness[i], 1.0, 0.0, True, True).x
    elif usual and not rated:
        for i in range(x.size):
            one = _contact(plate, stretch, 0.0, root[i], radius[i], thickness[i], 1.0, 0.0, False, True)
            x[i], root[i] = one.x, one.root
            log_chi[i] -= 1.25 * one.stiffer  # times 0.8 below, as ln V is
    elif usual and not thin:
        for i in range(x.size):
            own = with_saturation(plate, plate.saturated * exp(0.25 * later[i]))
            one = _contact(own, stretch, 0.0, root[i], radius[i], thickness[i], 1.0, later[i], False, True)
            x[i], root[i] = one.x, one.root
            log_chi[i] -= 1.25 * one.stiffer
    else:
        for i in range(x.size):
            grown = later[i] if rated else 0.0
            own = with_saturation(plate, plate.saturated * exp(0.25 * grown))
            one = _contact(
                own,
                stretch,
                log_chi[i],
                root[i],
                radius[i],
                thickness[i],
                mass[i] if mass.size > 0 else 1.0,
                grown,
                thin,
                False,
            )
            x[i], root[i] = one.x, one.root
            log_chi[i] -= 1.25 * one.stiffer
    series, c_chi = series_at(table, HEADER), table[C_CHI]
    for i in range(x.size):
        log_w[i] = evaluate(series, scale * x[i] - 1.0)
    if rated:
        _add_elastic(table, strength, x, more, log_w)
    for i in range(x.size):
        log_chi[i] = c_chi + 0.8 * log_chi[i] + log_w[i]


@kernel
def _are_inside(
    table: Array,
    speed: Array,
    radius: Array,
    thickness: Array,
    x: Array,
    log_chi: Array,
    strength: Array,
    outside: Array,
) -> bool:
    """Whether all impacts are valid and in the table; those that are not get coordinates of 0.

    `outside` is NaN for them, and is written only if there are some.
    """
    x_max, log_chi_max, most = table[X_MAX], table[LOG_CHI_MAX], strongest(table)
    good = 0
    for i in range(x.size):
        valid = is_valid(speed[i], radius[i], thickness[i]) & (x[i] >= 0.0) & (x[i] <= x_max)
        good += valid & (log_chi[i] <= log_chi_max) & (strength[i] <= most)
    if good == x.size:
        return True
    for i in range(x.size):
        valid = is_valid(speed[i], radius[i], thickness[i]) & (x[i] >= 0.0) & (x[i] <= x_max)
        if valid & (log_chi[i] <= log_chi_max) & (strength[i] <= most):
            outside[i] = 0.0
        else:
            x[i], log_chi[i], strength[i], outside[i] = 0.0, 0.0, 0.0, math.nan
    return False


@kernel(inline=True)
def _slice(values: Array, start: int, count: int) -> Array:
    """Part of an array; one kernel for all slices, since each is slow to compile."""
    return values[start : start + count]


@kernel(inline=True)
def _row(scratch: Array, row: int, count: int) -> Array:
    """First `count` numbers of a row of scratch memory."""
    return scratch[row, :count]


@kernel(cache=True)
def restitutions(table: Array, speed: Array, radius: Array, thickness: Array, mass: Array, out: Array) -> int:
    """Write the COR of many spheres on plates into out; return how many are NaN.

    Masses are over those of solid spheres; without any, all spheres are.
    """
    scratch, cells = np.zeros((7, _CHUNK)), np.empty((2, _CHUNK), dtype=np.int32)
    p, columns, layers = int(table[COR_AT]), int(table[COLUMNS]), int(table[LAYERS])
    step, row, column = np.uint64(columns), np.uint64(columns * layers), np.uint64(layers)
    bad = 0
    for start in range(0, out.size, _CHUNK):
        n = min(_CHUNK, out.size - start)
        v, r, h = _slice(speed, start, n), _slice(radius, start, n), _slice(thickness, start, n)
        m, values = _slice(mass, start, n), _slice(out, start, n)
        x, log_chi, along = _row(scratch, 0, n), _row(scratch, 1, n), _row(scratch, 2, n)
        a, b, outside = _row(scratch, 3, n), _row(scratch, 4, n), _row(scratch, 5, n)
        strength, first = _row(scratch, 6, n), cells[0, :n]
        _coordinates(table, v, r, h, m, x, log_chi, a, along, strength, b, outside)
        if layers > 0:
            _stretch(table, strength, x, a, log_chi)
        inside = _are_inside(table, v, r, h, x, log_chi, strength, outside)
        locate_all(table, x, log_chi, first, along, a, b)
        if layers > 0:
            _locate_layers(table, strength, first, cells[1, :n], a)
            for i in range(n):
                at = np.uint64(p + first[i])
                values[i] = _share(_field(table, at, row, column, x[i], along[i], a[i]))
        else:
            for i in range(n):
                values[i] = _share(_flat(table, np.uint64(p + first[i]), step, x[i], along[i]))
        if not inside:
            for i in range(n):
                values[i] += outside[i]
                bad += values[i] != values[i]
    return bad


@kernel(cache=True)
def outcomes(
    table: Array, speed: Array, radius: Array, thickness: Array, mass: Array, out: Outcome, root: Array
) -> int:
    """Write all fields of valid impacts on plates; return how many are NaN, being outside.

    V^(1/5) exp(eta) g^(2/5), over the mass to the power 2/5, goes into root.
    """
    scratch, cells = np.zeros((9, _CHUNK)), np.empty((2, _CHUNK), dtype=np.int32)
    p, columns, layers = int(table[COR_AT]), int(table[COLUMNS]), int(table[LAYERS])
    row, column = np.uint64(columns * max(layers, 1)), np.uint64(layers)
    step = np.uint64(int(table[OTHERS_AT]) - p)  # from field to field
    stretch, lowest = table[STRETCH], table[BLOCKS + START]
    bad = 0
    for start in range(0, speed.size, _CHUNK):
        n = min(_CHUNK, speed.size - start)
        v, r, h = _slice(speed, start, n), _slice(radius, start, n), _slice(thickness, start, n)
        m, roots = _slice(mass, start, n), _slice(root, start, n)
        x, log_chi, along = _row(scratch, 0, n), _row(scratch, 1, n), _row(scratch, 2, n)
        log_w, a, b = _row(scratch, 3, n), _row(scratch, 4, n), _row(scratch, 5, n)
        outside, strength, own = _row(scratch, 6, n), _row(scratch, 7, n), _row(scratch, 8, n)
        first = cells[0, :n]
        _coordinates(table, v, r, h, m, x, log_chi, log_w, roots, strength, a, b)
        for i in range(n):  # x = lam/(lam + stretch), chi = w_m/y
            out.inelasticity[start + i] = stretch * x[i] / (1.0 - x[i])
        for i in range(n):
            known = log_chi[i] > -math.inf  # else no body yields
            out.yield_ratio[start + i] = exp(log_w[i] - log_chi[i]) if known else math.inf
        for i in range(n):
            out.strength[start + i] = strength[i]
        for i in range(n):
            own[i] = log_chi[i]
        if layers > 0:
            _stretch(table, strength, x, a, log_chi)
        inside = _are_inside(table, v, r, h, x, log_chi, strength, outside)
        locate_all(table, x, log_chi, first, along, a, b)
        # no call that takes `out`: passing a tuple of arrays on costs reference counts each time
        if layers > 0:
            _locate_layers(table, strength, first, cells[1, :n], a)
            for i in range(n):
                at, s, t, k = np.uint64(p + first[i]), x[i], along[i], a[i]
                out.restitution[start + i] = _share(_field(table, at, row, column, s, t, k))
                out.contact_time[start + i] = _field(table, at + step, row, column, s, t, k)
                out.wave_rate[start + i] = _field(table, at + step + step, row, column, s, t, k)
                growth = _field(table, at + step + step + step, row, column, s, t, k)
                own[i] = (growth - 1.0) * max(own[i], lowest)
        else:
            for i in range(n):
                at, s, t = np.uint64(p + first[i]), x[i], along[i]
                out.restitution[start + i] = _share(_flat(table, at, row, s, t))
                out.contact_time[start + i] = _flat(table, at + step, row, s, t)
                out.wave_rate[start + i] = _flat(table, at + step + step, row, s, t)
                growth = _flat(table, at + step + step + step, row, s, t)
                own[i] = (growth - 1.0) * max(own[i], lowest)
        for i in range(n):
            out.elastic_compression[start + i] = exp(log_w[i])
        for i in range(n):
            out.compression_ratio[start + i] = exp(own[i])
        if not inside:
            for i in range(n):
                if outside[i] != 0.0:
                    _write_nan(out, start + i)
                    bad += 1
    return bad


@kernel(inline=True)
def _write_nan(out: Outcome, n: int) -> None:
    """Write NaN for the fields of impact n."""
    out.restitution[n] = out.contact_time[n] = out.wave_rate[n] = math.nan
    out.compression_ratio[n] = out.elastic_compression[n] = math.nan


@kernel(cache=True)
def fields(table: Array, clamp: bool, out: Outcome) -> int:
    """Write fields at the inelasticities, yield ratios and strengths of `out`; count those outside.

    Outside the table fields are NaN, unless `clamp` takes the nearest point of its border, and
    puts that point's coordinates in place of the impact's.
    """
    outside, x_max, log_chi_max, most = 0, table[X_MAX], table[LOG_CHI_MAX], strongest(table)
    lowest = table[BLOCKS + START]
    for n in range(out.inelasticity.size):
        x = out.inelasticity[n] / (out.inelasticity[n] + table[STRETCH])
        inside_x = x if 0.0 <= x <= x_max else x_max  # also where lambda is infinite
        strength = min(out.strength[n], most)
        at = at_strength(table, strength)
        log_w = log_elastic_at(table, inside_x, at)
        own = log_w - math.log(out.yield_ratio[n])
        factor = stretched(table, inside_x, at)
        log_chi = like(own, factor)
        inside_chi = log_chi if log_chi <= log_chi_max else log_chi_max
        if not (inside_x == x and inside_chi == log_chi and strength == out.strength[n]):
            outside += 1
            if not clamp:
                _write_nan(out, n)
                continue
            own = like(inside_chi, 1.0 / factor)
            out.inelasticity[n] = inside_x * table[STRETCH] / (1.0 - inside_x)
            out.yield_ratio[n], out.strength[n] = math.exp(log_w - own), strength
        place = Place(inside_x, inside_chi, strength, at.layer, at.place)
        out.restitution[n] = _share(field_at(table, place, 0))
        out.contact_time[n] = field_at(table, place, 1)
        out.wave_rate[n] = field_at(table, place, 2)
        growth = field_at(table, place, 3)
        out.compression_ratio[n] = math.exp((growth - 1.0) * max(own, lowest))
        out.elastic_compression[n] = math.exp(log_w)
    return outside


@kernel(cache=True)
def yield_speeds(table: Array, c_chi: float, radius: Array, thickness: Array, out: Array) -> None:
    """Write the speeds at which chi = 1 into out; NaN where lambda leaves the table before.

    c_chi is that of the body that yields first. d(ln chi)/d(ln V) lies between 2/3 and 4/5, so a
    step with slope 3/4 contracts by 0.12 at least; with losses it is up to 1, and a step contracts
    by 0.33.
    """
    plate = plate_of(table)
    for n in range(out.size):
        log_speed, x = -1.25 * c_chi, math.nan
        for _ in range(60):  # 0.12^30 and 0.33^60 are far below rounding
            one = _contact(
                plate,
                table[STRETCH],
                log_speed,
                math.exp(0.2 * log_speed),
                radius[n],
                thickness[n],
                1.0,
                0.0,
                is_thin(plate.corrections),
                not relaxes(plate),
            )
            x = one.x
            if not 0.0 <= x <= table[X_MAX]:
                break
            log_chi = c_chi - one.stiffer + 0.8 * log_speed + log_elastic(table, x)
            log_speed -= log_chi / 0.75
        out[n] = math.exp(log_speed) if 0.0 <= x <= table[X_MAX] else math.nan
