"""Fig. 11: error map of the turning-point form, the project's own closed form of the COR.

Within 0.05 % of the solver for lambda_Y up to 0.3 and v up to 10, within 0.15 % up to 20; exact on
the half-space (bottom edge). The form contains fits of two functions of one variable; right of the
line, where loading leaves Hertz's curve, also a fit of the loading work. Eq. 22 in its continuous
form is up to 4.6 % off for v up to 10.
"""

from __future__ import annotations

import math

import numpy as np

from contactlaw import laws
from contactlaw.laws.myc import P
from contactlaw.style import INK
from validation import figures
from validation.figures import chart
from validation.figures.chart import SLENDERNESS, SPEED, Axis, Panel
from validation.paper import closed_form, turning_point
from validation.paper.setting import ETA, largest, restitution

PART = figures.PAPER


def draw() -> chart.Drawn:
    """Draw the relative error, with the axes of the paper's pair on the right."""
    figure, (axes,) = chart.sheet(
        (10.0, 6.2),
        "The turning-point form: within 0.05 % up to 10 times the yield speed",
        "relative error of the COR against the solver; any pair of materials (R/H on the right: "
        "gamma-alumina on glass)",
        Panel(SPEED, Axis(r"inelasticity at yield  $\lambda_Y$")),
    )
    v, lam_y = np.linspace(0.05, 20.0, 200), np.linspace(0.0, 0.3, 61)
    myc = laws.law("myc")
    exact = np.array([[restitution(x, lam, myc) for x in v] for lam in lam_y])
    error = turning_point.restitution(v, lam_y[:, None]) / exact - 1.0
    look = {"cmap": "PuOr", "extend": "both", "levels": np.linspace(-0.15, 0.15, 13)}
    chart.contours(axes, v, lam_y, 100 * error, "error of the COR  [%]", **look)
    axes.axhline(ETA * 1.8**2, color=INK, linestyle=":", linewidth=1.2)
    overload = v**0.8 * turning_point.loading(lam_y[:, None] * v**0.2)
    axes.contour(v, lam_y, overload, levels=[P], colors=INK, linewidths=1.2)
    chart.note(axes, 4.1, 0.02, "loads along\nHertz's curve", ha="right")
    chart.note(axes, 4.7, 0.02, "and\nbeyond it", ha="left")
    other = axes.secondary_yaxis(
        "right",
        functions=(
            lambda lam: np.sqrt(np.maximum(lam, 0.0) / ETA),
            lambda ratio: ETA * np.square(ratio),
        ),
    )
    other.set_ylabel(SLENDERNESS.label)
    other.set_yticks([0.5, 1.0, 1.4, 1.8])
    axes.set_xticks([0, 5, 10, 15, 20])
    slow = error[:, v <= 10.0]
    peng = closed_form.peng(v, np.sqrt(lam_y / ETA)[:, None], ETA) / exact - 1.0
    return figure, {
        "largest error up to 10 V_Y0": largest(slow),
        "root mean square error up to 10 V_Y0": math.sqrt((slow**2).mean()),
        "largest error up to 20 V_Y0": largest(error),
        "largest error of Eq. 22, continuous, up to 10 V_Y0": largest(peng[:, v <= 10.0]),
    }
