"""What a constant COR would do instead: error of the energy with which each bead rebounds.

One number cannot be right on thin and on thick plates, for slow and for fast beads, even if it is
their mean. Each impact is compared with itself: nothing but the COR differs.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from contactlaw import style
from contactlaw.reporting.charts import wall_axis
from contactlaw.reporting.limits import label
from dem_demo.kit.beads import Floats
from dem_demo.rain.figures._labels import ring, ringed, source
from dem_demo.rain.measure import one_for_all, outside
from dem_demo.rain.record import Run

_HALO = withStroke(linewidth=3.0, foreground="white")


def draw(run: Run) -> Figure:
    """Draw a column per plate; within it beads are sorted from slow to fast."""
    error = 100.0 * (
        one_for_all(run) ** 2 - run.on_plates["restitution"] ** 2
    )  # of the impact energy: a COR may be nearly 0
    figure = style.figure(10.5, 6.2, _title(run, error), _subtitle(run))
    axes = figure.add_subplot()
    for n in range(len(run.scene.plates)):
        _column(axes, run, n, error)
    axes.axhline(0.0, color=style.INK, linewidth=1.4)
    wall_axis(axes, [label(plate.thickness) for plate in run.scene.plates])
    axes.set_ylabel("error of rebound energy [% of impact energy]")
    return figure


def _title(run: Run, error: Floats) -> str:
    known = error[~outside(run)]  # the model is an estimate for the others, which are ringed
    if not known.size:
        return "What a constant COR would do instead"
    return (
        f"One COR for all, {one_for_all(run):.2f}, gets the rebound energy wrong by "
        f"{_signed(known.min())} to {_signed(known.max())} of the impact's"
    )


def _signed(percent: float) -> str:
    return f"{percent:+.0f} %".replace("-", "\N{MINUS SIGN}")


def _subtitle(run: Run) -> str:
    return (
        f"{source(run)}; the mean of all impacts against the model for the same impacts, in each "
        f"column from slow (left) to fast (right); bar: median{ringed(outside(run))}"
    )


def _column(axes: Axes, run: Run, plate: int, error: Floats) -> None:
    here = run.on_plates["plate"] == plate
    if not here.any():
        return
    speed = run.on_plates["approach_speed"]
    x = plate + 0.8 * (speed[here] / speed.max() - 0.5)
    colour = np.where(error[here] > 0.0, style.VERMILION, style.BLUE)
    axes.scatter(x, error[here], s=16, c=list(colour), alpha=0.6, linewidths=0)
    ring(axes, x, error[here], outside(run)[here])
    middle = float(np.median(error[here]))
    axes.hlines(middle, plate - 0.42, plate + 0.42, color=style.INK, linewidth=2.5)
    axes.annotate(
        _signed(middle),
        (plate + 0.42, middle),
        xytext=(0, 3),
        textcoords="offset points",
        ha="right",
        va="bottom",
        fontweight="bold",
        path_effects=[_HALO],
    )
