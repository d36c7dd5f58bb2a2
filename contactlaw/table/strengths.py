"""Lookups for pairs whose strength grows with the rate of strain: between tables of rate-free ones.

An impact makes its pair stronger by a factor k = 1 + C ln(rate/rate0), at a rate that is a share of
V/R. Its COR is the cubic in ln k through those of four nodes, rate-free pairs that are stronger by
fixed factors. All are asked at the impact's own lambda and at overloads like its own: the same up
to yield; beyond, ln chi is the same share of LENGTH, the ln chi at which the law's range ends. So
the kinks at yield and at the end of the range lie at one place in all four, and what is
interpolated is smooth: at equal chi it would err by 2e-3.

The range of ln k is divided into pieces, with nodes at -1, -1/2, 1/2 and 1 of each: Chebyshev's
extrema. Neighbours share the node between them. All is packed into one array, as
`contactlaw.table.lookup` does it: a header,

    MARK       -1: no table of `lookup`   EDGE       ln chi over LENGTH at which the table ends
    SLOPE      C                          PIECES     number of pieces
    LOG_SHARE  ln(rate/rate0) at 1 /s

the ends of the pieces in ln k, from KNOTS on; four entries for each node, three for a piece and one

    LENGTH     see above                  SATURATED  of the plate, see `PlateConstants`
    SHIFT      c_chi less that of k = 1   AT         where the node's table begins

and the tables of the nodes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation.corrections import is_thin
from contactlaw.equation.numbers import PlateConstants, inelasticity_of, plate_stiffening
from contactlaw.table import lookup
from contactlaw.table.lookup import LOG_CHI_MAX, STRETCH, X_MAX
from contactlaw.table.slides import change

Array = NDArray[np.float64]
Four = tuple[float, float, float, float]

MARK, SLOPE, LOG_SHARE, EDGE, PIECES, KNOTS = range(6)
LENGTH, SHIFT, SATURATED, AT, NODE = range(5)
PLACES = (-1.0, -0.5, 0.5, 1.0)  # of a piece's nodes
_CHUNK = 256  # impacts at a time: the scratch arrays stay in the first-level cache


class Node(NamedTuple):
    """A rate-free pair, stronger by a fixed factor."""

    table: Array  # packed, with the corrections of its plates
    length: float
    log_overload: float  # c_chi


def pack(slope: float, log_share: float, knots: Sequence[float], nodes: Sequence[Node]) -> Array:
    """Pack the tables of the nodes, three for a piece and one."""
    edge = min(one.table[LOG_CHI_MAX] / one.length for one in nodes)
    head = [-1.0, slope, log_share, edge, len(knots) - 1.0, *knots]
    at, rows = len(head) + NODE * len(nodes), []
    for one in nodes:
        shift = one.log_overload - nodes[0].log_overload
        rows += [one.length, shift, one.table[lookup.SATURATED], float(at)]
        at += one.table.size
    return np.concatenate([head, rows, *(one.table for one in nodes)])


class Place(NamedTuple):
    """Place of an impact among the tables."""

    inside: bool
    first: int  # entry of the first of its four nodes
    weights: Four
    log_w: Four  # ln w_m of the nodes, at the nearest x inside
    strength: float  # ln k
    inelasticity: float
    x: float  # the nearest inside
    log_chi: float
    length: float
    root: float  # V^(1/5) exp(eta)


@kernel(inline=True)
def weights(t: float) -> Four:
    """Lagrange's polynomials of a piece's nodes, at t in [-1, 1]."""
    a, b = (t * t - 0.25) * (2.0 / 3.0), (t * t - 1.0) * (4.0 / 3.0)
    return a * (1.0 - t), b * (t - 0.5), -b * (t + 0.5), a * (1.0 + t)


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
def _entries(table: Array, first: int, entry: int) -> Four:
    """One entry of four nodes."""
    at, n = first + entry, NODE
    return table[at], table[at + n], table[at + 2 * n], table[at + 3 * n]


@kernel
def _node(table: Array, first: int, n: int) -> Array:
    """Table of one of four nodes."""
    return table[int(table[first + n * NODE + AT]) :]


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
    w, first = weights(t), last + 1 + 3 * NODE * (k - KNOTS)
    node = _node(table, first, 0)
    known, stiffer = lookup.plate_of(node, c_lam), 1.0
    log_chi = c_chi + _sum(w, _entries(table, first, SHIFT)) + 0.8 * log_speed
    saturated = _sum(w, _entries(table, first, SATURATED))
    plate = PlateConstants(c_lam, known.transit, known.x_at_one, saturated, known.corrections)
    if not is_thin(plate.corrections):
        eta = plate_stiffening(plate, root, ratio)
        stiffer = lookup.exp(eta)
        log_chi -= eta
    lam = inelasticity_of(plate, root, ratio, stiffer)
    x = lam / (lam + node[STRETCH])
    near = min(x, node[X_MAX])
    log_w = (
        lookup.log_elastic(node, near),
        lookup.log_elastic(_node(table, first, 1), near),
        lookup.log_elastic(_node(table, first, 2), near),
        lookup.log_elastic(_node(table, first, 3), near),
    )
    log_chi += _sum(w, log_w)
    length = _sum(w, _entries(table, first, LENGTH))
    inside = x <= near and log_chi <= table[EDGE] * length and strength <= table[last]
    return Place(
        inside, first, w, log_w, strength, lam, near, log_chi, length, root * stiffer
    )  # fmt: skip


@kernel
def cor_at(table: Array, place: Place) -> float:
    """COR at a place."""
    value, lengths = 0.0, _entries(table, place.first, LENGTH)
    for n in range(4):
        log_chi = like(place.log_chi, lengths[n] / place.length)
        value += place.weights[n] * lookup.cor_at(_node(table, place.first, n), place.x, log_chi)
    return min(max(value, 0.0), 1.0)


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
    piece = (place.first - KNOTS - int(table[PIECES]) - 1) // (3 * NODE)
    log_chi, lengths = (
        min(place.log_chi, table[EDGE] * place.length),
        _entries(table, place.first, LENGTH),
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
    knots, stretch = (
        int(table[PIECES]) + 1,
        _node(table, KNOTS + int(table[PIECES]) + 1, 0)[STRETCH],
    )
    for i in range(speed.size):
        at = place_of(table, c_lam, c_chi[i], speed[i], radius[i], ratio[i])
        out.piece[i], out.inside[i] = (at.first - KNOTS - knots) // (3 * NODE), at.inside
        out.strength[i], out.root[i] = at.strength, at.root
        out.unclamped[i] = at.inelasticity
        out.inelasticity[i] = min(at.inelasticity, stretch * at.x / (1.0 - at.x))
        most = table[EDGE] * at.length
        out.overload[i], out.largest[i] = math.exp(at.log_chi), math.exp(most)
        out.elastic_compression[i] = math.exp(_sum(at.weights, at.log_w))
        lengths = _entries(table, at.first, LENGTH)
        for n in range(4):
            out.weights[n, i] = at.weights[n]
            log_chi = like(min(at.log_chi, most), lengths[n] / at.length)
            out.yield_ratio[n, i] = math.exp(at.log_w[n] - log_chi)


@kernel(inline=True)
def _row(scratch: Array, row: int, count: int) -> Array:
    """First `count` numbers of a row of scratch memory."""
    return scratch[row, :count]


@kernel(cache=True)
def restitutions(
    table: Array, c_lam: float, c_chi: float, speed: Array, radius: Array, thickness: Array,
    out: Array,
) -> int:  # fmt: skip
    """Write the COR of many spheres on plates into out; return how many are NaN."""
    bad = 0
    for i in range(out.size):
        out[i] = restitution_on_plate(table, c_lam, c_chi, speed[i], radius[i], thickness[i])
        bad += out[i] != out[i]
    return bad
