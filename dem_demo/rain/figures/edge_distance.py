"""How the COR falls towards the ends of the plates, which nothing holds.

The plate gives way more at a free edge, and the bending wave comes back from it while the contact
lasts. Farther away than that wave goes, the COR is that of an endless plate.
"""

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

_FARTHEST = 6e-3  # [m], right end of the axis; most of the waves that matter have come back there
_LINES = 10  # largest number of lines in a panel, more could not be told apart


def draw(run: Run) -> Figure:
    """Draw a panel per plate that has edges: impacts, and the model's line of each."""
    plates = [n for n, plate in enumerate(run.scene.plates) if plate.thickness < math.inf]
    columns = min(style.pick(5, 2), max(1, len(plates)))
    count = max(1, math.ceil(len(plates) / columns))
    figure = style.figure(
        13.0,
        1.6 + style.pick(3.8, 2.6) * count,
        f"One constant COR, {run.constant_cor:g}, knows no edges"
        if run.baseline
        else "Near a free edge beads rebound less",
        f"{source(run)}; points: impacts of the run, lines: model for the same beads and speeds"
        f"{ringed(outside(run)[run.edge_distance < _FARTHEST])}",
    )
    grid = figure.subplots(count, columns, sharex=True, sharey=True, squeeze=False)
    panels, colours = list(grid.flat), radius_colours(run)
    for axes, n in zip(panels, plates, strict=False):
        _panel(axes, run, n, colours)
    for axes in panels[len(plates) :]:
        axes.set_visible(False)
    for axes in grid[:, 0]:
        axes.set_ylabel("COR / COR far from edges")
    figure.supxlabel("distance from the edge [mm]", fontsize=13, color=style.INK)
    figure.colorbar(colours, ax=panels, pad=0.01, fraction=0.02).set_label("bead radius [mm]")
    return figure


def _panel(axes: Axes, run: Run, plate: int, colours: ScalarMappable) -> None:
    thickness = run.scene.plates[plate].thickness
    here = (run.modelled["plate"] == plate) & (run.edge_distance < _FARTHEST)
    rows, distance = run.modelled[here], run.edge_distance[here]
    speed, radius = rows["approach_speed"], run.scene.beads.radius[rows["bead"]]
    far = np.asarray(run.model.restitution(speed, radius, thickness))
    near = np.linspace(0.0, _FARTHEST, 181)
    for n in np.argsort(distance)[:_LINES]:
        cor = np.asarray(run.model.restitution(speed[n], radius[n], thickness, edge_distance=near))
        colour = colours.to_rgba(radius[n] * 1e3)
        axes.plot(near * 1e3, cor / far[n], color=colour, linewidth=1.2)
    ring(axes, distance * 1e3, rows["restitution"] / far, outside(run)[here])
    axes.scatter(
        distance * 1e3, rows["restitution"] / far, s=28, zorder=3,
        c=list(colours.to_rgba(radius * 1e3)), edgecolors="white", linewidths=0.5,
    )  # fmt: skip
    axes.set_title(label(thickness))
    axes.set_xlim(-0.04 * _FARTHEST * 1e3, _FARTHEST * 1e3)
