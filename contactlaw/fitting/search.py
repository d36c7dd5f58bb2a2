"""The values that fit the data best: a scan of the whole range, then least squares.

With two unknowns the data may fit about as well in several regimes: thin and strong, thick and
soft. Least squares end in the basin where they start, so they have to start in each. The scan
predicts a few rebounds on a coarse grid. Predictions are smooth, so splines interpolate them to a
fine grid, on which the sum of squares shows every basin.
"""

import itertools
import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw.answers.backend import UnsolvedError
from contactlaw.fitting.measurements import INPUTS, KINDS, Measurements
from contactlaw.fitting.predictions import COARSE, ROUGH, Predictor, Values
from contactlaw.fitting.unknowns import Parameter, bounds
from contactlaw.table.cache import progress_bar

_ROWS = 8  # rebounds of each kind that the scan predicts, from the slowest to the fastest
_SUBSET = 200  # most rebounds of each kind in least squares before those with all rebounds
_GUESSED = 0.02  # relative error assumed where none is given, until it is estimated
# Relative change of the sum of squares at which a descent ends, and distance in logarithms within
# which it keeps derivatives that need another law; both near a basin and to its lowest point.
# Derivatives from a distance of 0.01 lead to a point a hundredth of a standard error off.
_NEARBY, _LOWEST = (1e-7, 0.02), (1e-10, 2e-4)
# Points of an axis on which each needs its own law, by the number of such axes: a law takes 10 ms.
_STRENGTHS, _MODULI = (0, 14, 9, 6), (0, 7, 5, 4)
_DENSITIES, _SLENDERNESS = 5, 22  # points of an axis of densities, and of R/H
_FRICTIONS = (0, 41, 16, 9)  # points of an axis of friction, by the number of unknowns
_SLENDEREST, _THICKEST = 6.0, 0.03  # R/H; a plate thinner than R/6 gives no rebound to measure
_RADII = np.geomspace(1e-5, 0.05, 16)  # [m]
_FINER = (0, 16, 8, 3)  # points of the fine grid per step of the coarse one, by number of unknowns
_BETWEEN = 0.01  # relative error of the splines between the points
_CHAIN = 40  # lowest points of the fine grid from which least squares on the splines start
_SAME_MINIMUM = 0.05  # distance in logarithms within which two results on the splines are one
_INSIDE = np.array([[1e-9], [-1e-9]])  # least distance of a start from either end of the grid
_MOST = 6  # basins of the scan from which least squares of the model start
_STEPS = 6  # steps after which a basin may be dropped: the splines' minimum is within 1 % of it
# A basin whose sum of squares is above 3 times the least plus this is neither the best one with all
# rebounds nor as good.
_HOPELESS = 25.0
_SAME_BASIN = 1e-2  # distance in logarithms within which two descents have found one basin


def limits(predictor: Predictor) -> tuple[Array, Array]:
    """Least and largest value of each parameter."""
    low, high = np.array([bounds(one, predictor.pair) for one in predictor.parameters]).T
    return low, high


class Basin(NamedTuple):
    """A minimum of the sum of squares."""

    at: Array
    squares: float  # sum of squares of data and priors


def basins(predictor: Predictor) -> list[Basin]:
    """Find all minima of the sum of squares that may be the least, the best first.

    If there are many rebounds, only some of them are used.
    """
    predictor = replace(predictor, fineness=COARSE)
    few = _few(predictor, _ROWS)
    found = _descents(few, scan(replace(few, fineness=ROUGH)), _STEPS)
    if len(predictor.data) > _SUBSET:  # come close before each step predicts all of them
        found = _descents(_few(predictor, _SUBSET), [one.at for one in found])
    return found


def _descents(predictor: Predictor, starts: list[Array], *steps: int) -> list[Basin]:
    descent, error = Descent(predictor), guessed(predictor.values)
    return distinct([descent(start, error, *steps) for start in progress_bar(iter(starts), len(starts))])


def guessed(values: Values) -> Array:
    """Errors of the values; a guess where none are given."""
    return np.where(np.isnan(values.error), _GUESSED * values.value, values.error)


def distinct(found: list[Basin]) -> list[Basin]:
    """Keep each basin once, the best first; drop those that cannot be the best."""
    kept = _apart(found, _SAME_BASIN)
    return [one for one in kept if one.squares <= 3.0 * kept[0].squares + _HOPELESS]


def _apart(found: list[Basin], least: float) -> list[Basin]:
    """Best basin of each place, the best first; logarithms in one place differ by less than `least`."""
    kept: list[Basin] = []
    for one in sorted(found, key=lambda one: one.squares):
        if all(np.abs(np.log(one.at / other.at)).max() > least for other in kept):
            kept.append(one)
    return kept


def scan(predictor: Predictor) -> list[Array]:
    """Values in each basin that a grid shows, the best first."""
    from scipy.interpolate import CubicSpline

    axes = _axes(predictor)
    free = [n for n, axis in enumerate(axes) if axis.size > 1]
    grid = [axes[n] for n in free]
    predicted = _predicted(predictor, axes).reshape(*(axis.size for axis in grid), -1)
    for n, axis in enumerate(grid):  # points between those of the grid, and predictions there by splines
        grid[n] = np.linspace(axis[0], axis[-1], (axis.size - 1) * _FINER[min(3, len(free))] + 1)
        predicted = CubicSpline(axis, predicted, axis=n)(grid[n])
    soft = np.hypot(guessed(predictor.values), _BETWEEN * predictor.values.value)
    off = (predicted - predictor.values.value) / soft
    starts = []
    for bottom in _bottoms(grid, off)[:_MOST] if free else [np.empty(0)]:
        start = np.array([axis[0] for axis in axes])
        start[free] = bottom
        starts.append(np.clip(_trial(predictor, start), *limits(predictor)))
    return starts


def attainable(predictor: Predictor) -> Array:
    """Predict the measured values over the range of the unknowns; a row for each trial."""
    axes = _axes(predictor)
    free = [n for n, one in enumerate(predictor.parameters) if one.is_free]
    if [predictor.parameters[n].name for n in free] == ["thickness"]:  # up to a half-space
        axes[free[0]] = np.append(axes[free[0]], np.log(limits(predictor)[1][free]))
    return _predicted(predictor, axes)


def _bottoms(axes: list[Array], off: Array) -> list[Array]:
    """Minima of the sum of squares of a grid of residuals, the best first; a row for each.

    A narrow valley across the grid has a chain of lowest points. Least squares on the splines start
    from each and end in one minimum, so that no chain hides another valley.
    """
    from scipy import interpolate, ndimage, optimize

    squares = (off**2).sum(axis=-1)
    lowest = squares <= ndimage.minimum_filter(squares, 3, mode="nearest")
    # where nothing yields, all strengths have the same sum: such a plateau counts as one place
    regions, count = ndimage.label(lowest, np.ones([3] * squares.ndim))
    places = ndimage.minimum_position(squares, regions, range(1, count + 1))
    places = sorted(places, key=lambda place: float(squares[place]))[:_CHAIN]
    between = interpolate.RegularGridInterpolator(axes, off)
    ends = np.array([(axis[0], axis[-1]) for axis in axes]).T
    bottoms = []
    for place in places:
        start = np.clip([axis[n] for axis, n in zip(axes, place, strict=True)], *(ends + _INSIDE))
        done = optimize.least_squares(lambda x: between(x)[0], start, bounds=ends, ftol=1e-3, max_nfev=20)
        bottoms.append(Basin(np.exp(done.x), float(done.cost)))
    return [np.log(one.at) for one in _apart(bottoms, _SAME_MINIMUM)]


def _trial(predictor: Predictor, point: Array) -> Array:
    """Trial at a point of the grid, where R/H replaces the thickness if a radius is sought, too."""
    found = np.exp(point)
    place = {one.name: n for n, one in enumerate(predictor.parameters) if one.is_free}
    if {"thickness", "radius"} <= place.keys():
        found[place["thickness"]] = found[place["radius"]] / found[place["thickness"]]
    return found


def _predicted(predictor: Predictor, axes: list[Array]) -> Array:
    """Predict the measured values at all points of the grid, one after the other."""
    count = predictor.values.value.size
    points = np.array(list(itertools.product(*axes)))
    found = np.empty((len(points), count))
    bodies = [n for n, one in enumerate(predictor.parameters) if one.unknown.body]
    bodies.sort(key=lambda n: not predictor.parameters[n].changes(predictor.law))  # one law after the other
    _, group = np.unique(points[:, bodies], axis=0, return_inverse=True)
    groups = int(group.max()) + 1
    for n in progress_bar(iter(range(groups)), groups):
        part = group.ravel() == n
        found[part] = predictor.at_trials(np.array([_trial(predictor, point) for point in points[part]]))
    return found


def _few(predictor: Predictor, count: int) -> Predictor:
    """Keep `count` rebounds of each kind, evenly over the speeds, and over each input that differs."""
    values, chosen = predictor.values, set[int]()
    names = *KINDS, *(f"{name}_error" for name in KINDS), *INPUTS
    columns: dict[str, Any] = {name: getattr(predictor.data, name) for name in names}
    columns = {name: column for name, column in columns.items() if column is not None}
    for name in columns.keys() & INPUTS:
        along = columns[name]
        if name != "speed" and np.unique(along[np.isfinite(along)]).size < 2:
            continue
        for kind in np.unique(values.kind):
            rows = values.row[values.kind == kind]
            rows = rows[np.argsort(along[rows], kind="stable")]
            at = np.linspace(0, rows.size - 1, min(count, rows.size)).round().astype(int)
            chosen.update(rows[at].tolist())
    kept = sorted(chosen)
    return replace(predictor, data=Measurements(**{name: column[kept] for name, column in columns.items()}))


def _middle(one: Parameter, predictor: Predictor) -> float:
    """Value of a parameter that is not scanned: the one given, or a guess."""
    if not math.isnan(one.centre):
        return one.centre
    if one.is_strength:
        return 1e-2 * float(getattr(predictor.pair, one.unknown.body).youngs_modulus)
    other = predictor.data.radius if one.name == "thickness" else predictor.data.thickness
    if other is None or not np.isfinite(other).any():
        return 1e-3
    return float(np.median(np.asarray(other)[np.isfinite(other)]))


def _axes(predictor: Predictor) -> list[Array]:
    """Logarithms of trial values of each parameter; one value where it is not scanned."""
    parameters, data = predictor.parameters, predictor.data
    scanned = {one.name for one in parameters if one.is_free}
    laws = min(3, sum(one.is_free and one.changes(predictor.law) for one in parameters))
    counts = {"youngs_modulus": _MODULI[laws or 1], "density": _DENSITIES, "loss_factor": _DENSITIES}
    counts["friction"] = _FRICTIONS[min(3, len(scanned))]
    low, high = limits(predictor)
    points = []
    for n, one in enumerate(parameters):
        if not one.is_free:
            axis = np.array([one.centre])
        elif one.is_strength:
            top = min(high[n], 2.0 * _onset(predictor, n))
            axis = np.geomspace(low[n], max(top, 2.0 * low[n]), _STRENGTHS[laws or 1])
        elif one.unknown.field in counts:
            axis = np.geomspace(low[n], high[n], counts[one.unknown.field])
        elif one.name == "thickness":
            radius = np.ones(1) if data.radius is None else np.asarray(data.radius)
            ends = radius.max() / _SLENDEREST, radius.min() / _THICKEST
            axis = np.geomspace(*ends, _SLENDERNESS)
            axis = 1.0 / axis if "radius" in scanned else axis
        else:
            axis = _RADII
            if data.thickness is not None and np.isfinite(data.thickness).any():
                thickness = np.asarray(data.thickness)[np.isfinite(data.thickness)]
                ends = _THICKEST * thickness.max(), _SLENDEREST * thickness.min()
                axis = np.geomspace(*ends, _SLENDERNESS)
        points.append(np.log(np.sort(axis)))
    return points


def _onset(predictor: Predictor, n: int) -> float:
    """Strength above which a body hardly yields; other parameters have their `_middle` values."""
    trial = np.array([_middle(one, predictor) for one in predictor.parameters])
    chi = float(np.max(predictor.impacts(predictor.setting(trial)).overload))
    # d_Y is in proportion to the square of the strength
    return float(trial[n] * math.sqrt(chi)) if chi > 0.0 else math.inf


class Descent:
    """Least squares by scipy; keeps predictions and slopes for the next call with other errors."""

    def __init__(self, predictor: Predictor, to_the_lowest: bool = False) -> None:
        self.predictor = predictor
        self._converged, self._near = _LOWEST if to_the_lowest else _NEARBY
        self._low, self._high = np.log(np.array(limits(predictor)))
        self._centres = np.array([0.0 if one.is_free else math.log(one.centre) for one in predictor.parameters])
        self._widths = np.array([one.prior for one in predictor.parameters])
        self._last_predicted: tuple[Array, Array] | None = None
        self._last_slopes: tuple[Array, Array] | None = None

    def predicted(self, x: Array) -> Array:
        """Fitted values, from the logarithms of the parameters."""
        if self._last_predicted is None or not np.array_equal(self._last_predicted[0], x):
            self._last_predicted = x.copy(), self.predictor.predicted(np.exp(x))
        return self._last_predicted[1]

    def slopes(self, x: Array) -> Array:
        """Differentiate the fitted values."""
        here = self.predicted(x)
        if self._last_slopes and float(np.abs(x - self._last_slopes[0]).max()) < self._near:
            return self.predictor.derivatives(np.exp(x), here, self._last_slopes[1])
        self._last_slopes = x.copy(), self.predictor.derivatives(np.exp(x), here)
        return self._last_slopes[1]

    def __call__(self, start: Array, error: Array, steps: int = 60) -> Basin:
        """Find the minimum from a start, in so many steps."""

        def residuals(x: Array) -> Array:
            try:
                off = (self.predicted(x) - self.predictor.values.value) / error
            except (UnsolvedError, ValueError):  # no answer there: scipy shortens the step
                off = np.full_like(error, np.inf)
            return np.concatenate([off, (x - self._centres) / self._widths])

        def slopes(x: Array) -> Array:
            return np.vstack([self.slopes(x) / error[:, None], np.diag(1.0 / self._widths)])

        from scipy.optimize import least_squares

        margin = 1e-6 * (self._high - self._low)
        first = np.clip(np.log(start), self._low + margin, self._high - margin)
        if not np.isfinite(residuals(first)).all():  # the model has no answer there
            return Basin(start, math.inf)
        found = least_squares(
            residuals,
            first,
            slopes,
            bounds=(self._low, self._high),
            x_scale="jac",
            ftol=self._converged,
            xtol=1e-9,
            gtol=1e-10,
            max_nfev=steps,
        )
        return Basin(np.exp(found.x), float(2.0 * found.cost))
