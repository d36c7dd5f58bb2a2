"""Interpolation in the table: the kernels that read its splines.

A table holds fields of impacts on the grid that `contactlaw.table.grid` describes, as coefficients of
uniform cubic B-splines. With lambda the inelasticity, V the speed, chi the overload, w(x) the largest
elastic compression of a slow pair and d_Y its yield compression, an impact has the coordinates

    x = lambda/(lambda + 2)    p = (w(x)/(unit d_Y))^(1/4), which grows as V^(1/5)

so that no logarithm is needed. Columns are uniform in 2 p/(p + g) up to yield, p = g; from there to
the law's end P(x) in s = 2 (p - g)/(p + P - 2 g); and beyond, where the law goes on in some way, in p
up to `top`. For a pair whose strength k grows with the rate of strain there is a grid for each of a
few strengths, the rungs of a ladder. Between two of them fields and g^2 are straight in k; the g of a
rung is the fourth root of the growth of its yield compression, which is nearly k^2.

All of it is packed into one array of float64, because a kernel that takes one array and a few numbers
is called from Python in a third of a microsecond: the numbers of `Axes`, the constants of a pair
(`with_plate`), the polynomials w^(1/4) and P over x, some numbers for each rung, and the
coefficients, for each field and rung a row after the other.

A batch runs the kernels of one impact, `place` and `value`, in two short loops over a few hundred
impacts: in one long loop a read of the table might alias what was written, and no loop would be
compiled to vector instructions. Speeds and lengths are in SI units: this module is where numbers from
outside become coordinates, and nothing above it in this folder has units.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel, tuple_of
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
    scaled,
)
from contactlaw.equation.outcome import Outcome

# Input outside these limits is a mistake. Sizes [m]: there is no continuum below 1 nm, and no bead
# above 1 km. Speeds [m/s]: no contact is quasi-static above the speed of every wave in a solid, and
# below 1e-30 m/s squares begin to underflow.
R_MIN, R_MAX, V_MAX = 1e-9, 1e3, 1e5
V_MIN = 1e-30
# Smallest H/R, whatever the law and the speed. A plate thinner than that is a foil, and nothing is
# known of impacts on it: finite elements reach R/H = 5.8, the flags begin there. For materials of
# the catalogue at 0.01 to 100 m/s lambda exceeds 6 on thicker plates already, from R/H = 1.4 to 60.
THINNEST = 0.01

STRETCH = 2.0  # c of x = lambda/(lambda + c)
DEGREE = 11  # of the polynomials w^(1/4) and P
NO_MASSES = np.empty(0)
_NUMBERS = Outcome._fields.index("inelasticity")  # where the numbers begin by which an impact is given
_CHUNK = 256  # impacts at a time: the scratch arrays stay in the first-level cache


class Axes(NamedTuple):
    """The beginning of a packed array."""

    x_max: float
    rows: float  # cells along x
    below: float  # cells up to yield
    beyond: float  # cells from yield to the end of the law; 0: no body yields
    after: float  # cells beyond that
    stride: float  # coefficients in a row
    size: float  # coefficients of a field in one rung
    rungs: float
    top: float  # p at the end of the table, if that is beyond the law's
    unit: float  # overload at p = g = 1
    slowest: float  # least p/g at which impacts were solved; slower ones are alike
    scale: float  # p at V = 1 m/s and w = 1; what follows belongs to a pair
    slope: float  # C of k = 1 + C ln(rate/rate0)
    log_rate: float  # ln(rate/rate0) at 1 m/s and a radius of 1 m


PAIR = Axes._fields.index("scale")
PLATE = len(Axes._fields)  # where the constants of the plate begin
WAVES = PLATE + 4
GROWTH = WAVES + len(PlateCorrections._fields)
ELASTIC = GROWTH + len(ModulusGrowth._fields)  # the polynomial w^(1/4)
END = ELASTIC + DEGREE + 1
HEADER = END + DEGREE + 1  # where the rungs begin
# Numbers of a rung: k, g^2, and squares in x, the factors of P and w^(1/4) of slow impacts.
RUNG = 8
NEXT = 1.02  # the table ends at least by this factor of p beyond the law, if it goes on


def with_plate(table: Array, pair: PairConstants) -> Array:
    """Copy a table and put in the constants of a pair."""
    table, plate, yielding, slope, log_rate = table.copy(), pair.plate, pair.yield_compression, 0.0, 0.0
    scale = (pair.time / (table[Axes._fields.index("unit")] * yielding)) ** 0.25
    if plate.rate.slope > 0.0:
        slope, log_rate = plate.rate.slope, math.log(plate.rate.per_speed / yielding)
    growth = plate.growth._replace(log_time=plate.growth.log_time - math.log(pair.time))
    table[PAIR:ELASTIC] = [scale, slope, log_rate, *plate[:4], *plate.corrections, *growth]
    return table


@kernel(inline=True)
def axes_of(table: Array) -> Axes:
    """Read the axes."""
    t = table
    return Axes(t[0], t[1], t[2], t[3], t[4], t[5], t[6], t[7], t[8], t[9], t[10], t[11], t[12], t[13])


@kernel(inline=True)
def plate_of(table: Array) -> PlateConstants:
    """Read the constants of the plate; `log_time` is for T_H of a sphere of 1 m at 1 m/s as 1."""
    w, k, r = table, WAVES, GROWTH
    corrections = PlateCorrections(
        w[k], w[k + 1], w[k + 2], w[k + 3], w[k + 4], w[k + 5], w[k + 6], w[k + 7], w[k + 8], w[k + 9], w[k + 10]
    )
    growth = ModulusGrowth(w[r], w[r + 1], w[r + 2], w[r + 3], w[r + 4], w[r + 5])
    return PlateConstants(w[PLATE], w[PLATE + 1], w[PLATE + 2], w[PLATE + 3], corrections, growth, NO_RATE)


@kernel(inline=True)
def series_at(table: Array, k: int) -> tuple[float, ...]:
    """Coefficients of a polynomial that begin at k, as numbers."""
    c = table
    return (
        (c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5])
        + (c[k + 6], c[k + 7], c[k + 8], c[k + 9], c[k + 10], c[k + 11])
    )  # fmt: skip


class Head(NamedTuple):
    """What kernels read of a table once, as numbers: no later write to an array can change them."""

    axes: Axes
    plate: PlateConstants
    w: Any  # coefficients of the polynomial w^(1/4)
    ends: Any  # and of P


@kernel(inline=True)
def head_of(table: Array) -> Head:
    """Read the beginning of a table."""
    return Head(axes_of(table), plate_of(table), series_at(table, ELASTIC), series_at(table, END))


@kernel(inline=True)
def powers(c: tuple[float, ...], t: float) -> float:
    """Polynomial of degree 11 by Estrin's scheme: 4 products deep where Horner's has 11."""
    t2 = t * t
    t4 = t2 * t2
    p0 = (c[0] + c[1] * t) + (c[2] + c[3] * t) * t2
    p1 = (c[4] + c[5] * t) + (c[6] + c[7] * t) * t2
    p2 = (c[8] + c[9] * t) + (c[10] + c[11] * t) * t2
    return (p0 + p1 * t4) + p2 * (t4 * t4)


_MANTISSA, _ONE = np.int64((1 << 52) - 1), np.int64(1023 << 52)
_TWO_52 = np.int64(0x433 << 52)  # bits of 2^52
_LN_2, _HALF_LN_2 = math.log(2.0), 0.5 * math.log(2.0)
_LOG = tuple(2.0 / n for n in range(1, 2 * DEGREE + 2, 2))  # of 2 artanh(z)/z over z^2
_EXP = tuple(1.0 / math.factorial(n) for n in range(DEGREE + 1))


@kernel(inline=True)
def log(v: float) -> float:
    """Logarithm of a positive v."""
    bits = np.float64(v).view(np.int64)
    m = np.int64((bits & _MANTISSA) | _ONE).view(np.float64)
    exponent = np.int64(np.int64(np.uint64(bits) >> np.uint64(52)) + _TWO_52).view(np.float64) - (2.0**52 + 1023.0)
    z = (m - math.sqrt(2.0)) / (m + math.sqrt(2.0))
    return (exponent * _LN_2 + _HALF_LN_2) + z * powers(_LOG, z * z)


@kernel(inline=True)
def exp(x: float) -> float:
    """Exponential of |x| < 700: x = n ln 2 + r, the series of exp(r/2), squared, n into the bits of the exponent."""
    shifted = x * (1.0 / _LN_2) + 1.5 * 2.0**52  # rounds to a whole number, in the last bits
    half = powers(_EXP, 0.5 * (x - (shifted - 1.5 * 2.0**52) * _LN_2))
    series = half * half
    bits = np.float64(shifted).view(np.int64) << np.int64(52)
    return np.int64(np.float64(series).view(np.int64) + bits).view(np.float64)


@kernel(inline=True)
def fifth_root(v: float) -> float:
    """Return v^(1/5) of a positive v."""
    return exp(0.2 * log(v))


@kernel(inline=True)
def whole(v: float) -> Any:
    """Whole part of a number above 0; of 32 bits, which vectors convert."""
    return np.int32(v)


@kernel(inline=True)
def weights(t: float) -> tuple[float, float, float, float]:
    """Cubic B-splines at t in [0, 1], times 6 (de Boor 1978, chapter IX).

    All four have the same operations, zeros and all, so that one vector instruction does four.
    """
    return (
        ((-1.0 * t + 3.0) * t - 3.0) * t + 1.0,
        ((3.0 * t - 6.0) * t + 0.0) * t + 4.0,
        ((-3.0 * t + 3.0) * t + 3.0) * t + 1.0,
        ((1.0 * t + 0.0) * t + 0.0) * t + 0.0,
    )


Three = tuple[float, float, float]  # coefficients of a square in x
ALIKE = (1.0, 0.0, 0.0)
_STRONGEST = 1.0 + 1e-9  # largest way between two rungs; above 1 by rounding


class Rung(NamedTuple):
    """A strength on the ladder."""

    lower: int  # of two rungs
    between: float  # way to the next, from 0 to 1
    g: float
    later: Three  # factor of P
    slower: Three  # factor of w^(1/4)


@kernel(inline=True)
def rung_of(table: Array, axes: Axes, strength: float) -> Rung:
    """Find a strength k on the ladder."""
    at, last = HEADER, HEADER + (int(axes.rungs) - 2) * RUNG
    while at < last and strength > table[at + RUNG]:
        at += RUNG
    way = (strength - table[at]) / (table[at + RUNG] - table[at]) if axes.rungs > 1.0 else 0.0
    later = _between(table, at + 2, way), _between(table, at + 3, way), _between(table, at + 4, way)
    slower = _between(table, at + 5, way), _between(table, at + 6, way), _between(table, at + 7, way)
    return Rung((at - HEADER) // RUNG, way, math.sqrt(_between(table, at + 1, way)), later, slower)


@kernel(inline=True)
def _between(table: Array, at: int, way: float) -> float:
    """Interpolate a number of two rungs."""
    number: float = table[at] + way * (table[at + RUNG] - table[at])
    return number


@kernel(inline=True)
def strength_at(axes: Axes, speed: float, radius: float) -> float:
    """Strength k at the rate of an impact."""
    return 1.0 + axes.slope * max(axes.log_rate + RATE_POWER * log(speed) - log(radius), 0.0)


@kernel(inline=True)
def strongest(table: Array, axes: Axes) -> float:
    """Largest strength k of a table; infinite without a ladder."""
    return float(table[HEADER + (int(axes.rungs) - 1) * RUNG]) if axes.rungs > 1.0 else math.inf


class Place(NamedTuple):
    """Place of an impact in a table: the nearest one, if it is outside."""

    row: float
    column: float
    x: float
    p: float
    w: float  # w^(1/4)
    root: float  # V^(1/5) exp(eta) g^(2/5) over mass^(2/5), if it is known
    inside: bool


@kernel(inline=True)
def of_rung(series: tuple[float, ...], factor: Three, x: float) -> float:
    """Return P or w^(1/4) of a strength."""
    return powers(series, x) * (factor[0] + x * (factor[1] + x * factor[2]))


@kernel(inline=True)
def on_grid(head: Head, on: Rung, x: float, above: float, root: float) -> Place:
    """Place of x and of p, which is `above` times w^(1/4)."""
    axes = head.axes
    near_x = x if 0.0 <= x <= axes.x_max else axes.x_max
    elastic, end = of_rung(head.w, on.slower, near_x), max(of_rung(head.ends, on.later, near_x), 1.0)
    p, top = above * elastic, max(axes.top * on.later[0], NEXT * end) if axes.after > 0.0 else end
    near_p = p if p <= top else top
    over, under, first = 2.0 * axes.beyond * (near_p - 1.0), near_p + end - 2.0, axes.below + 3.0
    over, under, first = (2.0 * axes.below * near_p, near_p + 1.0, 0.0) if near_p <= 1.0 else (over, under, first)
    after, last = (near_p > end) & (axes.after > 0.0), axes.below + axes.beyond + 6.0
    over, under, first = (axes.after * (near_p - end), top - end, last) if after else (over, under, first)
    inside = (near_x == x) & (near_p == p)
    return Place(near_x * (axes.rows / axes.x_max), first + over / under, near_x, near_p, elastic, root, inside)


@kernel(inline=True)
def is_valid(speed: float, radius: float, thickness: float) -> bool:
    """Whether an impact is in its limits; without a branch, so that loops become vectors."""
    valid = (speed >= V_MIN) & (speed <= V_MAX) & (thickness >= R_MIN)
    return valid & (radius >= R_MIN) & (radius <= R_MAX) & (THINNEST * radius <= thickness)


@kernel(inline=True)
def place(
    head: Head, speed: float, radius: float, thickness: float, mass: float, on: Rung, thin: bool, usual: bool
) -> Place:
    """Place of one impact.

    Loops over many impacts say of all of them whether the plate is thin and whether they are usual,
    without losses and of a solid sphere: then they become vector instructions.
    """
    plate, root, slower = head.plate, fifth_root(speed), 1.0
    above = head.axes.scale * root
    if not usual:
        if mass != 1.0:  # powers take longer than all else
            pair = of_mass(PairConstants(plate, 1.0, 1.0, 1.0), mass)
            plate, slower = pair.plate, pair.time
            above *= math.sqrt(math.sqrt(slower))
        if relaxes(plate):
            log_time = math.log(radius * slower) - 0.2 * math.log(speed)
            plate, root, growth = relaxed(plate, root, log_time)
            above *= math.exp(-0.25 * (0.4 + plate.growth.yield_power) * growth)
    if thin:  # one division: lam/(lam + c) with lam = c_lam V^(1/5) (R/H)^2
        part = plate.inelasticity * root * (radius * radius)
        x, above = part / (part + STRETCH * (thickness * thickness)), above / on.g
    else:
        ratio = radius / thickness
        plate = scaled(plate, 1.0, 1.0, 1.0, on.g)
        quarter = exp(0.25 * plate_stiffening(plate, root, ratio))
        stiffer = (quarter * quarter) * (quarter * quarter)
        lam = inelasticity_of(plate, root, ratio, stiffer)
        x, above, root = lam / (lam + STRETCH), above / (quarter * on.g), root * stiffer
    at = on_grid(head, on, x, above, root / slower)
    return tuple_of(Place, at, inside=at.inside & is_valid(speed, radius, thickness))


@kernel(inline=True)
def place_of(
    table: Array, head: Head, speed: float, radius: float, thickness: float, mass: float
) -> tuple[Place, Rung, float]:
    """Place of an impact, that of its strength, and this k."""
    strength = strength_at(head.axes, speed, radius) if head.axes.rungs > 1.0 else 1.0
    on, usual = rung_of(table, head.axes, strength), not relaxes(head.plate) and mass == 1.0
    at = place(head, speed, radius, thickness, mass, on, is_thin(head.plate.corrections), usual)
    return tuple_of(Place, at, inside=at.inside & (on.between <= _STRONGEST)), on, strength


@kernel(inline=True)
def place_near(table: Array, head: Head, x: float, above: float, strength: float) -> tuple[Place, Rung]:
    """Nearest place to dimensionless numbers; p is `above` times w^(1/4)."""
    most = strongest(table, head.axes)
    on = rung_of(table, head.axes, strength if strength <= most else most)
    at = on_grid(head, on, x, above, math.nan)
    return tuple_of(Place, at, inside=at.inside & (strength <= most * _STRONGEST)), on


@kernel(inline=True)
def place_at(table: Array, head: Head, lam: float, y: float, log_strength: float) -> tuple[Place, Rung]:
    """Nearest place to an inelasticity, a yield ratio and ln of a strength."""
    above = 1.0 / math.sqrt(math.sqrt(head.axes.unit * y))
    return place_near(table, head, lam / (lam + STRETCH), above, math.exp(log_strength))


@kernel(inline=True)
def value(table: Array, at: np.uint64, stride: np.uint64, row: float, column: float) -> float:
    """Interpolate in 4 x 4 coefficients of one rung, whose block begins at `at`; no index is negative."""
    i, j = whole(row), whole(column)
    a, b, c = weights(row - i), weights(column - j), (0.0, 0.0, 0.0, 0.0)
    p = at + np.uint64(i) * stride + np.uint64(j)
    for k in range(4):
        c0, c1 = c[0] + a[k] * table[p], c[1] + a[k] * table[p + np.uint64(1)]
        c = (c0, c1, c[2] + a[k] * table[p + np.uint64(2)], c[3] + a[k] * table[p + np.uint64(3)])
        p += stride
    return ((b[0] * c[0] + b[1] * c[1]) + (b[2] * c[2] + b[3] * c[3])) * (1.0 / 36.0)


@kernel(inline=True)
def field(table: Array, axes: Axes, which: int, at: Place, on: Rung) -> float:
    """Interpolate a field at a place and between two rungs."""
    size, stride, rungs = np.uint64(int(axes.size)), np.uint64(int(axes.stride)), int(axes.rungs)
    begin = np.uint64(HEADER + RUNG * rungs) + np.uint64(which * rungs + on.lower) * size
    low = value(table, begin, stride, at.row, at.column)
    return low + on.between * (value(table, begin + size, stride, at.row, at.column) - low) if rungs > 1 else low


@kernel(inline=True)
def cor_from(lost: float) -> float:
    """COR from the field 1 - COR, whose spline may pass its limits by its error."""
    return 1.0 - min(max(lost, 0.0), 1.0)


@kernel(inline=True)
def cor_of(table: Array, axes: Axes, at: Place, on: Rung) -> float:
    """COR at a place; NaN outside the table."""
    return cor_from(field(table, axes, 0, at, on)) if at.inside else math.nan


@kernel(cache=True)
def restitution_on_plate(table: Array, speed: float, radius: float, thickness: float, mass: float) -> float:
    """COR of one sphere on a plate; NaN for bad input and outside the table.

    The mass is over that of a solid sphere.
    """
    head = head_of(table)
    at, on, _ = place_of(table, head, speed, radius, thickness, mass)
    return cor_of(table, head.axes, at, on)


# Where the numbers of a chunk of impacts begin in their scratch memory. It is one array: compilers
# check that no write alters what is read, and make no vector instructions if there is much to check.
_ROW, _COLUMN, _P, _W, _ROOTS = range(0, 5 * _CHUNK, _CHUNK)
_STRENGTH, _LOWER, _BETWEEN, _G, _LATER = range(0, 5 * _CHUNK, _CHUNK)
_SLOWER, _SCRATCH = 7 * _CHUNK, 10 * _CHUNK


@kernel(inline=True)
def _three(s: Array, begin: int, i: int) -> Three:
    """Coefficients of an impact's square."""
    return s[begin + i], s[begin + _CHUNK + i], s[begin + 2 * _CHUNK + i]


class _Impacts(NamedTuple):
    """Some of many impacts."""

    speed: Array
    radius: Array
    thickness: Array
    mass: Array  # over those of solid spheres; without any, all are


@kernel(inline=True)
def _part(hit: _Impacts, start: int) -> _Impacts:
    """Impacts of a chunk."""
    end = start + _CHUNK
    return _Impacts(hit.speed[start:end], hit.radius[start:end], hit.thickness[start:end], hit.mass[start:end])


@kernel(inline=True)
def _find_places(head: Head, hit: _Impacts, k: Array, s: Array, thin: bool, usual: bool, rated: bool) -> None:
    """Places of a chunk of impacts; the column is -1 outside the table."""
    solid = usual or hit.mass.size == 0
    for i in range(hit.speed.size):
        later, slower = (_three(k, _LATER, i), _three(k, _SLOWER, i)) if rated else (ALIKE, ALIKE)
        on, share = Rung(0, 0.0, k[_G + i] if rated else 1.0, later, slower), 1.0 if solid else hit.mass[i]
        at = place(head, hit.speed[i], hit.radius[i], hit.thickness[i], share, on, thin, usual)
        s[_ROW + i], s[_COLUMN + i] = at.row if at.inside else 0.0, at.column if at.inside else -1.0
        s[_P + i], s[_W + i], s[_ROOTS + i] = at.p, at.w, at.root


@kernel
def _find(table: Array, head: Head, hit: _Impacts, k: Array, s: Array) -> None:
    """Places of a chunk of impacts, and those of their strengths."""
    rated, thin, usual = head.axes.rungs > 1.0, is_thin(head.plate.corrections), not relaxes(head.plate)
    if rated:
        for i in range(hit.speed.size):
            k[_STRENGTH + i] = strength_at(head.axes, hit.speed[i], hit.radius[i])
        for i in range(hit.speed.size):
            on = rung_of(table, head.axes, k[_STRENGTH + i])
            k[_LOWER + i], k[_BETWEEN + i], k[_G + i] = on.lower, on.between, on.g
            k[_LATER + i], k[_LATER + _CHUNK + i], k[_LATER + 2 * _CHUNK + i] = on.later
            k[_SLOWER + i], k[_SLOWER + _CHUNK + i], k[_SLOWER + 2 * _CHUNK + i] = on.slower
    # constants let the compiler leave out what a loop has not
    if not usual or hit.mass.size > 0:
        if thin or rated:
            _find_places(head, hit, k, s, thin, False, rated)
        else:
            _find_places(head, hit, k, s, False, False, False)
    elif thin:
        _find_places(head, hit, k, s, True, True, False)
    elif rated:
        _find_places(head, hit, k, s, False, True, True)
    else:
        _find_places(head, hit, k, s, False, True, False)
    for i in range(hit.speed.size):
        s[_COLUMN + i] = s[_COLUMN + i] if k[_BETWEEN + i] <= _STRONGEST else -1.0


@kernel(inline=True)
def _found(axes: Axes, k: Array, s: Array, i: int) -> tuple[Place, Rung]:
    """Place of impact i of a chunk, and that of its strength."""
    row, column, x = s[_ROW + i], s[_COLUMN + i], s[_ROW + i] * (axes.x_max / axes.rows)
    at = Place(row, max(column, 0.0), x, s[_P + i], s[_W + i], s[_ROOTS + i], column >= 0.0)
    return at, Rung(int(k[_LOWER + i]), k[_BETWEEN + i], 1.0, ALIKE, ALIKE)


@kernel(cache=True)
def restitutions(table: Array, speed: Array, radius: Array, thickness: Array, mass: Array, out: Array) -> int:
    """Write the COR of many spheres on plates into out; return how many are NaN.

    Masses are over those of solid spheres; without any, all spheres are.
    """
    head, k, s, bad = head_of(table), np.zeros(_SCRATCH), np.zeros(_SCRATCH), 0
    for start in range(0, out.size, _CHUNK):
        hit = _part(_Impacts(speed, radius, thickness, mass), start)
        _find(table, head, hit, k, s)
        for i in range(hit.speed.size):
            at, on = _found(head.axes, k, s, i)
            out[start + i] = cor_of(table, head.axes, at, on)
        for i in range(hit.speed.size):
            bad += s[_COLUMN + i] < 0.0
    return bad


@kernel(cache=True)
def outcomes(
    table: Array, speed: Array, radius: Array, thickness: Array, mass: Array, out: Outcome, root: Array
) -> int:
    """Write all fields of valid impacts on plates; return how many are NaN, being outside.

    V^(1/5) exp(eta) g^(2/5), over the mass to the power 2/5, goes into root.
    """
    head, k, s, bad = head_of(table), np.zeros(_SCRATCH), np.zeros(_SCRATCH), 0
    axes = head.axes
    for start in range(0, speed.size, _CHUNK):
        hit = _part(_Impacts(speed, radius, thickness, mass), start)
        _find(table, head, hit, k, s)
        for i in range(hit.speed.size):
            at, on = _found(axes, k, s, i)
            log_strength = log(k[_STRENGTH + i]) if axes.rungs > 1.0 else 0.0
            _write(table, axes, at, on, log_strength, at.inside, out, start + i)
            root[start + i] = at.root
            bad += not at.inside
    return bad


@kernel(cache=True)
def fields(table: Array, clamp: bool, out: Outcome) -> int:
    """Write fields at the inelasticities, yield ratios and strengths of `out`; count those outside.

    Outside the table fields are NaN, unless `clamp` takes the nearest point of its border, and
    puts that point's coordinates in place of the impact's.
    """
    head, bad = head_of(table), 0
    most = math.log(strongest(table, head.axes))
    for n in range(out.inelasticity.size):
        at, on = place_at(table, head, out.inelasticity[n], out.yield_ratio[n], out.strength[n])
        _write(table, head.axes, at, on, min(out.strength[n], most), at.inside or clamp, out, n)
        bad += not at.inside
    return bad


@kernel(inline=True)
def _write(
    table: Array, axes: Axes, at: Place, on: Rung, log_strength: float, known: bool, out: Outcome, n: int
) -> None:
    """Write the fields of impact n; those that are not known are NaN."""
    lost, ratio = field(table, axes, 0, at, on), at.w / at.p
    values = (
        cor_from(lost),
        1.0 / field(table, axes, 1, at, on),
        field(table, axes, 2, at, on),
        field(table, axes, 3, at, on),
        (at.w * at.w) * (at.w * at.w),
        STRETCH * at.x / (1.0 - at.x),
        (ratio * ratio) * (ratio * ratio) / axes.unit,
        log_strength,
    )
    for k in range(len(values)):
        if known:
            out[k][n] = values[k]
        elif k < _NUMBERS:
            out[k][n] = math.nan
