"""What commands about measured rebounds share: their options, and the figure with curves of the model."""

import argparse
import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array, Integers, Mask
from contactlaw._readable import drawn
from contactlaw.cli.parts import options
from contactlaw.cli.parts.figure import AXES, MOST_CURVES, Curve, Figure, Points

_SAMPLES = 120  # points of a curve
_WIDER = 1.3  # ratio of a curve's ends to the extreme values of the data
_STEEPEST = 89.0  # [deg] a bead at 90 does not hit
_ALIKE = 0.1  # ln of speeds and sizes that share a curve


class Measured(NamedTuple):
    """Measured values of one quantity, and the impacts that they belong to, in SI units."""

    quantity: str  # a key of AXES
    sizes: Mapping[str, Array]  # of each impact: speed, radius, thickness; angle [deg] of oblique ones
    value: Array
    error: Array | None
    flags: Integers


def add_options(command: argparse.ArgumentParser) -> Any:
    """Add the options of commands that read measurements; return the group of what they print."""
    of_file = " (default: that of FILE)"
    options.add_pair(command, of_file)
    options.add_radius(command, "all beads", quantities.value, known=of_file)
    what = f"thickness of all plates [m]; inf is a half-space{of_file}"
    options.add_quantity(command, "--thickness", quantities.LENGTH, what, metavar="H")
    options.add_name_of_law(command)
    command.epilog = options.UNITS
    output = command.add_mutually_exclusive_group()
    output.add_argument("--plot", metavar="FILE", help="draw data and model with its band into FILE (PNG, SVG, PDF)")
    return output


def figure_of(
    measured: Measured, predicted: Callable[[dict[str, Any]], dict[str, Any]], title: str, about: str, *remarks: str
) -> Figure:
    """Figure over the angle, or over the size that varies most.

    Of impacts with the sizes of a group, and an array of those along the axis, `predicted` gives what
    a `Curve` has besides its name and abscissa. If there are many groups, only some have a curve.
    """
    sizes = measured.sizes
    steps = {name: np.round(np.log(values) / _ALIKE) for name, values in sizes.items()}
    counts = {name: np.unique(step[np.isfinite(step)]).size for name, step in steps.items()}
    axis = "angle" if "angle" in sizes else max(("speed", "thickness", "radius"), key=counts.__getitem__)
    finite = sizes[axis][np.isfinite(sizes[axis])]
    x = np.geomspace(finite.min() / _WIDER, finite.max() * _WIDER, _SAMPLES)
    if axis == "angle":
        x = np.linspace(math.degrees(_ALIKE), _STEEPEST, _SAMPLES)
    rest = [name for name in sizes if name != axis]
    kinds, of = np.unique([steps[name] for name in rest], axis=1, return_inverse=True)
    of, count = of.ravel(), kinds.shape[1]
    shown = np.linspace(0, count - 1, min(count, MOST_CURVES)).round()
    varied = [name for name, step in zip(rest, kinds, strict=True) if np.unique(step).size > 1]
    curves, points = [], []
    for n in shown:
        here = {name: float(sizes[name][of == n].mean()) for name in rest}
        name = ", ".join(_in_words(one, here[one]) for one in varied) or "model"
        curves.append(Curve(x=x, label=name, **predicted(here | {axis: x})))
        look = ("", len(curves) - 1) if varied else ("measured", None)
        points.append(_points(measured, axis, x[-1], of == n, *look))
    if (others := ~np.isin(of, shown)).any():
        points.append(_points(measured, axis, x[-1], others, f"measured at another {' and '.join(varied)}"))
    about = ", ".join([about, *(_in_words(name, sizes[name][0]) for name in rest if name not in varied)])
    if finite.size < sizes[axis].size:
        remarks += ("Half-spaces stand at the right end",)
    return Figure(title, about, axis, measured.quantity, curves, points, remarks)


def _points(measured: Measured, axis: str, largest: float, rows: Mask, label: str, curve: int | None = None) -> Points:
    x, error = np.minimum(measured.sizes[axis], largest)[rows], measured.error
    return Points(x, measured.value[rows], label, None if error is None else error[rows], measured.flags[rows], curve)


def _in_words(name: str, size: float) -> str:
    return drawn(size) if size == math.inf else f"{name} {drawn(size, AXES[name].unit, 3)}"
