"""The last frame, in a slice along the deck's middle, under the law and with a constant COR.

Beads are coloured by the COR of their last impact on the deck; grey: none yet.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from dem_demo.kit.drawing import snapshot
from dem_demo.kit.runs import Runs
from dem_demo.sieve.drawing import Sheet
from dem_demo.sieve.scene import Sieve


def draw(runs: Runs[Sieve]) -> Figure:
    """Draw the last frame of both runs."""
    return snapshot(Sheet, runs, "The same feed on the same deck, with two kinds of rebound")
