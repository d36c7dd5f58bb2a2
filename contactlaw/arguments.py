"""Arguments as users give them: numbers or arrays in SI units, checked, flat, and shaped back."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw import lookup

Array = NDArray[np.float64]

_LIMITS = {
    "speed": (lookup.V_MIN, lookup.V_MAX, "m/s, positive: the approach speed along the normal"),
    "radius": (lookup.R_MIN, lookup.R_MAX, "metres"),
    "other_radius": (lookup.R_MIN, lookup.R_MAX, "metres"),
    "thickness": (lookup.R_MIN, math.inf, "metres; inf is the half-space"),
}


def broadcast(**arguments: ArrayLike) -> Any:
    """Flat float64 arrays of one length, and their common shape (None for scalars)."""
    arrays = []
    for name, value in arguments.items():
        array = np.asarray(value)
        if array.dtype.kind not in "iuf":
            raise ValueError(f"{name}: expected a number or an array of numbers, got {value!r}")
        arrays.append(array.astype(np.float64, copy=False))
    if not any(array.ndim for array in arrays):  # the usual call of an engine: broadcasting is slow
        return *(array.reshape(1) for array in arrays), None
    try:
        together = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = ", ".join(f"{n} {np.shape(v)}" for n, v in arguments.items())
        raise ValueError(f"{next(iter(arguments))}: shapes do not broadcast: {shapes}") from None
    return *(np.ravel(array) for array in together), together[0].shape


def check(**arrays: Array) -> None:
    """Refuse values outside the range of the argument of that name."""
    for name, values in arrays.items():
        low, high, unit = _LIMITS[name]
        if values.size == 1 and low <= values[0] <= high:
            continue
        wrong = ~((low <= values) & (values <= high))
        if wrong.any():
            n = int(np.argmax(wrong))
            where = f" (element {n})" if values.size > 1 else ""
            bounds = f"between {low:g} and {high:g}" if name != "speed" else f"above 0, to {high:g}"
            raise ValueError(f"{name}: got {values[n]!r}{where}; must lie {bounds} {unit}")


def shaped(values: Array, shape: tuple[int, ...] | None) -> float | Array:
    """Undo `broadcast`."""
    return float(values[0]) if shape is None else np.ascontiguousarray(values).reshape(shape)
