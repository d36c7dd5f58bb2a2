"""Fig. 19: three pairs at equal inelasticity, and the one line that the table has for them.

Below yield it does: the COR of the three agree within 0.003. Above, the table of the MYC law has
two to three times the plastic work of a sphere that is stiff for its strength (Fig. 24): steel on
glass or on aluminium (taken as elastic) keeps 0.05 to 0.08 more at 7 V_Y0, 7 to 11 % of its COR.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from validation.fem import compare
from validation.figures import _style
from validation.paper import impacts

_MARKERS = "os^"


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw one panel per inelasticity."""
    case = compare.comparison("pairs")
    figure = _style.figure(
        13.0,
        5.2,
        "One table serves all pairs until they yield; steel then keeps more",
        "points: finite elements of pairs with the same inelasticity at the yield speed; line: the "
        "model, one for all",
    )
    names = list(dict.fromkeys(zip(case.fem["sphere"], case.fem["plate"], strict=True)))
    looks = _style.BLUE, _style.ORANGE, _style.VERMILION
    panels = figure.subplots(1, 3, sharey=True)
    blocks = np.split(np.arange(case.slenderness.size), 3)
    for axes, block in zip(panels, blocks, strict=True):
        for name, marker, colour in zip(names, _MARKERS, looks, strict=True):
            rows = [n for n in block if (case.fem["sphere"][n], case.fem["plate"][n]) == name]
            axes.plot(
                case.speed_ratio[rows], case.fem["restitution"][rows], marker, markersize=9,
                color=colour, alpha=0.85,
                label=f"{name[0]} on {name[1]}, R/H {case.slenderness[rows[0]]:.2f}",
            )  # fmt: skip
        fine = np.geomspace(0.45, 7.4, 80)
        line = impacts(fine, case.slenderness[block[0]])  # the paper's pair comes first
        axes.plot(fine, line.restitution, color=_style.INK, linewidth=1.6)
        at_yield = case.inelasticity[block[0]] * case.speed_ratio[block[0]] ** -0.2
        axes.set_title(rf"$\lambda_Y$ = {at_yield:.3f}", fontweight="bold", loc="left")
        _style.speed_axis(axes, (0.5, 1.5, 3.5, 7))
        axes.set_ylim(0.35, 1.02)
        axes.legend(loc="lower left", fontsize=8.5)
    panels[0].set_ylabel("coefficient of restitution")
    cor = case.fem["restitution"].reshape(3, 3, 4)  # inelasticity, pair, speed
    spread = np.ptp(cor, axis=1)
    low = case.model["restitution"] / case.fem["restitution"] - 1.0
    low = low.reshape(3, 3, 4)[:, 1:, 3]
    work = case.model["plastic_fraction"] / np.maximum(case.fem["plastic"], 1e-9)
    steel = work.reshape(3, 3, 4)[:, 1:, 2:]
    return figure, {
        "plastic work, model over finite elements, steel from 3.5 V_Y0 on: least": float(
            steel.min()
        ),
        "plastic work, model over finite elements, steel from 3.5 V_Y0 on: largest": float(
            steel.max()
        ),
        "spread of the COR at 0.5 V_Y0, largest": float(spread[:, 0].max()),
        "spread of the COR at 7 V_Y0, smallest": float(spread[:, 3].min()),
        "spread of the COR at 7 V_Y0, largest": float(spread[:, 3].max()),
        "model over finite elements, steel at 7 V_Y0, less 1: nearest": float(low.max()),
        "model over finite elements, steel at 7 V_Y0, less 1: farthest": float(low.min()),
    }
