"""COR against impact speed, one panel per plate: impacts of the run on the model's curves."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.reporting.limits import label
from dem_demo.kit.drawing import source
from dem_demo.kit.run import Run, Runs
from dem_demo.rain.figures._columns import ring, ringed
from dem_demo.rain.scene import Shower


def draw(runs: Runs[Shower]) -> Figure:
    """Draw a panel per plate with a common scale."""
    run, plates = runs[0], runs[0].scene.plates
    columns = min(2, len(plates))
    figure = style.figure(
        style.COLUMN,
        1.8 + 2.6 * math.ceil(len(plates) / columns),
        "The COR depends on thickness, bead size and speed",
        f"{source(runs)}; points: impacts of the run, lines: model for the smallest, middle "
        f"and largest bead, triangle: yield speed{ringed(run.impacts)}",
    )
    grid = figure.subplots(math.ceil(len(plates) / columns), columns, sharex=True, sharey=True, squeeze=False)
    radius = run.scene.radius * 1e3
    colours = ScalarMappable(Normalize(radius.min(), max(radius.max(), radius.min() + 1e-6)), "cividis")
    for n, axes in enumerate(grid.flat):
        if n < len(plates):
            _panel(axes, run, n, colours)
        else:
            axes.set_visible(False)
    figure.supxlabel("normal impact speed [m/s]", color=style.INK)
    figure.supylabel("coefficient of restitution", color=style.INK)
    figure.colorbar(colours, ax=list(grid.flat), pad=0.01, fraction=0.03, aspect=40).set_label("bead radius [mm]")
    return figure


def _panel(axes: Axes, run: Run[Shower], plate: int, colours: ScalarMappable) -> None:
    thickness, radius = run.scene.plates[plate], run.scene.radius
    axes.set_title(label(thickness))
    speed = np.linspace(0.2, 1.05 * float(run.impacts["approach_speed"].max(initial=1.0)), 200)
    for r in (radius.min(), 0.5 * (radius.min() + radius.max()), radius.max()):
        colour = colours.to_rgba(r * 1e3)
        axes.plot(speed, run.model.restitution(speed, r, thickness), color=colour, linewidth=1.6)
        yields = _yield_speed(run, r, thickness)
        if yields <= speed[-1]:
            at = run.model.restitution(yields, r, thickness)
            axes.plot(yields, at, marker="v", color=colour, markersize=9, markeredgecolor="white")
    rows = run.impacts[run.impacts["plate"] == plate]
    x, y = rows["approach_speed"], rows["restitution"]
    ring(axes, x, y, rows)
    axes.scatter(x, y, c=list(colours.to_rgba(rows["radius"] * 1e3)), s=12, linewidths=0, alpha=0.8)
    axes.set_xlim(0.0, speed[-1])


def _yield_speed(run: Run[Shower], radius: float, thickness: float) -> float:
    try:
        return float(run.model.yield_speed(radius, thickness))
    except ValueError:  # the table has no yield on so thin a plate
        return math.inf
