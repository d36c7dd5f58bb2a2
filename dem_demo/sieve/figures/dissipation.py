"""Where the deck takes energy from the beads: where it wears, rings and warms.

Colours show the energy per area that impacts dissipate, in bending waves and at the contact,
without sliding friction.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from contactlaw import style
from dem_demo.kit.graphs import MM, panels, source
from dem_demo.kit.runs import Run, Runs
from dem_demo.sieve.measure import density, on_sheet
from dem_demo.sieve.scene import Sieve

_COLOURS, _SPAN = "inferno", 100.0


def draw(runs: Runs[Sieve]) -> Figure:
    """Draw the deck seen from above, under the law and with a constant COR."""
    values = [density(run) for run in runs.every]
    most = max(float(np.quantile(value, 0.999)) for value in values) or 1.0
    scale = LogNorm(most / _SPAN, most, clip=True)
    figure = style.figure(
        12.0,
        style.pick(5.9, 7.6),
        _title(runs),
        f"{source(runs)}; energy dissipated in {runs.law.time[-1] * 1e3:.0f} ms, averaged over "
        "neighbouring openings",
    )
    shown = panels(figure, runs)
    for (axes, run), value in zip(shown, values, strict=True):
        sheet = _sheet(axes, run, value, scale)
    bar = figure.colorbar(
        sheet, ax=[axes for axes, _ in shown], location="bottom", fraction=0.06, pad=0.03, aspect=50
    )
    bar.set_label("dissipated energy [J/m²]")
    bar.ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    bar.ax.xaxis.set_major_formatter("{x:g}")
    bar.ax.xaxis.set_minor_locator(NullLocator())
    return figure


def _title(runs: Runs[Sieve]) -> str:
    if runs.constant is None:
        return "Where the deck dissipates energy"
    law, constant = (float(run.dissipated.sum()) for run in runs.every)
    if not min(law, constant) > 0.0:
        return "Where the deck dissipates energy"
    more = law / constant
    if more > 1.0:
        return f"The deck dissipates {more:.1f} times as much energy as with a constant COR"
    return f"With a constant COR the deck dissipates {1.0 / more:.1f} times as much energy"


def _sheet(axes: Axes, run: Run[Sieve], value: np.ndarray, scale: Normalize) -> PolyCollection:
    corners = run.scene.deck.triangles()[on_sheet(run)][:, :, :2] * MM
    drawn = PolyCollection(
        list(corners), array=value, cmap=_COLOURS, norm=scale, edgecolors="none", antialiased=False
    )  # smoothed edges would show the triangles, and more than double the file
    drawn.set_rasterized(True)
    axes.add_collection(drawn)
    deck = run.scene.deck
    axes.set(xlim=(0.0, deck.length * MM), ylim=(0.0, deck.width * MM), aspect="equal")
    axes.set(xlabel="x [mm]", ylabel="y [mm]")
    axes.label_outer()
    axes.grid(visible=False)
    return drawn
