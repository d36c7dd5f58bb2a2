"""Fig. 7: COR against lambda: the elastic models, and impacts of the paper's pair.

Below yield all impacts lie on one curve (Zener's); Mueller's formula is within 2.5 % of it up to
lambda = 0.5, Raman's within 9.3 %. Above yield they leave it: at small lambda (R/H = 0.2) all three
are 30 % high at 7 V_Y0. Crosses are finite elements.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from validation import figures
from validation.closed_form import mueller, zener
from validation.figures import _matrix, _style
from validation.formulas import raman
from validation.paper import FASTEST, impacts

PART = figures.PAPER


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw models and impacts."""
    figure = _style.figure(
        11.0,
        6.2,
        "Elastic models hold below yield only",
        "COR against Zener's inelasticity; points: gamma-alumina on glass, R/H 0.05 to 2.2, "
        "at multiples of the yield speed V$_{Y0}$, modified Zener model; crosses: finite elements",
    )
    axes = figure.subplots()
    lam = np.linspace(0.0, 0.6, 241)
    axes.plot(lam, zener(lam), color=_style.INK, linewidth=2.4, label="Zener (solved)")
    axes.plot(lam, mueller(lam), "--", color=_style.VERMILION, label="Mueller, Eq. 3")
    axes.plot(lam, raman(lam), "-.", color=_style.ORANGE, label="Raman's form, exact slope")
    ratio = np.linspace(0.05, 2.2, 20)
    for v, colour in _matrix.SPEEDS.items():
        one = impacts(v, ratio)
        axes.plot(
            one.inelasticity, one.restitution, "o", color=colour, markersize=5,
            label=f"{v:g} V$_{{Y0}}$",
        )  # fmt: skip
        _matrix.marks(axes, "restitution", v)
    axes.set(xlabel=_style.INELASTICITY, ylabel=_style.RESTITUTION)
    axes.set(xlim=(0, 0.6), ylim=(0.25, 1.01))
    _style.key(
        axes, "finite elements", "X", color=_style.PALE, markersize=9, markeredgecolor=_style.INK
    )
    axes.legend(ncols=3, loc="upper right")
    thick = impacts(FASTEST, 0.2)
    near = lam[lam <= 0.5]
    return figure, {
        **{
            f"{name} over the model at 7 V_Y0, R/H = 0.2, less 1": float(
                form(thick.inelasticity) / thick.restitution - 1
            )
            for name, form in (("Zener", zener), ("Mueller", mueller), ("Raman's form", raman))
        },
        "largest error of Mueller up to lambda 0.5": float(
            np.abs(mueller(near) / zener(near) - 1).max()
        ),
        "largest error of Raman's form up to lambda 0.5": float(
            np.abs(raman(near) / zener(near) - 1).max()
        ),
    }
