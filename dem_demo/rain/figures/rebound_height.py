"""How high beads rebound, measured on their flight, per plate.

With one COR for all, all points would lie on one level line.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.kit.run import Runs
from dem_demo.rain.figures import _columns
from dem_demo.rain.measure import first_rebounds, one_for_all
from dem_demo.rain.scene import Shower


def draw(runs: Runs[Shower]) -> Figure:
    """Draw a column per plate; within it beads are sorted from slow to fast."""
    (run,), (rows, ratio) = runs, first_rebounds(runs[0])
    title = "How high beads rebound depends on the plate and on speed"
    figure, axes = _columns.figure(runs, title, "first impact of each bead", rows)
    x = _columns.place(runs, rows["plate"], rows["approach_speed"])
    axes.scatter(x, ratio, s=16, color=style.BLUE, alpha=0.6, linewidths=0, label="measured in the run")
    _columns.ring(axes, x, ratio, rows)
    ends, speed = (run.scene.radius.min(), run.scene.radius.max()), np.linspace(0.02, 1.0, 100)
    speed *= run.impacts["approach_speed"].max(initial=1.0)
    for n, thickness in enumerate(run.scene.plates):
        for radius in ends:
            squared = np.square(run.model.restitution(speed, radius, thickness))
            axes.plot(_columns.place(runs, n, speed), squared, color=style.INK, linewidth=1.4)
    axes.plot([], [], color=style.INK, linewidth=1.4, label="model, smallest and largest bead")
    cor = one_for_all(run)
    name = f"one COR for all: the run's mean, {cor:.2f}"
    axes.axhline(cor**2, color=style.VERMILION, linestyle="--", linewidth=2.0, label=name)
    axes.set_ylabel("rebound height / impact height  $v^2/2g$")
    axes.set_ylim(0.0, 1.05)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, columnspacing=1.4)
    return figure
