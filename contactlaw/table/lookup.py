"""Interpolation in the table: the kernels that read its splines.

A table holds functions of the inelasticity lambda and of ln chi, the logarithm of the overload, on
the nodes that `contactlaw.table.grid` places. Splines are kept as coefficients of uniform cubic
B-splines, two more than there are nodes: they need the least memory, and a table that stays in the
CPU's cache is a fast one. Below the first segment the values at its beginning hold. With x =
lambda/(lambda + c), ln w_m is a polynomial in x, and so is ln chi along each curved kink, one that
is not a line of constant chi.

All of it is packed into one array of float64, because a kernel that takes one array and a few
numbers is called from Python in a third of a microsecond. The array begins with a header:

    STRETCH      c                        SEGMENTS   number of segments n
    X_MAX        x of the largest lambda  CURVED     1 if there are curved kinks
    LOG_CHI_MAX  largest ln chi           COR_AT     where the coefficients of COR begin
    NODES_PER_X  1/(distance of nodes)    OTHERS_AT  where those of the other fields begin
    COLUMNS      coefficients in a row    TRANSIT on   of the plate, see `PlateConstants`

then, at HEADER, the polynomial's coefficients, n blocks and the polynomials of curved kinks:

    START, END   ln chi at lambda = 0     COLUMN     first column of coefficients
    PER_LOG      cells per unit of ln chi GRADED     1 if nodes are uniform in the root
    CELLS        nodes less one           LINE       where the polynomial of the start is, or 0

Legend: v speed, lam inelasticity, chi overload, w_m largest elastic compression [V0 T_H]. Powers:
lam = c_lam V^(1/5) (R/H)^2, ln chi = c_chi + (4/5) ln V + ln w_m; the two constants belong to a
pair of materials and a law, `contactlaw.physical.scaling` has them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation.corrections import PlateCorrections, is_thin
from contactlaw.equation.numbers import (
    NO_RATE,
    ModulusGrowth,
    PlateConstants,
    inelasticity_of,
    plate_stiffening,
    relaxed,
    relaxes,
)
from contactlaw.equation.outcome import Outcome

Array = NDArray[np.float64]
Integers = NDArray[np.int32]

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
SEGMENTS, CURVED, COR_AT, OTHERS_AT, TRANSIT, REACH, SATURATED, WAVES = range(5, 13)
GROWTH = WAVES + len(PlateCorrections._fields)
HEADER = GROWTH + len(ModulusGrowth._fields)  # where the series of ln w_m begins
DEGREE = 20  # degree of ln w_m in x: within 4e-12 at the nodes
START, END, PER_LOG, CELLS, COLUMN, GRADED, LINE, BLOCK = range(8)
BLOCKS = HEADER + DEGREE + 1
_CHUNK = 512  # impacts at a time: the scratch arrays stay in the first-level cache


def with_plate(table: Array, plate: PlateConstants) -> Array:
    """Copy a table and put in the corrections of a plate; the paper's dashpot needs no copy."""
    if is_thin(plate.corrections):
        return table
    table = table.copy()
    table[TRANSIT:WAVES] = plate.transit, plate.x_at_one, plate.saturated
    table[WAVES:GROWTH] = plate.corrections
    # x_at_one is the root of T_H of a sphere of 1 m at 1 m/s
    return with_growth(table, plate.growth, 2.0 * math.log(plate.x_at_one))


def with_growth(table: Array, growth: ModulusGrowth, log_time: float) -> Array:
    """Copy a table and put in the growth of moduli, and ln T_H at 1 m/s of a radius of 1."""
    table = table.copy()
    table[GROWTH:HEADER] = growth._replace(log_time=growth.log_time - log_time)
    return table


@kernel
def plate_of(table: Array, c_lam: float) -> PlateConstants:
    """Read the constants of the plate; `log_time` is for T_H of a sphere of 1 m at 1 m/s as 1."""
    w, k, r = table, WAVES, GROWTH
    corrections = PlateCorrections(
        w[k], w[k + 1], w[k + 2], w[k + 3], w[k + 4], w[k + 5],
        w[k + 6], w[k + 7], w[k + 8], w[k + 9], w[k + 10],
    )  # fmt: skip
    growth = ModulusGrowth(w[r], w[r + 1], w[r + 2], w[r + 3], w[r + 4], w[r + 5])
    return PlateConstants(c_lam, w[TRANSIT], w[REACH], w[SATURATED], corrections, growth, NO_RATE)


def lam_max(table: Array) -> float:
    """Largest inelasticity of a table."""
    return float(table[STRETCH] * table[X_MAX] / (1.0 - table[X_MAX]))


def chi_max(table: Array) -> float:
    """Largest overload of a table."""
    return math.exp(table[LOG_CHI_MAX])


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
    shifted = (
        x * (1.0 / math.log(2.0)) + 1.5 * 2.0**52
    )  # rounds to a whole number, in the last bits
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


@kernel(cache=True)
def log_elastic_compression(table: Array, lam: float) -> float:
    """Logarithm of w_m at an inelasticity inside the table."""
    return log_elastic(table, lam / (lam + table[STRETCH]))


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
def locate_all(
    table: Array, x: Array, log_chi: Array, first: Integers, along: Array, low: Array, high: Array
) -> None:
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
def _cor(table: Array, p: np.uint64, step: np.uint64, s: float, t: float) -> float:
    """COR from its 16 coefficients, which begin at p; four along ln chi share each instruction.

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
    return min(max(value, 0.0), 1.0)  # the spline may pass 1 by its error, and engines refuse that


_U = tuple(np.uint64(n) for n in range(12))  # indices need no test for negative ones


class _Others(NamedTuple):
    """Fields of a table other than COR."""

    contact_time: float
    wave_rate: float
    growth: float  # p in d_m/d_Y = chi^p, see `contactlaw.table.splines`


@kernel
def _other_fields(table: Array, p: np.uint64, s: float, t: float) -> _Others:
    """Contact time [T_H], wave rate and growth; their coefficients begin at p."""
    a, (b0, b1, b2, b3) = weights(s), weights(t)
    time = wave = ratio = 0.0
    step = np.uint64(3 * int(table[COLUMNS]))
    for k in range(4):
        time += a[k] * (
            (b0 * table[p] + b1 * table[p + _U[3]])
            + (b2 * table[p + _U[6]] + b3 * table[p + _U[9]])
        )
        wave += a[k] * (
            (b0 * table[p + _U[1]] + b1 * table[p + _U[4]])
            + (b2 * table[p + _U[7]] + b3 * table[p + _U[10]])
        )
        ratio += a[k] * (
            (b0 * table[p + _U[2]] + b1 * table[p + _U[5]])
            + (b2 * table[p + _U[8]] + b3 * table[p + _U[11]])
        )
        p += step
    return _Others(time / 36.0, wave / 36.0, ratio / 36.0)


@kernel
def _write_fields(
    table: Array, first: int, s: float, t: float, log_chi: float, log_w: float, out: Outcome, n: int
) -> None:
    """Write the fields of impact n, from the 4 x 4 coefficients that begin at `first`."""
    step = int(table[COLUMNS])
    out.restitution[n] = _cor(table, np.uint64(int(table[COR_AT]) + first), np.uint64(step), s, t)
    others = _other_fields(table, np.uint64(int(table[OTHERS_AT]) + 3 * first), s, t)
    out.contact_time[n] = others.contact_time
    out.wave_rate[n] = others.wave_rate
    lowest = table[BLOCKS + START]
    out.compression_ratio[n] = math.exp((others.growth - 1.0) * max(log_chi, lowest))
    out.elastic_compression[n] = math.exp(log_w)


@kernel
def _write_nan(out: Outcome, n: int) -> None:
    """Write NaN for the fields of impact n."""
    out.restitution[n] = out.contact_time[n] = out.wave_rate[n] = math.nan
    out.compression_ratio[n] = out.elastic_compression[n] = math.nan


@kernel(inline=True)
def is_valid(speed: float, radius: float, thickness: float) -> bool:
    """Whether an impact is in its limits; without a branch, so that loops become vectors."""
    valid = (speed >= V_MIN) & (speed <= V_MAX) & (thickness >= R_MIN)
    return valid & (radius >= R_MIN) & (radius <= R_MAX) & (THINNEST * radius <= thickness)


@kernel
def place_of(
    table: Array, c_lam: float, c_chi: float, speed: float, radius: float, ratio: float
) -> tuple[float, float]:
    """Place of an impact in the table, x and ln chi; NaN as in `restitution`."""
    if not V_MIN <= speed <= V_MAX:
        return math.nan, math.nan
    log_speed, root = log_and_root(speed)
    plate, stiffer = plate_of(table, c_lam), 1.0
    if relaxes(plate):
        plate, root, growth = relaxed(plate, root, log_and_root(radius)[0] - 0.2 * log_speed)
        c_chi -= (0.4 + plate.growth.yield_power) * growth
    if not is_thin(plate.corrections):
        eta = plate_stiffening(plate, root, ratio)
        stiffer = exp(eta)
        c_chi -= eta
    lam = inelasticity_of(plate, root, ratio, stiffer)
    x = lam / (lam + table[STRETCH])
    if not 0.0 <= x <= table[X_MAX]:
        return math.nan, math.nan
    log_chi = c_chi + 0.8 * log_speed + log_elastic(table, x)
    if not log_chi <= table[LOG_CHI_MAX]:
        return math.nan, math.nan
    return x, log_chi


@kernel
def cor_at(table: Array, x: float, log_chi: float) -> float:
    """COR at a place in the table."""
    row, column, s, t = locate(table, x, log_chi)
    step = int(table[COLUMNS])
    first = int(table[COR_AT]) + row * step + column
    return _cor(table, np.uint64(first), np.uint64(step), s, t)


@kernel(cache=True)
def restitution(
    table: Array, c_lam: float, c_chi: float, speed: float, radius: float, ratio: float
) -> float:
    """COR for a ratio R/H; NaN where the speed is no positive number and outside the table."""
    x, log_chi = place_of(table, c_lam, c_chi, speed, radius, ratio)
    return cor_at(table, x, log_chi) if x == x else math.nan


@kernel(cache=True)
def restitution_on_plate(
    table: Array, c_lam: float, c_chi: float, speed: float, radius: float, thickness: float
) -> float:
    """COR of one sphere on a plate; NaN for bad input and outside the table."""
    if not is_valid(speed, radius, thickness):
        return math.nan
    return restitution(table, c_lam, c_chi, speed, radius, radius / thickness)


@kernel
def _coordinates(
    table: Array,
    c_lam: float,
    c_chi: float,
    speed: Array,
    radius: Array,
    thickness: Array,
    log_chi: Array,
    x: Array,
    log_w: Array,
    root: Array,
) -> bool:
    """Coordinates ln chi and x of impacts, ln w_m, and V^(1/5) exp(eta) g^(2/5).

    Returns whether all of the impacts are valid and in the table.
    """
    stretch, x_max, scale = table[STRETCH], table[X_MAX], 2.0 / table[X_MAX]
    power_series, log_chi_max = series_at(table, HEADER), table[LOG_CHI_MAX]
    for i in range(x.size):
        log_chi[i], root[i] = log_and_root(speed[i])
    plate = plate_of(table, c_lam)
    if is_thin(plate.corrections):
        for i in range(x.size):
            # one division: lam/(lam + c) with lam = c_lam V^(1/5) (R/H)^2
            above = c_lam * root[i] * radius[i] * radius[i]
            x[i] = above / (above + stretch * (thickness[i] * thickness[i]))
    elif relaxes(plate):
        stronger = 0.5 + 1.25 * plate.growth.yield_power  # times 0.8 below
        for i in range(x.size):
            ratio, log_time = radius[i] / thickness[i], log_and_root(radius[i])[0]
            own, faster, growth = relaxed(plate, root[i], log_time - 0.2 * log_chi[i])
            eta = plate_stiffening(own, faster, ratio)
            lam = inelasticity_of(own, faster, ratio, exp(eta))
            root[i] = faster * exp(eta)
            x[i] = lam / (lam + stretch)
            log_chi[i] -= 1.25 * eta + stronger * growth
    else:
        for i in range(x.size):
            ratio = radius[i] / thickness[i]
            eta = plate_stiffening(plate, root[i], ratio)
            stiffer = exp(eta)
            lam = inelasticity_of(plate, root[i], ratio, stiffer)
            root[i] *= stiffer
            x[i] = lam / (lam + stretch)
            log_chi[i] -= 1.25 * eta  # times 0.8 below, as ln V is
    for i in range(x.size):
        log_w[i] = evaluate(power_series, scale * x[i] - 1.0)
        log_chi[i] = c_chi + 0.8 * log_chi[i] + log_w[i]
    good = 0
    for i in range(x.size):
        valid = is_valid(speed[i], radius[i], thickness[i]) & (x[i] >= 0.0)
        good += valid & (x[i] <= x_max) & (log_chi[i] <= log_chi_max)
    return good == x.size


@kernel
def _move_inside(
    table: Array,
    speed: Array,
    radius: Array,
    thickness: Array,
    log_chi: Array,
    x: Array,
    outside: Array,
) -> None:
    """Set coordinates of invalid impacts, or outside the table, to 0; `outside` is NaN for them."""
    for i in range(x.size):
        valid = is_valid(speed[i], radius[i], thickness[i])
        inside = valid and 0.0 <= x[i] <= table[X_MAX] and log_chi[i] <= table[LOG_CHI_MAX]
        outside[i] = 0.0 if inside else math.nan
        x[i], log_chi[i] = (x[i], log_chi[i]) if inside else (0.0, 0.0)


@kernel(inline=True)
def _slice(values: Array, start: int, count: int) -> Array:
    """Part of an array; one kernel for all slices, since each is slow to compile."""
    return values[start : start + count]


@kernel(inline=True)
def _row(scratch: Array, row: int, count: int) -> Array:
    """First `count` numbers of a row of scratch memory."""
    return scratch[row, :count]


@kernel(cache=True)
def restitutions(
    table: Array,
    c_lam: float,
    c_chi: float,
    speed: Array,
    radius: Array,
    thickness: Array,
    out: Array,
) -> int:
    """Write the COR of many spheres on plates into out; return how many are NaN."""
    scratch, first = np.empty((6, _CHUNK)), np.empty(_CHUNK, dtype=np.int32)
    cor_at, step = int(table[COR_AT]), np.uint64(int(table[COLUMNS]))
    bad = 0
    for start in range(0, out.size, _CHUNK):
        n = min(_CHUNK, out.size - start)
        v, r, h = _slice(speed, start, n), _slice(radius, start, n), _slice(thickness, start, n)
        values = _slice(out, start, n)
        x, log_chi, along = _row(scratch, 0, n), _row(scratch, 1, n), _row(scratch, 2, n)
        a, b, outside = _row(scratch, 3, n), _row(scratch, 4, n), _row(scratch, 5, n)
        inside = _coordinates(table, c_lam, c_chi, v, r, h, log_chi, x, a, b)
        if not inside:
            _move_inside(table, v, r, h, log_chi, x, outside)
        locate_all(table, x, log_chi, first[:n], along, a, b)
        for i in range(n):
            values[i] = _cor(table, np.uint64(cor_at + first[i]), step, x[i], along[i])
        if not inside:
            for i in range(n):
                values[i] += outside[i]
                bad += values[i] != values[i]
    return bad


@kernel(cache=True)
def outcomes(
    table: Array,
    c_lam: float,
    c_chi: float,
    speed: Array,
    radius: Array,
    thickness: Array,
    out: Outcome,
    root: Array,
) -> int:
    """Write all fields of valid impacts on plates; return how many are NaN, being outside.

    V^(1/5) exp(eta) g^(2/5) goes into root.
    """
    scratch, first = np.empty((7, _CHUNK)), np.empty(_CHUNK, dtype=np.int32)
    cor_at, step = int(table[COR_AT]), np.uint64(int(table[COLUMNS]))
    others_at, plate = int(table[OTHERS_AT]), plate_of(table, c_lam)
    lowest, y_1 = table[BLOCKS + START], math.exp(-c_chi)
    bad = 0
    for start in range(0, speed.size, _CHUNK):
        n = min(_CHUNK, speed.size - start)
        v, r, h = _slice(speed, start, n), _slice(radius, start, n), _slice(thickness, start, n)
        roots = _slice(root, start, n)
        x, log_chi, along = _row(scratch, 0, n), _row(scratch, 1, n), _row(scratch, 2, n)
        log_w, a, b = _row(scratch, 3, n), _row(scratch, 4, n), _row(scratch, 5, n)
        inside = _coordinates(table, c_lam, c_chi, v, r, h, log_chi, x, log_w, roots)
        if not is_thin(plate.corrections):
            for i in range(n):  # x = lam/(lam + stretch), chi = w_m/y
                out.inelasticity[start + i] = table[STRETCH] * x[i] / (1.0 - x[i])
                out.yield_ratio[start + i] = exp(log_w[i] - log_chi[i])
        else:
            for i in range(n):
                out.inelasticity[start + i] = inelasticity_of(plate, roots[i], r[i] / h[i], 1.0)
                square = roots[i] * roots[i]
                out.yield_ratio[start + i] = y_1 / (square * square)
        outside = _row(scratch, 6, n)
        if not inside:
            _move_inside(table, v, r, h, log_chi, x, outside)
        locate_all(table, x, log_chi, first[:n], along, a, b)
        # no call of `_write_fields`: passing a tuple of arrays on costs reference counts each time
        for i in range(n):
            at, s, t = int(first[i]), x[i], along[i]
            out.restitution[start + i] = _cor(table, np.uint64(cor_at + at), step, s, t)
            others = _other_fields(table, np.uint64(others_at + 3 * at), s, t)
            out.contact_time[start + i] = others.contact_time
            out.wave_rate[start + i] = others.wave_rate
            log_chi[i] = (others.growth - 1.0) * max(log_chi[i], lowest)
        for i in range(n):
            out.elastic_compression[start + i] = exp(log_w[i])
        for i in range(n):
            out.compression_ratio[start + i] = exp(log_chi[i])
        if not inside:
            for i in range(n):
                if outside[i] != 0.0:
                    _write_nan(out, start + i)
                    bad += 1
    return bad


@kernel(cache=True)
def fields(table: Array, clamp: bool, out: Outcome) -> int:
    """Write fields at the inelasticities and yield ratios of `out`; return how many are outside.

    Outside the table fields are NaN, unless `clamp` takes the nearest point of its border, and
    puts that point's coordinates in place of the impact's.
    """
    outside = 0
    for n in range(out.inelasticity.size):
        x = out.inelasticity[n] / (out.inelasticity[n] + table[STRETCH])
        inside_x = x if 0.0 <= x <= table[X_MAX] else table[X_MAX]  # also where lambda is infinite
        log_w = log_elastic(table, inside_x)
        log_chi = log_w - math.log(out.yield_ratio[n])
        inside_chi = log_chi if log_chi <= table[LOG_CHI_MAX] else table[LOG_CHI_MAX]
        if not (inside_x == x and inside_chi == log_chi):
            outside += 1
            if not clamp:
                _write_nan(out, n)
                continue
            out.inelasticity[n] = inside_x * table[STRETCH] / (1.0 - inside_x)
            out.yield_ratio[n] = math.exp(log_w - inside_chi)
        row, column, s, t = locate(table, inside_x, inside_chi)
        _write_fields(table, row * int(table[COLUMNS]) + column, s, t, inside_chi, log_w, out, n)
    return outside


@kernel(cache=True)
def yield_speeds(
    table: Array, c_lam: float, c_chi: float, radius: Array, ratio: Array, out: Array
) -> None:
    """Write the speeds at which chi = 1 into out; NaN where lambda leaves the table before.

    d(ln chi)/d(ln V) lies between 2/3 and 4/5, so a step with slope 3/4 contracts by 0.12 at least;
    with losses it is up to 1, and a step contracts by 0.33.
    """
    given = plate_of(table, c_lam)
    for n in range(out.size):
        log_speed = -1.25 * c_chi
        for _ in range(60):  # 0.12^30 and 0.33^60 are far below rounding
            root, plate, growth = math.exp(0.2 * log_speed), given, 0.0
            if relaxes(given):
                log_time = math.log(radius[n]) - 0.2 * log_speed
                plate, root, growth = relaxed(given, root, log_time)
            eta = 0.0 if is_thin(plate.corrections) else plate_stiffening(plate, root, ratio[n])
            lam = inelasticity_of(plate, root, ratio[n], math.exp(eta))
            x = lam / (lam + table[STRETCH])
            if not 0.0 <= x <= table[X_MAX]:
                break
            stiffer = eta + (0.4 + given.growth.yield_power) * growth
            log_speed -= (c_chi - stiffer + 0.8 * log_speed + log_elastic(table, x)) / 0.75
        out[n] = math.exp(log_speed) if 0.0 <= x <= table[X_MAX] else math.nan
