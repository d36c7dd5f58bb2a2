"""COR against impact speed, one panel per plate: impacts of the run on the model's curves."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.reporting.limits import label
from dem_demo.rain.figures._labels import radius_colours, ring, ringed, source
from dem_demo.rain.measure import outside
from dem_demo.rain.record import Run


def draw(run: Run) -> Figure:
    """Draw a panel per plate with a common scale."""
    plates = run.scene.plates
    columns = min(5, len(plates))
    rows = math.ceil(len(plates) / columns)
    figure = style.figure(
        13.0,
        1.6 + 3.8 * rows,
        "The COR depends on thickness, bead size and speed",
        f"{source(run)}; points: impacts of the run, lines: model for the smallest, middle "
        f"and largest bead, triangle: yield speed{ringed(outside(run))}",
    )
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    panels = list(grid.flat)
    colours = radius_colours(run)
    for n, axes in enumerate(panels):
        if n < len(plates):
            _panel(axes, run, n, colours)
        else:
            axes.set_visible(False)
    for axes in grid[:, 0]:
        axes.set_ylabel("coefficient of restitution")
    figure.supxlabel("normal impact speed [m/s]", fontsize=13, color=style.INK)
    figure.colorbar(colours, ax=panels, pad=0.01, fraction=0.02).set_label("bead radius [mm]")
    return figure


def _panel(axes: Axes, run: Run, plate: int, colours: ScalarMappable) -> None:
    thickness = run.scene.plates[plate].thickness
    axes.set_title(label(thickness))
    radius = run.scene.beads.radius
    speed = np.linspace(0.2, 1.05 * _fastest(run), 200)
    ends = radius.min(), 0.5 * (radius.min() + radius.max()), radius.max()
    for r in ends:
        colour = colours.to_rgba(r * 1e3)
        axes.plot(speed, run.model.restitution(speed, r, thickness), color=colour, linewidth=1.6)
        yields = _yield_speed(run, r, thickness)
        if yields <= speed[-1]:
            at = run.model.restitution(yields, r, thickness)
            axes.plot(yields, at, marker="v", color=colour, markersize=9, markeredgecolor="white")
    here = run.on_plates["plate"] == plate
    rows = run.on_plates[here]
    ring(axes, rows["approach_speed"], rows["restitution"], outside(run)[here])
    axes.scatter(
        rows["approach_speed"],
        rows["restitution"],
        c=list(colours.to_rgba(radius[rows["bead"]] * 1e3)),
        s=12,
        linewidths=0,
        alpha=0.8,
    )
    axes.set_xlim(0.0, 1.05 * _fastest(run))


def _yield_speed(run: Run, radius: float, thickness: float) -> float:
    try:
        return float(run.model.yield_speed(radius, thickness))
    except ValueError:  # the table has no yield on so thin a plate
        return math.inf


def _fastest(run: Run) -> float:
    rows = run.impacts[run.impacts["plate"] >= 0]
    return float(rows["approach_speed"].max(initial=1.0))
