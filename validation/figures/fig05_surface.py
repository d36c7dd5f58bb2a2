"""Fig. 5: the COR over speed and thickness (A), and against Mueller's elastic formula (B).

The COR falls with speed and with R/H everywhere. Above the yield speed Mueller's formula, which
leaves out plastic flow, is far too high: by 31 % at 7 V_Y0 on a plate of R/H = 0.5.
"""

from __future__ import annotations

import numpy as np

from contactlaw.style import BLUE, GREEN, INK, ORANGE, SKY, VERMILION
from validation import figures
from validation.figures import chart
from validation.figures.chart import RESTITUTION, SLENDERNESS, SPEED, Panel
from validation.paper.closed_form import mueller, yield_speed_ratio
from validation.paper.setting import ETA, FASTEST, THINNEST, impacts

PART = figures.PAPER

_RATIOS = {0.2: BLUE, 0.5: SKY, 1.0: GREEN, 1.4: ORANGE, 1.8: VERMILION}
_LINES = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9)  # COR


def draw() -> chart.Drawn:
    """Draw the surface as a map, and sections through it."""
    figure, (left, right) = chart.sheet(
        (13.0, 6.0),
        "The COR falls with speed and as the plate gets thinner",
        "gamma-alumina on glass, modified Zener model; A: contours of COR, dashed: yield speed; "
        "B: COR against speed, dashes: Mueller's elastic formula",
        Panel(SPEED, SLENDERNESS, "A"),
        Panel(SPEED.between(0, FASTEST), RESTITUTION.between(0.3, 1.01), "B"),
    )
    v, ratio = np.linspace(0.05, FASTEST, 200), np.linspace(0.0, THINNEST, 120)
    e = np.asarray(impacts(v, ratio[:, None]).restitution)
    chart.contours(left, v, ratio, e, RESTITUTION.label, levels=np.arange(0.3, 1.001, 0.05))
    inks = [INK if level > 0.65 else "white" for level in _LINES]
    lines = left.contour(v, ratio, e, levels=_LINES, colors=inks, linewidths=1)
    left.clabel(lines, fmt="%.1f", fontsize=10)
    left.plot(yield_speed_ratio(ETA * ratio**2), ratio, "--", color=INK)
    for one, colour in _RATIOS.items():
        right.plot(v, impacts(v, one).restitution, color=colour, label=f"R/H = {one:g}")
        right.plot(v, mueller(ETA * one**2 * v**0.2), "--", color=colour, linewidth=1.2)
        yields = float(yield_speed_ratio(ETA * one**2))
        right.plot(yields, impacts(yields, one).restitution, "v", color=colour, markersize=9)
    chart.key(right, "Mueller, elastic", "--", linewidth=1.2)
    chart.key(right, "yield speed", "v", markersize=9)
    right.legend(loc="lower left", ncols=2)
    over = mueller(ETA * 0.25 * FASTEST**0.2) / impacts(FASTEST, 0.5).restitution - 1
    return figure, {
        "COR at R/H = 1.8 and 7 V_Y0": e[-1, -1],
        "Mueller over the model at R/H = 0.5, 7 V_Y0, less 1": over,
        "largest rise of COR with speed or R/H": max(np.diff(e, axis=k).max() for k in (0, 1)),
    }
