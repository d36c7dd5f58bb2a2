"""Interpolation in the table: the kernels that read its splines.

A table holds functions of the inelasticity lambda and of ln chi, the logarithm of the overload.
Along lambda the nodes are uniform in x = lambda/(lambda + c); along ln chi they are uniform within
each segment between two kinks, and each segment has a spline of its own, so no spline runs across
a kink. Splines are kept as coefficients of uniform cubic B-splines, two more than there are nodes:
they need the least memory, and a table that stays in the cache is a fast one. Where ln chi < 0 the
contact is elastic and the values at ln chi = 0 hold. ln w_m is a polynomial in x.

All of it is packed into one array of float64, because a kernel that takes one array and a few
numbers is called from Python in a third of a microsecond. The array begins with a header:

    STRETCH      c                        COLUMNS    columns of coefficients, all segments
    X_MAX        x of the largest lambda  SEGMENTS   number of segments n
    LOG_CHI_MAX  largest ln chi           COR_AT     where the coefficients of COR begin
    NODES_PER_X  1/(distance of nodes)    OTHERS_AT  where those of the other fields begin

then, at HEADER, the polynomial's coefficients and n blocks (first ln chi, nodes per unit of
ln chi, first column). `contactlaw.packing` makes it; the constants are here, because numba's cache
does not see an edit of a constant in another file.

Legend: v speed, lam inelasticity, chi overload, w_m largest elastic compression [V0 T_H]. Powers:
lam = c_lam V^(1/5), ln chi = c_chi + (4/5) ln V + ln w_m; c_lam and c_chi come with SI units from
`contactlaw.evaluation`, for spheres on plates with R/H = 1.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba.core import types
from numba.extending import intrinsic
from numpy.typing import NDArray

from contactlaw._jit import kernel

Array = NDArray[np.float64]
Integers = NDArray[np.int32]

# Input beyond these is a mistake: no continuum below 1 nm, no bead above 1 km [m], no contact that
# is quasi-static above the speed of every wave in a solid, nor an impact below 1e-30 m/s, where
# squares begin to underflow [m/s].
R_MIN, R_MAX, V_MAX = 1e-9, 1e3, 1e5
V_MIN = 1e-30

STRETCH, X_MAX, LOG_CHI_MAX, NODES_PER_X = range(4)
COLUMNS, SEGMENTS, COR_AT, OTHERS_AT, HEADER = range(4, 9)
DEGREE = 20  # of ln w_m in x: within 4e-12 of the nodes
START, PER_LOG, COLUMN, BLOCK = range(4)
_CHUNK = 512  # impacts at a time: the scratch arrays stay in the first-level cache


@kernel(cache=True)
def lam_max(table: Array) -> float:
    """Largest inelasticity of a table."""
    value: float = table[STRETCH] * table[X_MAX] / (1.0 - table[X_MAX])
    return value


@kernel(cache=True)
def chi_max(table: Array) -> float:
    """Largest overload of a table."""
    return math.exp(table[LOG_CHI_MAX])


@intrinsic
def _bits(typing_context: Any, value: Any) -> Any:
    """Bits of a float64 as an int64."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], context.get_value_type(types.int64))

    return types.int64(types.float64), generate


@intrinsic
def _from_bits(typing_context: Any, value: Any) -> Any:
    """Float64 with the bits of an int64."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], context.get_value_type(types.double))

    return types.float64(types.int64), generate


def _root_series() -> tuple[float, ...]:
    """Taylor coefficients of f(z) = ((1 + z)/(1 - z))^(1/5), from (1 - z^2) f' = (2/5) f."""
    c = [1.0, 0.4]
    for n in range(1, 12):
        c.append((0.4 * c[n] + (n - 1) * c[n - 1]) / (n + 1))
    return tuple(c)


_ROOT = _root_series()
_ROOTS_OF_TWO = 2.0 ** (np.arange(-1024, 3072) / 5)  # 2^(k/5), for any 12 bits of an exponent


@kernel(cache=True)
def _log_and_root(v: float) -> tuple[float, float]:
    """Logarithm and fifth root to 2e-11, for V_MIN <= v <= V_MAX; garbage, but no crash, elsewhere.

    v = 2^k m with m within [sqrt(1/2), sqrt(2)) and z = (m - 1)/(m + 1), |z| < 0.172: the series of
    2 artanh z = ln m and of m^(1/5) do not wait for each other, and contain no call, so that loops
    over them become vector instructions.
    """
    bits: int = _bits(v)  # type: ignore[call-arg]
    # k + 1024, from the exponent of v/sqrt(1/2); unsigned, since vectors have no signed shift
    biased = np.uint64(bits - 0x3FE6A09E667F3BCD + (1024 << 52)) >> np.uint64(52)
    signed = np.int64(biased)
    exponent = _from_bits(signed + (0x433 << 52)) - (2.0**52 + 1024.0)  # k as a float
    m = _from_bits(bits - ((signed - 1024) << 52))
    z = (m - 1.0) / (m + 1.0)
    w = z * z
    w2 = w * w
    w4 = w2 * w2
    odd = (2.0 + w * (2 / 3)) + (2 / 5 + w * (2 / 7)) * w2  # next term of ln m: 1e-13
    odd += ((2 / 9 + w * (2 / 11)) + (2 / 13 + w * (2 / 15)) * w2) * w4
    c = _ROOT  # next term of the root: 5e-12
    root = (c[0] + c[1] * z) + (c[2] + c[3] * z) * w
    root += ((c[4] + c[5] * z) + (c[6] + c[7] * z) * w) * w2
    root += ((c[8] + c[9] * z) + (c[10] + c[11] * z) * w + c[12] * w2) * w4
    return exponent * math.log(2.0) + z * odd, root * _ROOTS_OF_TWO[biased]


@kernel(cache=True)
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


@kernel(cache=True)
def _power_series(table: Array) -> tuple[float, ...]:
    """Coefficients of ln w_m, as a tuple: no later write to an array can change them."""
    c, k = table, HEADER
    return (
        (c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], c[k + 6])
        + (c[k + 7], c[k + 8], c[k + 9], c[k + 10], c[k + 11], c[k + 12], c[k + 13])
        + (c[k + 14], c[k + 15], c[k + 16], c[k + 17], c[k + 18], c[k + 19], c[k + 20])
    )


@kernel(cache=True)
def _evaluate(c: tuple[float, ...], t: float) -> float:
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


@kernel(cache=True)
def _log_elastic(table: Array, x: float) -> float:
    """Logarithm of w_m at x."""
    return _evaluate(_power_series(table), 2.0 / table[X_MAX] * x - 1.0)


@kernel(cache=True)
def log_elastic_compression(table: Array, lam: float) -> float:
    """Logarithm of w_m at an inelasticity inside the table."""
    return _log_elastic(table, lam / (lam + table[STRETCH]))


@kernel(cache=True)
def _locate(table: Array, x: float, log_chi: float) -> tuple[int, float, float]:
    """Index of the first of 4 x 4 coefficients, and the place within the cell."""
    block = HEADER + DEGREE + 1
    for k in range(1, int(table[SEGMENTS])):
        # counted, not branched: half of the branches would be predicted wrongly
        block += BLOCK * (log_chi > table[HEADER + DEGREE + 1 + k * BLOCK + START])
    across = x * table[NODES_PER_X]
    along = max(0.0, log_chi - table[block + START]) * table[block + PER_LOG]
    row, cell = int(across), int(along)
    first = row * int(table[COLUMNS]) + int(table[block + COLUMN]) + cell
    return first, across - row, along - cell


@kernel(cache=True, inline=True)
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


@kernel(cache=True)
def _other_fields(table: Array, first: int, s: float, t: float) -> tuple[float, float, float]:
    """Contact time [T_H], wave rate and compression ratio."""
    a, b = weights(s), weights(t)
    time = wave = ratio = 0.0
    for k in range(4):
        start = int(table[OTHERS_AT]) + 3 * (first + k * int(table[COLUMNS]))
        for n in range(4):
            weight = a[k] * b[n]
            time += weight * table[start + 3 * n]
            wave += weight * table[start + 3 * n + 1]
            ratio += weight * table[start + 3 * n + 2]
    return time / 36.0, wave / 36.0, ratio / 36.0


@kernel(cache=True, inline=True)
def _restitution(
    table: Array, c_lam: float, c_chi: float, speed: float, radius_2: float, thickness_2: float
) -> float:
    """COR for lam = c_lam V^(1/5) R^2/H^2; NaN outside the table."""
    if not V_MIN <= speed <= V_MAX:
        return math.nan
    log_speed, root = _log_and_root(speed)
    above = c_lam * root * radius_2
    x = above / (above + table[STRETCH] * thickness_2)
    if not x <= table[X_MAX]:
        return math.nan
    log_chi = c_chi + 0.8 * log_speed + _log_elastic(table, x)
    if not log_chi <= table[LOG_CHI_MAX]:
        return math.nan
    first, s, t = _locate(table, x, log_chi)
    start, step = np.int64(table[COR_AT]), np.int64(table[COLUMNS])
    return _cor(table, np.uint64(start + first), np.uint64(step), s, t)


@kernel(cache=True)
def restitution(table: Array, c_lam: float, c_chi: float, speed: float) -> float:
    """COR at one speed; NaN where the speed is no positive number and outside the table."""
    return _restitution(table, c_lam, c_chi, speed, 1.0, 1.0)


@kernel(cache=True)
def restitution_on_plate(
    table: Array, c_lam: float, c_chi: float, speed: float, radius: float, thickness: float
) -> float:
    """COR of one sphere on a plate; NaN for bad input and outside the table."""
    if not (R_MIN <= radius <= R_MAX and thickness >= R_MIN):
        return math.nan
    return _restitution(table, c_lam, c_chi, speed, radius * radius, thickness * thickness)


@kernel(cache=True)
def _coordinates(
    table: Array,
    c_lam: float,
    c_chi: float,
    speed: Array,
    radius: Array,
    thickness: Array,
    log_chi: Array,
    x: Array,
) -> bool:
    """Coordinates ln chi and x of impacts, and whether all of them are valid and in the table."""
    stretch, x_max, scale = table[STRETCH], table[X_MAX], 2.0 / table[X_MAX]
    power_series, log_chi_max = _power_series(table), table[LOG_CHI_MAX]
    for i in range(x.size):
        log_chi[i], x[i] = _log_and_root(speed[i])
    for i in range(x.size):
        # one division: lam/(lam + c) with lam = c_lam V^(1/5) (R/H)^2
        above = c_lam * x[i] * radius[i] * radius[i]
        x[i] = above / (above + stretch * (thickness[i] * thickness[i]))
    for i in range(x.size):
        log_chi[i] = c_chi + 0.8 * log_chi[i] + _evaluate(power_series, scale * x[i] - 1.0)
    good = 0
    for i in range(x.size):
        valid = (speed[i] >= V_MIN) & (speed[i] <= V_MAX) & (thickness[i] >= R_MIN)
        valid &= (radius[i] >= R_MIN) & (radius[i] <= R_MAX)
        good += valid & (x[i] <= x_max) & (log_chi[i] <= log_chi_max)
    return good == x.size


@kernel(cache=True)
def _cells(
    table: Array, x: Array, log_chi: Array, first: Integers, along: Array, column: Integers
) -> None:
    """Index of the first of 4 x 4 coefficients; places within the cell over x and into along."""
    nodes_per_x = table[NODES_PER_X]
    columns, cor = np.int32(table[COLUMNS]), np.int32(table[COR_AT])
    for i in range(x.size):
        across = x[i] * nodes_per_x
        row = np.int32(across)
        x[i] = across - row
        first[i] = cor + row * columns
    for k in range(int(table[SEGMENTS])):
        block = HEADER + DEGREE + 1 + k * BLOCK
        start, per_log = table[block + START], table[block + PER_LOG]
        offset = np.int32(table[block + COLUMN])
        for i in range(x.size):
            place = max(0.0, log_chi[i] - start) * per_log
            cell = np.int32(place)
            here = (log_chi[i] > start) | (k == 0)
            along[i] = place - cell if here else along[i]
            column[i] = offset + cell if here else column[i]
    for i in range(x.size):
        first[i] += column[i]


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
    """COR of many spheres on plates into out; how many are NaN."""
    log_chi, x, along = np.empty(_CHUNK), np.empty(_CHUNK), np.empty(_CHUNK)
    first, column = np.empty(_CHUNK, dtype=np.int32), np.empty(_CHUNK, dtype=np.int32)
    step = np.uint64(np.int64(table[COLUMNS]))
    bad = 0
    for start in range(0, out.size, _CHUNK):
        stop = min(start + _CHUNK, out.size)
        n = stop - start
        v, r, h, values = (
            speed[start:stop],
            radius[start:stop],
            thickness[start:stop],
            out[start:stop],
        )
        if _coordinates(table, c_lam, c_chi, v, r, h, log_chi[:n], x[:n]):
            _cells(table, x[:n], log_chi[:n], first[:n], along[:n], column[:n])
            for i in range(n):
                values[i] = _cor(table, np.uint64(first[i]), step, x[i], along[i])
        else:  # one by one; such chunks are rare
            for i in range(n):
                values[i] = restitution_on_plate(table, c_lam, c_chi, v[i], r[i], h[i])
                bad += values[i] != values[i]
    return bad


@kernel(cache=True)
def fields(table: Array, lam: Array, yield_ratio: Array, clamp: bool, out: Array) -> int:
    """COR, contact time, wave rate, compression ratio, w_m into out (5, n); how many are outside.

    yield_ratio is y = w_m/chi. Outside the table all fields are NaN, unless `clamp` takes the
    nearest point of its border, and puts that point's coordinates over lam and yield_ratio.
    """
    outside = 0
    start, step = np.int64(table[COR_AT]), np.uint64(np.int64(table[COLUMNS]))
    for n in range(lam.size):
        x = lam[n] / (lam[n] + table[STRETCH])
        inside_x = min(x, table[X_MAX])
        log_w = _log_elastic(table, inside_x)
        log_chi = log_w - math.log(yield_ratio[n])
        inside_chi = min(log_chi, table[LOG_CHI_MAX])
        if not (inside_x == x and inside_chi == log_chi):
            outside += 1
            if not clamp:
                for k in range(len(out)):  # a slice would take the compiler a second
                    out[k, n] = math.nan
                continue
            lam[n] = inside_x * table[STRETCH] / (1.0 - inside_x)
            yield_ratio[n] = math.exp(log_w - inside_chi)
        first, s, t = _locate(table, inside_x, inside_chi)
        out[0, n] = _cor(table, np.uint64(start + first), step, s, t)
        out[1, n], out[2, n], out[3, n] = _other_fields(table, first, s, t)
        out[4, n] = math.exp(log_w)
    return outside


@kernel(cache=True)
def yield_speeds(table: Array, c_lam: Array, c_chi: float, out: Array) -> None:
    """Speeds at which chi = 1 into out; NaN where lambda leaves the table before.

    d(ln chi)/d(ln V) lies between 2/3 and 4/5, so a step with slope 3/4 contracts by 0.12 at least.
    """
    for n in range(out.size):
        log_speed = -1.25 * c_chi
        for _ in range(30):  # 0.12^30 is far below rounding
            lam = c_lam[n] * math.exp(0.2 * log_speed)
            x = lam / (lam + table[STRETCH])
            if not x <= table[X_MAX]:
                break
            log_speed -= (c_chi + 0.8 * log_speed + _log_elastic(table, x)) / 0.75
        out[n] = math.exp(log_speed) if x <= table[X_MAX] else math.nan
