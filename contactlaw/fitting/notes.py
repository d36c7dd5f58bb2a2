"""Remarks on a fit, in words; some name signs of mistaken units, materials or measurements."""

import math
from collections.abc import Iterator, Mapping

import numpy as np

from contactlaw._arrays import Array
from contactlaw._readable import in_unit, percent, rounded
from contactlaw.fitting.identify import UnidentifiedError
from contactlaw.fitting.measurements import KINDS
from contactlaw.fitting.predictions import Predictor
from contactlaw.fitting.search import Basin
from contactlaw.fitting.unknowns import OTHER_STRENGTH, UNKNOWNS
from contactlaw.physical.rebound import Rebound

_FAR = 4.0  # standard errors; values that are further off the fit are named
_MISFIT = 1.5  # scatter over the scatter to be expected; a larger ratio is reported
_AT_BOUND = 1e-3  # relative distance from a bound; a nearer value is at the bound
# Factors by which a value may differ from the one given: a strength depends on the temper. A loss
# factor depends on the frequency and is often a guess.
_FACTORS = {"yield_strength": 3.0, "youngs_modulus": 2.0, "density": 2.0}


def notes(
    predictor: Predictor, best: Basin, hit: Rebound, error: Array, freedom: float, model: Array, covariance: Array
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
    model : ndarray (m,)
        Errors of the model, relative to the fitted values; 0 if they are not known.
    covariance : ndarray (p, p)
        Covariance of the parameters' logarithms.
    """
    parameters, (low, high) = predictor.parameters, predictor.limits
    off = predictor.values.value / best.fitted - 1.0
    if not freedom:
        yield "as many unknowns as values, and no errors of these: the errors stated are those of the model alone"
    yield from _misfits(predictor, off, np.hypot(error / best.fitted, model), freedom)
    if not model.any():
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
    yield from _above_one(predictor)
    yield from _far(predictor, best.x, covariance)


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
    """Say what is attainable if no value of the unknowns gives any of the data; else why they are refused."""
    values, unknown = predictor.values, " and ".join(one.name for one in predictor.parameters if one.is_unknown)
    grid = np.vstack([predictor.predicted(x) for x in extremes])
    low, high = np.nanmin(grid, axis=0), np.nanmax(grid, axis=0)
    near = np.clip(values.value, low, high)
    margin = 2.0 * np.nan_to_num(values.error) + 1e-6 * near
    message = refused.reason
    # else the law does not depend on the unknowns, or some value is attainable
    if (high > 1.001 * low).any() and (np.abs(values.value - near) > margin).all():
        n = int(np.argmax(np.abs(values.value / near - 1.0)))
        kind, row = [*KINDS.values()][values.kind[n]], values.row[n]
        value, least, most = (one[n] - kind.shift for one in (values.value, low, high))
        speed, unit = rounded(np.asarray(predictor.data.speed)[row], 3), kind.unit.strip("-")
        message = f"no {unknown} gives the {kind.title} {value:.4g} of {predictor.data.rebound(row)}, at {speed} m/s: "
        message += f"attainable is from {least * (least > 1e-3 * most):.3g} to {most:.3g} {unit}".rstrip()
        if unknown in OTHER_STRENGTH:
            message += f"; or ask for {OTHER_STRENGTH[unknown]} if that body yields"
    return UnidentifiedError(". ".join([message, *_above_one(predictor)]), refused.unknown, refused.known)


def _misfits(predictor: Predictor, off: Array, expected: Array, freedom: float) -> Iterator[str]:
    values, deviations = predictor.values, off / expected
    given = deviations[np.isfinite(values.error)]
    if given.size and (ratio := math.sqrt(np.mean(given**2))) > _MISFIT:
        yield (
            f"the values are off by {rounded(ratio)} times what their errors and the model's "
            "allow: another number may be wrong, or the errors too small"
        )
    for n in np.flatnonzero(np.abs(deviations) > _FAR) if freedom >= 3.0 else ():
        name = [*KINDS.values()][values.kind[n]].title
        yield (
            f"{name} of {predictor.data.rebound(values.row[n])} is {'+' * bool(off[n] > 0.0)}{percent(off[n])} off the "
            f"fit, {rounded(abs(deviations[n]))} standard errors: a mistake?"
        )


def _above_one(predictor: Predictor) -> Iterator[str]:
    for name in ("restitution", "tangential_restitution"):
        for n in np.flatnonzero(np.array(getattr(predictor.data, name), dtype=np.float64) > 1.0).tolist():
            which = f"{KINDS[name].title} of {predictor.data.rebound(n)}"
            yield f"{which} is above 1: no impact gains energy, a mistake?"


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
