"""Fig. 15: the COR by finite elements, R/H 0.1 to 1.8, 0.3 to 7 V_Y0, and by the model.

The modified Zener model is within 4.6 % for 64 impacts, 1.9 % rms; Zener's, which has no yielding,
is up to 37 % high. The model exceeds finite elements most on thin plates just above yield.
"""

from __future__ import annotations

import numpy as np

from contactlaw.style import INK
from validation import figures
from validation.accuracy import compare
from validation.fem.studies import SLENDERNESS
from validation.figures import chart
from validation.figures.chart import INELASTICITY, RATIO, RESTITUTION, SPEED, Panel
from validation.paper.closed_form import zener
from validation.paper.setting import impacts

PART = figures.FINITE_ELEMENTS

_LIFT = {0.1: 4, 0.25: -6, 0.5: -9}  # shifts of labels that would overlap [points]


def draw() -> chart.Drawn:
    """Draw the COR against speed and against the inelasticity."""
    case = compare.comparison("matrix")
    up = RESTITUTION.between(0.3, 1.02)
    figure, (left, right) = chart.sheet(
        (13.0, 6.4),
        "Once the bead yields, the modified Zener model holds and Zener's does not",
        f"gamma-alumina on glass, each colour a thickness; {RATIO}",
        Panel(SPEED.log(0.3, 0.6, 1, 2, 3.5, 7).between(0.27, 9.0), up),
        Panel(INELASTICITY, up),
    )
    fine, lam = np.geomspace(0.25, 7.6, 100), np.linspace(0.0, 0.38, 60)
    for slenderness, colour in zip(SLENDERNESS, chart.shades(len(SLENDERNESS)), strict=True):
        rows = np.isclose(case.slenderness, slenderness)
        v, e = case.speed_ratio[rows], case.fem["restitution"][rows]
        elastic = case.fem["plastic_strain"][rows] == 0.0
        line = impacts(fine, slenderness)
        for axes, x, at in ((left, v, fine), (right, case.inelasticity[rows], line.inelasticity)):
            axes.plot(at, line.restitution, color=colour, linewidth=1.6)
            axes.plot(x[~elastic], e[~elastic], "o", color=colour)
            axes.plot(x[elastic], e[elastic], "o", color=colour, markerfacecolor="white")
        lift = _LIFT.get(slenderness, -4)
        left.annotate(
            f"{slenderness:g}", (7.0, e[-1]), (14, lift), textcoords="offset points", color=colour
        )
        if slenderness == SLENDERNESS[0]:
            left.annotate("R/H", (7.0, e[-1]), (14, 20), textcoords="offset points")
    right.plot(lam, zener(lam), ":", color=INK)
    chart.key(right, "finite elements", "o")
    chart.key(right, "finite elements, no plastic strain", "o", markerfacecolor="white")
    chart.key(right, "modified Zener model", "-", linewidth=1.6)
    chart.key(right, "Zener's model", ":")
    right.legend(loc="upper right")
    return figure, {
        f"{name}: {kind} error": error
        for name, errors in compare.errors(case).items()
        for kind, error in zip(("largest", "rms"), errors, strict=True)
    }
