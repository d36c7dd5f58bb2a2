"""Fig. 19: three pairs at equal inelasticity, and the one line that the table has for them.

Below yield it does: the COR of the three agree within 0.003. Above, the table of the MYC law has
two to three times the plastic work of a sphere that is stiff for its strength (Fig. 24): steel on
glass or on aluminium (taken as elastic) keeps 0.05 to 0.08 more at 7 V_Y0, 7 to 11 % of its COR.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from validation import figures
from validation.fem import compare
from validation.figures import _style
from validation.paper import impacts

PART = figures.FINITE_ELEMENTS

_LOOKS = (  # of the pairs, which lie on each other
    {"marker": "o", "markersize": 8, "color": _style.BLUE},
    {"marker": "s", "markersize": 12, "color": _style.INK, "markerfacecolor": "none"},
    {"marker": "^", "markersize": 7, "color": _style.VERMILION},
)


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw one panel per inelasticity."""
    case = compare.comparison("pairs")
    figure = _style.figure(
        13.0,
        5.8,
        "One table serves all pairs until they yield; steel then keeps more",
        "points: finite elements of three pairs with the same inelasticity at the yield speed, "
        f"plates in the order of the panels; {_style.RATIO}",
    )
    names = list(dict.fromkeys(_pair(case, n) for n in range(case.slenderness.size)))
    panels = figure.subplots(1, 3, sharey=True)
    blocks = np.split(np.arange(case.slenderness.size), 3)
    for axes, block in zip(panels, blocks, strict=True):
        for name, look in zip(names, _LOOKS, strict=True):
            rows = [n for n in block if _pair(case, n) == name]
            at, cor = case.speed_ratio[rows], case.fem["restitution"][rows]
            axes.plot(at, cor, linestyle="none", label=_label(case, name), **look)
        fine = np.geomspace(0.45, 7.4, 80)
        line = impacts(fine, case.slenderness[block[0]])  # the paper's pair comes first
        axes.plot(
            fine, line.restitution, color=_style.INK, linewidth=1.6, zorder=1,
            label="modified Zener model with law MYC, one line for all",
        )  # fmt: skip
        at_yield = case.inelasticity[block[0]] * case.speed_ratio[block[0]] ** -0.2
        axes.set_title(rf"inelasticity at yield  $\lambda_Y$ = {at_yield:.3f}")
        _style.speed_axis(axes, (0.5, 1.5, 3.5, 7))
        axes.set_ylim(0.45, 1.02)
    panels[0].set_ylabel(_style.RESTITUTION)
    named = panels[0].get_legend_handles_labels()
    figure.legend(*named, loc="outside lower center", ncols=2)
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


def _pair(case: compare.Comparison, impact: int) -> tuple[str, str]:
    return case.fem["sphere"][impact], case.fem["plate"][impact]


def _label(case: compare.Comparison, pair: tuple[str, str]) -> str:
    rows = [n for n in range(case.slenderness.size) if _pair(case, n) == pair]
    ratios = ", ".join(f"{ratio:.2f}" for ratio in dict.fromkeys(case.slenderness[rows].round(2)))
    return f"{pair[0]} on {pair[1]}, R/H {ratios}"
