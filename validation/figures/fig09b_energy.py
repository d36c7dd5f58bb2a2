"""Fig. 9B: where the energy goes, against speed, at R/H = 0.2, 0.5 and 1.2.

At R/H = 1.2 plastic flow takes more than the wave only above 9.98 V_Y0, beyond the paper's range;
at 0.5 it does above 1.82 V_Y0, at 0.2 above 1.22. The shares sum to 1.
"""

from __future__ import annotations

import numpy as np

from contactlaw.style import BLUE, INK, ORANGE, PALE
from validation import figures
from validation.figures import chart
from validation.figures.chart import SPEED, Axis
from validation.paper.setting import FASTEST, borderline, impacts, largest

PART = figures.PAPER

_RATIOS = (0.2, 0.5, 1.2)


def draw() -> chart.Drawn:
    """Stack kept, wave and plastic energy."""
    figure, panels = chart.by_thickness(
        (13.0, 5.0),
        "Thin plates lose energy to the wave, thick ones to plastic flow",
        "shares of the initial kinetic energy, gamma-alumina on glass",
        _RATIOS,
        SPEED.between(0.05, FASTEST),
        Axis("share of the initial kinetic energy").between(0, 1),
    )
    v = np.linspace(0.05, FASTEST, 300)
    numbers = {f"plastic overtakes wave at R/H = {one:g}": borderline(one) for one in _RATIOS}
    unaccounted = 0.0
    for ratio, axes in panels:
        one = impacts(v, ratio)
        kept, wave = np.asarray(one.restitution) ** 2, np.asarray(one.wave_fraction)
        plastic = np.asarray(one.plastic_fraction)
        axes.stackplot(
            v, kept, wave, plastic, colors=(PALE, BLUE, ORANGE),
            labels=("kept by the sphere", "bending wave", "plastic flow"),
        )  # fmt: skip
        if borderline(ratio) < FASTEST:
            words = "more plastic than wave beyond"
            axes.axvline(borderline(ratio), color=INK, linestyle=":", label=words)
        unaccounted = max(unaccounted, largest(kept + wave + plastic - 1))
    named = figure.axes[0].get_legend_handles_labels()
    figure.axes[2].legend(*named, loc="lower left", frameon=True)
    return figure, {**numbers, "energy not accounted for": unaccounted}
