"""Fig. 8: COR against speed for several thicknesses: the solver and the closed forms.

Eq. 22 as printed jumps to 1 at the yield speed and is up to 55 % off. With the elastic COR at yield
as a factor it is continuous and within 4 %. The turning-point form (Fig. 11) is within 0.05 % here.
"""

from __future__ import annotations

import numpy as np

from contactlaw.style import BLUE, GREEN, INK, MUTED, VERMILION
from validation import figures
from validation.accuracy import compare
from validation.figures import chart
from validation.figures.chart import RESTITUTION, SPEED
from validation.paper import turning_point
from validation.paper.closed_form import peng
from validation.paper.formulas import eq_22
from validation.paper.setting import ETA, FASTEST, impacts, largest

PART = figures.PAPER

_RATIOS = (0.25, 0.75, 1.25, 1.8)  # where there are finite elements


def draw() -> chart.Drawn:
    """Draw one panel per thickness, all closed forms in each."""
    figure, panels = chart.by_thickness(
        (13.0, 5.2),
        "Eq. 22 as printed jumps at yield; one factor mends it",
        "COR against speed, gamma-alumina on glass",
        _RATIOS,
        SPEED.between(0, FASTEST + 0.3),
        RESTITUTION.between(0.3, 1.02),
    )
    v = np.linspace(0.05, FASTEST, 400)
    errors: dict[str, float] = {}
    case = compare.comparison("matrix")
    for ratio, axes in panels:
        e = np.asarray(impacts(v, ratio).restitution)
        turned = turning_point.restitution(v, ETA * ratio**2)
        for name, words, line, colour, form in (
            ("printed", "Eq. 22, printed", ":", MUTED, eq_22(v, ratio, ETA)),
            ("continuous", "Eq. 22, continuous", "--", VERMILION, peng(v, ratio, ETA)),
            ("turning point", "turning point", "-", GREEN, turned),
        ):
            axes.plot(v, form, line, color=colour, label=words)
            errors[name] = max(errors.get(name, 0.0), largest(form / e - 1))
        axes.plot(v[::16], e[::16], "o", color=BLUE, markersize=4.5, label="solver")
        here = np.isclose(case.slenderness, ratio)
        axes.plot(
            case.speed_ratio[here], case.fem["restitution"][here], "x", color=INK,
            markersize=8, markeredgewidth=2, label="finite elements",
        )  # fmt: skip
    figure.axes[0].legend(loc="lower left")
    return figure, {f"largest error, {name}": error for name, error in errors.items()}
