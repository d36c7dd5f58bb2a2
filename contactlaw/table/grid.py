"""Where the nodes of a table lie: along lambda, and along ln chi between the kinks of the law.

Along lambda the nodes are uniform in x = lambda/(lambda + c), along ln chi within each segment
between two kinks.

As long as loading follows Hertz's curve, the largest compression is chi d_Y, and a kink of the law
is a line of constant chi. A later kink is a curve chi_k(lambda), and segments begin and end along
that curve. An impact that turns beyond a kink of the loading curve by some share p has spent a time
there that grows as the root of p: its outcome has a term in p^(3/2) where the slope of the curve
jumps, in p^(5/2) where its curvature does. Behind such a kink the nodes are uniform in the root of
p, in which these terms are smooth.
"""

import dataclasses
import itertools
import math
from dataclasses import dataclass

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.equation import force, zener
from contactlaw.laws import Law, Strengths
from contactlaw.laws._branches import END
from contactlaw.table import axes as _axes
from contactlaw.table.axes import SERIES, Axis, Segment, TableGrid, chebyshev_nodes, power_series, series_values
from contactlaw.table.lookup import ELASTIC, ROWS, STRETCHED, TERMS

AXES = "inelasticity", "log_overload", "log_strength"
FEWEST = 5  # nodes of a segment along the first two axes, our choice
_FEWEST_GRADED = 24  # nodes of a graded segment, our choice: two kinks may be only 8 % apart
_COARSER = 4.0  # factor on steps in ln chi below yield, where only the sphere's stiffening counts
_BEYOND = 1.5  # largest chi of a pair's table, over the chi up to which its law was made
# Largest lambda of a pair's table. At 10 m/s a bead of tungsten carbide of radius 1 mm has 5.5 on
# 0.6 mm of gamma-alumina.
_LARGEST = 6.0
# Steps in ln chi of a table that is built on demand: one as fine as its rows, and one for the long
# tables of soft bodies, most of which is complete flow. The largest errors of both are alike.
_STEP, _LONG_STEP = 0.03, 0.05
_ROOM = 0.02  # least distance in ln chi from the last kink to the end of the table


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
                raise ArgumentError(name, value, f"must lie between {low:g} and {high:g}")


RANGES = {
    "largest_inelasticity": (1e-3, 10.0),  # 10: COR is 7e-6 there
    "largest_overload": (1e-3, 1e20),  # the weakest body, with sigma_Y = 1e-12 E, reaches 2e18
    "inelasticity_nodes": (FEWEST, 100_000),
    "log_overload_step": (1e-4, 1.0),
    "stretch": (1e-3, 1e3),
    "rtol": (1e-13, 1e-4),
}


def inelasticity_axis(settings: Settings) -> Axis:
    """Lambda from 0 to the largest, in one segment."""
    ends = np.zeros(SERIES), np.full(SERIES, settings.largest_inelasticity)
    shares = np.linspace(0.0, 1.0, settings.inelasticity_nodes)
    return Axis(AXES[0], (Segment(*ends, shares, graded=False),), settings.stretch)


def strength_axis(strengths: Strengths, coarser: int = 1) -> Axis:
    """Ln of the strength from 0 to the largest, in segments between the knots."""
    segments = []
    for (low, high), cells in zip(itertools.pairwise(strengths.knots), strengths.cells, strict=True):
        ends = np.full(SERIES, low), np.full(SERIES, high)
        count = max(-(-cells // coarser) + 1, _axes.FEWEST)
        segments.append(Segment(*ends, np.linspace(0.0, 1.0, count), graded=False))
    return Axis(AXES[2], tuple(segments))


def with_steps(law: Law, grid: TableGrid, settings: Settings, steps: float | Array, coarser: int = 1) -> TableGrid:
    """Place other nodes between the same kinks; one step for all segments, or one for each.

    Cells along the strength are wider by a factor.
    """
    overload = grid.axes[1]
    each = np.broadcast_to(steps, len(overload.segments))
    segments = tuple(_with_nodes(*one) for one in zip(overload.segments, each, strict=True))
    axes = inelasticity_axis(settings), dataclasses.replace(overload, segments=segments)
    more = () if law.strengths is None else (strength_axis(law.strengths, coarser),)
    return dataclasses.replace(grid, axes=(*axes, *more))


def largest_inelasticity(law: Law) -> float:
    """Largest lambda of a law's own table, which is known before the table is built."""
    return Settings.largest_inelasticity if math.isinf(law.range[1]) else _LARGEST


def on_demand(law: Law) -> Settings:
    """Choose settings of a table that is built when it is first needed."""
    if math.isinf(law.range[1]):
        return Settings(log_overload_step=_STEP, rtol=1e-11)
    w_m = zener.elastic_compression(law.data, 0.0)
    deepest = zener.overload_at(law.data, 0.0, w_m, law.range[1], 1e-11, few=True)
    return Settings(
        largest_inelasticity=largest_inelasticity(law),
        largest_overload=float(f"{_BEYOND * deepest:.3g}"),
        log_overload_step=_STEP if law.range[1] <= END else _LONG_STEP,
        inelasticity_nodes=41,
        rtol=1e-11 if law.strengths is None else 1e-10,
    )


def axes_with(overload: Axis, law: Law, settings: Settings) -> tuple[Axis, ...]:
    """Axes of a table, from that of ln chi, which has to fit the law and the settings."""
    overload.check()
    end = overload.segments[-1].end
    if overload.stretch != math.inf or not (end == math.log(settings.largest_overload)).all():
        raise ValueError("its axes are not those of its settings")
    kinks = [kink for kink in law.outcome_kinks if kink <= _straight(law)]
    if not law.is_hertz:
        kinks.insert(0, law.range[0])
    starts = [one.start[0] for one in overload.segments[: len(kinks)] if not np.ptp(one.start)]
    if not np.array_equal(starts, np.log(kinks[: len(overload.segments)])):
        raise ValueError(f"its kinks are not those of the law, {law.outcome_kinks}")
    axes = inelasticity_axis(settings), overload
    return axes if law.strengths is None else (*axes, strength_axis(law.strengths))


def _straight(law: Law) -> float:
    """Compression up to which kinks lie at constant chi: the end of Hertz's curve, or yield."""
    if not law.is_hertz:
        return 1.0 if law.yields else 0.0
    return law.loading_kinks[0] if law.loading_kinks else math.inf


def _with_nodes(segment: Segment, step: float) -> Segment:
    """Place the nodes of a segment."""
    length = float((segment.end - segment.start).max())
    # steps that are even in the root are twice as long at the end as on average
    least, denser = (_FEWEST_GRADED, 1.25) if segment.graded else (FEWEST, 1.0)
    if not segment.end.max() > 0.0:
        denser = 1.0 / _COARSER
    cells = max(least - 1, math.ceil(denser * length / step))
    shares = np.linspace(0.0, 1.0, cells + 1)
    return segment._replace(shares=shares**2 if segment.graded else shares)


def grid(law: Law, settings: Settings) -> TableGrid:
    """Place the nodes for a law that yields; its kinks are found by the solver."""
    if not law.yields and law.is_hertz:
        reason = "never yields; the edge chi = 1 of any table serves it"
        raise ArgumentError("law", law.name, reason)
    inelasticity = inelasticity_axis(settings)
    lam = series_values(inelasticity)
    elastic = elastic_compressions(law, lam)
    lines, graded = _kink_lines(law, settings, lam, elastic)
    segments = tuple(
        _with_nodes(Segment(start, end, np.empty(0), root), settings.log_overload_step)
        for (start, end), root in zip(itertools.pairwise(lines), graded, strict=True)
    )
    axes = inelasticity, Axis(AXES[1], segments)
    if law.strengths is None:
        return TableGrid(axes, elastic)
    has_end = len(lines) > 2 + (not law.is_hertz)  # of the law's range
    return TableGrid((*axes, strength_axis(law.strengths)), elastic, _rows(law, settings, has_end))


def _rows(law: Law, settings: Settings, has_end: bool) -> Array:
    """Rows of polynomials for the segments in ln k, as `contactlaw.table.lookup` has them."""
    assert law.strengths is not None
    data, knots = law.at_any_strength, np.array(law.strengths.knots)
    places = knots[:-1, None] + np.diff(knots)[:, None] * chebyshev_nodes(TERMS)
    along = inelasticity_axis(settings).values(chebyshev_nodes(ROWS - ELASTIC))
    every = np.append(places, 0.0)  # the last one is the slow pair, which the others are beside
    lam, s = np.tile(along, every.size), np.repeat(every, along.size)
    elastic = elastic_compressions(law, lam, s)
    end = np.ones((every.size, along.size))
    if has_end:
        rungs = force.rungs(data)
        kink = np.repeat(np.interp(every, rungs[:, force.STRENGTH], rungs[:, force.END]), along.size)
        end = np.log(_overloads(law, kink, lam, elastic, s)).reshape(end.shape)
    log_w_m = np.log(elastic).reshape(end.shape)
    growth = [[math.log(force.growth_at(data, one))] for one in every.tolist()]
    factor = [power_series(one, ELASTIC - STRETCHED - 1) for one in end[-1] / end]
    stiffer = [power_series(one, ROWS - ELASTIC - 1) for one in log_w_m - log_w_m[-1]]
    rows = np.split(np.hstack([growth, factor, stiffer])[:-1], len(places))
    return np.array([[power_series(row, TERMS - 1) for row in one.T] for one in rows])


def _kink_lines(law: Law, settings: Settings, lam: Array, elastic: Array) -> tuple[list[Array], list[bool]]:
    """Ln chi of the kinks and the table's end along lambda, and which segments are graded."""
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
            graded.append(kink in (*law.loading_kinks, law.range[1]))
    return [*lines, np.full(lam.size, end)], graded


def _overloads(law: Law, kink: Array | float, lam: Array, elastic: Array, strength: Array | float = 0.0) -> Array:
    """Overloads at which the largest compression is that of a kink."""
    data = law.at_any_strength
    found: Array = np.full(np.shape(lam), math.nan)
    # impacts that turn next to a kink may want smaller steps than there are, others at each rtol
    for rtol in (1e-12, 1e-11, 1e-10, 1e-9):
        tried = zener.overload_at(data, lam, elastic, kink, rtol, strength=strength)
        found = np.where(np.isfinite(found), found, tried)
        if np.isfinite(found).all():
            return found
    raise RuntimeError(f"law {law.name!r}: no impact was found that turns at {np.unique(kink)} d_Y")


def elastic_compressions(law: Law, lam: Array, strength: Array | float = 0.0) -> Array:
    """Largest compressions w_m of impacts that just yield."""
    return np.asarray(zener.elastic_compression(law.at_any_strength, lam, strength))
