"""The bed at its end, in a slice along the middle of the deck, under the law and beside it.

Beads are coloured by the COR of their last impact on the deck; grey: none yet.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.sieve.figures._bed import SLICE, Bed, restitution_range, window
from dem_demo.sieve.figures._labels import MM, panels, source
from dem_demo.sieve.record import Runs


def draw(runs: Runs) -> Figure:
    """Draw the last frame that both runs have."""
    frame = min(run.time.size for run in runs.every) - 1
    scene = runs.law.scene
    left, right, bottom, top = window(runs.law)
    figure = style.figure(
        12.0,
        1.4 + len(runs.every) * (0.4 + style.pick(10.0, 5.5) * (top - bottom) / (right - left)),
        "The same feed on the same sheet, with two kinds of rebound"
        if runs.constant
        else "The feed on the sheet",
        f"{source(runs)}; t = {runs.law.time[frame] * 1e3:.0f} ms, a slice of "
        f"{2.0 * SLICE * scene.radius.max() * MM:.0f} mm along the middle",
    )
    shown = panels(figure, runs, stacked=True)
    for axes, run in shown:
        bed = Bed(axes, run, restitution_range(runs.law))
        bed.show(frame)
    bar = figure.colorbar(
        bed.beads, ax=[axes for axes, _ in shown], location=style.pick("right", "bottom"),
        pad=0.02, fraction=0.03,
    )  # fmt: skip
    bar.set_label("COR of the last impact")
    return figure
