"""What each plate takes from the beads, and where the energy goes.

A thin plate's bending wave carries energy away for good; on a thick plate the losses at the contact
prevail.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.reporting import run as of_any_run
from contactlaw.reporting.figures import energy
from dem_demo.kit.run import Runs
from dem_demo.rain.scene import Shower


def draw(runs: Runs[Shower]) -> Figure:
    """Draw two panels with a bar for each plate."""
    known = of_any_run.Run(runs[0].record)
    if not known.rows.size:
        return style.figure(style.COLUMN, 4.0, "Where the energy of the impacts goes", "no bead has hit a plate yet")
    return energy.draw(known)
