"""What commands about measured rebounds share: their options, and the figure with curves of the model."""

import argparse
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array, Integers, Mask
from contactlaw.cli.parts import options
from contactlaw.cli.parts.figure import MOST_CURVES, Curve, Figure, Points, named

_SAMPLES = 120  # points of a curve
_WIDER = 1.3  # ratio of a curve's ends to the extreme values of the data
_ANGLES = np.linspace(0.01, 89.0, _SAMPLES)  # [deg] of a curve: a bead at 0 does not slide, one at 90 does not hit
_LEAST = 1e-12  # any unit: an angle of 0 has no logarithm
_ALIKE = 0.1  # ln of speeds and sizes that share a curve


def add_options(command: argparse.ArgumentParser, forms: Mapping[str, str]) -> None:
    """Add the options of commands that read measurements; `forms` are those of what they print."""
    of_file = " (default: that of FILE)"
    options.add_pair(command, of_file)
    options.add_radius(command, "all beads", quantities.value, known=of_file)
    what = f"thickness of all plates [m]; inf is a half-space{of_file}"
    options.add_quantity(command, "--thickness", quantities.LENGTH, what, metavar="H")
    what = f"standard error of the instants of bounces [s]{of_file}"
    options.add_quantity(command, "--time-error", quantities.TIME, what, metavar="T")
    options.add_name_of_law(command)
    command.epilog = options.UNITS
    what = "draw data and model with its band into FILE (PNG, SVG, PDF)"
    options.add_forms(command, forms).add_argument("--plot", metavar="FILE", help=what)


def figure_of(
    quantity: str,
    sizes: Mapping[str, Array],
    value: Array,
    error: Array | None,
    flags: Integers,
    predicted: Callable[[dict[str, Any]], tuple[Any, Array, Array, Array]],
    title: str,
    about: str,
    *remarks: str,
) -> Figure:
    """Figure of measured values over the speed, angle or size that varies most.

    `quantity` is a key of `AXES`; `sizes` are speed, radius and thickness of each impact, and the
    angle [deg] of oblique ones. Of impacts with the sizes of a group, and an array of those along
    the axis, `predicted` gives the outcome, values and the ends of their band. If there are many groups,
    only the first have a curve.
    """

    def points(rows: Mask, label: str, curve: int | None = None) -> Points:
        x = np.minimum(sizes[axis], largest)[rows]
        return Points(x, value[rows], label, None if error is None else error[rows], flags[rows], curve)

    steps = {name: np.round(np.log(np.maximum(size, _LEAST)) / _ALIKE) for name, size in sizes.items()}
    axis = max(sizes, key=lambda name: np.unique(steps[name]).size)
    finite = sizes[axis][np.isfinite(sizes[axis])]
    largest = finite.max() * _WIDER
    x = _ANGLES if axis == "angle" else np.geomspace(finite.min() / _WIDER, largest, _SAMPLES)
    rest = [name for name in sizes if name != axis]
    kinds, of = np.unique([steps[name] for name in rest], axis=1, return_inverse=True)
    of = of.ravel()
    varied = [name for name, step in zip(rest, kinds, strict=True) if np.unique(step).size > 1]
    curves, measured = list[Curve](), list[Points]()
    for n in range(min(kinds.shape[1], MOST_CURVES)):
        here = {name: float(sizes[name][of == n].mean()) for name in rest}
        label = ", ".join(named(name, here[name]) for name in varied)
        measured.append(points(of == n, "", len(curves)) if label else points(of == n, "measured"))
        hit, y, low, high = predicted(here | {axis: x})
        curves.append(Curve(x, y, label or "model", low, high, np.asarray(hit.flags)))
    if (others := of >= MOST_CURVES).any():
        measured.append(points(others, f"measured at another {' and '.join(varied)}"))
    about = ", ".join([about, *(named(name, sizes[name][0]) for name in rest if name not in varied)])
    if finite.size < sizes[axis].size:
        remarks += ("Half-spaces stand at the right end",)
    return Figure(title, about, axis, quantity, curves, measured, remarks)
