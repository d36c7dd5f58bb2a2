"""Where the energy of the beads came from and went, over time.

Upper line: energy at the start, plus what gravity and the turning drum have added since.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from dem_demo.drum.scene import Drum
from dem_demo.kit import graphs
from dem_demo.kit.runs import Runs


def draw(runs: Runs[Drum]) -> Figure:
    """Draw where the energy is over time, stacked, under the law and with a constant COR."""
    return graphs.energy(runs, "The drum lifts the beads, and impacts calm them", "drum")
