"""How fast the beads come, what is left of it, and at which angle.

The angle is that from the plate's normal: 0° is straight on.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from dem_demo.kit.graphs import histograms
from dem_demo.rain.record import Run


def draw(run: Run) -> Figure:
    """Draw histograms of all impacts on the plates."""
    return histograms(run.modelled, run.model.pair, run.law, run.engine)
