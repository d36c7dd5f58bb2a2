"""Fit of unknown properties of bead and plate to measured rebounds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array, Integers, Places
from contactlaw._errors import ArgumentError
from contactlaw._jit import enable_caching
from contactlaw.answers.derivatives import FINE
from contactlaw.fitting import search
from contactlaw.fitting.errors import chi_squared, covariance_of, model_errors, student
from contactlaw.fitting.identify import EXCLUDED, UnidentifiedError, check, check_strengths, profile
from contactlaw.fitting.measurements import NORMAL, Measurements
from contactlaw.fitting.notes import alternative_note, explained, notes
from contactlaw.fitting.predictions import COARSE, Predictor, Values, impacts
from contactlaw.fitting.search import Basin
from contactlaw.fitting.unknowns import parameters, with_guesses
from contactlaw.laws import DEFAULT, Law
from contactlaw.physical.law import law_of
from contactlaw.physical.pair import Pair
from contactlaw.physical.rebound import Rebound
from contactlaw.record.file import Record

_LEAST = 1e-6  # smallest relative standard error; data without scatter would get zero
_POOLED = 4  # a kind with fewer values gets the scatter of all kinds


@dataclass(frozen=True, eq=False)
class Fit:
    """Values that `fit` has found, and their errors.

    Attributes
    ----------
    unknown : tuple of str
        Names of the unknowns.
    values : dict of str to float
        Values found for them, in SI units.
    errors : dict of str to float
        Standard errors, of data and model together.
    statistical_errors, model_errors : dict of str to float
        The two parts: from the errors of the data and of the priors, and from the model's own
        errors, found by comparison with finite elements; inf, and not in `errors`, if not known.
    correlation : ndarray (k, k)
        Correlations of the unknowns, in their order.
    alternatives : tuple of dict of str to float
        Other values, more than two standard errors away, that fit the data as well within the
        errors of data and model, the best first; each has a note. The errors stated are those
        around `values`.
    residuals : dict of str to ndarray
        Measured over fitted values, minus 1 [-], for each kind that was measured; of 1 plus the
        rotational restitution, which may be 0.
    rows : dict of str to ndarray of int
        Indices of the rebounds that the residuals of each kind belong to.
    scatter : dict of str to float
        Relative root mean square of the residuals [-].
    flags : ndarray of int (n,)
        `Validity` limits of the model that each rebound exceeds.
    notes : tuple of str
        Remarks on the fit, in words.
    pair : Pair
        Materials with the values found in place.
    radius, thickness : ndarray (n,)
        Sizes of each rebound [m], with the values found in place.
    data : Measurements
        Measurements as given.
    law : str
        Name of the law.
    """

    unknown: tuple[str, ...]
    values: dict[str, float]
    errors: dict[str, float]
    statistical_errors: dict[str, float]
    model_errors: dict[str, float]
    correlation: Array
    alternatives: tuple[dict[str, float], ...]
    residuals: dict[str, Array]
    rows: dict[str, Places]
    scatter: dict[str, float]
    flags: Integers
    notes: tuple[str, ...]
    pair: Pair
    radius: Array
    thickness: Array
    data: Measurements
    law: str
    _predictor: Predictor = field(repr=False)
    _x: Array = field(repr=False)
    _covariance: Array = field(repr=False)  # of the logarithms of all parameters

    def curve(
        self, speed: ArrayLike, radius: ArrayLike, thickness: ArrayLike, sliding_speed: ArrayLike | None = None
    ) -> tuple[Rebound, dict[str, Array]]:
        """Rebounds at other speeds with the values found, and their standard errors.

        Parameters
        ----------
        speed : array_like
            Normal approach speeds [m/s].
        radius, thickness : array_like
            Sizes of beads and plates [m]; a size that was fitted has the error of the fit.
        sliding_speed : array_like, optional
            Speeds of the contact point along the plate [m/s], for the oblique kinds, which are left
            out without them; with the friction found, or the mean of that given.

        Returns
        -------
        Rebound
            Everything about these impacts, integrated.
        dict of str to ndarray
            Standard errors of the kinds that were measured, from the errors of all parameters.
        """
        inputs: dict[str, Any] = {"speed": speed, "radius": radius, "thickness": thickness}
        friction = self._predictor.setting(self._x).friction
        if sliding_speed is not None and friction is not None:
            inputs |= {"sliding_speed": sliding_speed, "friction": np.mean(friction)}
        kinds = [name for name in self.residuals if name in NORMAL or "friction" in inputs]
        varied = [replace(p, centre=x) for p, x in zip(self._predictor.parameters, np.exp(self._x), strict=True)]
        data = Measurements(**inputs, **dict.fromkeys(kinds, 0.5))
        along = replace(self._predictor, pair=self.pair, data=data, parameters=varied)
        hit = impacts(along.setting(self._x), along.law)
        slopes = along.derivatives(self._x, along.predicted(self._x)[0])
        spread = np.sqrt(np.einsum("ij,jk,ik->i", slopes, self._covariance, slopes))
        return hit, {name: spread[rows] for name, rows in along.values.by_kind().items()}


def fit(
    pair: Pair,
    data: Measurements | Mapping[str, ArrayLike] | Record,
    unknown: str | Iterable[str],
    law: str | Law = DEFAULT,
    priors: Mapping[str, float] | None = None,
) -> Fit:
    """Find unknown properties of bead and plate from measured rebounds.

    Parameters
    ----------
    pair : Pair
        Materials of bead and plate. Their values of unknowns are ignored, except that moduli and
        densities are sought within a factor of 5 of them.
    data : Measurements, mapping or Record
        What was measured, as `Measurements` or as a mapping with its arguments for names, where
        heights and times, as `Measurements.of` names them, may stand for speeds and COR; or the
        record of a run, of whose impacts on walls the COR counts.
    unknown : str or sequence of str
        Up to three of ``"yield_strength"``, ``"youngs_modulus"``, ``"density"`` of the bead,
        ``"plate_yield_strength"``, ``"plate_youngs_modulus"``, ``"plate_density"``,
        ``"thickness"`` of the plate, ``"radius"`` of the bead and ``"friction"`` between them.
    law : str or Law, optional
        Normal force law, as in `ImpactModel`.
    priors : mapping of str to float, optional
        Standard errors [SI units] of numbers that are given but not exactly known; they enter the
        errors of the result. With a prior, the given value of an unknown counts as a measurement.

    Returns
    -------
    Fit

    Raises
    ------
    ValueError
        Data out of range or incomplete, fewer values than unknowns, names that are not known.
    UnidentifiedError
        The data do not determine the unknowns; the message says what they do determine.
    ImportError
        Without scipy.

    Notes
    -----
    Least squares of the values over their errors, from the best points of a scan. If no standard
    errors are given, values of one kind share one relative error, found from the scatter; the
    errors of the result are then widened by Student's distribution, so that 68 % of the true
    values lie within them.

    Examples
    --------
    >>> import contactlaw as cl
    >>> pair = cl.Pair("gamma-alumina", "glass")
    >>> data = {
    ...     "speed": [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
    ...     "radius": 0.9e-3,
    ...     "restitution": [0.885, 0.868, 0.862, 0.851, 0.848, 0.841],
    ... }
    >>> found = cl.fit(pair, data, unknown="thickness")
    >>> f"{1e3 * found.values['thickness']:.2f} mm"
    '0.80 mm'
    """
    enable_caching()
    if not isinstance(pair, Pair):
        raise TypeError(f"pair: expected a contactlaw.Pair, got {pair!r}")
    unknown, priors = [unknown] if isinstance(unknown, str) else list(unknown), priors or {}
    data = Measurements.of(data, {*unknown} - {*priors}, pair.sphere.density)
    varied = parameters(pair, data, unknown, priors)
    pair = with_guesses(pair, data, varied)
    predictor = Predictor(pair, law_of(pair, law), data, varied)
    if predictor.values.value.size < (free := sum(one.is_free for one in varied)):
        many = f"{predictor.values.value.size} measured values cannot determine {free} unknowns"
        raise ArgumentError("unknown", None, f"{many}: leave one out, give priors, or measure more")
    found, extremes = search.basins(predictor)
    try:
        return _result(predictor, *_least_squares(predictor, found))
    except UnidentifiedError as error:
        raise explained(error, predictor, extremes) from None


def _least_squares(predictor: Predictor, found: list[Basin]) -> tuple[list[Basin], Array, float]:
    """Minimum of each basin, the best first, errors of the values, and their degrees of freedom.

    These are inf where all errors were given. Errors that the data lack are found from the scatter
    in two rounds; a third changes them by less than 1 %.
    """
    error, freedom, stages = search.guessed(predictor.values), math.inf, [FINE]
    if np.isnan(predictor.values.error).any():
        freedom, stages = error.size - sum(one.is_free for one in predictor.parameters), [COARSE, COARSE, FINE]
    for n, fineness in enumerate(stages):
        if n and freedom:
            error = _scatter(predictor.values, found[0], error, freedom)
        nearby = replace(predictor, fineness=fineness)
        found = search.lowest([search.descend(nearby, one.x, error) for one in found])
    return found, error, freedom


def _scatter(values: Values, best: Basin, error: Array, freedom: float) -> Array:
    """Errors of the values, from their scatter where they were not given.

    Values of one kind share one relative error; kinds with few values take the scatter of all.
    """
    off, error, estimated = values.value / best.fitted - 1.0, error.copy(), np.isnan(values.error)
    for kind in np.unique(values.kind[estimated]):
        part = estimated & (values.kind == kind)
        variance = np.mean(off[part if part.sum() >= _POOLED else estimated] ** 2) * error.size / freedom
        error[part] = max(math.sqrt(variance), _LEAST) * best.fitted[part]
    return error


def _result(predictor: Predictor, found: list[Basin], error: Array, freedom: float) -> Fit:
    """State the values of the best basin with their errors.

    Raises
    ------
    UnidentifiedError
    """
    best, values = found[0], predictor.values
    names = tuple(one.name for one in predictor.parameters if one.is_unknown)
    unknowns = slice(len(names))  # the unknowns come first
    bodies = predictor.setting(best.x)
    hit = impacts(bodies, predictor.law)
    shared = model_errors(predictor, best.x, hit)
    model = np.linalg.norm(shared, axis=1)
    # with as many values as unknowns there is no scatter: only the model's errors are known
    doubt = error if freedom or not model.any() else model
    check_strengths(predictor, best, doubt, model)
    linear, scaled = covariance_of(best.slopes), np.pad(shared / error[:, None], ((0, best.x.size), (0, 0)))
    gain = linear @ best.slopes.T @ scaled
    of_model, of_data = gain @ gain.T, linear * (student(freedom) ** 2 if freedom else 0.0)
    if len(names) > 1 or not freedom:
        check(names, best.x, of_data if freedom else of_model)
    if freedom:
        widths = profile(predictor, best, linear, error)
        of_data *= np.outer(widths, widths)
        check(names, best.x, of_data)
    covariance = of_data + of_model
    spread = np.sqrt(np.diag(covariance))
    weights = np.append(doubt / error, np.ones(best.x.size))
    squares = [chi_squared(one.off, weights, scaled * (freedom > 0.0)) for one in found]
    alike = [one.x for one, square in zip(found, squares, strict=True) if square < squares[0] + EXCLUDED]
    others = [np.exp(x) for x in alike if (np.abs(x - best.x) > 2.0 * spread).any()]
    off, kinds = values.value / best.fitted - 1.0, values.by_kind()

    def named(sizes: Array) -> dict[str, float]:
        return dict(zip(names, sizes[unknowns].tolist(), strict=True))

    at = np.exp(best.x)
    remarks = notes(predictor, best, hit, error, freedom, model / best.fitted, covariance)
    return Fit(
        unknown=names,
        values=named(at),
        errors=named(at * spread),
        statistical_errors=named(at * np.sqrt(np.diag(of_data))),
        model_errors=named(at * (np.sqrt(np.diag(of_model)) if model.any() else np.inf)),
        correlation=(covariance / np.outer(spread, spread))[unknowns, unknowns],
        residuals={name: off[rows] for name, rows in kinds.items()},
        rows={name: values.row[rows] for name, rows in kinds.items()},
        scatter={name: float(np.sqrt(np.mean(off[rows] ** 2))) for name, rows in kinds.items()},
        flags=np.asarray(hit.flags),
        alternatives=tuple(map(named, others)),
        notes=(*remarks, *(alternative_note(named(other)) for other in others)),
        pair=bodies.pair,
        radius=bodies.radius,
        thickness=bodies.thickness,
        data=predictor.data,
        law=predictor.law.family,
        _predictor=predictor,
        _x=best.x,
        _covariance=covariance,
    )
