"""What a plot shows over what: which list is the axis, which the curves, and which the panels."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw._errors import ArgumentError
from contactlaw.quantities import ANGLE, FRICTION, LENGTH, SPEED, Quantity

_MOST_CURVES, _MOST_PANELS = 8, 6  # more could not be distinguished in one figure


class Axis(NamedTuple):
    """A quantity that may be drawn over."""

    label: str
    quantity: Quantity
    logarithmic: bool = True  # if its range is wide


AXES = {
    "speed": Axis("impact speed", SPEED),
    "thickness": Axis("plate thickness", LENGTH),
    "radius": Axis("bead radius", LENGTH),
    "angle": Axis("angle of incidence", ANGLE, logarithmic=False),
    "friction": Axis("coefficient of friction", FRICTION, logarithmic=False),
}


class Layout(NamedTuple):
    """Values to draw, in SI units and degrees: panels, then curves, then along the axis.

    A map has the values along its upward axis in place of the curves. The last value along an axis
    of thicknesses may be inf.
    """

    panel: str
    curve: str
    axis: str
    values: dict[str, Array]  # of every quantity; those that do not vary have one value
    is_map: bool

    def grid(self) -> dict[str, Array]:
        """Every combination, as arrays that broadcast to the shape panels, curves, axis."""
        ends = {self.panel: (-1, 1, 1), self.curve: (1, -1, 1)}
        return {name: at.reshape(ends.get(name, (1, 1, -1))) for name, at in self.values.items()}


class Answers(NamedTuple):
    """What is drawn of each combination of a layout: arrays of its shape."""

    value: Array
    flags: Integers
    overload: Array  # a body yields where it is above 1
    low: Array  # ends of the band of the value; the value itself without a band
    high: Array
    said: str = ""  # meaning of the band


Ask = Callable[[dict[str, Array]], Answers]


def is_logarithmic(name: str, least: float, largest: float) -> bool:
    """Whether a range is so wide that it is spaced and drawn logarithmically."""
    return AXES[name].logarithmic and largest >= 20.0 * least


def can_be_axis(values: Sequence[float]) -> bool:
    """Whether a list has two finite values, between which there is something to draw."""
    return len({value for value in values if value < math.inf}) > 1


def layout(given: Mapping[str, Sequence[float]], along: int, across: int) -> Layout:
    """Choose what is drawn over what, along an axis, as curves and in panels.

    A list of more than 8 values is an axis, and two of them are those of a map. Otherwise the axis
    is the first list in the order of `given`. The next one makes curves, and a third one panels. An
    axis of a curve has `along` values, one of a map `across`.
    """
    values = {name: sorted(set(listed)) for name, listed in given.items()}
    lists = [name for name in values if len(values[name]) > 1]
    many = [name for name in lists if len(values[name]) > _MOST_CURVES]
    axes = many or [name for name in lists if can_be_axis(values[name])][:1]
    if not axes:
        reason = f"got no two values of {', '.join(values)} to draw between: give a range of one"
        raise ArgumentError("plot", None, reason)
    curves = [name for name in lists if name not in axes]
    is_map, counts = len(axes) > 1, [len(values[name]) for name in curves]
    if len(axes) > 2 or len(curves) > 2 * (not is_map) or max(counts[1:], default=0) > _MOST_PANELS:
        raise ArgumentError(
            ", ".join(lists),
            None,
            f"got {', '.join(str(len(values[name])) for name in lists)} "
            f"values, too many for one picture: give one list, {_MOST_CURVES} values at most of a "
            f"second and {_MOST_PANELS} of a third, or for a map two lists alone",
        )
    if is_map and "thickness" in axes and values["thickness"][-1] == math.inf:
        raise ArgumentError("thickness", math.inf, "no axis of a map reaches it: leave it out")
    for name in axes:
        values[name] = _samples(name, values[name], across if is_map else along)
    axis, curve, panel = [*axes, *curves, "", ""][:3]
    arrays = {name: np.array(listed) for name, listed in values.items()}
    return Layout(panel, curve, axis, arrays, is_map)


def _samples(name: str, values: Sequence[float], count: int) -> list[float]:
    """Values from the least to the largest finite one, and inf if that is given."""
    finite = [value for value in values if value < math.inf]
    spaced = np.geomspace if is_logarithmic(name, finite[0], finite[-1]) else np.linspace
    return [*spaced(finite[0], finite[-1], count).tolist(), *values[len(finite) :]]
