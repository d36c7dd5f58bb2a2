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

import numpy as np

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
    """Nodes of a table, and the beginning of its packed array."""

    head: Array  # see `contactlaw.table.lookup`; without a pair
    rungs: Array  # likewise, (rungs, RUNG)

    @classmethod
    def of(cls, packed: Array) -> "Grid":
        """Grid of a packed array."""
        end = lookup.HEADER + int(packed[Axes._fields.index("rungs")]) * RUNG
        return cls(packed[: lookup.HEADER], packed[lookup.HEADER : end].reshape(-1, RUNG))

    @property
    def ladder(self) -> Array:
        """Return ln k of the rungs."""
        return np.log(self.rungs[:, 0])

    @property
    def axes(self) -> Axes:
        """Numbers of cells and limits."""
        return Axes(*self.head[: len(Axes._fields)].tolist())

    def with_cells(self, rows: int, below: int, beyond: int, after: int) -> "Grid":
        """Change the numbers of cells."""
        head, axes = self.head.copy(), self.axes
        counts = [below, beyond, after * (axes.after > 0.0)]
        stride = 1 + sum(count + 3 for count in counts if count)
        head[: lookup.PAIR] = (*(axes.x_max, rows, *counts, stride, (rows + 4) * stride), *axes[7 : lookup.PAIR])
        return dataclasses.replace(self, head=head)

    def on_ladder(self, law: Law, ladder: Array) -> "Grid":
        """Change the strengths, which are ln k; where their laws end is found by the solver."""
        head, axes, rungs = self.head.copy(), self.axes, np.zeros((ladder.size, RUNG))
        head[Axes._fields.index("rungs")], rungs[:, 0] = ladder.size, np.exp(ladder)
        rungs[:, [1, 2, 5]] = 1.0
        x = axes.x_max * np.linspace(0.0, 1.0, 7)
        lam = STRETCH * x / (1.0 - x)
        for n, log_k in enumerate(ladder.tolist() if law.strengths else ()):
            growth = force.growth_at(law.at_any_strength, log_k)
            w, end = zener.elastic_compression(law.at_any_strength, lam, log_k), self.end(x)
            if axes.after:
                end = (_overloads(law, x, w, log_k, _end(law, log_k)) / axes.unit) ** 0.25
            rungs[n, 1] = math.sqrt(growth)
            rungs[n, 2:5] = np.polynomial.polynomial.polyfit(x, end / self.end(x), 2)
            rungs[n, 5:] = np.polynomial.polynomial.polyfit(x, (w / self.elastic(x)) ** 0.25, 2)
        return dataclasses.replace(self, head=head, rungs=rungs)

    def _polynomial(self, x: Array, begins: int, factors: Array | None) -> Array:
        """Polynomial of slow impacts, or times the square of a rung (3, ...)."""
        slow = np.polynomial.polynomial.polyval(x, self.head[begins : begins + DEGREE + 1])
        return np.asarray(slow if factors is None else slow * (factors[0] + x * (factors[1] + x * factors[2])))

    def elastic(self, x: Array, own: Array | None = None) -> Array:
        """Return w, the largest elastic compression; `own` are the numbers of a rung (6, ...)."""
        return self._polynomial(x, lookup.ELASTIC, own if own is None else own[3:]) ** 4

    def end(self, x: Array, own: Array | None = None) -> Array:
        """Return p/g at the end of the law."""
        return self._polynomial(x, lookup.END, own)

    def yield_ratios(self, x: Array, p: Array, g: Array, own: Array) -> Array:
        """Yield ratios y at places; slower impacts than the slowest have its outcome."""
        return np.asarray(self.elastic(x, own) / (self.axes.unit * np.maximum(p / g, self.axes.slowest) ** 4))

    def nodes(self) -> tuple[Array, Array, Array]:
        """Inelasticity, yield ratio and ln k at every node, (rungs, rows, columns)."""
        axes, rungs = self.axes, self.rungs.T[:, :, None, None]
        g = np.sqrt(rungs[1])
        x = np.linspace(0.0, axes.x_max, int(axes.rows) + 1)[:, None] + 0.0 * g
        end = g * np.maximum(self.end(x, rungs[2:]), 1.0)
        q, s, t = (np.linspace(0.0, 1.0, int(count) + 1) for count in (axes.below, axes.beyond, axes.after))
        p = [g * q / (2.0 - q) + 0.0 * x, (2.0 * g + s * (end - 2.0 * g)) / (2.0 - s)]
        if axes.after:
            p.append(end + t * (np.maximum(axes.top * g * rungs[2], lookup.NEXT * end) - end))
        whole = np.concatenate(p, axis=2)
        y = self.yield_ratios(np.broadcast_to(x, whole.shape), whole, g, rungs[2:])
        return STRETCH * x / (1.0 - x) + 0.0 * whole, y, np.log(rungs[0]) + 0.0 * whole

    def coefficients(self, values: Array) -> Array:
        """Coefficients of cubic splines through values at nodes, along rows and columns.

        Values may have more axes. Rows and columns end with one more coefficient: kernels read it
        with the weight 0, without a test.
        """
        counts = [int(count) + 1 for count in self.axes[2:5] if count]
        blocks = np.split(values.swapaxes(0, 2), np.cumsum(counts)[:-1])
        fitted = np.concatenate([spline_coefficients(block) for block in blocks]).swapaxes(0, 2)
        fitted = spline_coefficients(fitted.swapaxes(0, 1)).swapaxes(0, 1)
        return np.pad(fitted, [(0, 0), (0, 1), (0, 1), *[(0, 0)] * (values.ndim - 3)], mode="edge")

    def packed(self, coefficients: Array) -> Array:
        """Pack all into one array."""
        return np.concatenate([self.head, self.rungs.ravel(), coefficients.ravel()])


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
    lam = STRETCH * x / (1.0 - x)
    w, end = np.asarray(zener.elastic_compression(law.data, lam)), np.full(_NODES, most)
    after = False
    if law.range[1] < math.inf:
        found = _overloads(law, x, w, 0.0, law.range[1])
        after = found.min() < most
        end = found if after else end
    series = [_powers_of(x, one**0.25) for one in (w, end / unit)]
    head = np.zeros(lookup.HEADER)
    slowest = _SLOWEST if law.is_hertz else max(_SLOWEST, 1.001 * (law.range[0] / unit) ** 0.25)
    head[: lookup.PAIR] = (x_max, 0, 0, 0, after, 0, 0, 1, (most / unit) ** 0.25 * after, unit, slowest)
    head[lookup.ELASTIC : lookup.END], head[lookup.END :] = series
    made = Grid(head, np.empty(0)).with_cells(settings.rows, BELOW, settings.columns, AFTER)
    return made.on_ladder(law, np.zeros(1))


def _powers_of(x: Array, values: Array) -> Array:
    """Coefficients of a polynomial in x, fitted in Chebyshev's polynomials: powers are nearly alike."""
    fitted = np.polynomial.Chebyshev.fit(x, values, DEGREE)
    return np.asarray(fitted.convert(kind=np.polynomial.Polynomial).coef)


def ladder_of(law: Law, widest: float) -> Array:
    """Rungs ln k of a law: its corners, and others so that no two are farther apart than `widest`."""
    if law.strengths is None:
        return np.zeros(1)
    rungs = [np.zeros(1)]
    for low, high in itertools.pairwise(law.strengths.knots):
        rungs.append(np.linspace(low, high, 1 + math.ceil((high - low) / widest))[1:])
    return np.concatenate(rungs)


def _end(law: Law, log_k: float) -> float:
    """Compression up to which the law of a strength holds."""
    rungs = force.rungs(law.at_any_strength)
    return float(np.interp(log_k, rungs[:, force.STRENGTH], rungs[:, force.END]))


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


def spline_coefficients(values: Array) -> Array:
    """Coefficients of the cubic B-spline through uniform nodes along axis 0, not-a-knot ends.

    With v = (c[i-1] + 4 c[i] + c[i+1])/6 at each node and no jump of the third derivative next to
    the ends, c is known there; a tridiagonal system is left between. Solved without LAPACK, whose
    threads would fight for the cores with those of an MPI run.
    """
    n = len(values)
    if n < 4:
        raise ArgumentError("values", n, "a spline with not-a-knot ends needs at least 4 nodes")
    c = np.empty((n + 2, *values.shape[1:]))
    c[2], c[n - 1] = ((8.0 * values[k] - values[k - 1] - values[k + 1]) / 6.0 for k in (1, n - 2))
    gain = np.zeros(n + 2)
    for k in range(3, n - 1):
        gain[k] = 1.0 / (4.0 - gain[k - 1])
        c[k] = (6.0 * values[k - 1] - c[k - 1]) * gain[k]
    for k in range(n - 2, 2, -1):
        c[k] -= gain[k] * c[k + 1]
    for edge, inwards in ((1, 1), (n, -1)):
        node = edge - 1
        c[edge] = 6.0 * values[node + inwards] - 4.0 * c[edge + inwards] - c[edge + 2 * inwards]
        c[edge - inwards] = 6.0 * values[node] - 4.0 * c[edge] - c[edge + inwards]
    return c
