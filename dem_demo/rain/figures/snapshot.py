"""The scene at one instant: beads as streaks, coloured by their last rebound from a plate."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.rain import paths
from dem_demo.rain.figures._labels import ringed, source
from dem_demo.rain.figures._rain import EXPOSURE, PLATES_MAGNIFIED, Picture, instants, magnified
from dem_demo.rain.record import Run


def draw(run: Run) -> Figure:
    """Draw the busiest instant: most beads in sight that have hit a plate."""
    made = paths.pieces(run)
    times, counts = instants(run, made)
    time = float(times[np.argmax(counts)]) if counts.size else 0.0
    hands = "; hands turn with the beads" if run.scene.friction else ""
    figure = style.figure(
        12.0,
        6.6,
        "Beads rain on plates of different thickness",
        f"{source(run)}; t = {time * 1e3:.0f} ms, beads drawn {magnified(run):g} times their size, "
        f"plates {PLATES_MAGNIFIED:g} times as thick, streaks: the last {EXPOSURE * 1e3:g} ms"
        f"{hands}{ringed(paths.at(made, time)['outside'] > 0)}",
    )
    axes = figure.add_subplot()
    picture = Picture(axes, run, made)
    picture.show(time)
    bar = figure.colorbar(picture.circles, ax=axes, location="right", pad=0.02, fraction=0.03)
    bar.set_label("COR of the last impact")
    return figure
