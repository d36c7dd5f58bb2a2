"""Fig. 9B: where the energy goes, against speed, at R/H = 0.2, 0.5 and 1.2.

At R/H = 1.2 plastic flow does not take more than the wave below 9.98 V_Y0, so not in the paper's
range; at 0.5 it overtakes at 1.82 V_Y0, at 0.2 at 1.22. The shares sum to 1.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from validation import figures
from validation.figures import _style
from validation.paper import FASTEST, borderline, impacts

PART = figures.PAPER

_RATIOS = (0.2, 0.5, 1.2)


def draw() -> tuple[Figure, dict[str, float]]:
    """Stack kept, wave and plastic energy."""
    figure = _style.figure(
        13.0,
        5.0,
        "Thin plates lose energy to the wave, thick ones to plastic flow",
        f"shares of the initial kinetic energy, gamma-alumina on glass; {_style.RATIO}",
    )
    v = np.linspace(0.05, FASTEST, 300)
    open_balance = 0.0
    for axes, ratio in zip(figure.subplots(1, 3, sharey=True), _RATIOS, strict=True):
        one = impacts(v, ratio)
        kept, wave = np.asarray(one.restitution) ** 2, np.asarray(one.wave_fraction)
        plastic = np.asarray(one.plastic_fraction)
        axes.stackplot(
            v, kept, wave, plastic, colors=(_style.PALE, _style.BLUE, _style.ORANGE),
            labels=("kept by the sphere", "bending wave", "plastic flow"),
        )  # fmt: skip
        overtakes = borderline(ratio)
        if overtakes < FASTEST:
            axes.axvline(
                overtakes, color=_style.INK, linestyle=":", linewidth=1.5,
                label="more plastic than wave beyond",
            )  # fmt: skip
        axes.set(title=f"R/H = {ratio:g}", xlim=(v[0], FASTEST), ylim=(0, 1))
        open_balance = max(open_balance, float(np.abs(kept + wave + plastic - 1).max()))
    figure.axes[0].set_ylabel("share of the initial kinetic energy")
    figure.axes[1].set_xlabel(_style.SPEED)
    named = figure.axes[0].get_legend_handles_labels()
    figure.axes[2].legend(*named, loc="lower left", frameon=True)
    return figure, {
        "plastic overtakes wave at R/H = 0.2": borderline(0.2),
        "plastic overtakes wave at R/H = 0.5": borderline(0.5),
        "plastic overtakes wave at R/H = 1.2": borderline(1.2),
        "energy not accounted for": open_balance,
    }
