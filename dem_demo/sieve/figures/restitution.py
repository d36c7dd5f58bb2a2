"""The COR of the impacts on the deck, over their approach speed.

From a thin plate heavy beads rebound less than light ones, and fast ones less than slow ones.
The lines are those of a deck without openings. Points below them are beads near an opening, where
the deck gives way more; other beads struck some while they touched the deck. At the rim of an
opening a bead has several contacts at once, which share its rebound.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from dem_demo.kit import graphs
from dem_demo.kit.runs import Runs
from dem_demo.sieve.measure import on_faces
from dem_demo.sieve.scene import Sieve


def draw(runs: Runs[Sieve]) -> Figure:
    """Draw a point per impact under the law, the law's curves, and the constant."""
    run = runs.law
    small, radius = run.scene.small, run.scene.radius * 1e3
    kinds = [
        (f"smaller beads, radius {radius.min():g} mm", small),
        (f"larger beads, radius {radius.max():g} mm", ~small),
    ]
    title = "One deck has many coefficients of restitution"
    return graphs.restitution(runs, on_faces(run), kinds, title, "at a rim or a wall")
