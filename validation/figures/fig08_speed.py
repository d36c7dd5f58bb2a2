"""Fig. 8: COR against speed for several thicknesses: the solver and the closed forms.

Eq. 22 as printed jumps to 1 at the yield speed and is up to 55 % off. With the elastic COR at yield
as a factor it is continuous and within 4 %. The turning-point form is within 0.05 % here.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from contactlaw import turning_point
from validation import figures
from validation.closed_form import peng
from validation.fem import compare
from validation.figures import _style
from validation.formulas import eq_22
from validation.paper import ETA, FASTEST, impacts

PART = figures.PAPER

_RATIOS = (0.25, 0.75, 1.25, 1.8)  # where there are finite elements


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw one panel per thickness, all closed forms in each."""
    figure = _style.figure(
        13.0,
        5.2,
        "Eq. 22 as printed jumps at yield; one factor mends it",
        f"COR against speed, gamma-alumina on glass; {_style.RATIO}",
    )
    panels = figure.subplots(1, len(_RATIOS), sharey=True)
    v = np.linspace(0.05, FASTEST, 400)
    errors = {"printed": 0.0, "continuous": 0.0, "turning point": 0.0}
    case = compare.comparison("matrix")
    for axes, ratio in zip(panels, _RATIOS, strict=True):
        e = np.asarray(impacts(v, ratio).restitution)
        forms = {
            "printed": eq_22(v, ratio, ETA),
            "continuous": peng(v, ratio, ETA),
            "turning point": turning_point.restitution(v, ETA * ratio**2),
        }
        for name, form in forms.items():
            errors[name] = max(errors[name], float(np.abs(form / e - 1).max()))
        axes.plot(
            v, forms["printed"], ":", color=_style.MUTED, linewidth=2, label="Eq. 22, printed"
        )
        axes.plot(v, forms["continuous"], "--", color=_style.VERMILION, label="Eq. 22, continuous")
        axes.plot(v, forms["turning point"], color=_style.GREEN, label="turning point")
        axes.plot(v[::16], e[::16], "o", color=_style.BLUE, markersize=4.5, label="solver")
        here = np.isclose(case.slenderness, ratio)
        axes.plot(
            case.speed_ratio[here], case.fem["restitution"][here], "x", color=_style.INK,
            markersize=8, markeredgewidth=2, label="finite elements",
        )  # fmt: skip
        axes.set(title=f"R/H = {ratio:g}", xlim=(0, FASTEST + 0.3))
    figure.supxlabel(_style.SPEED)
    panels[0].set(ylabel=_style.RESTITUTION, ylim=(0.3, 1.02))
    panels[0].legend(loc="lower left")
    return figure, {f"largest error, {name}": error for name, error in errors.items()}
