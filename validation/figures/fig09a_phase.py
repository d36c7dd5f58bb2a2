"""Fig. 9A: which loss rules where, over speed and R/H.

Region I is elastic; in II the bending wave takes more than plastic flow, in III less. Eq. 23 is the
border of II and III to within 10 % in speed, worst near R/H = 0.25. Of the three cited experiments
the paper gives materials and regions, but neither thickness nor speed, so there are no points to
draw. It puts Kharaz and Gorham's, on plastic loss, into region II, where the wave rules; on thick
plates that region is a sliver, 0.1 V_Y0 wide at R/H = 0.1, so III may be meant.
"""

from __future__ import annotations

import numpy as np

from validation import figures
from validation.figures import chart
from validation.figures.chart import SLENDERNESS, SPEED, Panel
from validation.paper.closed_form import yield_speed_ratio
from validation.paper.evidence import fitted_border
from validation.paper.formulas import border
from validation.paper.setting import ETA, borderline, impacts

PART = figures.PAPER


def draw() -> chart.Drawn:
    """Draw the share of plastic loss, both isolines and Eq. 23."""
    figure, (axes,) = chart.sheet(
        (10.0, 6.6),
        "Wave or plastic flow: which loss is larger?",
        "share of the energy loss that is plastic, gamma-alumina on glass; black: the isolines 0 "
        "and 1/2 of the model, dashed: Eq. 23",
        Panel(SPEED.between(0.05, 10.0), SLENDERNESS.between(0.01, 1.8)),
    )
    v, ratio = np.linspace(0.05, 10.0, 200), np.linspace(0.01, 1.8, 120)
    one = impacts(v, ratio[:, None])
    share = np.asarray(one.plastic_fraction) / (1.0 - np.asarray(one.restitution) ** 2)
    label = "plastic share of the loss"
    chart.contours(axes, v, ratio, share, label, levels=np.linspace(0, 1, 11))
    half = np.linspace(0.05, 1.2, 24)
    exact = np.array([borderline(float(x)) for x in half])
    axes.plot(yield_speed_ratio(ETA * ratio**2), ratio, color="black", linewidth=2.2)
    axes.plot(exact, half, color="black", linewidth=2.2)
    axes.plot(border(half), half, "--", color="white", linewidth=2.2)
    for x, y, text, cited in (
        (1.75, 1.5, "II  wave", "as cited: Kharaz & Gorham 2000;\nPatil & Higgs 2017 (to III)"),
        (6.2, 0.4, "III  plastic", "as cited: Patil & Higgs 2017 (from II)"),
    ):
        colour = "white" if x < 5 else "black"
        axes.text(x, y, text, fontsize=15, fontweight="bold", color=colour)
        axes.text(x, y - 0.03, cited, fontsize=10, color=colour, va="top")
    axes.text(0.15, 0.75, "I  elastic", fontsize=15, fontweight="bold", color="white", rotation=90)
    axes.text(0.55, 0.75, "as cited: Mueller et al. 2015", fontsize=10, color="white", rotation=90)
    off = np.abs(border(half) / exact - 1)
    yields = float(yield_speed_ratio(ETA * half[1] ** 2))
    return figure, {
        "coefficient of Eq. 23, fitted over R/H 0.1 to 1.2": fitted_border(1.2),
        "the same, over R/H 0.1 to 1.1": fitted_border(1.1),
        "speed at which plastic loss overtakes at R/H = 1.2": borderline(1.2),
        "largest error of Eq. 23 in speed, R/H 0.05 to 1.2": off.max(),
        "R/H at which it is": half[off.argmax()],
        "width of region II at R/H = 0.1 [V_Y0]": borderline(0.1) - yields,
    }
