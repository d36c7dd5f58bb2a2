"""How high beads rebound, measured on their flight, per plate.

With one COR for all, all points would lie on one level line.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from contactlaw import style
from dem_demo.kit.run import Run, Runs
from dem_demo.kit.scene import FLYING, GRAVITY, Floats
from dem_demo.rain.figures import _columns
from dem_demo.rain.paths import hits
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
    cor = run.mean_cor
    name = f"one COR for all: the run's mean, {cor:.2f}"
    axes.axhline(cor**2, color=style.VERMILION, linestyle="--", linewidth=2.0, label=name)
    axes.set_ylabel("rebound height over $v^2/2g$")
    axes.set_ylim(0.0, 1.05)
    axes.legend(loc="lower left", bbox_to_anchor=(-0.05, 1.0))
    return figure


def first_rebounds(run: Run[Shower]) -> tuple[NDArray[np.void], Floats]:
    """Find first impacts of beads, and measure their rebound height over impact height.

    A bead counts if its first collision is on a plate and its second one after the next frame.
    Height and vertical speed in that frame give the apex, y + v^2/2g: a measure of what the engine
    did that does not rely on the COR in the record.
    """
    bead, time, row = hits(run)
    n, first = np.unique(bead, return_index=True)
    after = np.r_[np.where(bead[1:] == bead[:-1], time[1:], math.inf), math.inf][first]
    rows, last = run.record.rows[row[first]], run.time.size - 1
    frame = np.searchsorted(run.time, time[first], side="right").clip(max=last)
    ok = (rows["plate"] >= 0) & run.record.impact[row[first]] & (run.status[frame, n] == FLYING)
    ok &= (time[first] < run.time[frame]) & (run.time[frame] < after)
    n, frame, rows = n[ok], frame[ok], rows[ok]
    upwards = run.velocity[frame, n, 1].astype(float)
    apex = run.position[frame, n, 1] - run.scene.radius[n] + upwards * np.abs(upwards) / (2.0 * GRAVITY)
    return rows, apex * 2.0 * GRAVITY / rows["approach_speed"] ** 2
