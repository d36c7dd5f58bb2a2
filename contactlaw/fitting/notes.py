"""Remarks on a fit, in words; some name signs of mistaken units, materials or measurements."""

import math
from collections.abc import Iterator, Mapping

import numpy as np

from contactlaw._arrays import Array, Places
from contactlaw._readable import in_unit, percent, rounded
from contactlaw.fitting.identify import UnidentifiedError
from contactlaw.fitting.measurements import KINDS
from contactlaw.fitting.predictions import Predictor
from contactlaw.fitting.search import Basin
from contactlaw.fitting.unknowns import OTHER_STRENGTH, UNKNOWNS
from contactlaw.physical.oblique import ObliqueRebound
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.validity import count_flags, explain

_FAR = 4.0  # standard errors; values that are further off the fit are named
_MISFIT = 1.5  # scatter over the scatter to be expected; a larger ratio is reported
_AT_BOUND = 1e-3  # relative distance from a bound; a nearer value is at the bound
_HALF_SPACE = math.log(UNKNOWNS["thickness"].largest)
_SLIDES = 1.0 - 1e-6  # share of the friction at which an impulse is that of full sliding
_LISTED = 8  # rows or runs of rows that are listed; more are only counted
_SIGNIFICANCE = 1e-3  # a trend is noted if scatter alone gives it in fewer than 1 of 1000 fits
# Residuals are cut to 3 standard errors or medians, so that one mistake makes no trend.
_OUTLIER = 3.0
# Factors by which a value may differ from the one given: a strength depends on the temper. A loss
# factor depends on the frequency and is often a guess.
_FACTORS = {"yield_strength": 3.0, "youngs_modulus": 2.0, "density": 2.0}


def notes(
    predictor: Predictor,
    best: Basin,
    hit: Rebound,
    error: Array,
    freedom: float,
    model: Array | None,
    covariance: Array,
) -> Iterator[str]:
    """Say what is unusual about a fit, and what makes it doubtful.

    Parameters
    ----------
    predictor : Predictor
        Model and parameters of the fit.
    best : Basin
        Values found.
    hit : Rebound
        Fitted rebounds.
    error : ndarray (m,)
        Standard errors of the values, as given or found.
    freedom : float
        Degrees of freedom; inf where all errors were given.
    model : ndarray (m,) or None
        Errors of the model, relative to the fitted values; None where they are not known.
    covariance : ndarray (p, p)
        Covariance of the parameters' logarithms.
    """
    parameters, friction, low, high = predictor.parameters, predictor.setting(best.x).friction, *predictor.limits
    off, standard = predictor.values.value / best.fitted - 1.0, error / best.fitted
    if freedom:
        yield from _found_errors(predictor, standard)
    else:
        yield "as many unknowns as values, and no errors of these: the errors stated are those of the model alone"
    yield from _misfits(predictor, off, np.hypot(standard, 0.0 if model is None else model), freedom)
    if model is None:
        yield (
            f"how far law {predictor.law.family!r} is from finite elements is not known: the "
            "errors stated are those of the data alone"
        )
    for n in np.flatnonzero((best.x < low + _AT_BOUND) | (best.x > high - _AT_BOUND)):
        ends = f"{math.exp(low[n]):.3g} to {math.exp(high[n]):.3g}"
        yield f"{parameters[n].unknown.title} is at an end of the range searched, {ends}"
    if any(one.is_strength for one in parameters):
        yielded = int(np.count_nonzero(np.asarray(hit.overload) > 1.0))
        yield f"{yielded} of {len(predictor.data)} rebounds are beyond yield and give the strength"
    if isinstance(hit, ObliqueRebound) and friction is not None:
        sliding = int(np.count_nonzero(np.asarray(hit.impulse_ratio) > _SLIDES * friction))
        yield f"{sliding} of {len(predictor.data)} rebounds slide all the time"
    flags = np.asarray(hit.flags)
    for flag in count_flags(flags):
        yield f"{flag.name}, rebounds {listed(np.flatnonzero(flags & flag))}: {explain(flag)[0]}"
    yield from _above_one(predictor)
    yield from _far(predictor, best.x, covariance)
    yield from _trends(predictor, off, standard, model)


def alternative_note(values: Mapping[str, float]) -> str:
    """Say that other values fit as well."""
    what = ", ".join(
        f"{UNKNOWNS[name].title} {in_unit(value, UNKNOWNS[name].unit, 4).rstrip()}" for name, value in values.items()
    )
    return (
        f"the data are fitted as well by {what}: the stated errors do not reach there. Measure "
        "another quantity or other speeds, or give a prior"
    )


def explained(refused: UnidentifiedError, predictor: Predictor, extremes: Array) -> UnidentifiedError:
    """Add to a refusal which values are attainable, or which of them cannot be."""
    message = ". ".join([*(_outside(predictor, extremes) or [refused.reason]), *_above_one(predictor)])
    return UnidentifiedError(message, refused.unknown, refused.known)


def listed(rows: Places) -> str:
    """Write indices of rebounds; of three and more in a row only the ends.

    Examples
    --------
    >>> listed(np.array([0, 1, 2, 5, 7, 8]))
    '0 to 2, 5, 7, 8'
    """
    runs = np.split(rows, np.flatnonzero(np.diff(rows) != 1) + 1)
    parts = []
    for run in runs:
        parts += [f"{run[0]} to {run[-1]}"] if run.size > 2 else [str(row) for row in run]
    more = len(parts) - _LISTED
    return ", ".join(parts[:_LISTED]) + (f" and {more} more" if more > 0 else "")


def _found_errors(predictor: Predictor, standard: Array) -> Iterator[str]:
    for name, of_kind in predictor.values.by_kind().items():
        of_kind = of_kind & np.isnan(predictor.values.error)
        if of_kind.any():
            share = float(standard[of_kind][0])
            yield (
                f"{KINDS[name].title}: no errors were given; one of {percent(share)} was found from the "
                f"scatter of {np.count_nonzero(of_kind)} values"
            )


def _misfits(predictor: Predictor, off: Array, expected: Array, freedom: float) -> Iterator[str]:
    values = predictor.values
    given = np.isfinite(values.error)
    free = max(1, sum(one.is_free for one in predictor.parameters))
    if np.count_nonzero(given) > free:
        ratio = float(np.sqrt(((off / expected)[given] ** 2).sum() / (given.sum() - free)))
        if ratio > _MISFIT:
            yield (
                f"the values are off by {rounded(ratio)} times what their errors and the model's "
                "allow: another number may be wrong, or the errors too small"
            )
    if freedom < 3.0:
        return
    for n in np.flatnonzero(np.abs(off) > _FAR * expected):
        name = [*KINDS.values()][values.kind[n]].title
        sign = "+" if off[n] > 0.0 else ""
        yield (
            f"{name} of {predictor.data.rebound(values.row[n])} is {sign}{percent(off[n])} off the "
            f"fit, {rounded(abs(off[n]) / expected[n])} standard errors: a mistake?"
        )


def _above_one(predictor: Predictor) -> Iterator[str]:
    for name in ("restitution", "tangential_restitution"):
        rows = np.flatnonzero(np.array(getattr(predictor.data, name), dtype=np.float64) > 1.0)
        if rows.size:
            which = predictor.data.rebound(rows[0]) if rows.size == 1 else f"rebounds {listed(rows)}"
            yield f"{KINDS[name].title} of {which} is above 1: no impact gains energy, a mistake?"


def _outside(predictor: Predictor, extremes: Array) -> list[str]:
    """Say so if no value of the unknowns gives any of the data, and what is attainable."""
    values, unknown = predictor.values, " and ".join(one.name for one in predictor.parameters if one.is_unknown)
    if unknown == "thickness":  # up to a half-space
        extremes = np.vstack([extremes, np.append(_HALF_SPACE, extremes[0, 1:])])
    grid = np.vstack([predictor.predicted(x) for x in extremes])
    low, high = np.nanmin(grid, axis=0), np.nanmax(grid, axis=0)
    near = np.clip(values.value, low, high)
    margin = 2.0 * np.nan_to_num(values.error) + 1e-6 * near
    # else the law does not depend on the unknowns, or some value can be
    if not ((high > 1.001 * low).any() and (np.abs(values.value - near) > margin).all()):
        return []
    n = int(np.argmax(np.abs(values.value / near - 1.0)))
    kind, row = [*KINDS.values()][values.kind[n]], values.row[n]
    unit = kind.unit.strip("-")
    value, least, most = (float(one[n]) - kind.shift for one in (values.value, low, high))
    least = least if abs(least) > 1e-3 * most else 0.0
    ends = f"from {least:.3g} to {most:.3g} {unit}".rstrip()
    ends += ", that of a half-space" if unknown == "thickness" and high[n] == grid[-1, n] else ""
    if unknown in OTHER_STRENGTH:
        ends += f"; or ask for {OTHER_STRENGTH[unknown]} if that body yields"
    which = f"{kind.title} {f'{value:.4g} {unit}'.rstrip()} of {predictor.data.rebound(row)}"
    speed = rounded(float(np.asarray(predictor.data.speed)[row]), 3)
    return [f"no {unknown} gives the {which}, at {speed} m/s: attainable is {ends}"]


def _far(predictor: Predictor, x: Array, covariance: Array) -> Iterator[str]:
    """Name values that, with two standard errors, are far from those given."""
    for n, one in enumerate(predictor.parameters):
        most = _FACTORS.get(one.unknown.field, math.inf)
        ratio = math.exp(x[n]) / one.centre  # NaN if none was given
        apart = abs(math.log(ratio)) - 2.0 * math.sqrt(covariance[n, n])
        if one.is_unknown and apart > math.log(most):
            body = getattr(predictor.pair, one.unknown.body).name
            yield (
                f"{one.unknown.title} is {rounded(max(ratio, 1.0 / ratio))} times "
                f"{'above' if ratio > 1.0 else 'below'} that of {body}, "
                f"{in_unit(one.centre, one.unknown.unit, 4)}: units or materials mistaken, or sphere and plate "
                "exchanged?"
            )


def _trends(predictor: Predictor, off: Array, standard: Array, model: Array | None) -> Iterator[str]:
    """Name kinds of values whose residuals trend with speed."""
    speed = np.asarray(predictor.data.speed)[predictor.values.row]
    for name, of_kind in predictor.values.by_kind().items():
        order = np.flatnonzero(of_kind)
        order = order[np.argsort(speed[order])]
        thirds = np.array_split(order, 3)
        if chance(thirds, off / standard) >= _SIGNIFICANCE:
            continue
        means = [float(off[third].mean()) for third in thirds]
        slow, middle, fast = map(percent, means)
        known = 0.0 if model is None else math.sqrt(np.mean(np.square(model[of_kind])))
        why = "units, materials or the law may be wrong"
        if max(map(abs, means)) < 2.0 * known:
            why = f"errors of law {predictor.law.family!r} allow that, those of the data do not"
        yield (
            f"residuals of {KINDS[name].title} trend with speed: {slow}, {middle} and {fast} in the slow, the "
            f"middle and the fast third, by chance in fewer than 1 of 1000 fits: {why}"
        )


def chance(thirds: list[Places], off: Array) -> float:
    """Chance that scatter alone moves the means of the thirds as far apart, by Fisher's test.

    Parameters take up a part of any trend, so that the chance is rather too large.
    """
    from scipy.stats import f_oneway

    if min(third.size for third in thirds) < 2:
        return 1.0
    most = _OUTLIER * max(1.0, float(np.median(np.abs(off[np.concatenate(thirds)]))))
    return float(f_oneway(*(np.clip(off[third], -most, most) for third in thirds)).pvalue)
