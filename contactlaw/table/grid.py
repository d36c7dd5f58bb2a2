"""The grid of a table: where its nodes lie, and splines through values at them.

`contactlaw.table.lookup` has the coordinates x and p. Along x nodes are uniform. Along p there is a
block of columns up to yield, one from there to the end of the law and one beyond; no spline runs
across the two kinks between them. For a pair with a rate of strain there is such a grid for each rung
of a ladder of strengths, with rungs at the corners of the law.
"""

import dataclasses
import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial
from numpy.polynomial.polynomial import polyfit, polyval
from scipy.interpolate import CubicSpline

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.equation import force, zener
from contactlaw.laws import Law
from contactlaw.table import lookup
from contactlaw.table.lookup import DEGREE, RUNG, STRETCH, Axes

_BEYOND = 1.5  # largest chi of a pair's table, over the chi up to which its law was made
# Largest lambda of a pair's table. At 10 m/s a bead of tungsten carbide of radius 1 mm has 5.5 on
# 0.6 mm of gamma-alumina.
_LARGEST = 6.0
BELOW, AFTER = 8, 8  # cells up to yield, where only the sphere's stiffening counts, and beyond the law's end
_SLOWEST = 0.02  # least p at which impacts are solved; slower ones are alike
_ELASTIC = 25.0  # overload at the end of the first block of a law that never yields, over its first compression
_NODES = 40  # places along x at which w and the end of the law are found
_ALIKE = (1.0,)
_EARLY = 1e-7  # relatively: impacts are found that turn before a kink, not at it


@dataclass(frozen=True)
class Settings:
    """Extent and fineness of a table; the defaults are those of the packaged one.

    Parameters
    ----------
    largest_inelasticity : float
        Largest lambda.
    largest_overload : float
        Largest chi. 40 is what V0 = 100 V_Y0 reaches on a half-space, and less on any plate.
    rows : int
        Cells along lambda, uniform in lambda/(lambda + 2).
    columns : int
        Cells from yield to the end of the law. They are doubled up to three times while the COR errs
        by more than promised; for a pair with a rate of strain so are the strengths.
    rtol : float
        Tolerance of the solver at each node.
    """

    largest_inelasticity: float = 5.0
    largest_overload: float = 40.0
    rows: int = 40
    columns: int = 64
    rtol: float = 1e-9

    def __post_init__(self) -> None:
        for name, (low, high) in RANGES.items():
            value = getattr(self, name)
            if not low <= value <= high:
                raise ArgumentError(name, value, f"must lie between {low:g} and {high:g}")


RANGES = {
    "largest_inelasticity": (1e-3, 10.0),  # 10: COR is 7e-6 there
    "largest_overload": (1e-3, 1e20),  # the weakest body, with sigma_Y = 1e-12 E, reaches 2e18
    "rows": (4, 10_000),
    "columns": (4, 10_000),
    "rtol": (1e-13, 1e-4),
}


def largest_inelasticity(law: Law) -> float:
    """Largest lambda of a law's own table, which is known before the table is built."""
    return Settings.largest_inelasticity if math.isinf(law.range[1]) else _LARGEST


def on_demand(law: Law) -> Settings:
    """Choose settings of a table that is built when it is first needed."""
    if math.isinf(law.range[1]):
        return Settings()
    w_m = zener.elastic_compression(law.data, 0.0)
    deepest = zener.overload_at(law.data, 0.0, w_m, law.range[1], 1e-11, few=True)
    return Settings(largest_inelasticity(law), float(f"{_BEYOND * deepest:.3g}"))


@dataclass(frozen=True, eq=False)
class Grid:
    """Nodes of a table, and the beginning of its packed array.

    A position t is a column as a number that no count of cells changes: up to 1 in the first block,
    from 1 to 2 in that up to the law's end, and from 2 to 3 beyond.
    """

    head: Array  # see `contactlaw.table.lookup`; without a pair
    rungs: Array  # likewise, (rungs, RUNG)

    @classmethod
    def of(cls, packed: Array) -> "Grid":
        """Grid of a packed array."""
        end = lookup.HEADER + int(packed[Axes._fields.index("rungs")]) * RUNG
        return cls(packed[: lookup.HEADER], packed[lookup.HEADER : end].reshape(-1, RUNG))

    @property
    def axes(self) -> Axes:
        """Numbers of cells and limits."""
        return Axes(*self.head[: len(Axes._fields)].tolist())

    def with_axes(self, **changed: float) -> "Grid":
        """Change numbers of the axes, as those of cells."""
        axes = self.axes._replace(**changed)
        stride = 1 + sum(count + 3 for count in self._cells(axes))
        axes = axes._replace(stride=stride, size=(axes.rows + 4) * stride)
        return dataclasses.replace(self, head=np.concatenate([axes, self.head[len(axes) :]]))

    def on_ladder(self, law: Law, ladder: Array) -> "Grid":
        """Change the strengths, which are ln k; where their laws end is found by the solver."""
        rungs = np.tile(lookup.SINGLE[3:], (ladder.size, 1))
        x = self.axes.x_max * np.linspace(0.0, 1.0, 7)
        for row, log_k in zip(rungs, ladder.tolist() if law.strengths else (), strict=False):
            growth = force.growth_at(law.at_any_strength, log_k)
            w, end = zener.elastic_compression(law.at_any_strength, STRETCH * x / (1.0 - x), log_k), self.end(x)
            if self.axes.after:
                ends = force.rungs(law.at_any_strength)[:, [force.STRENGTH, force.END]].T
                deepest = float(np.interp(log_k, *ends))
                end = (_overloads(law, x, w, log_k, deepest) / self.axes.unit) ** 0.25
            row[:2] = math.exp(log_k), math.sqrt(growth)
            row[2:5], row[5:] = (polyfit(x, one, 2) for one in (end / self.end(x), (w / self.elastic(x)) ** 0.25))
        return dataclasses.replace(self.with_axes(rungs=ladder.size), rungs=rungs)

    def elastic(self, x: Array, factor: Any = _ALIKE) -> Array:
        """Return w, the largest elastic compression; the factor is `slower` of a rung."""
        return self._polynomial(lookup.ELASTIC, x, factor) ** 4

    def end(self, x: Array, factor: Any = _ALIKE) -> Array:
        """Return p at the end of the law; the factor is `later` of a rung."""
        return np.maximum(self._polynomial(lookup.END, x, factor), 1.0)

    def _polynomial(self, begins: int, x: Array, factor: Any) -> Array:
        return np.asarray(polyval(x, self.head[begins : begins + DEGREE + 1]) * polyval(x, factor, tensor=False))

    def yield_ratios(self, x: Array, t: Array, rung: Any) -> Array:
        """Yield ratios y at positions t; slower impacts than the slowest have its outcome."""
        axes, end = self.axes, self.end(x, rung[2:5])
        top = np.maximum(axes.top * rung[2], lookup.NEXT * end)
        q, s, beyond = np.minimum(t, 1.0), np.clip(t - 1.0, 0.0, 1.0), np.maximum(t - 2.0, 0.0)
        p = q / (2.0 - q) + s * (end - 1.0) / (2.0 - s) + beyond * (top - end)
        return np.asarray(self.elastic(x, rung[5:]) / (axes.unit * np.maximum(p, axes.slowest) ** 4))

    def nodes(self) -> tuple[Array, Array, Array]:
        """Inelasticity, yield ratio and ln k at every node, (rungs, rows, columns)."""
        axes, rung = self.axes, self.rungs.T[:, :, None, None]
        x = np.linspace(0.0, axes.x_max, int(axes.rows) + 1)[:, None]
        t = np.concatenate([n + np.linspace(0.0, 1.0, count + 1) for n, count in enumerate(self._cells(axes))])
        y = self.yield_ratios(x, t, rung)
        return STRETCH * x / (1.0 - x) + 0.0 * y, y, np.log(rung[0]) + 0.0 * y

    @staticmethod
    def _cells(axes: Axes) -> list[int]:
        """Return the numbers of cells of each block of columns."""
        return [int(count) for count in (axes.below, axes.beyond, axes.after) if count]

    def packed(self, values: Array) -> Array:
        """Pack the grid and splines through values at its nodes, one after the other (nodes, fields).

        Rows and columns end with one more coefficient: kernels read it with the weight 0, without a
        test.
        """
        axes = self.axes
        stride = int(axes.stride) - 2 * len(self._cells(axes)) - 1  # nodes of a row
        values = values.reshape(int(axes.rungs), int(axes.rows) + 1, stride, -1)
        blocks = np.split(values, np.cumsum(np.array(self._cells(axes)) + 1)[:-1], axis=2)
        fitted = spline_coefficients(np.concatenate([spline_coefficients(block, 2) for block in blocks], axis=2), 1)
        fitted = np.pad(fitted, [(0, 0), (0, 1), (0, 1), (0, 0)], mode="edge")
        return np.concatenate([self.head, self.rungs.ravel(), np.moveaxis(fitted, 3, 0).ravel()])


def check(packed: Array, fields: int) -> None:
    """Refuse an array that is no table of so many numbers at a node.

    Raises
    ------
    ValueError
        If it is none: kernels would read beyond its end.
    """
    grid = Grid.of(packed)
    axes, counts = grid.axes, np.array([*grid.axes[1:5], grid.axes.rungs])
    whole = np.isfinite(packed).all() and (counts == abs(counts.round())).all() and axes.rungs >= 1.0
    rises = (np.diff(grid.rungs[:, 0]) > 0.0).all() and (grid.rungs[:, 1] > 0.0).all()
    size = lookup.HEADER + axes.rungs * (RUNG + fields * axes.size)
    if not (whole and rises and grid.with_axes().axes == axes and packed.size == size):
        raise ValueError(f"its table of {packed.size} numbers does not fit its axes")


def grid(law: Law, settings: Settings) -> Grid:
    """Place the nodes for a law that yields, or is not Hertz's; where it ends is found by the solver."""
    if not law.yields and law.is_hertz:
        reason = "never yields; the edge chi = 1 of any table serves it"
        raise ArgumentError("law", law.name, reason)
    # The table of a law that never yields has its first block where the law is still Hertz's, or
    # impacts lose the same share at all speeds, see `zener.follow_impact`.
    unit, most = 1.0 if law.yields else _ELASTIC * law.range[0], settings.largest_overload
    x_max = settings.largest_inelasticity / (settings.largest_inelasticity + STRETCH)
    x = x_max * (0.5 - 0.5 * np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES))
    w, end = np.asarray(zener.elastic_compression(law.data, STRETCH * x / (1.0 - x))), np.full(_NODES, most)
    if law.range[1] < math.inf:
        found = _overloads(law, x, w, 0.0, law.range[1])
        end = found if found.min() < most else end
    after = bool(end.min() < most)
    slowest = _SLOWEST if law.is_hertz else max(_SLOWEST, 1.001 * (law.range[0] / unit) ** 0.25)
    # fitted in Chebyshev's polynomials: powers are nearly alike
    series = [Chebyshev.fit(x, one**0.25, DEGREE).convert(kind=Polynomial).coef for one in (w, end / unit)]
    made = Grid(np.concatenate([np.zeros(lookup.ELASTIC), *series]), np.empty(0))
    top = (most / unit) ** 0.25
    cells = {"rows": settings.rows, "below": BELOW, "beyond": settings.columns, "after": AFTER * after}
    return made.with_axes(x_max=x_max, top=top, unit=unit, slowest=slowest, **cells).on_ladder(law, np.zeros(1))


def ladder_of(law: Law, widest: float) -> Array:
    """Rungs ln k of a law: its corners, and others so that no two are farther apart than `widest`."""
    if law.strengths is None:
        return np.zeros(1)
    rungs = [np.zeros(1)]
    for low, high in itertools.pairwise(law.strengths.knots):
        rungs.append(np.linspace(low, high, 1 + math.ceil((high - low) / widest))[1:])
    return np.concatenate(rungs)


def _overloads(law: Law, x: Array, w: Array, log_k: float, deepest: float) -> Array:
    """Overloads of impacts that turn just before a compression."""
    data, lam = law.at_any_strength, STRETCH * x / (1.0 - x)
    found: Array = np.full(lam.size, math.nan)
    # impacts that turn next to a kink may want smaller steps than there are, others at each rtol
    for rtol in (1e-11, 1e-10, 1e-9):
        tried = zener.overload_at(data, lam, w, deepest * (1.0 - _EARLY), rtol, strength=log_k)
        found = np.where(np.isfinite(found), found, tried)
        if np.isfinite(found).all():
            return found
    raise RuntimeError(f"law {law.name!r}: no impact was found that turns at {deepest} d_Y")


def spline_coefficients(values: Array, axis: int = 0) -> Array:
    """Coefficients of the cubic B-spline through uniform nodes along an axis, not-a-knot ends.

    At node i the value is v = (c[i-1] + 4 c[i] + c[i+1])/6 and the second derivative c[i-1] - 2 c[i] +
    c[i+1], so that c[i] is v less a sixth of that.
    """
    nodes = np.arange(values.shape[axis])
    v = np.moveaxis(values, axis, 0)
    c = v - CubicSpline(nodes, v)(nodes, 2) / 6.0
    ends = 6.0 * v[[0, -1]] - 4.0 * c[[0, -1]] - c[[1, -2]]
    return np.asarray(np.moveaxis(np.concatenate([ends[:1], c, ends[1:]]), 0, axis))
