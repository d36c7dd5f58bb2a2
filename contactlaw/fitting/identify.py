"""Whether the data determine the unknowns, and which products of them if they do not."""

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._readable import percent

_VAGUE = 0.5  # standard error of a logarithm from which on a value is not known; our choice
_SMALL = 0.05  # smaller exponents are left out of a product


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


def check(names: tuple[str, ...], values: Array, covariance: Array) -> None:
    """Refuse values that the data do not determine, and say which products they do.

    Parameters
    ----------
    names, values : tuple of str, ndarray (k,)
        Unknowns, and the values found.
    covariance : ndarray (k, k)
        Covariance of the values' logarithms.

    Raises
    ------
    UnidentifiedError
        If the standard error of a logarithm is above 0.5.
    """
    squares, directions = np.linalg.eigh(covariance)
    if not squares[-1] > _VAGUE**2:
        return
    if len(names) == 1:
        error = min(100.0 * float(np.sqrt(squares[-1])), 999.0)
        raise UnidentifiedError(f"the data do not determine {names[0]}: its standard error is {error:.0f} %", names)
    known = [
        _product(names, values, direction, float(np.sqrt(square)))
        for square, direction in zip(squares, directions.T, strict=True)
        if square <= _VAGUE**2
    ]
    what = "; ".join(f"{_words(powers)} = {value:.4g} within {percent(error)}" for powers, value, error in known)
    products = f"They determine {what} (in SI units). " if known else ""
    raise UnidentifiedError(
        f"the data do not determine {' and '.join(names)} separately. {products}"
        "Fix one of them, give one with its prior standard error, or measure another quantity",
        names,
        tuple(known),
    )


def _product(
    names: tuple[str, ...], values: Array, direction: Array, error: float
) -> tuple[dict[str, float], float, float]:
    """Product of powers whose largest exponent is 1, its value and relative error."""
    largest = direction[int(np.argmax(np.abs(direction)))]
    powers = direction / largest
    kept = {name: float(power) for name, power in zip(names, powers, strict=True) if abs(power) > _SMALL}
    value = float(np.exp(sum(kept.get(name, 0.0) * np.log(value) for name, value in zip(names, values, strict=True))))
    return kept, value, error / abs(float(largest))


def _words(powers: dict[str, float]) -> str:
    """Write a product of powers.

    Examples
    --------
    >>> _words({"thickness": 1.0, "plate_density": 0.252})
    'thickness x plate_density^0.25'
    """
    return " x ".join(name if power == 1.0 else f"{name}^{power:.2g}" for name, power in powers.items())
