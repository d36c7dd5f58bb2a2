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
from contactlaw.fitting.measurements import INPUTS
from contactlaw.fitting.predictions import COARSE, ROUGH, Predictor, Values
from contactlaw.fitting.unknowns import SLENDERNESS
from contactlaw.table.cache import progress_bar

_ROWS = 8  # rebounds of each kind that the scan predicts, from the slowest to the fastest
_GUESSED = 0.02  # relative error assumed where none is given, until it is estimated
# Points of an axis by the number of axes, of those on which each point needs its own law, which
# takes 10 ms, and of the others.
_LAWS, _OTHERS = (14, 8, 5), (24, 18, 12)
_BETWEEN = 0.01  # relative error of the splines between the points
_PLACES = 20  # points of the grid, no two beside each other, from which descents on the splines start
_SAME_MINIMUM = 0.05  # distance in logarithms within which two results on the splines are one
_MOST = 6  # basins of the scan from which least squares of the model start
_STEPS = 6  # steps after which a basin may be dropped: the splines' minimum is within 1 % of it
# A basin whose sum of squares is above 3 times the least plus this is neither the best one with all
# rebounds nor as good.
_HOPELESS, _KEPT = 25.0, 3  # and most basins that are kept
# Relative change of the sum of squares at which a descent ends, and distance in logarithms within
# which it keeps derivatives; both near a basin and to its lowest point. Derivatives from a distance
# of 0.01 lead to a point a hundredth of a standard error off.
_NEARBY, _LOWEST = (1e-3, 0.02), (1e-8, 1e-3)
_SAME_BASIN = 1e-2  # distance in logarithms within which two descents have found one basin


class Basin(NamedTuple):
    """A minimum of the sum of squares."""

    x: Array
    squares: float  # sum of squares of data and priors
    fitted: Array  # values predicted there (m,)
    slopes: Array  # of these over their errors, and of the priors' deviations (m + p, moved parameters)


def basins(predictor: Predictor) -> tuple[list[Basin], Array]:
    """Find all minima of the sum of squares that may be the least, the best first, by a few rebounds.

    The second result has the trials, over the whole range, at which values are largest or smallest.
    """
    chosen = _few(replace(predictor, fineness=COARSE))
    starts, extremes = _scan(replace(chosen, fineness=ROUGH))
    error = guessed(chosen.values)
    return lowest([descend(chosen, x, error, steps=_STEPS) for x in progress_bar(iter(starts), len(starts))]), extremes


def guessed(values: Values) -> Array:
    """Errors of the values; a guess where none are given."""
    return np.where(np.isnan(values.error), _GUESSED * values.value, values.error)


def lowest(found: list[Basin]) -> list[Basin]:
    """Keep each basin once, the best first; drop those that cannot be the best."""
    kept = _apart(found, _SAME_BASIN)
    return [one for one in kept[:_KEPT] if one.squares <= 3.0 * kept[0].squares + _HOPELESS]


def _apart(found: list[Basin], least: float) -> list[Basin]:
    """Best basin of each place, the best first; logarithms in one place differ by less than `least`."""
    kept: list[Basin] = []
    for one in sorted(found, key=lambda one: one.squares):
        if all(np.abs(one.x - other.x).max() > least for other in kept):
            kept.append(one)
    return kept


def descend(
    predictor: Predictor, start: Array, error: Array, held: int | None = None, steps: int | None = None
) -> Basin:
    """Find the minimum from a start; not quite, in some steps at most. One parameter may be held."""
    from scipy.optimize import least_squares

    moved = np.arange(start.size) != held
    centres = np.array([0.0 if one.is_free else math.log(one.centre) for one in predictor.parameters])
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
        return np.concatenate([off, (x - centres) / widths])

    def slopes(part: Array) -> Array:
        here = fitted(whole(part).tobytes())
        if not known or np.abs(part - known[-1][0]).max() > near:
            whole_slopes = predictor.derivatives(x, here, np.flatnonzero(moved)) / error[:, None]
            known.append((part.copy(), np.vstack([whole_slopes, np.diag(1.0 / widths)])[:, moved]))
        return known[-1][1]

    first = x[moved]
    off = residuals(first)
    if not np.isfinite(off).all():  # the model has no answer there
        return Basin(start, math.inf, off[: value.size], np.empty((off.size, first.size)))
    if not first.size:
        return Basin(x, float(off @ off), off[: value.size] * error + value, np.empty((off.size, 0)))
    ends = {"ftol": converged, "xtol": 1e-8, "gtol": 1e-10, "max_nfev": steps or 15}
    done = least_squares(residuals, first, slopes, bounds=(low, high), x_scale="jac", **ends)
    return Basin(whole(done.x), float(2.0 * done.cost), done.fun[: value.size] * error + value, done.jac)


def _scan(predictor: Predictor) -> tuple[list[Array], Array]:
    """Values in each basin that a grid shows, the best first, and the trials of the extreme values."""
    from scipy.interpolate import RegularGridInterpolator
    from scipy.optimize import least_squares

    parameters, value = predictor.parameters, predictor.values.value
    free = [n for n, one in enumerate(parameters) if one.is_free]
    if not free:
        start = np.log([one.centre for one in parameters])
        return [start], start[None]
    free.sort(key=lambda n: not parameters[n].changes(predictor.law))  # one law after the other
    axes = _axes(predictor, free)
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(free))
    trials = np.array([_trial(predictor, free, point) for point in points])
    predicted = _predicted(predictor, trials)
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
        start = np.clip([axis[n] for axis, n in zip(axes, place, strict=True)], bounds[0] + 1e-9, bounds[1] - 1e-9)
        done = least_squares(lambda x: (between(x)[0] - value) / soft, start, bounds=bounds, ftol=1e-3, max_nfev=20)
        bottoms.append(Basin(done.x, float(done.cost), value, value))
    starts = [_trial(predictor, free, one.x) for one in _apart(bottoms, _SAME_MINIMUM)[:_MOST]]
    return [np.clip(x, *predictor.limits) for x in starts], trials[ends]


def _axes(predictor: Predictor, free: Sequence[int]) -> list[Array]:
    """Values of each free parameter on the grid; H/R in place of the thickness if the radius is free."""
    parameters = predictor.parameters
    laws, axes = sum(parameters[n].changes(predictor.law) for n in free), []
    for n in free:
        one, (low, high) = parameters[n], predictor.limits[:, n]
        if one.is_strength:
            high = max(min(high, _onset(predictor, n)), low + math.log(2.0))
        if _by_radius(predictor, n):
            low, high = (-math.log(ratio) for ratio in reversed(SLENDERNESS))
        count = _LAWS[laws - 1] if one.changes(predictor.law) else _OTHERS[len(free) - 1]
        axes.append(np.linspace(low, high, count))
    return axes


def _onset(predictor: Predictor, n: int) -> float:
    """Strength from which on a body hardly yields, twice over; others are in the middle of their ranges."""
    x = predictor.limits.mean(axis=0)
    chi = float(np.max(predictor.impacts(predictor.setting(x)).overload))
    # d_Y is in proportion to the square of the strength
    return float(x[n]) + 0.5 * math.log(4.0 * chi) if chi > 0.0 else math.inf


def _by_radius(predictor: Predictor, n: int) -> bool:
    """Whether a parameter is the thickness, and the radius is not known."""
    return predictor.parameters[n].name == "thickness" and predictor.data.radius is None


def _trial(predictor: Predictor, free: Sequence[int], point: Array) -> Array:
    """All parameters at a point of the grid."""
    x = np.array([math.log(one.centre) if not one.is_free else 0.0 for one in predictor.parameters])
    x[free] = point
    for n in free:
        if _by_radius(predictor, n):
            x[n] += next(x[m] for m, one in enumerate(predictor.parameters) if one.name == "radius")
    return x


def _predicted(predictor: Predictor, trials: Array) -> Array:
    """Predict the measured values at all trials (k, m), those of the same bodies together."""
    bodies = [n for n, one in enumerate(predictor.parameters) if one.unknown.body]
    found = np.empty((len(trials), predictor.values.value.size))
    _, group = np.unique(trials[:, bodies], axis=0, return_inverse=True)
    groups = int(group.max()) + 1
    for n in progress_bar(iter(range(groups)), groups):
        found[group.ravel() == n] = predictor.predicted(*trials[group.ravel() == n])
    return found


def _few(predictor: Predictor) -> Predictor:
    """Keep some rebounds of each kind, evenly over the speeds and over each other input."""
    values, chosen = predictor.values, set[int]()
    for along in (getattr(predictor.data, name) for name in INPUTS):
        for kind in np.unique(values.kind) if along is not None else ():
            rows = values.row[values.kind == kind]
            rows = rows[np.argsort(along[rows], kind="stable")]
            at = np.linspace(0, rows.size - 1, min(_ROWS, rows.size)).round().astype(int)
            chosen.update(rows[at].tolist())
    return replace(predictor, data=predictor.data.part(sorted(chosen)))
