"""Figures of ``contactlaw cor --plot``."""

import argparse
import math
from collections.abc import Sequence

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._readable import drawn
from contactlaw.cli.cor import tables
from contactlaw.cli.parts import bands
from contactlaw.cli.parts.figure import AXES, MOST_CURVES, WIDE, Curve, Figure
from contactlaw.cli.parts.table import in_words
from contactlaw.model import ImpactModel

_SAMPLES = 200  # points of a curve
_SLOWEST = 0.1  # times the speed stated, where an axis without a list begins


def figure(arguments: argparse.Namespace, model: ImpactModel) -> Figure:
    """Draw the force over time, or a curve over one of the lists for each value of another one.

    The axis is the list of more than 8 values, otherwise the first one that has two finite values.
    """
    if arguments.history:
        table, _ = tables.table(arguments, model)
        curve = Curve(table.values["time"], table.values["force"], flags=table.flags)
        return Figure("Contact force", in_words(table.asked), "time", "force", [curve])
    y = "restitution" if arguments.angle is None else "tangential_restitution"
    lists = {name: sorted({*listed}) for name, listed in reversed(tables.axes(arguments).items())}
    if not any(map(_is_axis, lists.values())):
        lists["speed"] = [_SLOWEST * lists["speed"][0], *lists["speed"]]
    several = [name for name in lists if len(lists[name]) > 1]
    axes = [name for name in several if len(lists[name]) > MOST_CURVES] or [
        name for name in several if _is_axis(lists[name])
    ][:1]
    if len(axes) > 1 or len(several) > 2:
        counts = ", ".join(str(len(lists[name])) for name in several)
        reason = f"got {counts} values; a plot has one list as its axis and at most {MOST_CURVES} values of another"
        raise ArgumentError(", ".join(several), None, reason)
    (axis,) = axes
    varied = next((name for name in several if name != axis), "")
    x = _samples(axis, lists[axis])
    drawn_curves, remarks = [], []
    for value in lists.get(varied, [0.0]):
        chosen_lists = {axis: x.tolist()} | ({varied: [value]} if varied else {})
        table, known = tables.table(argparse.Namespace(**vars(arguments) | chosen_lists), model)
        ends = {end: table.values.get(f"{y}_{end}") for end in ("low", "high")}
        more = {"flags": table.flags, "overload": table.values["overload"]}
        drawn_curves.append(Curve(x, table.values[y], _named(varied, value) if varied else "", **ends, **more))
        remarks = [f"Shaded: {bands.meaning(known.restitution, model.pair)}"] if known else []
    same = [_named(name, lists[name][0]) for name in lists if name not in (axis, varied)]
    about = ", ".join([in_words(table.asked), *same])
    return Figure(AXES[y].label.capitalize(), about, axis, y, drawn_curves, remarks=remarks)


def _samples(name: str, values: Sequence[float]) -> Array:
    """Space values from the least to the largest finite one, and add inf if the list has it."""
    finite = [value for value in values if value < math.inf]
    is_wide = AXES[name].may_be_logarithmic and finite[-1] >= WIDE * finite[0]
    spaced = (np.geomspace if is_wide else np.linspace)(finite[0], finite[-1], _SAMPLES)
    return np.array([*spaced, *values[len(finite) :]])


def _named(name: str, value: float) -> str:
    """Write the value of a quantity with its name."""
    if name == "thickness":
        return "half-space" if value == math.inf else f"plate {drawn(value)}"
    unit = AXES[name].unit.strip("-")
    return f"{name} {drawn(value, unit)}".rstrip()


def _is_axis(values: Sequence[float]) -> bool:
    """Whether a list has two finite values, between which there is something to draw."""
    return sum(value < math.inf for value in values) > 1
