"""Fig. 17: where the energy goes, by finite elements and by the model.

Plate and plastic flow take nearly all of it; vibration and residual stress keep up to 3.4 % in
the sphere, which the model counts as plastic work, and friction takes less than 1 %.
"""

from __future__ import annotations

import numpy as np

from contactlaw.style import BLUE, GREEN, INK, ORANGE, VERMILION
from validation import figures
from validation.accuracy import compare
from validation.figures import chart
from validation.figures.chart import SPEED, Axis

PART = figures.FINITE_ELEMENTS

_SHARES = {
    "wave": (BLUE, "plate"),
    "plastic": (ORANGE, "plastic work"),
    "vibration": (GREEN, "left in the sphere"),
    "friction_loss": (VERMILION, "friction"),
}


def draw() -> chart.Drawn:
    """Draw the shares against speed for three thicknesses."""
    figure, panels = chart.by_thickness(
        (13.0, 5.2),
        "Where the energy goes: plate, plastic flow, and little else",
        "gamma-alumina on glass; areas: finite elements, lines: the modified Zener model",
        (0.25, 0.75, 1.8),
        SPEED.log(0.3, 1, 2, 3.5, 7).between(0.3, 7.0),
        Axis("share of the initial energy").between(0.0, 1.0),
    )
    case = compare.comparison("matrix")
    for ratio, axes in panels:
        rows = np.isclose(case.slenderness, ratio)
        v = case.speed_ratio[rows]
        axes.stackplot(
            v, *(case.fem[name][rows] for name in _SHARES), alpha=0.55,
            colors=[colour for colour, _ in _SHARES.values()],
            labels=[label for _, label in _SHARES.values()],
        )  # fmt: skip
        wave, plastic = case.model["wave_fraction"][rows], case.model["plastic_fraction"][rows]
        axes.plot(v, wave, color=INK)
        axes.plot(v, wave + plastic, color=INK, label="model: plate; with plastic work")
    figure.axes[0].legend(loc="upper left")
    return figure, {
        "largest share left in the sphere": case.fem["vibration"].max(),
        "largest share of friction": case.fem["friction_loss"].max(),
    }
