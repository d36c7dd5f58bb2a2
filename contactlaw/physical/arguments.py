"""Arguments as users give them: numbers or arrays in SI units, checked, flat, and shaped back."""

from __future__ import annotations

import difflib
import math
import warnings
from collections.abc import Iterable
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.table import lookup

# Units by argument. The others are dimensionless, for which pint and astropy take the unit "".
_UNITS = {
    "m": "radius other_radius thickness edge_distance hole_radius",
    "s": "times duration contact_time step",
    "m/s": "speed slowest fastest sliding_speed velocity wall_velocity",
    "1/s": "rate",
    "kg": "mass",
    "rad/s": "spin",
}
_SI = {name: unit for unit, names in _UNITS.items() for name in names.split()}

_LARGE = 0.1  # [m], our choice: of larger beads and plates few are modelled, and many are mistakes
ROUGHEST = 1e3  # largest coefficient of friction
BARE = frozenset({float, int, np.float64})  # types without a unit, which long lists hold
_LIMITS = {
    "speed": (lookup.V_MIN, lookup.V_MAX, "m/s, the approach speed"),
    "slowest": (lookup.V_MIN, lookup.V_MAX, "m/s"),
    "fastest": (lookup.V_MIN, lookup.V_MAX, "m/s"),
    "radius": (lookup.R_MIN, lookup.R_MAX, "metres"),
    "other_radius": (lookup.R_MIN, lookup.R_MAX, "metres"),
    "thickness": (lookup.R_MIN, math.inf, "metres; inf is the half-space"),
    "edge_distance": (0.0, math.inf, "metres; inf is a plate without edges"),
    "hole_radius": (lookup.R_MIN, math.inf, "metres; inf is a straight edge"),
    "mass": (1e-30, 1e15, "kilograms"),
    "contact_time": (1e-12, 1e6, "seconds"),
    "sliding_speed": (-lookup.V_MAX, lookup.V_MAX, "m/s, of the contact point along the plate"),
    "friction": (0.0, ROUGHEST, ""),
    "weights": (0.0, 1e300, "relative frequencies"),
}


def broadcast(**arguments: ArrayLike) -> Any:
    """Flat float64 arrays of one length, and their common shape (None for scalars)."""
    arrays = {name: _numbers(name, value) for name, value in arguments.items()}
    shape = _common_shape(arrays)
    return *(_flat(array, shape) for array in arrays.values()), shape or None


def _common_shape(arrays: dict[str, Array], *more: tuple[int, ...]) -> tuple[int, ...]:
    """Shape to which all arrays, and shapes beside them, can be broadcast."""
    try:
        return np.broadcast_shapes(*more, *(array.shape for array in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        said = f"shapes do not broadcast: {shapes}"
        raise ArgumentError(next(iter(arrays)), None, said) from None


def refuse_units(name: str, value: object, unit: str) -> None:
    """Refuse what carries a unit, as pint, astropy, unyt and xarray have it: numpy drops it."""
    if _unit(value) is not None:
        raise ArgumentError(
            name,
            value,
            "its unit would be lost; convert it to SI and pass the bare numbers: "
            f'x.to("{unit}").magnitude with pint, x.to_value("{unit}") with astropy, unyt',
        )


def _unit(value: object) -> object:
    """Find the unit of an object, or of a part of a list; None for bare numbers."""
    if isinstance(value, list | tuple):
        parts = (_unit(one) for one in value if type(one) not in BARE)
        return next((unit for unit in parts if unit is not None), None)
    unit = getattr(value, "units", getattr(value, "unit", None))
    return None if isinstance(unit, Real) else unit  # a number: a pandas Series has a row "unit"


def _numbers(name: str, value: ArrayLike, expected: str = "a number or an array of numbers") -> Array:
    refuse_units(name, value, _SI.get(name, ""))
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError):  # rows of different lengths, 10**400
        array = np.asarray(None)
    if array.dtype.kind not in "iuf" or isinstance(value, np.ma.MaskedArray):
        raise ArgumentError(name, value, f"expected {expected}")
    with np.errstate(over="ignore"):  # a huge long double becomes inf
        return array.astype(np.float64, copy=False)


def _flat(array: Array, shape: tuple[int, ...]) -> Array:
    """Flatten; copy only arrays of another shape or that kernels refuse, as read-only."""
    # not array.flags.writeable, which warns for what np.broadcast_arrays gives
    read_only = array.__array_interface__["data"][1]
    if array.shape == shape and not read_only:
        return np.ravel(array)
    return np.broadcast_to(array, shape).flatten()


def vectors(**arguments: ArrayLike) -> tuple[Any, tuple[int, ...]]:
    """Rows of three numbers (n, 3), copied, all of one length, and their common shape (..., 3).

    The number 0 is the vector of zeros.
    """
    arrays = {name: _numbers(name, value) for name, value in arguments.items()}
    for name, values in arrays.items():
        if values.shape[-1:] != (3,) and not (values.ndim == 0 and values == 0.0):
            reason = f"expected vectors of three numbers on the last axis, got {values.shape}"
            raise ArgumentError(name, None, reason)
        if not np.isfinite(values).all():
            raise ArgumentError(name, arguments[name], "must be finite")
    shape = _common_shape(arrays, (3,))
    rows = (np.broadcast_to(values, shape).reshape(-1, 3) for values in arrays.values())
    return tuple(np.array(row, dtype=np.float64, order="C") for row in rows), shape


def number(name: str, value: float) -> float:
    """Convert one number of any kind to a float; the caller checks its range."""
    if type(value) is float:  # a short cut for engines, which come here in every step
        return value
    array = _numbers(name, value, "one number")
    if array.ndim > 0:
        raise ArgumentError(name, value, "expected one number")
    return float(array)


def positive(name: str, given: float, unit: str) -> float:
    """Return one number, or raise an error if it is not positive, or so extreme that its powers overflow."""
    found = number(name, given)
    if not 1e-60 <= found <= 1e60:
        raise ArgumentError(name, given, f"must be positive, from 1e-60 to 1e60 [{unit}]")
    return found


def scalars(**arguments: float) -> tuple[Array, ...]:
    """Check single numbers and return them as arrays of one element."""
    arrays = {name: np.array([number(name, value)]) for name, value in arguments.items()}
    check(**arrays)
    return tuple(arrays.values())


def check(**arrays: Array) -> None:
    """Refuse values outside the range of the argument of that name."""
    for name, values in arrays.items():
        within(name, values, *_LIMITS[name])
    if "radius" in arrays and "thickness" in arrays:
        _check_ratio(arrays["radius"], arrays["thickness"])


def _check_ratio(radius: Array, thickness: Array) -> None:
    """Refuse plates so thin beside the bead that no law is known to hold."""
    known = lookup.THINNEST * radius <= thickness
    if known.all():
        return
    n = int(np.argmin(known))
    r, h = (float(np.broadcast_to(values, known.shape)[n]) for values in (radius, thickness))
    least = f"{lookup.THINNEST:g} of the radius, of impacts on thinner foils nothing is known"
    reason = f"R/H is {r / h:.4g} beside a radius of {r!r}; must be at least {least}"
    raise ArgumentError("thickness", h, reason, n if known.size > 1 else None)


def within(name: str, values: Array, low: float, high: float, remark: str) -> None:
    """Refuse values that do not lie between two limits; the remark ends the message."""
    if values.size == 1 and low <= values[0] <= high:
        return
    wrong = ~((low <= values) & (values <= high))
    if wrong.any():
        n = int(np.argmax(wrong))
        reason = f"must lie between {low:.9g} and {high:.9g} {remark}".rstrip()
        raise ArgumentError(name, values[n], reason, n if values.size > 1 else None)


def unlikely(sizes: ArrayLike) -> float | None:
    """Find the largest bead or plate [m] that is suspiciously large: probably a number in millimetres."""
    array = np.ravel(np.asarray(sizes, dtype=np.float64))
    largest = float(np.max(array[np.isfinite(array)], initial=0.0))
    return largest if largest > _LARGE else None


def warn_of_metres(name: str, sizes: ArrayLike, stacklevel: int) -> None:
    """Warn of a bead or plate that is `unlikely`, at the caller's caller's, or further up."""
    if (size := unlikely(sizes)) is not None:
        said = f"{name}: {size:g} is {size:g} m; {size:g}e-3 for {size:g} mm?"
        warnings.warn(said, stacklevel=stacklevel + 1)


def checked(**arguments: tuple[ArrayLike, float, float, str]) -> Any:
    """Flat arrays and their shape; each argument with its limits and what to do beyond them."""
    *arrays, shape = broadcast(**{name: value for name, (value, *_) in arguments.items()})
    for values, (name, (_, low, high, remark)) in zip(arrays, arguments.items(), strict=True):
        within(name, values, low, high, remark)
    return *arrays, shape


def shaped(values: Array, shape: tuple[int, ...] | None) -> float | Array:
    """Undo `broadcast`."""
    return float(values[0]) if shape is None else np.ascontiguousarray(values).reshape(shape)


def unknown(name: str, known: Iterable[str]) -> str:
    """Say that a name is not among those known, and which of them is like it.

    Examples
    --------
    >>> unknown("thicknes", ["radius", "thickness"])
    "unknown 'thicknes'; did you mean thickness? known: radius, thickness"
    """
    names = [*known]
    near = difflib.get_close_matches(name, names, n=1)
    return f"unknown {name!r}; {f'did you mean {near[0]}? ' if near else ''}known: {', '.join(names)}"
