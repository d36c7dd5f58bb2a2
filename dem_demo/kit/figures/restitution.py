"""The COR of the impacts on the walls, over their approach speed.

From a thin plate heavy beads rebound less than light ones, and fast ones less than slow ones.
The lines are those of an endless plate. Points off them are beads near an opening or a seam, where
a plate gives way more or less, or beads that other beads struck while they touched the wall. At a
rim or a seam a bead has several contacts at once, which share its rebound.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from contactlaw import style
from dem_demo.kit.drawing import source
from dem_demo.kit.run import B, Runs

_SHOWN = 6000  # most points that are drawn of each kind
_SLOWEST = 0.03  # [m/s], left end of the speed axis
_MARGIN = 0.12  # room on the COR axis below the curves; above them half of it


def draw(runs: Runs[B]) -> Figure:
    """Draw a point per impact under the law, the law's curves, and the constant."""
    run, scene = runs[0], runs[0].scene
    figure = style.figure(
        style.COLUMN,
        5.8,
        f"One {scene.WALL} has many coefficients of restitution",
        f"{source(runs)}; points: impacts as they happened in the engine, lines: the law",
    )
    axes = figure.add_subplot()
    rows, flat = run.impacts, scene.on_faces(run.impacts)
    speeds = np.geomspace(_SLOWEST, max(2.0, float(rows["approach_speed"].max(initial=0.0))), 200)
    _scatter(axes, rows[~flat], style.PALE, scene.FLAT)
    lowest, highest = 1.0, float(np.quantile(rows["restitution"], 0.98)) if rows.size else 1.0
    for (name, which), colour in zip(scene.groups, (style.ORANGE, style.BLUE), strict=True):
        _scatter(axes, rows[flat & which[rows["bead"]]], colour, name)
        for size in sorted({scene.radius[which].min(), scene.radius[which].max()}) if which.any() else ():
            cor = np.asarray(run.model.restitution(speeds, size, scene.thickness))
            axes.plot(speeds, cor, color=style.INK, linewidth=1.0, alpha=0.8)
            lowest, highest = min(lowest, float(cor.min())), max(highest, float(cor.max()))
    constant, name = runs[1].making.constant_cor, f"constant {runs[1].name}"
    axes.axhline(constant or 0.0, color=style.VERMILION, linestyle="--", linewidth=2.0, label=name)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_xlim(speeds[0], speeds[-1])
    axes.set_ylim(max(0.0, lowest - _MARGIN), min(1.0, highest) + 0.5 * _MARGIN)
    axes.set(xlabel="normal approach speed [m/s]", ylabel="coefficient of restitution")
    axes.legend(loc="lower left")
    return figure


def _scatter(axes: Axes, rows: NDArray[np.void], colour: str, name: str) -> None:
    rows = np.random.default_rng(0).permutation(rows)[:_SHOWN]
    size, alpha = (26, 0.7) if rows.size < 500 else (10, 0.5)
    x, y = rows["approach_speed"], rows["restitution"]
    axes.scatter(x, y, s=size, c=colour, alpha=alpha, linewidths=0, rasterized=True)
    axes.scatter([], [], s=30, color=colour, label=name)
