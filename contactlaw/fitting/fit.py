"""Fit of unknown properties of bead and plate to measured rebounds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array, Integers, Mask, Places
from contactlaw._errors import ArgumentError
from contactlaw._jit import enable_caching
from contactlaw.fitting import errors, identify, search
from contactlaw.fitting.measurements import KINDS, NORMAL, Measurements
from contactlaw.fitting.notes import alternative_note, explained, notes
from contactlaw.fitting.predictions import COARSE, Predictor, Values
from contactlaw.fitting.unknowns import OTHER_STRENGTH, Parameter, parameters, setting, with_loss_factors
from contactlaw.laws import DEFAULT, Law
from contactlaw.physical.law import law_of
from contactlaw.physical.pair import Pair
from contactlaw.physical.rebound import Rebound
from contactlaw.record.file import Record
from contactlaw.table.cache import progress_bar

_ROUNDS = 2  # rounds to estimate errors that were not given; a third changes them by less than 1 %
_LEAST_FREEDOM = 0.5  # least degrees of freedom of a kind of values, so that it has a finite error
_SETTLED = 6  # rounds until errors of the data and leverages, which depend on each other, agree
_LEAST = 1e-6  # smallest relative standard error; data without scatter would get zero
_POOLED = 4  # a kind with fewer values gets the scatter of all kinds
_TRIALS = 40  # trial strengths, down to the first that the data exclude
_EXCLUDED = 4.0  # rise of the sum of squares that excludes values: two standard errors
_CURVED = 0.02  # standard error of a logarithm; over a smaller one the model is linear
_LEAST_RISE = 2.0  # least rise of the sum of squares at two standard errors; a linear model has 4


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
    _state: _State = field(repr=False)

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
        state = self._state
        inputs: dict[str, Any] = {"speed": speed, "radius": radius, "thickness": thickness}
        friction = state.predictor.setting(state.at).friction
        if sliding_speed is not None and friction is not None:
            inputs |= {"sliding_speed": sliding_speed, "friction": np.mean(friction)}
        kinds = [name for name in self.residuals if name in NORMAL or "friction" in inputs]
        if not kinds:
            reason = "has to be given, since only oblique kinds were measured"
            raise ArgumentError("sliding_speed", None, reason)
        data = Measurements(**inputs, **dict.fromkeys(kinds, 0.5))
        varied = [replace(p, centre=x) for p, x in zip(state.predictor.parameters, state.at, strict=True)]
        along = Predictor(self.pair, state.predictor.law, data, varied)
        here = along.predicted(state.at)
        slopes = along.derivatives(state.at, here)
        spread = np.sqrt(np.einsum("ij,jk,ik->i", slopes, state.covariance, slopes))
        return along.flagged(state.at), {name: spread[rows] for name, rows in along.values.by_kind().items()}


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
    unknown, priors = (unknown,) if isinstance(unknown, str) else tuple(unknown), priors or {}
    data = Measurements.of(data, {*unknown} - {*priors}, pair.sphere.density)
    given, pair = pair, with_loss_factors(pair, data, unknown)
    varied = parameters(pair, data, unknown, priors, given)
    predictor = Predictor(pair, _law(pair, law, varied), data, varied)
    descent = search.Descent(predictor, to_the_lowest=True)
    ended = _least_squares(predictor, descent)
    try:
        return _result(predictor, descent, ended)
    except identify.UnidentifiedError as error:
        raise explained(error, predictor, ended.basins[0].at) from None


def _law(pair: Pair, law: str | Law, parameters: list[Parameter]) -> Law:
    """Resolve the law; for that, a body whose strength is unknown has a guess of it."""
    strengths = [one for one in parameters if one.is_strength]
    if strengths:
        guesses = np.array([1e-2 * getattr(pair, one.unknown.body).youngs_modulus for one in strengths])
        one_row = Measurements(speed=1.0, radius=1.0, thickness=1.0, restitution=0.5)
        pair = setting(pair, one_row, strengths, guesses).pair
    return law_of(pair, law)


class _LeastSquares(NamedTuple):
    """Result of least squares."""

    basins: list[search.Basin]  # the best first
    error: Array  # of the values
    freedom: float  # degrees of freedom; inf where all errors were given


def _least_squares(predictor: Predictor, descent: search.Descent) -> _LeastSquares:
    """Find the minimum of each basin, and estimate the errors that the data lack."""
    values = predictor.values
    free = sum(one.is_free for one in predictor.parameters)
    if values.value.size < free:
        many = f"{values.value.size} measured values cannot determine {free} unknowns"
        remedy = "leave one out, give priors, or measure more"
        raise ArgumentError("unknown", None, f"{many}: {remedy}")
    error, freedom, rounds = search.guessed(values), math.inf, 0
    if np.isnan(values.error).any():
        freedom, rounds = 0.0, _ROUNDS if values.value.size > free else 0
    basins = search.basins(predictor)
    nearby = search.Descent(replace(predictor, fineness=COARSE))
    for n in range(rounds + 1):
        follow = descent if n == rounds else nearby
        if n > 0:
            error, freedom = _found_errors(predictor, follow, basins[0].at, error)
        basins = search.distinct([follow(one.at, error) for one in progress_bar(iter(basins), len(basins))])
    return _LeastSquares(basins, error, freedom)


def _found_errors(predictor: Predictor, descent: search.Descent, at: Array, error: Array) -> tuple[Array, float]:
    """Errors of the values, from their scatter where they were not given; degrees of freedom.

    Each free parameter costs one degree of freedom, of the kinds of values that determine it; one
    with a prior costs the share that they determine. Costs and errors depend on each other.
    """
    values = predictor.values
    fitted, slopes = descent.predicted(np.log(at)), descent.slopes(np.log(at))
    off = values.value / fitted - 1.0
    left = np.ones_like(off)
    for _ in range(_SETTLED):
        left = 1.0 - errors.Linear.of(predictor, slopes, error).leverages()
        error = error.copy()
        for part, pool, freedom in _pools(values, left):
            error[part] = max(math.sqrt(float(np.sum(off[pool] ** 2)) / freedom), _LEAST) * fitted[part]
    return error, float(left.sum())


def _pools(values: Values, left: Array) -> Iterator[tuple[Mask, Mask, float]]:
    """Values that share one unknown error, those from whose scatter it is found, and the freedom of these.

    Both are the values of one kind. Kinds with few values take the scatter of all kinds. Of each
    value `left` is what the parameters leave of its degree of freedom.
    """
    unknown = np.isnan(values.error)
    counts = np.bincount(values.kind[unknown], minlength=len(KINDS))
    group = np.where(counts[values.kind] < _POOLED, -1, values.kind)
    for n in np.unique(group[unknown]):
        part = unknown & (group == n)
        pool = unknown if n < 0 else part
        yield part, pool, max(float(left[pool].sum()), _LEAST_FREEDOM)


class _State(NamedTuple):
    """What `Fit.curve` needs of a fit."""

    predictor: Predictor
    at: Array
    covariance: Array  # of the logarithms of all parameters


def _result(predictor: Predictor, descent: search.Descent, ended: _LeastSquares) -> Fit:
    at, error, freedom = ended.basins[0].at, ended.error, ended.freedom
    values = predictor.values
    names = tuple(one.name for one in predictor.parameters if one.is_unknown)
    fitted = descent.predicted(np.log(at))
    hit = predictor.flagged(at)
    model = errors.model_covariance(predictor, at, hit)
    slopes = predictor.derivatives(at, fitted)  # the descent may have kept those of a point nearby
    linear = errors.Linear.of(predictor, slopes, error)
    found = linear.covariances(error, model)
    unknowns = slice(len(names))  # the unknowns come first
    model_error = None if model is None else np.abs(model.size)
    # with as many values as unknowns there is no scatter: only the model's errors are known
    doubt = error if freedom > 0.0 or model_error is None else model_error
    _check_strengths(predictor, at, fitted, doubt, model_error)
    widths = np.zeros(at.size)
    if freedom > 0.0:
        pools = [(part, freed) for part, _, freed in _pools(values, 1.0 - linear.leverages())]
        widths = errors.student(linear.freedoms(pools))
    found = found.widened(widths)
    used = found.statistical if freedom > 0.0 else found.total
    identify.check(names, at[unknowns], used[unknowns, unknowns])
    found = found.widened(_nonlinearity_factors(predictor, at, fitted, used, doubt))
    spread = np.sqrt(np.diag(found.total))
    others = _alternatives(predictor, ended, spread, model)
    off = values.value / fitted - 1.0
    relative = None if model_error is None else model_error / fitted
    kinds = values.by_kind()
    bodies = predictor.setting(at)

    def named(sizes: Array) -> dict[str, float]:
        return dict(zip(names, sizes[unknowns].tolist(), strict=True))

    return Fit(
        unknown=names,
        values=named(at),
        errors=named(at * spread),
        statistical_errors=named(at * np.sqrt(np.diag(found.statistical))),
        model_errors=named(at * (np.inf if model is None else np.sqrt(np.diag(found.model)))),
        correlation=(found.total / np.outer(spread, spread))[unknowns, unknowns],
        residuals={name: off[rows] for name, rows in kinds.items()},
        rows={name: values.row[rows] for name, rows in kinds.items()},
        scatter={name: float(np.sqrt(np.mean(off[rows] ** 2))) for name, rows in kinds.items()},
        flags=np.asarray(hit.flags),
        alternatives=tuple(named(other) for other in others),
        notes=(
            *notes(predictor, at, hit, off, error / fitted, freedom, relative, found.total),
            *(alternative_note(names, other) for other in others),
        ),
        pair=bodies.pair,
        radius=bodies.radius,
        thickness=bodies.thickness,
        data=predictor.data,
        law=predictor.law.family,
        _state=_State(predictor, at, found.total),
    )


def _alternatives(
    predictor: Predictor, ended: _LeastSquares, spread: Array, model: errors.ModelCovariance | None
) -> list[Array]:
    """Values in other basins that fit as well, within the errors of data and model."""
    best, *others = ended.basins
    error = ended.error
    if not ended.freedom > 0.0:  # a fit through all values has no errors but the model's
        error, model = (error if model is None else np.abs(model.size)), None

    def squares(one: search.Basin) -> float:
        own = _squares(predictor, predictor.predicted(one.at), ended.error)
        off = predictor.predicted(one.at) - predictor.values.value
        whole = float(((off / error) ** 2).sum()) if model is None else model.squares(off, error)
        return one.squares - own + whole

    least = squares(best)
    return [
        one.at
        for one in others
        if squares(one) < least + _EXCLUDED and (np.abs(np.log(one.at / best.at)) > 2.0 * spread).any()
    ]


def _squares(predictor: Predictor, values: Array, error: Array) -> float:
    off = (values - predictor.values.value) / error
    return float(off @ off)


def _nonlinearity_factors(predictor: Predictor, at: Array, fitted: Array, covariance: Array, error: Array) -> Array:
    """Factors that widen standard errors where the model is not linear in a parameter.

    Two standard errors off, with the other parameters following, the sum of squares rises by 4 if
    the model is linear. It does not rise as much for thick plates, whose COR depends ever less on
    thickness: a thickness that was found too small has too small an error. A value that the data
    bound on one side only, such as a thickness that may be any larger, is refused.

    Raises
    ------
    UnidentifiedError
    """
    low, high = search.limits(predictor)
    factors = np.ones(at.size)
    priors = np.array([one.prior for one in predictor.parameters])
    for n, one in enumerate(predictor.parameters):
        if not one.is_free:
            continue
        shift = 2.0 * covariance[n] / math.sqrt(covariance[n, n])
        for sign, words in ((1.0, "above"), (-1.0, "below")):
            there = np.clip(at * np.exp(sign * shift), low, high)
            off = (predictor.at_trials(there[None])[0] - fitted) / error
            pulled = np.log(there / at) / priors
            square = float(off @ off + pulled @ pulled)
            if shift[n] > 2.0 * _CURVED:
                factors[n] = max(factors[n], math.sqrt(4.0 / max(square, _LEAST_RISE)))
            if square < _LEAST_RISE:
                end = float(at[n] * math.exp(-sign * shift[n]))
                raise identify.UnidentifiedError(
                    f"the data bound {one.name} on one side only: {words} "
                    f"{f'{end:.3g} {one.unknown.unit}'.rstrip()}. Measure another quantity, or "
                    f"other {'angles' if one.name == 'friction' else 'speeds'}",
                    (one.name,),
                )
    return factors


def _check_strengths(predictor: Predictor, at: Array, fitted: Array, error: Array, model: Array | None) -> None:
    """Refuse a strength or a friction that might as well be any larger one.

    Raises
    ------
    UnidentifiedError
    """
    low, high = search.limits(predictor)
    for n, one in enumerate(predictor.parameters):
        if not (one.is_free and (one.is_strength or one.name == "friction")):
            continue
        trials = np.tile(at, (_TRIALS, 1))
        trials[:, n] = np.geomspace(high[n], low[n], _TRIALS)
        largest = predictor.at_trials(trials[:1])[0]
        # in a contact that sticks, friction changes less than the model's errors
        doubt = error if one.is_strength or model is None else np.hypot(error, model)
        if _squares(predictor, largest, doubt) < _squares(predictor, fitted, doubt) + _EXCLUDED:
            most = _squares(predictor, largest, error) + _EXCLUDED
            squares = (_squares(predictor, predictor.at_trials(trial[None])[0], error) for trial in trials)
            excluded = (trial[n] for trial, square in zip(trials, squares, strict=True) if square > most)
            why = _any_above(predictor, one, next(excluded, None))
            raise identify.UnidentifiedError(f"the data do not determine {one.name}: {why}", (one.name,))


def _any_above(predictor: Predictor, one: Parameter, least: float | None) -> str:
    """Say above which strength or friction the data exclude none; None: they exclude no value at all."""
    if one.name == "friction":
        if least is None:
            return "any fits as well. Measure at other angles"
        stick = "fits as well, since the beads stick. Measure at larger angles from the normal"
        return f"any above {least:.2g} or so {stick}"
    if least is None:
        return f"law {predictor.law.family!r} does not depend on it with these bodies"
    return (
        f"any above {least / 1e6:.3g} MPa or so fits as well, since the body does not yield enough. "
        f"Measure faster impacts, or ask for {OTHER_STRENGTH[one.name]} if that body yields"
    )
