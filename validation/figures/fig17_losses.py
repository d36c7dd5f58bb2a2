"""Fig. 17: where the energy goes, by finite elements and by the model.

Plate and plastic flow take nearly all of it; vibration and residual stress keep up to 3.4 % in
the sphere, which the model counts as plastic work, and friction takes less than 1 %.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from validation import figures
from validation.fem import compare
from validation.figures import _style

PART = figures.FINITE_ELEMENTS

_SHARES = {
    "wave": (_style.BLUE, "plate"),
    "plastic": (_style.ORANGE, "plastic work"),
    "vibration": (_style.GREEN, "left in the sphere"),
    "friction_loss": (_style.VERMILION, "friction"),
}


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw the shares against speed for three thicknesses."""
    case = compare.comparison("matrix")
    figure = _style.figure(
        13.0,
        5.2,
        "Where the energy goes: plate, plastic flow, and little else",
        "gamma-alumina on glass; areas: finite elements, lines: the modified Zener model; "
        f"{_style.RATIO}",
    )
    panels = figure.subplots(1, 3, sharey=True)
    for axes, slenderness in zip(panels, (0.25, 0.75, 1.8), strict=True):
        rows = np.isclose(case.slenderness, slenderness)
        v = case.speed_ratio[rows]
        axes.stackplot(
            v, *(case.fem[name][rows] for name in _SHARES), alpha=0.55,
            colors=[colour for colour, _ in _SHARES.values()],
            labels=[label for _, label in _SHARES.values()],
        )  # fmt: skip
        wave, plastic = case.model["wave_fraction"][rows], case.model["plastic_fraction"][rows]
        axes.plot(v, wave, color=_style.INK, linewidth=1.6)
        axes.plot(
            v,
            wave + plastic,
            color=_style.INK,
            linewidth=1.6,
            label="model: plate; with plastic work",
        )
        axes.set_title(f"R/H = {slenderness:g}")
        _style.speed_axis(axes, (0.3, 1, 2, 3.5, 7))
        axes.set(xlim=(0.3, 7.0), ylim=(0.0, 1.0))
    panels[0].set_ylabel("share of the initial energy")
    panels[0].legend(loc="upper left")
    return figure, {
        "largest share left in the sphere": float(case.fem["vibration"].max()),
        "largest share of friction": float(case.fem["friction_loss"].max()),
    }
