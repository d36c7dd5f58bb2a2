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

from contactlaw import style
from dem_demo.kit.graphs import MM, panels, source
from dem_demo.kit.runs import Run, Runs
from dem_demo.sieve.measure import density, on_sheet
from dem_demo.sieve.scene import Sieve

_COLOURS, _SPAN = "inferno", 100.0


def draw(runs: Runs[Sieve]) -> Figure:
    """Draw the sheet seen from above, under the law and with a constant COR."""
    values = [density(run) for run in runs.every]
    most = max(float(np.quantile(value, 0.999)) for value in values) or 1.0
    scale = LogNorm(most / _SPAN, most, clip=True)
    figure = style.figure(
        13.0,
        style.pick(5.4, 7.6),
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
    return figure


def _title(runs: Runs[Sieve]) -> str:
    if runs.constant is None:
        return "Where the deck dissipates energy"
    law, constant = (float(run.dissipated.sum()) for run in runs.every)
    if not min(law, constant) > 0.0:
        return "Where the deck dissipates energy"
    more = law / constant
    times = f"{more:.1f} times as much" if more > 1.0 else f"{1.0 / more:.1f} times less"
    return f"The sheet dissipates {times} energy as with a constant COR"


def _sheet(axes: Axes, run: Run[Sieve], value: np.ndarray, scale: Normalize) -> PolyCollection:
    corners = run.scene.deck.triangles()[on_sheet(run)][:, :, :2] * MM
    drawn = PolyCollection(
        list(corners), array=value, cmap=_COLOURS, norm=scale, edgecolors="face", linewidths=0.1
    )
    drawn.set_rasterized(True)
    axes.add_collection(drawn)
    deck = run.scene.deck
    axes.set(xlim=(0.0, deck.length * MM), ylim=(0.0, deck.width * MM), aspect="equal")
    axes.set(xlabel="x [mm]", ylabel="y [mm]")
    axes.label_outer()
    axes.grid(visible=False)
    return drawn
