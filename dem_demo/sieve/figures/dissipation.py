"""Where the deck takes energy from the beads: where it wears, rings and warms.

Colours show the energy per area that impacts dissipate, in bending waves and at the contact,
without sliding friction.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.reporting.charts import density_bar, density_scale, sheet
from dem_demo.kit.graphs import MM, panels, source
from dem_demo.kit.runs import Run, Runs
from dem_demo.sieve.measure import density, on_sheet
from dem_demo.sieve.scene import Sieve


def draw(runs: Runs[Sieve]) -> Figure:
    """Draw the deck seen from above, under the law and with a constant COR."""
    values = [density(run) for run in runs.both]
    scale = density_scale(values)
    figure = style.figure(
        12.0,
        5.9,
        _title(runs),
        f"{source(runs)}; energy dissipated in {runs.law.time[-1] * 1e3:.0f} ms, averaged over neighbouring openings",
    )
    shown = panels(figure, runs)
    for (axes, run), value in zip(shown, values, strict=True):
        drawn = _sheet(axes, run, value, scale)
    density_bar(figure, drawn, [axes for axes, _ in shown])
    return figure


def _title(runs: Runs[Sieve]) -> str:
    law, constant = (float(run.dissipated.sum()) for run in runs.both)
    if not min(law, constant) > 0.0:
        return "Where the deck dissipates energy"
    cor = f"one COR, {runs.constant.constant_cor:.3g}"
    more = law / constant
    if more > 1.0:
        return f"The deck dissipates {more:.1f} times as much energy as with {cor}"
    return f"With {cor}, the deck dissipates {1.0 / more:.1f} times as much energy"


def _sheet(axes: Axes, run: Run[Sieve], value: np.ndarray, scale: LogNorm) -> PolyCollection:
    corners = run.scene.deck.triangles()[on_sheet(run)][:, :, :2] * MM
    drawn = sheet(axes, corners, value, scale)
    deck = run.scene.deck
    axes.set(xlim=(0.0, deck.length * MM), ylim=(0.0, deck.width * MM))
    axes.set(xlabel="x [mm]", ylabel="y [mm]")
    axes.label_outer()
    return drawn
