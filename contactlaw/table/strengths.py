"""Lookups for pairs whose strength grows with the rate of strain: between tables of rate-free ones.

An impact makes its pair stronger by a factor k = 1 + C ln(rate/rate0), at a rate that is a share of
V/R. Its COR is the cubic in ln k through those of four nodes, rate-free pairs that are stronger by
fixed factors. All are asked at the impact's own lambda and at overloads like its own: the same up
to yield; beyond, ln chi is the same share of LENGTH, the ln chi at which the law's range ends. So
the kinks at yield and at the end of the range lie at one place in all four, and what is
interpolated is smooth: at equal chi it would err by 2e-3.

The range of ln k is divided into pieces, with nodes at -1, -1/2, 1/2 and 1 of each: Chebyshev's
extrema. Neighbours share the node between them. A piece has the header of its first node's table
and the splines of all four COR on that table's grid, their coefficients side by side, so that one
vector instruction serves four nodes. All is packed into one array, as `contactlaw.table.lookup`
does it: a header,

    MARK       -1: no table of `lookup`   EDGE       ln chi over LENGTH at which the table ends
    SLOPE      C                          PIECES     number of pieces
    LOG_SHARE  ln(rate/rate0) at 1 /s

the ends of the pieces in ln k, from KNOTS on; for each piece, of its four nodes

    LENGTH     see above                  SERIES     entry of the series of ln w_m
    SHIFT      c_chi less that of k = 1   AT         entry of the piece's header
    SATURATED  of the plate

and the pieces.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation import outcome
from contactlaw.equation.corrections import is_thin
from contactlaw.equation.numbers import (
    inelasticity_of,
    plate_stiffening,
    relaxed,
    relaxes,
    with_saturation,
)
from contactlaw.table import lookup, splines
from contactlaw.table.lookup import LOG_CHI_MAX, STRETCH, X_MAX
from contactlaw.table.nodes import Table
from contactlaw.table.slides import change

Array = NDArray[np.float64]
Four = tuple[float, float, float, float]

MARK, SLOPE, LOG_SHARE, EDGE, PIECES, KNOTS = range(6)
LENGTH, SHIFT, SATURATED, SERIES, AT, PIECE = 0, 4, 8, 12, 13, 14
PLACES = (-1.0, -0.5, 0.5, 1.0)  # of a piece's nodes
LAGRANGE = (  # coefficients of the cubics that are 1 at one of the places
    (-2.0 / 3.0, 2.0 / 3.0, 1.0 / 6.0, -1.0 / 6.0),
    (4.0 / 3.0, -2.0 / 3.0, -4.0 / 3.0, 2.0 / 3.0),
    (-4.0 / 3.0, -2.0 / 3.0, 4.0 / 3.0, 2.0 / 3.0),
    (2.0 / 3.0, 2.0 / 3.0, -1.0 / 6.0, -1.0 / 6.0),
)
_END = 1.0 + 1e-12  # of a piece in t: rounding leaves no gap between two of them
_CHUNK = 256  # impacts at a time, as in `lookup`


class Node(NamedTuple):
    """A rate-free pair, stronger by a fixed factor."""

    table: Table
    packed: Array  # with the corrections of its plates
    length: float
    log_overload: float  # c_chi


def pack(slope: float, log_share: float, knots: Sequence[float], nodes: Sequence[Node]) -> Array:
    """Pack the tables of the nodes, three for a piece and one."""
    edge = min(one.packed[LOG_CHI_MAX] / one.length for one in nodes)
    head = [-1.0, slope, log_share, edge, len(knots) - 1.0, *knots]
    at, entries, parts = len(head) + PIECE * (len(knots) - 1), [], []
    for first in range(0, len(nodes) - 1, 3):
        four = nodes[first : first + 4]
        series = [one.packed[lookup.HEADER : lookup.HEADER + lookup.DEGREE + 1] for one in four]
        entries += [one.length for one in four]
        entries += [one.log_overload - nodes[0].log_overload for one in four]
        entries += [one.packed[lookup.SATURATED] for one in four]
        parts += [*series, _piece(four)]
        entries += [at, at + sum(map(len, series))]
        at += sum(map(len, parts[-5:]))
    return np.concatenate([head, entries, *parts])


def _piece(nodes: Sequence[Node]) -> Array:
    """Header of the first node's table, and splines of the COR of four on its grid."""
    grid = nodes[0].table.grid
    lam, log_chi = grid.nodes()
    cor = np.empty((*log_chi.shape, len(nodes)))
    for n, one in enumerate(nodes):
        share = one.length / nodes[0].length
        found = outcome.at(np.broadcast_to(lam, log_chi.shape).ravel(), np.empty(log_chi.size))
        log_w = [lookup.log_elastic_compression(one.packed, row) for row in lam[:, 0].tolist()]
        alike = np.where(log_chi > 0.0, share * log_chi, log_chi)
        found.yield_ratio[:] = np.exp(np.array(log_w)[:, None] - alike).ravel()
        lookup.fields(one.packed, True, found)
        cor[..., n] = found.restitution.reshape(log_chi.shape)
    head = nodes[0].packed[: int(nodes[0].packed[lookup.COR_AT])].copy()
    return np.concatenate([head, splines.surface(cor, grid).ravel()])


class Place(NamedTuple):
    """Place of an impact among the tables."""

    inside: bool
    first: int  # entry of its piece
    weights: Four
    log_w: Four  # ln w_m of the nodes, at the nearest x inside
    strength: float  # ln k
    inelasticity: float
    x: float  # the nearest inside
    log_chi: float
    length: float
    root: float  # V^(1/5) exp(eta) g^(2/5)


@kernel(inline=True)
def _at(c: Four, t: float) -> float:
    """Cubic in t, the third power first."""
    return ((c[0] * t + c[1]) * t + c[2]) * t + c[3]


@kernel(inline=True)
def weights(t: float) -> Four:
    """Lagrange's polynomials of a piece's nodes, at t in [-1, 1]."""
    return _at(LAGRANGE[0], t), _at(LAGRANGE[1], t), _at(LAGRANGE[2], t), _at(LAGRANGE[3], t)


@kernel(inline=True)
def _log_strength(slope: float, log_share: float, log_speed: float, radius: float) -> float:
    """Logarithm of the factor k by which an impact makes its pair stronger."""
    log_rate = log_share + log_speed - lookup.log_and_root(radius)[0]
    return lookup.log_and_root(1.0 + slope * max(log_rate, 0.0))[0]


@kernel(inline=True)
def like(log_chi: float, share: float) -> float:
    """Ln chi of a node that is like that of the impact; share of their lengths."""
    return log_chi * share if log_chi > 0.0 else log_chi


@kernel(inline=True)
def _sum(w: Four, values: Four) -> float:
    return (w[0] * values[0] + w[1] * values[1]) + (w[2] * values[2] + w[3] * values[3])


@kernel
def _entries(table: Array, at: int) -> Four:
    """Entries of the four nodes of a piece."""
    return table[at], table[at + 1], table[at + 2], table[at + 3]


@kernel
def _head(table: Array, first: int) -> Array:
    """Header and splines of a piece."""
    return table[int(table[first + AT]) :]


@kernel
def _series(table: Array, first: int, n: int) -> tuple[float, ...]:
    """Series of ln w_m of one of four nodes."""
    return lookup.series_at(table, int(table[first + SERIES]) + n * (lookup.DEGREE + 1))


@kernel
def place_of(
    table: Array, c_lam: float, c_chi: float, speed: float, radius: float, ratio: float
) -> Place:
    """Place of an impact whose V, R and R/H are in their limits."""
    log_speed, root = lookup.log_and_root(speed)
    strength = _log_strength(table[SLOPE], table[LOG_SHARE], log_speed, radius)
    k, last = KNOTS, KNOTS + int(table[PIECES])
    while k + 1 < last and strength > table[k + 1]:
        k += 1
    t = 2.0 * (min(strength, table[last]) - table[k]) / (table[k + 1] - table[k]) - 1.0
    w, first = weights(t), last + 1 + PIECE * (k - KNOTS)
    node = _head(table, first)
    known, stiffer = lookup.plate_of(node, c_lam), 1.0
    log_chi = c_chi + _sum(w, _entries(table, first + SHIFT)) + 0.8 * log_speed
    saturated = _sum(w, _entries(table, first + SATURATED))
    plate = with_saturation(known, saturated)
    if relaxes(plate):
        log_time = lookup.log_and_root(radius)[0] - 0.2 * log_speed
        plate, root, growth = relaxed(plate, root, log_time)
        log_chi -= (0.4 + plate.growth.yield_power) * growth
    if not is_thin(plate.corrections):
        eta = plate_stiffening(plate, root, ratio)
        stiffer = lookup.exp(eta)
        log_chi -= eta
    lam = inelasticity_of(plate, root, ratio, stiffer)
    x = lam / (lam + node[STRETCH])
    near = min(x, node[X_MAX])
    t = 2.0 / node[X_MAX] * near - 1.0
    log_w = (
        lookup.evaluate(_series(table, first, 0), t),
        lookup.evaluate(_series(table, first, 1), t),
        lookup.evaluate(_series(table, first, 2), t),
        lookup.evaluate(_series(table, first, 3), t),
    )
    log_chi += _sum(w, log_w)
    length = _sum(w, _entries(table, first + LENGTH))
    inside = x <= near and log_chi <= table[EDGE] * length and strength <= table[last]
    return Place(
        inside, first, w, log_w, strength, lam, near, log_chi, length, root * stiffer
    )  # fmt: skip


@kernel(inline=True)
def _along(table: Array, p: np.uint64, b: Four) -> Four:
    """Sum four splines along ln chi, whose coefficients begin at p, side by side."""
    q, r, o = p + np.uint64(4), p + np.uint64(8), p + np.uint64(12)
    i, j, k = np.uint64(1), np.uint64(2), np.uint64(3)
    return (
        b[0] * table[p] + b[1] * table[q] + b[2] * table[r] + b[3] * table[o],
        b[0] * table[p + i] + b[1] * table[q + i] + b[2] * table[r + i] + b[3] * table[o + i],
        b[0] * table[p + j] + b[1] * table[q + j] + b[2] * table[r + j] + b[3] * table[o + j],
        b[0] * table[p + k] + b[1] * table[q + k] + b[2] * table[r + k] + b[3] * table[o + k],
    )


@kernel(inline=True)
def _cor(table: Array, p: np.uint64, step: np.uint64, s: float, along: float, w: Four) -> float:
    """COR from the splines of four nodes and their weights."""
    a, b = lookup.weights(s), lookup.weights(along)
    c, d = _along(table, p, b), _along(table, p + step, b)
    e, f = _along(table, p + step + step, b), _along(table, p + step + step + step, b)
    four = (
        w[0] * (a[0] * c[0] + a[1] * d[0] + a[2] * e[0] + a[3] * f[0]),
        w[1] * (a[0] * c[1] + a[1] * d[1] + a[2] * e[1] + a[3] * f[1]),
        w[2] * (a[0] * c[2] + a[1] * d[2] + a[2] * e[2] + a[3] * f[2]),
        w[3] * (a[0] * c[3] + a[1] * d[3] + a[2] * e[3] + a[3] * f[3]),
    )
    value: float = ((four[0] + four[1]) + (four[2] + four[3])) * (1.0 / 36.0)
    return min(max(value, 0.0), 1.0)


@kernel
def cor_at(table: Array, place: Place) -> float:
    """COR at a place."""
    node = _head(table, place.first)
    log_chi = like(place.log_chi, table[place.first + LENGTH] / place.length)
    row, column, s, along = lookup.locate(node, place.x, log_chi)
    step = 4 * int(node[lookup.COLUMNS])
    p = int(node[lookup.COR_AT]) + row * step + 4 * column
    return _cor(node, np.uint64(p), np.uint64(step), s, along, place.weights)


@kernel(cache=True)
def restitution(
    table: Array, c_lam: float, c_chi: float, speed: float, radius: float, ratio: float
) -> float:
    """COR for a ratio R/H; NaN where the speed is no positive number and outside the tables."""
    if not lookup.V_MIN <= speed <= lookup.V_MAX:
        return math.nan
    place = place_of(table, c_lam, c_chi, speed, radius, ratio)
    return cor_at(table, place) if place.inside else math.nan


@kernel(cache=True)
def restitution_on_plate(
    table: Array, c_lam: float, c_chi: float, speed: float, radius: float, thickness: float
) -> float:
    """COR of one sphere on a plate; NaN for bad input and outside the tables."""
    if not lookup.is_valid(speed, radius, thickness):
        return math.nan
    return restitution(table, c_lam, c_chi, speed, radius, radius / thickness)


@kernel(inline=True)
def is_rated(table: Array) -> bool:
    """Whether an array has tables of several strengths, rather than one table."""
    return bool(table[MARK] < 0.0)


def pack_slides(ends: Sequence[Array]) -> Array:
    """Pack the tangential rebounds of the nodes at the knots."""
    at = np.cumsum([len(ends), *(one.size for one in ends[:-1])]).astype(float)
    return np.concatenate([at, *ends])


@kernel
def change_at(table: Array, slides: Array, place: Place, e: float, psi: float) -> float:
    """Change of the contact point's speed [mu V0]: linear in ln k between the ends of a piece.

    With all four nodes it would err by 6e-4 rather than 2e-3, and take twice as long to prepare.
    """
    w = place.weights
    share = 0.5 + 0.5 * ((w[3] - w[0]) + 0.5 * (w[2] - w[1]))  # weights are exact for t itself
    piece = (place.first - KNOTS - int(table[PIECES]) - 1) // PIECE
    log_chi, lengths = (
        min(place.log_chi, table[EDGE] * place.length),
        _entries(table, place.first + LENGTH),
    )
    low, high = slides[int(slides[piece]) :], slides[int(slides[piece + 1]) :]
    below = change(low, place.x, like(log_chi, lengths[0] / place.length), e, psi)
    above = change(high, place.x, like(log_chi, lengths[3] / place.length), e, psi)
    return below + share * (above - below)


@kernel(cache=True)
def changes(
    table: Array, slides: Array, c_lam: float, c_chi: float, speed: Array, radius: Array,
    thickness: Array, e: Array, psi: Array, out: Array,
) -> None:  # fmt: skip
    """`change_at` of many impacts, those beyond the tables at their border."""
    for i in range(psi.size):
        ratio = radius[i] / thickness[i]
        place = place_of(table, c_lam, c_chi, speed[i], radius[i], ratio)
        out[i] = change_at(table, slides, place, e[i], psi[i])


class Places(NamedTuple):
    """Places of many impacts, moved to the border where they are beyond it."""

    piece: NDArray[np.int64]
    inside: NDArray[np.bool_]
    weights: Array  # (4, impacts)
    yield_ratio: Array  # y of the nodes, (4, impacts)
    strength: Array
    inelasticity: Array
    unclamped: Array  # the inelasticity before it was moved
    overload: Array  # before it was moved
    largest: Array  # overload of the border
    elastic_compression: Array
    root: Array


def empty(count: int) -> Places:
    """Allocate places."""
    four, one = (np.empty((4, count)) for _ in range(2)), np.empty((7, count))
    return Places(np.empty(count, dtype=np.int64), np.empty(count, dtype=np.bool_), *four, *one)


@kernel(cache=True)
def locate(
    table: Array, c_lam: float, c_chi: Array, speed: Array, radius: Array, ratio: Array, out: Places
) -> None:
    """Find the places of impacts whose inputs are in their limits."""
    knots = int(table[PIECES]) + 1
    stretch = _head(table, KNOTS + knots)[STRETCH]
    for i in range(speed.size):
        at = place_of(table, c_lam, c_chi[i], speed[i], radius[i], ratio[i])
        out.piece[i], out.inside[i] = (at.first - KNOTS - knots) // PIECE, at.inside
        out.strength[i], out.root[i] = at.strength, at.root
        out.unclamped[i] = at.inelasticity
        out.inelasticity[i] = min(at.inelasticity, stretch * at.x / (1.0 - at.x))
        most = table[EDGE] * at.length
        out.overload[i], out.largest[i] = math.exp(at.log_chi), math.exp(most)
        out.elastic_compression[i] = math.exp(_sum(at.weights, at.log_w))
        lengths = _entries(table, at.first + LENGTH)
        for n in range(4):
            out.weights[n, i] = at.weights[n]
            log_chi = like(min(at.log_chi, most), lengths[n] / at.length)
            out.yield_ratio[n, i] = math.exp(at.log_w[n] - log_chi)


@kernel(inline=True)
def _row(scratch: Array, row: int, count: int) -> Array:
    """First `count` numbers of a row of scratch memory."""
    return scratch[row, :count]


@kernel(inline=True)
def _slice(values: Array, start: int, count: int) -> Array:
    """Part of an array."""
    return values[start : start + count]


@kernel
def _cubic(v: Four) -> Four:
    """Coefficients of the cubic through values at a piece's nodes."""
    a, b, c, d = LAGRANGE
    return (
        v[0] * a[0] + v[1] * b[0] + v[2] * c[0] + v[3] * d[0],
        v[0] * a[1] + v[1] * b[1] + v[2] * c[1] + v[3] * d[1],
        v[0] * a[2] + v[1] * b[2] + v[2] * c[2] + v[3] * d[2],
        v[0] * a[3] + v[1] * b[3] + v[2] * c[3] + v[3] * d[3],
    )


@kernel
def _coordinates(
    table: Array, c_lam: float, c_chi: float, first: int, log_speed: Array, root: Array, t: Array,
    radius: Array, ratio: Array, x: Array, log_chi: Array, length: Array, eta: Array,
) -> None:  # fmt: skip
    """Coordinates of impacts as `place_of` has them, in loops with one array that is written."""
    node = _head(table, first)
    saturated = _cubic(_entries(table, first + SATURATED))
    known, stretch = lookup.plate_of(node, c_lam), node[STRETCH]
    if relaxes(known):
        for i in range(x.size):
            log_time = lookup.log_and_root(radius[i])[0] - 0.2 * log_speed[i]
            plate = with_saturation(known, _at(saturated, t[i]))
            plate, faster, growth = relaxed(plate, root[i], log_time)
            stiffer = plate_stiffening(plate, faster, ratio[i])
            lam = inelasticity_of(plate, faster, ratio[i], lookup.exp(stiffer))
            x[i] = lam / (lam + stretch)
            eta[i] = stiffer + (0.4 + known.growth.yield_power) * growth
    else:
        for i in range(x.size):
            plate = with_saturation(known, _at(saturated, t[i]))
            eta[i] = plate_stiffening(plate, root[i], ratio[i])
        for i in range(x.size):
            plate = with_saturation(known, _at(saturated, t[i]))
            lam = inelasticity_of(plate, root[i], ratio[i], lookup.exp(eta[i]))
            x[i] = lam / (lam + stretch)
    shifts = _cubic(_entries(table, first + SHIFT))
    for i in range(x.size):
        log_chi[i] = c_chi + _at(shifts, t[i]) + (0.8 * log_speed[i] - eta[i])
    scale = 2.0 / node[X_MAX]
    for n in range(4):
        w = LAGRANGE[n]
        series = _series(table, first, n)
        for i in range(x.size):
            log_chi[i] += _at(w, t[i]) * lookup.evaluate(series, scale * x[i] - 1.0)
    lengths = _cubic(_entries(table, first + LENGTH))
    for i in range(x.size):
        length[i] = _at(lengths, t[i])


@kernel
def _are_inside(
    speed: Array, radius: Array, thickness: Array, t: Array, x: Array, log_chi: Array,
    length: Array, x_max: float, edge: float,
) -> bool:  # fmt: skip
    """Whether all impacts are valid, in a piece and in its tables."""
    good = 0
    for i in range(x.size):
        valid = lookup.is_valid(speed[i], radius[i], thickness[i]) & (x[i] >= 0.0) & (x[i] <= x_max)
        good += valid & (abs(t[i]) <= _END) & (log_chi[i] <= edge * length[i])
    return good == x.size


@kernel(cache=True)
def restitutions(
    table: Array, c_lam: float, c_chi: float, speed: Array, radius: Array, thickness: Array,
    out: Array,
) -> int:  # fmt: skip
    """Write the COR of many spheres on plates into out; return how many are NaN."""
    scratch, cells = np.empty((12, _CHUNK)), np.empty(_CHUNK, dtype=np.int32)
    slope, log_share, edge = table[SLOPE], table[LOG_SHARE], table[EDGE]
    pieces, bad = int(table[PIECES]), 0
    for start in range(0, out.size, _CHUNK):
        n = min(_CHUNK, out.size - start)
        v, r, h = _slice(speed, start, n), _slice(radius, start, n), _slice(thickness, start, n)
        values, first = _slice(out, start, n), cells[:n]
        log_v, root, strength = _row(scratch, 0, n), _row(scratch, 1, n), _row(scratch, 2, n)
        x, log_chi, length = _row(scratch, 3, n), _row(scratch, 4, n), _row(scratch, 5, n)
        along, t, ratio = _row(scratch, 6, n), _row(scratch, 7, n), _row(scratch, 8, n)
        outside, a, b = _row(scratch, 9, n), _row(scratch, 10, n), _row(scratch, 11, n)
        for i in range(n):
            log_v[i], root[i] = lookup.log_and_root(v[i])
        for i in range(n):
            strength[i] = _log_strength(slope, log_share, log_v[i], r[i])
        for i in range(n):
            ratio[i] = r[i] / h[i]
        for i in range(n):
            values[i] = math.nan
        for k in range(pieces):
            low, high = table[KNOTS + k], table[KNOTS + k + 1]
            here = 0
            for i in range(n):
                t[i] = (2.0 * strength[i] - (low + high)) / (high - low)
                here += abs(t[i]) <= _END
            if here == 0:
                continue
            row = KNOTS + pieces + 1 + PIECE * k
            node = _head(table, row)
            x_max = node[X_MAX]
            _coordinates(table, c_lam, c_chi, row, log_v, root, t, r, ratio, x, log_chi, length, a)
            whole = _are_inside(v, r, h, t, x, log_chi, length, x_max, edge)
            for i in range(n):
                outside[i] = 0.0
            if not whole:
                for i in range(n):
                    inside = lookup.is_valid(v[i], r[i], h[i]) & (x[i] >= 0.0) & (x[i] <= x_max)
                    if not (inside & (abs(t[i]) <= _END) & (log_chi[i] <= edge * length[i])):
                        x[i], log_chi[i], t[i], length[i], outside[i] = 0.0, 0.0, 0.0, 1.0, math.nan
            own = table[row + LENGTH]
            for i in range(n):
                log_chi[i] = like(log_chi[i], own / length[i])
            lookup.locate_all(node, x, log_chi, first, along, a, b)
            cor_at, step = int(node[lookup.COR_AT]), np.uint64(4 * int(node[lookup.COLUMNS]))
            for i in range(n):
                p = np.uint64(cor_at + 4 * first[i])
                cor = outside[i] + _cor(node, p, step, x[i], along[i], weights(t[i]))
                values[i] = cor if cor == cor else values[i]
        for i in range(n):
            bad += values[i] != values[i]
    return bad
