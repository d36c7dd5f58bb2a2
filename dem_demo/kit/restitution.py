"""The COR of the impacts over their speed, one panel for each plate: what one constant cannot be.

From a thin plate heavy beads rebound less than light ones, and fast ones less than slow ones. The
lines are those of an endless plate. Points off them are beads near an edge, where a plate gives way
more, or beads that other beads struck while they touched the wall.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.reporting.limits import label
from dem_demo.kit.run import Run, Runs, S

_SHOWN = 4000  # most points of a panel


def draw(runs: Runs[S]) -> Figure:
    """Draw points for the impacts under the law, the law's curves, and the constant if there is one."""
    run, plates = runs[0], runs[0].scene.plates
    columns = min(2, len(plates))
    rows = math.ceil(len(plates) / columns)
    figure = style.figure(
        style.COLUMN,
        2.2 + (3.8 if rows == 1 else 2.6 * rows),
        "The COR depends on speed and bead size" + ", and on the plate" * (len(plates) > 1),
        f"{run.scene.subject}; points: impacts of the run (faint: outside a limit of the model), lines: the law "
        "for the smallest and the largest bead",
    )
    grid = figure.subplots(rows, columns, sharex=True, sharey="row", squeeze=False)
    radius = run.scene.radius * 1e3
    colours = ScalarMappable(Normalize(radius.min(), max(radius.max(), radius.min() + 1e-6)), "cividis")
    for axes in grid.flat[len(plates) :]:
        axes.set_visible(False)
    for n, axes in enumerate(grid.flat[: len(plates)]):
        _panel(axes, run, n, colours)
        for constant in runs[1:]:
            cor = constant.making.constant_cor or 0.0
            axes.axhline(cor, color=style.VERMILION, linestyle="--", label=f"constant {constant.name}")
            axes.legend(loc="lower left")
        if n + columns >= len(plates):
            axes.tick_params(labelbottom=True)
            axes.set_xlabel("normal speed [m/s]")
    figure.supylabel("coefficient of restitution", color=style.INK)
    bar = figure.colorbar(colours, ax=list(grid.flat), location="bottom", fraction=0.02, pad=0.03, aspect=40)
    bar.set_label("bead radius [mm]")
    return figure


def _panel(axes: Axes, run: Run[S], plate: int, colours: ScalarMappable) -> None:
    thickness, radius = run.scene.plates[plate], run.scene.radius
    axes.set_title(label(thickness))
    hit = run.impacts["approach_speed"] if run.impacts.size else np.ones(1)
    speed = np.geomspace(0.7 * float(np.quantile(hit, 0.01)), 1.05 * float(hit.max()), 200)
    for r in (radius.min(), radius.max()):
        axes.plot(speed, run.model.restitution(speed, r, thickness), color=colours.to_rgba(r * 1e3))
    rows = run.impacts[run.impacts["plate"] == plate]
    rows = rows[:: rows.size // _SHOWN + 1]
    colour = colours.to_rgba(rows["radius"] * 1e3, alpha=np.where(rows["flags"] != 0, 0.25, 0.9))
    axes.scatter(rows["approach_speed"], rows["restitution"], c=list(colour), s=12, linewidths=0)
    axes.set_xscale("log")
    axes.set_xlim(speed[0], speed[-1])
    style.decades(axes.xaxis, (1.0, 2.0, 5.0))
