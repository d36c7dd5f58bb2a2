"""Whether the data determine the unknowns, how well, and what they do determine if not."""

import functools
import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._readable import percent
from contactlaw.fitting.predictions import Predictor
from contactlaw.fitting.search import Basin, descend
from contactlaw.fitting.unknowns import OTHER_STRENGTH

_VAGUE = 0.5  # standard error of a logarithm from which on a value is not known; our choice
_SMALL = 0.05  # smaller exponents are left out of a product
EXCLUDED = 4.0  # rise of the sum of squares that excludes values: two standard errors
_CURVED = 0.02  # standard error of a logarithm; over a smaller one the model is linear
# Rise of the sum of squares at two standard errors, where that of a linear model is 4: the least with
# which a value counts as bounded, and that from which on the model counts as linear.
_LEAST_RISE, _PARABOLA = 2.0, 3.5
_STEPS = 4  # of the other parameters, which begin where a linear model has them


class UnidentifiedError(ArgumentError):
    """Raised if the data do not determine the unknowns of a fit.

    Attributes
    ----------
    unknown : tuple of str
        Names of the unknowns.
    known : tuple of tuple
        Products of unknowns that the data determine: exponents by name, value in SI units, and
        relative standard error.
    """

    def __init__(
        self, message: str, unknown: tuple[str, ...], known: tuple[tuple[dict[str, float], float, float], ...] = ()
    ) -> None:
        super().__init__("unknown", None, message)
        self.args = message, unknown, known  # pickle needs them
        self.unknown, self.known = unknown, known


def check(names: tuple[str, ...], x: Array, covariance: Array) -> None:
    """Refuse values that the data do not determine, and say which products they do.

    Parameters
    ----------
    names, x : tuple of str, ndarray (p,)
        Unknowns, which are the first parameters, and the logarithms of all values found.
    covariance : ndarray (p, p)
        Covariance of the logarithms.

    Raises
    ------
    UnidentifiedError
        If the standard error of a logarithm is above 0.5.
    """
    count = len(names)
    squares, directions = np.linalg.eigh(covariance[:count, :count])
    if not squares[-1] > _VAGUE**2:
        return
    if count == 1:
        error = min(100.0 * math.sqrt(squares[-1]), 999.0)
        raise UnidentifiedError(f"the data do not determine {names[0]}: its standard error is {error:.0f} %", names)
    known, words = [], []
    for square, direction in zip(squares, directions.T, strict=True):
        if square <= _VAGUE**2:
            largest = direction[np.argmax(np.abs(direction))]
            powers = np.where(np.abs(direction / largest) > _SMALL, direction / largest, 0.0)
            value, error = math.exp(powers @ x[:count]), math.sqrt(square) / abs(largest)
            exponents = {name: power for name, power in zip(names, powers.tolist(), strict=True) if power}
            known.append((exponents, value, error))
            product = " x ".join(name if power == 1.0 else f"{name}^{power:.2g}" for name, power in exponents.items())
            words.append(f"{product} = {value:.4g} within {percent(error)}")
    products = f"They determine {'; '.join(words)} (in SI units). " if known else ""
    raise UnidentifiedError(
        f"the data do not determine {' and '.join(names)} separately. {products}"
        "Fix one of them, give one with its prior standard error, or measure another quantity",
        names,
        tuple(known),
    )


def check_strengths(predictor: Predictor, best: Basin, error: Array, model: Array) -> None:
    """Refuse a strength or a friction that might as well be any larger one.

    Raises
    ------
    UnidentifiedError
    """
    for n, one in enumerate(predictor.parameters):
        if not (one.is_free and (one.is_strength or one.name == "friction")):
            continue
        # in a contact that sticks, friction changes less than the model's errors
        doubt = error if one.is_strength else np.hypot(error, model)

        low, high = predictor.limits[:, n]
        if _rise_alone(predictor, best, doubt, n, high) < 0.0:
            least = _bound(predictor, best, error, n, low)
            why = _any_above(predictor, one.name, least)
            raise UnidentifiedError(f"the data do not determine {one.name}: {why}", (one.name,))


def _rise_alone(predictor: Predictor, best: Basin, error: Array, n: int, place: float) -> float:
    """Rise of the sum of squares if one parameter is moved, beyond the rise that excludes a value."""
    x = np.where(np.arange(best.x.size) == n, place, best.x)
    off = (np.vstack([predictor.predicted(x), best.fitted]) - predictor.values.value) / error
    there, here = np.nan_to_num((off**2).sum(axis=1), nan=1e9)
    return float(there - here) - EXCLUDED


def _bound(predictor: Predictor, best: Basin, error: Array, n: int, end: float) -> float | None:
    """Value up to which the data exclude those from an end of the range; None: they exclude none."""
    from scipy.optimize import brentq

    rise = functools.partial(_rise_alone, predictor, best, error, n)
    return math.exp(brentq(rise, end, best.x[n], xtol=0.01)) if rise(end) > 0.0 else None


def _any_above(predictor: Predictor, name: str, least: float | None) -> str:
    """Say above which strength or friction the data exclude none; None: they exclude no value at all."""
    if name == "friction":
        if least is None:
            return "any fits as well. Measure at other angles"
        stick = "fits as well, since the beads stick. Measure at larger angles from the normal"
        return f"any above {least:.2g} or so {stick}"
    if least is None:
        return f"law {predictor.law.family!r} does not depend on it with these bodies"
    return (
        f"any above {least / 1e6:.3g} MPa or so fits as well, since the body does not yield enough. "
        f"Measure faster impacts, or ask for {OTHER_STRENGTH[name]} if that body yields"
    )


def profile(predictor: Predictor, best: Basin, covariance: Array, error: Array) -> Array:
    """Factors by which standard errors are too small, since the model is not linear in a parameter.

    A standard error is the distance at which the sum of squares rises by 1, with the other
    parameters at their best. The COR of thick plates, say, depends ever less on thickness: a
    thickness that was found too small has too small an error by its covariance.

    Raises
    ------
    UnidentifiedError
        For a value that the data bound on one side only, such as a thickness that may be any larger.
    """
    from scipy.optimize import brentq

    factors = np.ones(best.x.size)
    for n, one in enumerate(predictor.parameters):
        spread = math.sqrt(covariance[n, n])
        if not one.is_free or spread < _CURVED:
            continue
        low, high = predictor.limits[:, n]
        for end, other, sign, side in ((low, high, -1.0, "below"), (high, low, 1.0, "above")):
            rise = functools.partial(_rise, predictor, best, error, n, sign * covariance[n] / spread)
            last = min(2.0, abs(end - best.x[n]) / spread)
            rises = rise(last) + 1.0
            if best.x.size == 1 and rises < _LEAST_RISE and (bound := _bound(predictor, best, error, n, other)):
                raise UnidentifiedError(
                    f"the data bound {one.name} on one side only: {side} {f'{bound:.3g} {one.unknown.unit}'.rstrip()}. "
                    "Measure another quantity, or other speeds or angles",
                    (one.name,),
                )
            if _LEAST_RISE <= rises < _PARABOLA:
                factors[n] = max(factors[n], brentq(rise, 0.0, last, xtol=0.02))
    return factors


def _rise(predictor: Predictor, best: Basin, error: Array, n: int, along: Array, errors: float) -> float:
    """Rise of the sum of squares beyond 1, one parameter being off and the others fitted again."""
    start = np.clip(best.x + errors * along, *predictor.limits)
    return descend(predictor, start, error, n, _STEPS).squares - best.squares - 1.0
