"""Where the nodes of a table lie: along lambda, and along ln chi between the kinks of the law.

Along lambda the nodes are uniform in x = lambda/(lambda + c). Along ln chi they are uniform within
each segment between two kinks, so that no spline runs across one; a kink is a node twice, once as
the end of a segment and once as the beginning of the next.

As long as loading follows Hertz's curve, the largest compression is chi d_Y, and a kink of the law
is a line of constant chi. A kink that comes later is a curve, chi_k(lambda), along which the
segments' ends are drawn. An impact that turns beyond a kink of the loading curve by some share p
has spent a time there that grows as the root of p: its outcome has a term in p^(3/2) where the
slope of the curve jumps, in p^(5/2) where its curvature does. Behind such a kink the nodes are
uniform in the root of p, in which these are smooth; behind those of a capped law, too.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw.equation import zener
from contactlaw.laws import Law
from contactlaw.laws._branches import END

Array = NDArray[np.float64]

SERIES = 48  # Chebyshev nodes along x of what is known along lambda alone: w_m and curved kinks
_FEWEST = 5  # nodes of a segment; not-a-knot ends need as many
_FEWEST_GRADED = 24  # our choice: between two kinks of a capped law that are 8 % apart
_COARSER = 4.0  # steps in ln chi below yield: only the sphere's stiffening is to be seen there
_BEYOND = 1.5  # of the overload up to which a law was made, for a table of it
_THINNEST = 6.0  # lambda of a table that is made for a pair: 1 mm of carbide on 0.6 mm at 10 m/s
# In ln chi, of a table that is made for a pair, as fine as its rows; and of a long one, for a soft
# body, most of which is complete flow: its largest errors are the same.
_STEP, _LONG_STEP = 0.03, 0.05
_ROOM = 0.02  # in ln chi, between the last kink and the end of the table


@dataclass(frozen=True)
class Settings:
    """Extent and fineness of a table; the defaults are those of the packaged one.

    Parameters
    ----------
    largest_inelasticity : float
        Largest lambda.
    largest_overload : float
        Largest chi. 40 is what V0 = 100 V_Y0 reaches on a half-space, and less on any plate.
    inelasticity_nodes : int
        Nodes along lambda.
    log_overload_step : float
        Largest distance of two nodes in ln chi.
    stretch : float
        c in x = lambda/(lambda + c), in which the nodes along lambda are uniform.
    rtol : float
        Tolerance of the solver at each node.
    """

    largest_inelasticity: float = 5.0
    largest_overload: float = 40.0
    inelasticity_nodes: int = 81
    log_overload_step: float = 0.02
    stretch: float = 2.0
    rtol: float = 1e-12

    def __post_init__(self) -> None:
        for name, (low, high) in RANGES.items():
            value = getattr(self, name)
            if not low <= value <= high:
                raise ValueError(f"{name}: must lie between {low:g} and {high:g}, got {value!r}")


RANGES = {
    "largest_inelasticity": (1e-3, 10.0),  # 10: COR is 7e-6 there
    "largest_overload": (1e-3, 1e20),  # above 2e18, of a body of sigma_Y = 1e-12 E, the weakest
    "inelasticity_nodes": (_FEWEST, 100_000),
    "log_overload_step": (1e-4, 1.0),
    "stretch": (1e-3, 1e3),
    "rtol": (1e-13, 1e-4),
}


class Segment(NamedTuple):
    """Columns of nodes between two kinks."""

    start: Array  # ln chi at `series_nodes`; all equal for a kink of constant chi
    end: Array
    shares: Array  # of the way from start to end in ln chi, rising from 0 to 1, one for each node
    graded: bool  # shares are squares of even steps, else even steps


@dataclass(frozen=True, eq=False)
class Grid:
    """Nodes of a table.

    Parameters
    ----------
    stretch, largest_inelasticity : float
        Of `Settings`.
    elastic_compression : ndarray
        w_m at `series_inelasticity` [V0 T_H].
    inelasticity : ndarray
        Lambda of the rows.
    segments : tuple of Segment
        Columns.
    """

    stretch: float
    largest_inelasticity: float
    elastic_compression: Array
    inelasticity: Array
    segments: tuple[Segment, ...]

    @property
    def columns(self) -> int:
        """Nodes along ln chi."""
        return sum(segment.shares.size for segment in self.segments)

    def log_overload(self) -> Array:
        """Ln chi of every node: (rows, columns)."""
        at = _place(self.inelasticity, self.stretch, self.largest_inelasticity)
        parts = []
        for segment in self.segments:
            start, end = (_from_series(ends, at)[:, None] for ends in (segment.start, segment.end))
            parts.append(start + (end - start) * segment.shares)
        return np.concatenate(parts, axis=1)

    def segment_of(self, lam: Array, log_chi: Array) -> NDArray[np.intp]:
        """Find the segments that places lie in, by number."""
        at = _place(lam, self.stretch, self.largest_inelasticity)
        starts = [_from_series(segment.start, at) for segment in self.segments[1:]]
        return np.asarray(np.sum([log_chi > start for start in starts], axis=0, dtype=np.intp))

    def series_inelasticity(self) -> Array:
        """Lambda at the nodes of the series along lambda."""
        return series_inelasticity(self.stretch, self.largest_inelasticity)


def coarser(grid: Grid, rows: int, steps: float | Array) -> Grid:
    """Other nodes between the same kinks; one step for all segments, or one for each."""
    each = np.broadcast_to(steps, len(grid.segments))
    segments = [_with_nodes(*one) for one in zip(grid.segments, each, strict=True)]
    nodes = row_inelasticity(rows, grid.stretch, grid.largest_inelasticity)
    return dataclasses.replace(grid, inelasticity=nodes, segments=tuple(segments))


def largest_inelasticity(law: Law) -> float:
    """Largest lambda of a law's own table, which is known before the table is built."""
    return Settings.largest_inelasticity if math.isinf(law.range[1]) else _THINNEST


def on_demand(law: Law) -> Settings:
    """Choose settings of a table that is built when it is first needed, in tenths of a second."""
    if math.isinf(law.range[1]):
        return Settings(log_overload_step=_STEP, rtol=1e-11)
    w_m = zener.elastic_compression(law.data, 0.0, 1e-11)[1]
    deepest = zener.overload_at(law.data, 0.0, w_m, law.range[1], 1e-11)
    return Settings(
        largest_inelasticity=largest_inelasticity(law),
        largest_overload=float(f"{_BEYOND * deepest:.3g}"),
        log_overload_step=_STEP if law.range[1] <= END else _LONG_STEP,
        inelasticity_nodes=41, rtol=1e-11,
    )  # fmt: skip


def check(segments: Sequence[Segment], law: Law, end: float) -> None:
    """Refuse segments that are none, or not those of a law's kinks.

    Raises
    ------
    ValueError
        With what is wrong of the table.
    """
    kinks = [kink for kink in law.outcome_kinks if kink <= _straight(law)]
    if not law.is_hertz:
        kinks.insert(0, law.range[0])
    starts = [segment.start[0] for segment in segments[: len(kinks)] if not np.ptp(segment.start)]
    if not segments or not np.array_equal(starts, np.log(kinks[: len(segments)])):
        raise ValueError(f"its kinks are not those of the law, {law.outcome_kinks}")
    for one, following in itertools.pairwise(segments):
        if not np.array_equal(one.end, following.start):
            raise ValueError("its segments do not meet")
    for segment in segments:
        steps = np.diff(segment.shares)
        whole = segment.shares[0] == 0.0 and segment.shares[-1] == 1.0 and (steps > 0.0).all()
        if segment.shares.size < _FEWEST or not whole or not (segment.start < segment.end).all():
            raise ValueError("its axes along ln chi do not rise")
    if not (segments[-1].end == end).all():
        raise ValueError("its axes are not those of its settings")


def _straight(law: Law) -> float:
    """Compression up to which kinks are lines of constant chi: Hertz's curve, or yield alone."""
    if not law.is_hertz:
        return 1.0 if law.yields else 0.0
    return law.loading_kinks[0] if law.loading_kinks else math.inf


def _with_nodes(segment: Segment, step: float) -> Segment:
    """Place the nodes of a segment."""
    length = float((segment.end - segment.start).max())
    # even steps of the root are twice as far apart at the end as on average
    least, denser = (_FEWEST_GRADED, 1.25) if segment.graded else (_FEWEST, 1.0)
    if not segment.end.max() > 0.0:
        denser = 1.0 / _COARSER
    cells = max(least - 1, math.ceil(denser * length / step))
    shares = np.linspace(0.0, 1.0, cells + 1)
    return segment._replace(shares=shares**2 if segment.graded else shares)


def row_inelasticity(count: int, stretch: float, largest: float) -> Array:
    """Lambda of the rows of a table."""
    nodes = _inelasticity(np.linspace(0.0, 1.0, count), stretch, largest)
    nodes[-1] = largest  # not one rounding error beyond
    return nodes


def chebyshev_nodes() -> Array:
    """Places in [0, 1] along x/x_max at which w_m and the curved kinks are given."""
    nodes: Array = 0.5 - 0.5 * np.cos(np.pi * (np.arange(SERIES) + 0.5) / SERIES)
    return nodes


def series_inelasticity(stretch: float, largest: float) -> Array:
    """Lambda at `chebyshev_nodes`."""
    return _inelasticity(chebyshev_nodes(), stretch, largest)


def _inelasticity(share: Array, stretch: float, largest: float) -> Array:
    """Lambda at shares of the largest x."""
    x = share * largest / (largest + stretch)
    return np.asarray(stretch * x / (1.0 - x))


def _place(lam: Array, stretch: float, largest: float) -> Array:
    """Shares of the largest x, from lambda."""
    return lam / (lam + stretch) * (largest + stretch) / largest


def power_series(values: Array, degree: int) -> Array:
    """Fit a polynomial in t = 2 x/x_max - 1 to values at `chebyshev_nodes`."""
    t = 2.0 * chebyshev_nodes() - 1.0
    basis = np.polynomial.chebyshev.chebvander(t, degree)
    # the nodes make the basis orthogonal, so no system is to be solved
    coefficients = (basis * values[:, None]).sum(axis=0) * (2.0 / SERIES)
    coefficients[0] /= 2.0
    return np.asarray(np.polynomial.chebyshev.cheb2poly(coefficients))


def _from_series(values: Array, share: Array) -> Array:
    """Values at shares of the largest x, from those at `chebyshev_nodes`."""
    if np.ptp(values) == 0.0:
        return np.full_like(share, values[0])
    return np.asarray(np.polynomial.polynomial.polyval(2.0 * share - 1.0, power_series(values, 20)))


def grid(law: Law, settings: Settings, rows: int, step: float) -> Grid:
    """Place the nodes for a law.

    Parameters
    ----------
    law : Law
        One that yields.
    settings : Settings
        Extent of the table, and tolerance of the solver.
    rows : int
        Nodes along lambda.
    step : float
        Largest distance of two nodes in ln chi.

    Returns
    -------
    Grid

    Raises
    ------
    ValueError
        If the law never yields: the elastic edge of any table serves it.
    RuntimeError
        If the solver does not find a kink.
    """
    if not law.yields and law.is_hertz:
        raise ValueError(f"law: {law.name!r} never yields; the edge chi = 1 of any table serves it")
    c, largest = settings.stretch, settings.largest_inelasticity
    lam = series_inelasticity(c, largest)
    elastic = elastic_compressions(law, lam, settings.rtol)
    bounds, graded = _kink_lines(law, settings, lam, elastic)
    segments = [
        _with_nodes(Segment(start, end, np.empty(0), root), step)
        for (start, end), root in zip(itertools.pairwise(bounds), graded, strict=True)
    ]
    return Grid(c, largest, elastic, row_inelasticity(rows, c, largest), tuple(segments))


def _kink_lines(
    law: Law, settings: Settings, lam: Array, elastic: Array
) -> tuple[list[Array], list[bool]]:
    """Ln chi of the kinks along lambda, and of the table's end; behind which nodes are graded."""
    end = math.log(settings.largest_overload)
    leaves = _straight(law)
    lines, graded = [], []
    if not law.is_hertz:
        lines, graded = [np.full(lam.size, math.log(law.range[0]))], [False]
    for kink in law.outcome_kinks:
        if kink <= leaves:
            line = np.full(lam.size, math.log(kink))
        else:
            line = np.log(_overloads(law, kink, lam, elastic))
        if line.max() < end - _ROOM:
            lines.append(line)
            graded.append(law.capped or kink in (*law.loading_kinks, law.range[1]))
    return [*lines, np.full(lam.size, end)], graded


def _overloads(law: Law, kink: float, lam: Array, elastic: Array) -> Array:
    """Overloads at which the largest compression is that of a kink."""
    found = np.array(
        [
            zener.overload_at(law.data, one, w_m, kink, 1e-12)
            for one, w_m in zip(lam, elastic, strict=True)
        ]
    )
    if not np.isfinite(found).all():
        raise RuntimeError(f"law {law.name!r}: no impact was found that turns at {kink:g} d_Y")
    return found


def elastic_compressions(law: Law, lam: Array, rtol: float) -> Array:
    """Largest compressions w_m of impacts that just yield."""
    out = np.empty_like(lam)
    for n, value in enumerate(lam):
        status, out[n] = zener.elastic_compression(law.data, value, rtol)
        if status != zener.OK:
            raise RuntimeError(f"w_m({value:.6g}) did not solve: {zener.MESSAGES[status]}")
    return out
