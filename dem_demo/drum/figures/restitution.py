"""The COR of the impacts on the drum, over their approach speed.

From a thin plate heavy beads rebound less than light ones, and fast ones less than slow ones.
Points off the lines are beads near a seam of shell and end, where the walls cannot move, or beads
that other beads struck while they touched the drum. At a seam a bead has two contacts at once,
which share its rebound.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from dem_demo.drum.scene import Drum
from dem_demo.drum.tale import on_faces
from dem_demo.kit import graphs
from dem_demo.kit.runs import Runs


def draw(runs: Runs[Drum]) -> Figure:
    """Draw a point per impact under the law, the law's curves, and the constant."""
    run = runs.law
    radius = run.scene.radius
    middle = float(np.median(radius))
    kinds = [
        (f"smaller beads, radius {radius.min() * 1e3:.1f} to {middle * 1e3:.1f} mm", radius <= middle),
        (f"larger beads, radius {middle * 1e3:.1f} to {radius.max() * 1e3:.1f} mm", radius > middle),
    ]
    title = "One drum has many coefficients of restitution"
    return graphs.restitution(runs, on_faces(run), kinds, title, "at a seam of shell and end")
