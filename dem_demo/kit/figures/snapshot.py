"""The last frame, in a slice along the middle, under the law and with a constant COR.

Beads are coloured by the COR of their last impact on a wall; grey: none yet.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.kit.drawing import MM, drawings, height, source
from dem_demo.kit.run import B, Runs


def draw(runs: Runs[B]) -> Figure:
    """Draw the last frame of both runs."""
    time, scene = runs[0].time[-1], runs[0].scene
    figure = style.figure(
        style.COLUMN,
        1.2 + height(runs),
        "The same beads on the same walls, with two kinds of rebound",
        f"{source(runs)}; t = {time * 1e3:.0f} ms, a slice of {2.0 * scene.slice[1] * MM:.0f} mm along the middle",
    )
    for drawing in drawings(figure, runs):
        drawing.show(time)
    return figure
