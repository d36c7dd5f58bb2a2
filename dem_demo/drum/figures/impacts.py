"""How fast the beads come, what is left of it, and at which angle, under the law.

The angle is that from the wall's normal: 0° is straight on.
"""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from dem_demo.kit.graphs import histograms
from dem_demo.kit.runs import Runs


def draw(runs: Runs[Any]) -> Figure:
    """Draw histograms of all impacts on the walls."""
    run = runs.law
    return histograms(run.collisions, run.pair, run.law, run.engine)
