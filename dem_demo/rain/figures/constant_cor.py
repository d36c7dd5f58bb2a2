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
from dem_demo.kit.run import Runs
from dem_demo.kit.scene import Floats
from dem_demo.rain.figures import _columns
from dem_demo.rain.scene import Shower

_HALO = withStroke(linewidth=3.0, foreground="white")


def draw(runs: Runs[Shower]) -> Figure:
    """Draw a column per plate; within it beads are sorted from slow to fast."""
    rows, cor = runs[0].impacts, runs[0].mean_cor
    # a share of the impact's energy, not of the rebound's: a COR may be nearly 0
    error = 100.0 * (cor**2 - rows["restitution"] ** 2)
    points = "bar: median, points: the mean of all impacts against the model for the same impacts"
    known = error[rows["flags"] == 0]  # the model is an estimate for the others, which are ringed
    figure, axes = _columns.figure(runs, _title(cor, known), points, rows)
    x = _columns.place(runs, rows["plate"], rows["approach_speed"])
    axes.scatter(x, error, s=16, c=list(np.where(error > 0.0, style.VERMILION, style.BLUE)), alpha=0.6, linewidths=0)
    _columns.ring(axes, x, error, rows)
    for n in np.unique(rows["plate"]).tolist():
        middle = float(np.median(error[rows["plate"] == n]))
        axes.hlines(middle, n - 0.42, n + 0.42, color=style.INK, linewidth=2.5)
        look: dict[str, Any] = {"ha": "right", "va": "bottom", "fontweight": "bold", "path_effects": [_HALO]}
        axes.annotate(_signed(middle), (n + 0.42, middle), (0, 3), textcoords="offset points", **look)
    axes.axhline(0.0, color=style.INK, linewidth=1.4)
    axes.set_ylabel("error [% of the impact's energy]")
    return figure


def _title(cor: float, error: Floats) -> str:
    if not error.size:
        return "What a constant COR would do instead"
    ends = f"{_signed(error.min())} to {_signed(error.max())}"
    return f"One COR for all, {cor:.2f}, gets the rebound energy wrong by {ends} of the impact's"


def _signed(percent: float) -> str:
    return f"{percent:+.0f} %".replace("-", "\N{MINUS SIGN}")
