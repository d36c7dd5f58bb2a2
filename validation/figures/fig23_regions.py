"""Fig. 23: errors in COR of the model, the closed forms and the laws, by region.

Each field has the largest error over its impacts, and the rms. Before anything yields all but
Thornton's law, which has its own yield speed, are within 6 %. The errors of the model are largest
on thin plates where the wave takes more than plastic flow; Zener and Mueller fail wherever the
sphere yields. Law fem, which was fitted to these impacts too, is within 1 %.
"""

from __future__ import annotations

import numpy as np
from matplotlib.colors import LogNorm

from contactlaw import style
from contactlaw.style import INK
from validation import figures
from validation.accuracy import compare
from validation.figures import chart

PART = figures.FINITE_ELEMENTS

_AT_MOST = "\N{LESS-THAN OR EQUAL TO}"


def draw() -> chart.Drawn:
    """Draw a field per predictor and region."""
    case = compare.comparison("matrix")
    parts = {"all": np.ones(case.slenderness.size, bool), **compare.regions(case)}
    cors = dict(case.restitution)
    for law, cor in compare.by_law().items():
        if law not in ("myc", "hertz"):  # the modified Zener model, and Zener's
            cors[f"{chart.law(law)[-1]}'s law"] = cor
    cors["law fem"] = compare.by_fem("matrix")
    errors = np.array(
        [[compare.deviation(cor, case, where) for where in parts.values()] for cor in cors.values()]
    )
    figure = style.figure(
        13.0,
        8.0,
        "The modified Zener model and its closed form hold in every region",
        f"COR of {case.slenderness.size} impacts, gamma-alumina on glass, against finite elements: "
        "largest error, and in brackets rms, in percent; R/H: radius over thickness",
    )
    axes = figure.subplots()
    largest = errors[..., 0]
    axes.imshow(largest, cmap="YlOrRd", norm=LogNorm(0.01, 0.6), aspect="auto", alpha=0.8)
    for i, j in np.ndindex(*largest.shape):
        big, rms = 100.0 * errors[i, j]
        ink = "white" if big > 30.0 else INK
        axes.text(j, i, f"{big:.1f}  ({rms:.1f})", ha="center", va="center", color=ink)
    counts = [
        f"{part.replace('<=', _AT_MOST)}\n{where.sum()} impacts" for part, where in parts.items()
    ]
    axes.set_xticks(range(len(parts)), counts)
    axes.set_yticks(range(len(cors)), list(cors))
    axes.xaxis.tick_top()
    axes.tick_params(length=0)
    axes.grid(visible=False)
    return figure, {
        f"{name}, {part}: {kind}": errors[i, j, k]
        for i, name in enumerate(cors)
        for j, part in enumerate(parts)
        for k, kind in enumerate(("largest", "rms"))
    }
