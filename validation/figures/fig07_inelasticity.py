"""Fig. 7: COR against lambda: the elastic models, and impacts of the paper's pair.

Below yield all impacts lie on one curve (Zener's); Mueller's formula is within 2.5 % of it up to
lambda = 0.5, Raman's within 9.3 %. Above yield the impacts leave that curve: at small lambda (R/H =
0.2) all three elastic models are 30 % high at 7 V_Y0. Crosses are finite elements.
"""

from __future__ import annotations

import numpy as np

from contactlaw.style import INK, ORANGE, VERMILION
from validation import figures
from validation.figures import chart
from validation.figures.chart import INELASTICITY, RESTITUTION, SPEEDS, Panel
from validation.paper.closed_form import mueller, zener
from validation.paper.formulas import raman
from validation.paper.setting import FASTEST, impacts, largest

PART = figures.PAPER


def draw() -> chart.Drawn:
    """Draw models and impacts."""
    figure, (axes,) = chart.sheet(
        (11.0, 6.2),
        "Elastic models hold below yield only",
        "COR against Zener's inelasticity; points: gamma-alumina on glass, R/H 0.05 to 2.2, "
        "at multiples of the yield speed V$_{Y0}$, modified Zener model; crosses: finite elements",
        Panel(INELASTICITY.between(0, 0.6), RESTITUTION.between(0.25, 1.01)),
    )
    lam, ratio = np.linspace(0.0, 0.6, 241), np.linspace(0.05, 2.2, 20)
    axes.plot(lam, zener(lam), color=INK, linewidth=2.4, label="Zener (solved)")
    axes.plot(lam, mueller(lam), "--", color=VERMILION, label="Mueller, Eq. 3")
    axes.plot(lam, raman(lam), "-.", color=ORANGE, label="Raman's form, exact slope")
    for v, colour in SPEEDS.items():
        one, words = impacts(v, ratio), f"{v:g} V$_{{Y0}}$"
        axes.plot(one.inelasticity, one.restitution, "o", color=colour, markersize=5, label=words)
        chart.matrix(axes, "restitution", v)
    chart.cross(axes, [], [], label="finite elements")
    axes.legend(ncols=3, loc="upper right")
    thick, near = impacts(FASTEST, 0.2), lam[lam <= 0.5]
    numbers = {
        f"{name} over the model at 7 V_Y0, R/H = 0.2, less 1": form(thick.inelasticity)
        / thick.restitution
        - 1
        for name, form in (("Zener", zener), ("Mueller", mueller), ("Raman's form", raman))
    }
    return figure, {
        **numbers,
        "largest error of Mueller up to lambda 0.5": largest(mueller(near) / zener(near) - 1),
        "largest error of Raman's form up to lambda 0.5": largest(raman(near) / zener(near) - 1),
    }
