"""What a constant COR would do instead: error of the energy with which each bead rebounds.

One number cannot be right on thin and on thick plates, for slow and for fast beads, even if it is
their mean. Each impact is compared with itself: nothing but the COR differs.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from contactlaw import style
from contactlaw.reporting.limits import label
from dem_demo.kit.run import Runs
from dem_demo.rain.scene import Shower

_HALO = withStroke(linewidth=3.0, foreground="white")


def draw(runs: Runs[Shower]) -> Figure:
    """Draw a column per plate; within it beads are sorted from slow to fast."""
    run, rows, cor = runs[0], runs[0].impacts, runs[0].mean_cor
    # a share of the impact's energy, not of the rebound's: a COR may be nearly 0
    error, inside = 100.0 * (cor**2 - rows["restitution"] ** 2), rows["flags"] == 0
    title = "What a constant COR would do instead"
    if inside.any():
        ends = f"{_signed(error[inside].min())} to {_signed(error[inside].max())}"
        title = f"One COR for all, {cor:.2f}, gets the rebound energy wrong by {ends} of the impact's"
    figure = style.figure(
        style.COLUMN,
        6.4,
        title,
        f"{run.scene.subject}; the mean COR against the model's, for each impact inside the model's limits; "
        "in each column from slow (left) to fast (right); bar: median",
    )
    axes = figure.add_subplot()
    speed = rows["approach_speed"]
    x = rows["plate"] + 0.8 * (speed / speed.max(initial=1e-9) - 0.5)
    colours = np.where(error > 0.0, style.VERMILION, style.BLUE)
    axes.scatter(x[inside], error[inside], s=16, c=list(colours[inside]), alpha=0.6, linewidths=0)
    for n in np.unique(rows["plate"][inside]).tolist():
        middle = float(np.median(error[inside & (rows["plate"] == n)]))
        axes.hlines(middle, n - 0.42, n + 0.42, color=style.INK, linewidth=2.5)
        look: dict[str, Any] = {"ha": "right", "va": "bottom", "fontweight": "bold", "path_effects": [_HALO]}
        axes.annotate(_signed(middle), (n + 0.42, middle), (0, 3), textcoords="offset points", **look)
    axes.axhline(0.0, color=style.INK, linewidth=1.4)
    labels = [label(thickness) for thickness in run.scene.plates]
    axes.set_xticks(range(len(labels)), labels, rotation=60 if len(labels) > 5 else 0)
    axes.set(xlim=(-0.55, len(labels) - 0.45), xlabel="plate thickness", ylabel="error [% of the impact's energy]")
    axes.grid(visible=False, axis="x")
    return figure


def _signed(percent: float) -> str:
    return f"{percent:+.0f} %".replace("-", "\N{MINUS SIGN}")
