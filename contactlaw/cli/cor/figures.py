"""Figures of ``contactlaw cor --plot``."""

import math
from argparse import Namespace
from collections.abc import Sequence

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.cli.cor import tables
from contactlaw.cli.parts import bands
from contactlaw.cli.parts.figure import AXES, MOST_CURVES, Curve, Figure, named
from contactlaw.cli.parts.table import in_words
from contactlaw.model import ImpactModel

_SAMPLES = 200  # points of a curve
_SLOWEST = 0.1  # times the speed stated, where an axis without a list begins


def figure(arguments: Namespace, model: ImpactModel) -> Figure:
    """Draw the force over time, or a curve over one of the lists for each value of another one.

    The axis is the list of more than 8 values, otherwise the first one that has two finite values.
    """
    if arguments.history:
        table, _ = tables.table(arguments, model)
        curve = Curve(table.values["time"], table.values["force"], flags=table.flags)
        return Figure("Contact force", in_words(table.asked), "time", "force", [curve])
    y = "restitution" if arguments.angle is None else "tangential_restitution"
    lists = {name: sorted({*values}) for name, values in reversed(tables.axes(arguments).items())}
    if not any(map(_is_axis, lists.values())):
        lists["speed"].insert(0, _SLOWEST * lists["speed"][0])
    several = [name for name in lists if len(lists[name]) > 1]
    counts = {name: len(lists[name]) for name in several}
    axis, *varied = sorted(several, key=lambda name: (counts[name] <= MOST_CURVES, not _is_axis(lists[name])))
    if len(varied) > 1 or any(counts[name] > MOST_CURVES for name in varied):
        listed = ", ".join(map(str, counts.values()))
        reason = f"got {listed} values; a plot has one list as its axis and at most {MOST_CURVES} values of another"
        raise ArgumentError(", ".join(several), None, reason)
    x = _samples(axis, lists[axis])
    curves, remarks = [], []
    for value in lists[varied[0]] if varied else [0.0]:
        one_curve = {axis: x.tolist()} | {name: [value] for name in varied}
        table, known = tables.table(Namespace(**vars(arguments) | lists | one_curve), model)
        ends = {end: table.values.get(f"{y}_{end}") for end in ("low", "high")}
        label = "".join(named(name, value) for name in varied)
        curves.append(Curve(x, table.values[y], label, **ends, flags=table.flags))
        remarks = [f"Shaded: {bands.meaning(known.restitution, model.pair)}"] if known else []
    if all(np.isnan(curve.y).all() for curve in curves):
        raise ArgumentError("angle", arguments.angle[0], "without a speed along the plate there is nothing to draw")
    same = [named(name, lists[name][0]) for name in lists if name not in several]
    about = ", ".join([in_words(table.asked), *same])
    return Figure(AXES[y].label.capitalize(), about, axis, y, curves, remarks=remarks)


def _samples(name: str, values: Sequence[float]) -> Array:
    """Space values from the least to the largest finite one, and add inf if the list has it."""
    finite = [value for value in values if value < math.inf]
    space = np.geomspace if AXES[name].may_be_logarithmic else np.linspace
    return np.array([*space(finite[0], finite[-1], _SAMPLES), *values[len(finite) :]])


def _is_axis(values: Sequence[float]) -> bool:
    """Whether a list has two finite values, between which there is something to draw."""
    return sum(value < math.inf for value in values) > 1
