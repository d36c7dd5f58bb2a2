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
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel, numbers_at
from contactlaw._spline import spline_value
from contactlaw.equation.corrections import PlateCorrections, is_thin
from contactlaw.equation.numbers import (
    NO_RATE,
    RATE_POWER,
    Impact,
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
DEGREE = 11  # of polynomials
NO_MASSES = np.empty(0)
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
RUNG = 8  # numbers of a rung: k, g^2, and the factors of P and of w^(1/4)
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


class Series(NamedTuple):
    """Coefficients of a polynomial, from that of t^0 on."""

    c0: float
    c1: float
    c2: float
    c3: float
    c4: float
    c5: float
    c6: float
    c7: float
    c8: float
    c9: float
    c10: float
    c11: float


class Head(NamedTuple):
    """What kernels read of a table once, as numbers: no later write to an array can change them."""

    axes: Axes
    plate: PlateConstants  # `log_time` of its growth is for T_H of a sphere of 1 m at 1 m/s as 1
    w: Series  # w^(1/4)
    end: Series  # P


@kernel(inline=True)
def head_of(table: Array) -> Head:
    """Read the beginning of a table."""
    t, corrections = table, numbers_at(PlateCorrections, table, WAVES, 1)
    growth = numbers_at(ModulusGrowth, t, GROWTH, 1)
    plate = PlateConstants(t[PLATE], t[PLATE + 1], t[PLATE + 2], t[PLATE + 3], corrections, growth, NO_RATE)
    return Head(numbers_at(Axes, t, 0, 1), plate, numbers_at(Series, t, ELASTIC, 1), numbers_at(Series, t, END, 1))


@kernel(inline=True)
def powers(c: Series, t: float) -> float:
    """Polynomial of degree 11 by Estrin's scheme: 4 products deep where Horner's has 11."""
    t2 = t * t
    t4 = t2 * t2
    low = (c.c0 + c.c1 * t) + (c.c2 + c.c3 * t) * t2
    middle = (c.c4 + c.c5 * t) + (c.c6 + c.c7 * t) * t2
    return (low + middle * t4) + ((c.c8 + c.c9 * t) + (c.c10 + c.c11 * t) * t2) * (t4 * t4)


_MANTISSA, _ONE = np.int64((1 << 52) - 1), np.int64(1023 << 52)
_TWO_52 = np.int64(0x433 << 52)  # bits of 2^52
_GUESS = 1.2 * (1023 - 0.045) * 2.0**20
_LN_2, _HALF_LN_2 = math.log(2.0), 0.5 * math.log(2.0)
_LOG = Series(*(2.0 / n for n in range(1, 2 * DEGREE + 2, 2)))  # of 2 artanh(z)/z over z^2
_EXP = Series(*(1.0 / math.factorial(n) for n in range(DEGREE + 1)))


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
    """Exponential of |x| < 700.

    With x = n ln 2 + r it is the square of the series of exp(r/2), with n in the bits of the exponent.
    """
    shifted = x * (1.0 / _LN_2) + 1.5 * 2.0**52  # rounds to a whole number, in the last bits
    half = powers(_EXP, 0.5 * (x - (shifted - 1.5 * 2.0**52) * _LN_2))
    series = half * half
    bits = np.float64(shifted).view(np.int64) << np.int64(52)
    return np.int64(np.float64(series).view(np.int64) + bits).view(np.float64)


@kernel(inline=True)
def fifth_root(v: float) -> float:
    """Return v^(1/5) of a positive v: v r^4, with r = v^(-1/5) by Newton's method."""
    high = np.int32(np.int64(np.float64(v).view(np.int64) >> np.int64(32)))
    r = np.int64(np.int64(np.int32(_GUESS - 0.2 * high)) << np.int64(32)).view(np.float64)
    for _ in range(4):
        square = r * r
        r *= 1.2 - 0.2 * v * (square * square * r)
    square = r * r
    return v * (square * square)


class Rung(NamedTuple):
    """A strength on the ladder."""

    lower: float  # of two rungs
    between: float  # way to the next, from 0 to 1
    inside: float  # 1; 0 for a strength above the ladder, which has the place of the highest
    k: float
    g: float
    p0: float  # factor of P, a square in x
    p1: float
    p2: float
    w0: float  # factor of w^(1/4)
    w1: float
    w2: float


SINGLE = Rung(0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)  # of a table without a ladder
_ROUNDING = 1.0 + 1e-9  # largest way between two rungs
_SCRATCH = len(Rung._fields) * _CHUNK  # numbers of a chunk's rungs, which are more than those of its places


@kernel(inline=True)
def rung_of(table: Array, axes: Axes, strength: float) -> Rung:
    """Find a strength k on the ladder."""
    if axes.rungs == 1.0:
        return SINGLE
    at, last = HEADER, HEADER + (int(axes.rungs) - 2) * RUNG
    while at < last and strength > table[at + RUNG]:
        at += RUNG
    way = (strength - table[at]) / (table[at + RUNG] - table[at])
    s = min(way, 1.0)
    k, g = _mix(table, at, s), math.sqrt(_mix(table, at + 1, s))
    p0, p1, p2 = _mix(table, at + 2, s), _mix(table, at + 3, s), _mix(table, at + 4, s)
    w0, w1, w2 = _mix(table, at + 5, s), _mix(table, at + 6, s), _mix(table, at + 7, s)
    return Rung((at - HEADER) / RUNG, s, 1.0 if way <= _ROUNDING else 0.0, k, g, p0, p1, p2, w0, w1, w2)


@kernel(inline=True)
def _mix(table: Array, at: int, share: float) -> float:
    """Interpolate a number of two rungs."""
    number: float = table[at] + share * (table[at + RUNG] - table[at])
    return number


@kernel(inline=True)
def strength_at(axes: Axes, speed: float, radius: float) -> float:
    """Strength k at the rate of an impact."""
    return 1.0 + axes.slope * max(axes.log_rate + RATE_POWER * log(speed) - log(radius), 0.0)


class Place(NamedTuple):
    """Place of an impact in a table."""

    row: float
    column: float  # -1 outside the table
    p: float
    w: float  # w^(1/4)
    root: float  # V^(1/5) exp(eta) g^(2/5) over mass^(2/5), if it is known


@kernel(inline=True)
def on_grid(head: Head, on: Rung, x: float, above: float, root: float, valid: bool, clamp: bool) -> Place:
    """Place of x and of p, which is `above` times w^(1/4); `clamp` takes the nearest one."""
    axes = head.axes
    near_x = x if 0.0 <= x <= axes.x_max else axes.x_max
    elastic = powers(head.w, near_x) * (on.w0 + near_x * (on.w1 + near_x * on.w2))
    end = max(powers(head.end, near_x) * (on.p0 + near_x * (on.p1 + near_x * on.p2)), 1.0)
    p, top = above * elastic, max(axes.top * on.p0, NEXT * end) if axes.after > 0.0 else end
    near_p = p if p <= top else top
    over, under, first = 2.0 * axes.beyond * (near_p - 1.0), near_p + end - 2.0, axes.below + 3.0
    over, under, first = (2.0 * axes.below * near_p, near_p + 1.0, 0.0) if near_p <= 1.0 else (over, under, first)
    after, last = (near_p > end) & (axes.after > 0.0), axes.below + axes.beyond + 6.0
    over, under, first = (axes.after * (near_p - end), top - end, last) if after else (over, under, first)
    inside = valid & (near_x == x) & (near_p == p) & (on.inside > 0.0)
    column = first + over / under if inside | clamp else -1.0
    return Place(near_x * (axes.rows / axes.x_max), column, near_p, elastic, root)


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
    return on_grid(head, on, x, above, root / slower, is_valid(speed, radius, thickness), False)


@kernel(inline=True)
def place_of(
    table: Array, head: Head, speed: float, radius: float, thickness: float, mass: float
) -> tuple[Place, Rung]:
    """Place of an impact, and that of its strength."""
    on, usual = SINGLE, not relaxes(head.plate) and mass == 1.0
    if head.axes.rungs > 1.0:
        on = rung_of(table, head.axes, strength_at(head.axes, speed, radius))
    return place(head, speed, radius, thickness, mass, on, is_thin(head.plate.corrections), usual), on


@kernel(inline=True)
def place_at(table: Array, head: Head, lam: float, y: float, log_strength: float, clamp: bool) -> tuple[Place, Rung]:
    """Place of an inelasticity, a yield ratio and ln of a strength."""
    on, above = rung_of(table, head.axes, math.exp(log_strength)), 1.0 / math.sqrt(math.sqrt(head.axes.unit * y))
    return on_grid(head, on, lam / (lam + STRETCH), above, math.nan, True, clamp), on


@kernel(inline=True)
def field(table: Array, axes: Axes, which: int, at: Place, on: Rung) -> float:
    """Interpolate a field at a place and between two rungs."""
    rungs, size = int(axes.rungs), int(axes.size)
    begin = HEADER + RUNG * rungs + (which * rungs + int(on.lower)) * size
    low = value(table, begin, axes, at.row, at.column)
    return low + on.between * (value(table, begin + size, axes, at.row, at.column) - low) if rungs > 1 else low


@kernel(inline=True)
def value(table: Array, begin: int, axes: Axes, row: float, column: float) -> float:
    """Interpolate in 4 x 4 coefficients of one rung, whose block has its beginning there."""
    i, j, stride = int(row), int(column), int(axes.stride)
    return spline_value(table, begin + i * stride + j, stride, row - i, column - j)


@kernel(inline=True)
def cor_from(lost: float) -> float:
    """COR from the field 1 - COR, whose spline may pass its limits by its error."""
    return 1.0 - min(max(lost, 0.0), 1.0)


@kernel(inline=True)
def cor_of(table: Array, axes: Axes, at: Place, on: Rung) -> float:
    """COR at a place; NaN outside the table."""
    return cor_from(field(table, axes, 0, at, on)) if at.column >= 0.0 else math.nan


@kernel(cache=True)
def restitution_on_plate(table: Array, speed: float, radius: float, thickness: float, mass: float) -> float:
    """COR of one sphere on a plate; NaN for bad input and outside the table.

    The mass is over that of a solid sphere.
    """
    head = head_of(table)
    at, on = place_of(table, head, speed, radius, thickness, mass)
    return cor_of(table, head.axes, at, on)


@kernel(inline=True)
def _write_places(
    head: Head, hit: Impact, start: int, k: Array, s: Array, thin: bool, usual: bool, rated: bool
) -> None:
    """Write the places of a chunk of impacts into s; their strengths are in k."""
    solid = usual or hit.mass.size == 0
    for i in range(min(hit.speed.size - start, _CHUNK)):
        n, on = start + i, numbers_at(Rung, k, i, _CHUNK) if rated else SINGLE
        mass = 1.0 if solid else hit.mass[n]
        at = place(head, hit.speed[n], hit.radius[n], hit.thickness[n], mass, on, thin, usual)
        for c in range(len(at)):
            s[c * _CHUNK + i] = at[c]


@kernel
def _find(table: Array, head: Head, hit: Impact, start: int, k: Array, s: Array) -> int:
    """Find the places of a chunk of impacts, and those of their strengths; return how many there are."""
    rated, thin, usual = head.axes.rungs > 1.0, is_thin(head.plate.corrections), not relaxes(head.plate)
    count: int = min(hit.speed.size - start, _CHUNK)
    if rated:
        for i in range(count):
            s[i] = strength_at(head.axes, hit.speed[start + i], hit.radius[start + i])
        for i in range(count):
            on = rung_of(table, head.axes, s[i])
            for c in range(len(on)):
                k[c * _CHUNK + i] = on[c]
    # constants let the compiler leave out what a loop has not
    if not usual or hit.mass.size > 0:
        _write_places(head, hit, start, k, s, thin, False, rated)
    elif thin:
        _write_places(head, hit, start, k, s, True, True, False)
    else:
        _write_places(head, hit, start, k, s, False, True, rated)
    return count


@kernel(cache=True)
def restitutions(table: Array, speed: Array, radius: Array, thickness: Array, mass: Array, out: Array) -> int:
    """Write the COR of many spheres on plates into out; return how many are NaN.

    Masses are over those of solid spheres; without any, all spheres are.
    """
    head, k, s, bad = head_of(table), np.zeros(_SCRATCH), np.zeros(_SCRATCH), 0
    for start in range(0, out.size, _CHUNK):
        for i in range(_find(table, head, Impact(speed, radius, thickness, mass), start, k, s)):
            at, on = numbers_at(Place, s, i, _CHUNK), numbers_at(Rung, k, i, _CHUNK)
            out[start + i] = cor_of(table, head.axes, at, on)
            bad += at.column < 0.0
    return bad


@kernel(cache=True)
def outcomes(
    table: Array, speed: Array, radius: Array, thickness: Array, mass: Array, out: Outcome, root: Array
) -> int:
    """Write all fields of valid impacts on plates; return how many are NaN, being outside.

    V^(1/5) exp(eta) g^(2/5), over the mass to the power 2/5, goes into root.
    """
    head, k, s, bad = head_of(table), np.zeros(_SCRATCH), np.zeros(_SCRATCH), 0
    for start in range(0, speed.size, _CHUNK):
        for i in range(_find(table, head, Impact(speed, radius, thickness, mass), start, k, s)):
            at, on = numbers_at(Place, s, i, _CHUNK), numbers_at(Rung, k, i, _CHUNK)
            _write(table, head.axes, at, on, out, start + i)
            root[start + i] = at.root
            bad += at.column < 0.0
    return bad


@kernel(cache=True)
def fields(table: Array, clamp: bool, out: Outcome) -> int:
    """Write fields at the inelasticities, yield ratios and strengths of `out`; count those outside.

    Outside the table fields are NaN, unless `clamp` takes the nearest point of its border, and
    puts that point's coordinates in place of the impact's.
    """
    head, bad = head_of(table), 0
    for n in range(out.inelasticity.size):
        at, on = place_at(table, head, out.inelasticity[n], out.yield_ratio[n], out.strength[n], clamp)
        _write(table, head.axes, at, on, out, n)
        bad += at.column < 0.0
    return bad


@kernel(inline=True)
def _write(table: Array, axes: Axes, at: Place, on: Rung, out: Outcome, n: int) -> None:
    """Write the fields of impact n; outside the table they are NaN."""
    if at.column < 0.0:
        out.restitution[n] = out.contact_time[n] = out.wave_rate[n] = math.nan
        out.compression_ratio[n] = out.elastic_compression[n] = math.nan
        return
    ratio, x = at.w / at.p, at.row * (axes.x_max / axes.rows)
    out.restitution[n] = cor_from(field(table, axes, 0, at, on))
    out.contact_time[n] = 1.0 / field(table, axes, 1, at, on)
    out.wave_rate[n] = field(table, axes, 2, at, on)
    out.compression_ratio[n] = field(table, axes, 3, at, on)
    out.elastic_compression[n] = (at.w * at.w) * (at.w * at.w)
    out.inelasticity[n] = STRETCH * x / (1.0 - x)
    out.yield_ratio[n] = (ratio * ratio) * (ratio * ratio) / axes.unit
    out.strength[n] = log(on.k) if axes.rungs > 1.0 else 0.0
