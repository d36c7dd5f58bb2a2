"""Where the energy of the beads came from and went, over time.

Upper line: energy at the start, plus what gravity and the deck have added since.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from dem_demo.kit import graphs
from dem_demo.kit.runs import Runs
from dem_demo.sieve.scene import Sieve


def draw(runs: Runs[Sieve]) -> Figure:
    """Draw where the energy is over time, stacked, under the law and with a constant COR."""
    title = "A vibrating deck feeds energy in, and impacts take it away"
    return graphs.energy(runs, title, "deck")
