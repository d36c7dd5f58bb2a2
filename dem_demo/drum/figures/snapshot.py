"""The drum at the end, seen along its axis, under the law and with a constant COR.

Beads are coloured by the COR of their last impact on the drum; grey: none yet.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from dem_demo.drum.drawing import Section
from dem_demo.drum.scene import Drum
from dem_demo.kit.drawing import snapshot
from dem_demo.kit.runs import Runs


def draw(runs: Runs[Drum]) -> Figure:
    """Draw the last frame of both runs."""
    return snapshot(Section, runs, "The same beads in the same drum, with two kinds of rebound")
