"""How high beads rebound, measured on their flight, per plate.

With one COR for all, all points would lie on one level line.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.reporting.charts import wall_axis
from contactlaw.reporting.limits import label
from dem_demo.rain.figures._labels import ring, ringed, source
from dem_demo.rain.measure import Rebounds, first_rebounds, one_for_all
from dem_demo.rain.record import Run


def draw(run: Run) -> Figure:
    """Draw a column per plate; within it beads are sorted from slow to fast."""
    columns = [first_rebounds(run, n) for n in range(len(run.scene.plates))]
    figure = style.figure(
        10.5,
        6.2,
        "How high beads rebound depends on the plate and on speed",
        f"{source(run)}; first impact of each bead, in each column from slow (left) to fast "
        f"(right){ringed(np.concatenate([far for _, _, far in columns]))}",
    )
    axes = figure.add_subplot()
    fastest = float(np.max(run.impacts["approach_speed"], initial=1.0))
    for n, column in enumerate(columns):
        _column(axes, run, n, column, fastest)
    cor = one_for_all(run)
    axes.axhline(
        cor**2,
        color=style.VERMILION,
        linestyle="--",
        linewidth=2.0,
        label=f"one COR for all: the run's mean, {cor:.2f}",
    )
    wall_axis(axes, [label(plate.thickness) for plate in run.scene.plates])
    axes.set_ylabel("rebound height / impact height  $v^2/2g$")
    axes.set_ylim(0.0, 1.05)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, columnspacing=1.4)
    return figure


def _column(axes: Axes, run: Run, plate: int, column: Rebounds, fastest: float) -> None:
    speed, ratio, far = column
    first = plate == 0
    x = plate + 0.8 * (speed / fastest - 0.5)
    axes.scatter(
        x, ratio, s=16, color=style.BLUE, alpha=0.6, linewidths=0, label="measured in the run" if first else None
    )
    ring(axes, x, ratio, far)
    radius = run.scene.beads.radius
    v = np.linspace(0.02, 1.0, 100) * fastest
    x = plate + 0.8 * (v / fastest - 0.5)
    for r in (radius.min(), radius.max()):
        e = run.model.restitution(v, r, run.scene.plates[plate].thickness)
        axes.plot(
            x,
            np.square(e),
            color=style.INK,
            linewidth=1.4,
            label="model, smallest and largest bead" if first and r == radius.min() else None,
        )
