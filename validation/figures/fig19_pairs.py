"""Fig. 19: three pairs at equal inelasticity, for which the table of the MYC law has one line.

Below yield that is right: the CORs of the three agree within 0.003. Above, the table of MYC has two
to three times the plastic work of a sphere that is stiff for its strength (Fig. 24): steel on glass
or on aluminium (taken as elastic) has a COR 0.05 to 0.08, or 7 to 11 %, higher at 7 V_Y0.
"""

from __future__ import annotations

import numpy as np

from contactlaw.style import BLUE, INK, VERMILION
from validation import figures
from validation.accuracy import compare
from validation.figures import chart
from validation.figures.chart import RATIO, RESTITUTION, SPEED, Panel
from validation.paper.setting import impacts

PART = figures.FINITE_ELEMENTS

_LOOKS: tuple[chart.Look, ...] = (  # the marks of the pairs overlap
    {"marker": "o", "markersize": 8, "color": BLUE},
    {"marker": "s", "markersize": 12, "color": INK, "markerfacecolor": "none"},
    {"marker": "^", "markersize": 7, "color": VERMILION},
)


def draw() -> chart.Drawn:
    """Draw one panel per inelasticity."""
    case = compare.comparison("pairs")
    blocks = np.split(np.arange(case.slenderness.size), 3)
    at_yield = [case.inelasticity[b[0]] * case.speed_ratio[b[0]] ** -0.2 for b in blocks]
    across, up = SPEED.log(0.5, 1.5, 3.5, 7), RESTITUTION.between(0.45, 1.02)
    titles = [rf"inelasticity at yield  $\lambda_Y$ = {lam:.3f}" for lam in at_yield]
    figure, panels = chart.sheet(
        (13.0, 5.8),
        "One table serves all pairs until they yield; steel then keeps more",
        "points: finite elements of three pairs with the same inelasticity at the yield speed, "
        f"plates in the order of the panels; {RATIO}",
        *(Panel(across, up, title) for title in titles),
        sharey=True,
    )
    names = list(dict.fromkeys(_pair(case, n) for n in range(case.slenderness.size)))
    fine = np.geomspace(0.45, 7.4, 80)
    for axes, block in zip(panels, blocks, strict=True):
        for name, look in zip(names, _LOOKS, strict=True):
            rows = [n for n in block if _pair(case, n) == name]
            at, cor = case.speed_ratio[rows], case.fem["restitution"][rows]
            axes.plot(at, cor, linestyle="none", label=_label(case, name), **look)
        line = impacts(fine, case.slenderness[block[0]])  # the paper's pair comes first
        words = "modified Zener model with law MYC, one line for all"
        axes.plot(fine, line.restitution, color=INK, zorder=1, label=words)
        axes.label_outer()
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    cor = case.fem["restitution"].reshape(3, 3, 4)  # inelasticity, pair, speed
    spread = np.ptp(cor, axis=1)
    low = case.model["restitution"] / case.fem["restitution"] - 1.0
    low = low.reshape(3, 3, 4)[:, 1:, 3]
    work = case.model["plastic_fraction"] / np.maximum(case.fem["plastic"], 1e-9)
    steel = work.reshape(3, 3, 4)[:, 1:, 2:]
    return figure, {
        "plastic work, model over finite elements, steel from 3.5 V_Y0 on: least": steel.min(),
        "plastic work, model over finite elements, steel from 3.5 V_Y0 on: largest": steel.max(),
        "spread of the COR at 0.5 V_Y0, largest": spread[:, 0].max(),
        "spread of the COR at 7 V_Y0, smallest": spread[:, 3].min(),
        "spread of the COR at 7 V_Y0, largest": spread[:, 3].max(),
        "model over finite elements, steel at 7 V_Y0, less 1: nearest": low.max(),
        "model over finite elements, steel at 7 V_Y0, less 1: farthest": low.min(),
    }


def _pair(case: compare.Comparison, impact: int) -> tuple[str, str]:
    return case.fem["sphere"][impact], case.fem["plate"][impact]


def _label(case: compare.Comparison, pair: tuple[str, str]) -> str:
    rows = [n for n in range(case.slenderness.size) if _pair(case, n) == pair]
    ratios = ", ".join(f"{ratio:.2f}" for ratio in dict.fromkeys(case.slenderness[rows].round(2)))
    return f"{pair[0]} on {pair[1]}, R/H {ratios}"
