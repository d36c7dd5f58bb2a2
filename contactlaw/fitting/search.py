"""The values that fit the data best: a scan of the whole range, then least squares.

With two unknowns the data may fit about as well in several regimes: thin and strong, thick and
soft. Least squares end in the basin where they start, so they have to start in each. The scan
predicts a few rebounds on a coarse grid. Predictions are smooth, so that least squares on splines
through them find every basin.
"""

import functools
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw.fitting.predictions import COARSE, ROUGH, Predictor, Values
from contactlaw.fitting.unknowns import SLENDERNESS

_ROWS = 48  # least number of rebounds that the scan predicts, evenly over the speeds
_GUESSED = 0.02  # relative error assumed where none is given, until it is estimated
_POINTS = (20, 9, 7)  # points of an axis by the number of axes; one may need its own law, which takes 10 ms
_BETWEEN = 0.01  # relative error of the splines between the points
_PLACES = 20  # points of the grid, no two beside each other, from which descents on the splines start
_SAME_MINIMUM = 0.05  # distance in logarithms within which two results on the splines are one
_MOST = 6  # basins from which descents of the model start, by few rebounds; the best three go on with all
_STEPS = 6  # steps after which a basin may be dropped: the splines' minimum is within 1 % of it
# A basin whose sum of squares is above 3 times the least plus this is neither the best one with all
# rebounds nor as good.
_HOPELESS = 25.0
# Relative change of the sum of squares at which a descent ends, and distance in logarithms within
# which it keeps derivatives; both near a basin and to its lowest point. Derivatives from a distance
# of 0.01 lead to a point a hundredth of a standard error off.
_NEARBY, _LOWEST = (1e-3, 0.02), (1e-8, 1e-3)
_SAME_BASIN = 1e-2  # distance in logarithms within which two descents have found one basin


class Basin(NamedTuple):
    """A minimum of the sum of squares."""

    x: Array
    squares: float  # sum of squares of data and priors
    off: Array  # deviations of values and priors over their errors (m + p,)
    slopes: Array  # of these (m + p, moved parameters)
    fitted: Array  # values predicted there (m,)


def basins(predictor: Predictor) -> tuple[list[Basin], Array]:
    """Find all minima of the sum of squares that may be the least, the best first, by a few rebounds.

    The second result has the trials, over the whole range, at which values are largest or smallest.
    """
    rows = np.argsort(np.asarray(predictor.data.speed), kind="stable")
    some = predictor.data.part(rows[:: max(1, rows.size // _ROWS)])
    chosen = replace(predictor, fineness=COARSE, data=some)
    starts, extremes = _scan(replace(chosen, fineness=ROUGH))
    error = guessed(chosen.values)
    return lowest([descend(chosen, x, error, steps=_STEPS) for x in starts])[:3], extremes


def guessed(values: Values) -> Array:
    """Errors of the values; a guess where none are given."""
    return np.where(np.isnan(values.error), _GUESSED * values.value, values.error)


def lowest(found: list[Basin], apart: float = _SAME_BASIN) -> list[Basin]:
    """Keep each basin once, the best first; drop those that cannot be the best."""
    kept: list[Basin] = []
    for one in sorted(found, key=lambda one: one.squares):
        if all(np.abs(one.x - other.x).max() > apart for other in kept):
            kept.append(one)
    return [one for one in kept if one.squares <= 3.0 * kept[0].squares + _HOPELESS]


def descend(
    predictor: Predictor, start: Array, error: Array, held: int | None = None, steps: int | None = None
) -> Basin:
    """Find the minimum from a start; not quite, in some steps at most. One parameter may be held."""
    from scipy.optimize import least_squares

    moved = np.arange(start.size) != held
    widths = np.array([one.prior for one in predictor.parameters])
    value, fitted = predictor.values.value, functools.cache(lambda key: predictor.predicted(np.frombuffer(key))[0])
    low, high = predictor.limits[:, moved]
    margin = 1e-6 * (high - low)
    converged, near = _LOWEST if steps is None else _NEARBY
    known: list[tuple[Array, Array]] = []
    x = start.copy()
    x[moved] = np.clip(start[moved], low + margin, high - margin)

    def whole(part: Array) -> Array:
        x[moved] = part
        return x

    def residuals(part: Array) -> Array:
        off = (fitted(whole(part).tobytes()) - value) / error
        return np.concatenate([off, (x - predictor.centres) / widths])

    def slopes(part: Array) -> Array:
        here = fitted(whole(part).tobytes())
        if not known or np.abs(part - known[-1][0]).max() > near:
            whole_slopes = predictor.derivatives(x, here, np.flatnonzero(moved)) / error[:, None]
            known.append((part.copy(), np.vstack([whole_slopes, np.diag(1.0 / widths)])[:, moved]))
        return known[-1][1]

    first = x[moved]
    off = residuals(first)
    slope = off[:, None]
    if first.size and np.isfinite(off).all():  # NaN: the model has no answer there
        # trf: "dogbox" takes fewer trials along flat valleys, but has to refuse more fits of three unknowns
        ends = {"ftol": converged, "gtol": 1e-10, "max_nfev": steps or 15}
        done = least_squares(residuals, first, slopes, bounds=(low, high), x_scale="jac", **ends)
        whole(done.x)
        off, slope = done.fun, done.jac
    squares = float(np.nan_to_num(off @ off, nan=math.inf))
    return Basin(x, squares, off, slope, off[: value.size] * error + value)


def _scan(predictor: Predictor) -> tuple[list[Array], Array]:
    """Values in each basin that a grid shows, the best first, and the trials of the extreme values."""
    from scipy.interpolate import RegularGridInterpolator
    from scipy.optimize import least_squares

    parameters, value = predictor.parameters, predictor.values.value
    known = predictor.centres
    free = [n for n, one in enumerate(parameters) if one.is_free]
    if not free:
        return [known], known[None]
    # trials with one law come one after the other, and those of the same bodies are predicted together
    free.sort(key=lambda n: (not parameters[n].changes(predictor.law), not parameters[n].unknown.body))
    names = [parameters[n].name for n in free]
    axes, basis = [_axis(predictor, n, names) for n in free], np.eye(known.size)[free]
    if {"radius", "thickness"} <= {*names}:  # the axis of the thickness is one of H/R
        basis[names.index("radius"), free[names.index("thickness")]] = 1.0
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(free))
    trials = known + points @ basis
    alike = math.prod(axis.size for axis, n in zip(axes, free, strict=True) if not parameters[n].unknown.body)
    predicted = np.concatenate([predictor.predicted(*part) for part in trials.reshape(-1, alike, known.size)])
    ends = np.unique([np.nanargmin(predicted, axis=0), np.nanargmax(predicted, axis=0)])
    shape = [axis.size for axis in axes]
    grid = np.nan_to_num(predicted).reshape(*shape, -1)  # 0: far from any measured value
    between = RegularGridInterpolator(axes, grid, method="cubic")
    soft = np.hypot(guessed(predictor.values), _BETWEEN * value)
    squares = (((grid - value) / soft) ** 2).sum(axis=-1)
    places: list[Array] = []
    for place in np.array(np.unravel_index(np.argsort(squares, axis=None), shape)).T:
        if len(places) < _PLACES and all(np.abs(place - other).max() > 1 for other in places):
            places.append(place)
    bounds = np.array([(axis[0], axis[-1]) for axis in axes]).T
    bottoms = []
    for place in places:
        start = np.clip(points.reshape(*shape, -1)[tuple(place)], bounds[0] + 1e-9, bounds[1] - 1e-9)
        done = least_squares(lambda x: (between(x)[0] - value) / soft, start, bounds=bounds, ftol=1e-3, max_nfev=20)
        bottoms.append(Basin(done.x, float(done.cost), value, value, value))
    starts = [known + bottom.x @ basis for bottom in lowest(bottoms, _SAME_MINIMUM)[:_MOST]]
    return [np.clip(x, *predictor.limits) for x in starts], trials[ends]


def _axis(predictor: Predictor, n: int, names: Sequence[str]) -> Array:
    """Logarithms of a free parameter on the grid; those of H/R for a thickness beside a radius."""
    one, (low, high) = predictor.parameters[n], predictor.limits[:, n]
    if one.name == "thickness" and "radius" in names:
        low, high = -np.log(SLENDERNESS[::-1])
    return np.linspace(low, high, _POINTS[len(names) - 1])
