"""The axes of a table: each coordinate of an impact with its map, its kinks and its nodes.

An axis is cut at the kinks of the law into segments, so that no spline runs across one; a kink is a
node twice, once as the end of a segment and once as the beginning of the next. Within a segment the
nodes are spaced evenly, or by the squares of even steps, in the axis' map x of its values.

Functions of the first axis alone are given at the nodes of a Chebyshev series along it: the largest
elastic compression, and the kinks of later axes, which may be curves over the first.
"""

import itertools
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, Places
from contactlaw.table.lookup import ELASTIC, STRETCHED

SERIES = 48  # nodes of the series along the first axis
FEWEST = 4  # nodes of a segment; splines with not-a-knot ends need as many


class Segment(NamedTuple):
    """Nodes of an axis between two kinks."""

    start: Array  # values at the nodes of the series; all equal for a kink that is a straight line
    end: Array
    shares: Array  # places of the nodes in x, from 0 at the start to 1 at the end
    graded: bool  # shares are squares of even steps, else even steps


@dataclass(frozen=True, eq=False)
class Axis:
    """One coordinate of a table."""

    name: str
    segments: tuple[Segment, ...]  # from kink to kink
    stretch: float = math.inf  # c of the map x = v/(v + c) of values v; inf: x is v

    @property
    def sizes(self) -> list[int]:
        """Number of nodes of each segment."""
        return [segment.shares.size for segment in self.segments]

    @property
    def largest(self) -> float:
        """Last value; it is the same all along the first axis."""
        return float(self.segments[-1].end[0])

    def check(self) -> None:
        """Raise a ValueError if segments do not meet, or nodes do not rise."""
        pairs = itertools.pairwise(self.segments)
        if not self.segments or not all(np.array_equal(a.end, b.start) for a, b in pairs):
            raise ValueError(f"its segments along {self.name} leave gaps, or overlap")
        for start, end, shares, _ in self.segments:
            rises = shares.size >= FEWEST and (np.diff(shares) > 0.0).all() and (start < end).all()
            if not (rises and shares[0] == 0.0 and shares[-1] == 1.0):
                raise ValueError(f"its axes along {self.name} do not rise")

    def mapped(self, values: Array | float) -> Array:
        """Coordinate x of values."""
        return np.asarray(values if math.isinf(self.stretch) else values / (values + self.stretch))

    def place(self, values: Array) -> Array:
        """Places of values from 0 to 1 in x, for an axis that begins at 0."""
        return self.mapped(values) / self.mapped(self.largest)

    def values(self, place: Array) -> Array:
        """Values at places from 0 to 1 in x, the inverse of `place`."""
        x = self.mapped(self.largest) * place
        return x if math.isinf(self.stretch) else np.asarray(self.stretch * x / (1.0 - x))

    def nodes(self, along: Array) -> Array:
        """Values at all nodes: a row for each place along the first axis."""
        parts = []
        for segment in self.segments:
            start, end = (_from_series(line, along)[:, None] for line in segment[:2])
            low, high = self.mapped(start), self.mapped(end)
            x = low + (high - low) * segment.shares
            values = x if math.isinf(self.stretch) else self.stretch * x / (1.0 - x)
            parts.append(np.clip(values, start, end))  # rounding must not go beyond
        return np.concatenate(parts, axis=1)

    def segment_of(self, values: Array, along: Array) -> Places:
        """Find the segments that values lie in, by number."""
        starts = [_from_series(segment.start, along) for segment in self.segments[1:]]
        return np.asarray(np.sum([values > start for start in starts], axis=0, dtype=np.intp))


@dataclass(frozen=True, eq=False)
class TableGrid:
    """Nodes of a table."""

    axes: tuple[Axis, ...]  # the inelasticity lambda, ln chi, and ln k if strengths differ
    elastic_compression: Array  # w_m at `series_values` of the first axis [V0 T_H]
    # Rows of polynomials for each segment of the third axis, see `contactlaw.table.lookup`.
    by_strength: Array | None = None

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of nodes along each axis."""
        return tuple(sum(axis.sizes) for axis in self.axes)

    @property
    def rows(self) -> Array:
        """Values of the first axis at its nodes."""
        return np.asarray(self.axes[0].nodes(np.zeros(1))[0])

    def nodes(self) -> tuple[Array, ...]:
        """Values along each axis at every node, each of the grid's shape."""
        rows, others = self.rows, range(1, len(self.axes))
        along = self.axes[0].place(rows)
        lines = [rows[:, None], *(axis.nodes(along) for axis in self.axes[1:])]
        spread = [
            np.expand_dims(line, [other for other in others if other != max(k, 1)]) for k, line in enumerate(lines)
        ]
        return np.broadcast_arrays(*spread)

    def points(self) -> tuple[Array, Array, Array]:
        """Inelasticity, overload and ln of the strength at every node, each as a row."""
        lam, log_chi, *more = (values.ravel() for values in self.nodes())
        strength = np.zeros_like(lam)
        if more:  # the law may jump a little at a knot: the next segment begins just above it
            begins = np.cumsum(self.axes[2].sizes)[:-1]
            each = more[0].reshape(-1, self.shape[2]).copy()
            each[:, begins] = np.nextafter(each[:, begins], math.inf)
            strength = each.ravel()
        return lam, np.exp(self.own(lam, log_chi, strength)), strength

    def own(self, lam: Array, log_chi: Array, strength: Array) -> Array:
        """Ln chi of impacts, from that along the axis, which is stretched beyond yield."""
        if self.by_strength is None:
            return log_chi
        which = self.axes[2].segment_of(strength, np.zeros(1))
        ends = np.array([(one.start[0], one.end[0]) for one in self.axes[2].segments])[which]
        t = (2.0 * strength - ends.sum(axis=-1)) / (ends[..., 1] - ends[..., 0])
        z = 2.0 * self.axes[0].place(lam) - 1.0
        factor = np.zeros_like(lam)
        for row in range(ELASTIC - 1, STRETCHED - 1, -1):
            terms = self.by_strength[which, row].T
            factor = factor * z + np.polynomial.polynomial.polyval(t, terms, tensor=False)
        return np.where(log_chi > 0.0, log_chi / factor, log_chi)


def series_values(first: Axis) -> Array:
    """Values of the first axis at the nodes of the series along it."""
    return np.clip(first.values(chebyshev_nodes()), 0.0, first.largest)


def power_series(values: Array, degree: int) -> Array:
    """Fit a polynomial in t from -1 to 1 to values at Chebyshev nodes, as those of the series."""
    count = len(values)
    basis = np.polynomial.chebyshev.chebvander(2.0 * chebyshev_nodes(count) - 1.0, degree)
    # the nodes make the basis orthogonal, so no system is to be solved
    coefficients = (basis * values[:, None]).sum(axis=0) * (2.0 / count)
    coefficients[0] /= 2.0
    found = np.zeros(degree + 1)
    powers = np.polynomial.chebyshev.cheb2poly(coefficients)  # drops zeros at the end
    found[: powers.size] = powers
    return found


def chebyshev_nodes(count: int = SERIES) -> Array:
    """Places of Chebyshev nodes from 0 to 1; by default of the series along the first axis."""
    nodes: Array = 0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / count)
    return nodes


def _from_series(values: Array, along: Array) -> Array:
    """Values at places along the first axis, from those at the nodes of the series."""
    if np.ptp(values) == 0.0:
        return np.full_like(along, values[0])
    return np.asarray(np.polynomial.polynomial.polyval(2.0 * along - 1.0, power_series(values, 20)))
