"""The figure of ``contactlaw cor --plot``: which list is the axis, and which one makes the curves."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._readable import drawn
from contactlaw.cli.parts.figure import AXES, MOST_CURVES, WIDE, Curve, Figure

_SAMPLES = 200  # points of a curve
_SLOWEST = 0.1  # times the speed stated, where an axis without a list begins


def save(
    path: str,
    lists: Mapping[str, Sequence[float]],
    curve: Callable[[dict[str, Array]], dict[str, Any]],
    about: str,
    remarks: Sequence[str] = (),
    y: str = "restitution",
) -> None:
    """Draw the fields of a `Curve` over one of the lists, once for each value of another one.

    The axis is the list of more than 8 values, otherwise the first one in the order of `lists`.
    """
    values = {name: sorted({*listed}) for name, listed in lists.items()}
    if not any(map(_is_axis, values.values())):
        values["speed"] = [_SLOWEST * values["speed"][0], *values["speed"]]
    several = [name for name in values if len(values[name]) > 1]
    axes = [name for name in several if len(values[name]) > MOST_CURVES]
    axes = axes or [name for name in several if _is_axis(values[name])][:1]
    if len(axes) > 1 or len(several) > 2:
        counts = ", ".join(str(len(values[name])) for name in several)
        reason = f"got {counts} values; a plot has one list as its axis and at most {MOST_CURVES} values of another"
        raise ArgumentError(", ".join(several), None, reason)
    (axis,) = axes
    x = _samples(axis, values.pop(axis))
    (curves,) = [name for name in several if name != axis] or [next(iter(values))]
    drawn_curves = []
    for value in values[curves]:
        sizes = {name: np.full(x.size, listed[0]) for name, listed in values.items()}
        label = _named(curves, value) if len(values[curves]) > 1 else ""
        fields = curve(sizes | {curves: np.full(x.size, value), axis: x})
        drawn_curves.append(Curve(x, label=label, **fields))
    same = [_named(name, listed[0]) for name, listed in values.items() if len(listed) == 1]
    title = AXES[y].label.capitalize()
    Figure(title, ", ".join([about, *same]), axis, y, drawn_curves, remarks=remarks).save(path)


def _is_axis(values: Sequence[float]) -> bool:
    """Whether a list has two finite values, between which there is something to draw."""
    return sum(value < math.inf for value in values) > 1


def _samples(name: str, values: Sequence[float]) -> Array:
    """Values from the least to the largest finite one, and inf if that is given."""
    finite = [value for value in values if value < math.inf]
    is_wide = AXES[name].may_be_logarithmic and finite[-1] >= WIDE * finite[0]
    spaced = (np.geomspace if is_wide else np.linspace)(finite[0], finite[-1], _SAMPLES)
    return np.array([*spaced, *values[len(finite) :]])


def _named(name: str, value: float) -> str:
    """Write the value of a quantity with its name."""
    if name == "thickness":
        return "half-space" if value == math.inf else f"plate {drawn(value)}"
    unit = AXES[name].unit
    return f"{name} {value:g}°" if name == "angle" else f"{name} {drawn(value, unit.strip('-'))}".rstrip()
