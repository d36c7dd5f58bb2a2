"""Fig. 5: the COR over speed and thickness (A), and against Mueller's elastic formula (B).

The COR falls with speed and with R/H everywhere. Above the yield speed, Mueller's formula, which
knows no plasticity, is far too high: by 31 % at 7 V_Y0 on a plate of R/H = 0.5.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from validation import figures
from validation.closed_form import mueller, yield_speed_ratio
from validation.figures import _style
from validation.paper import ETA, FASTEST, THINNEST, impacts

PART = figures.PAPER

_RATIOS = (0.2, 0.5, 1.0, 1.4, 1.8)
_LINES = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9)  # COR


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw the surface as a map, and sections through it."""
    figure = _style.figure(
        13.0,
        6.0,
        "The COR falls with speed and as the plate gets thinner",
        "gamma-alumina on glass, modified Zener model; A: contours of COR, dashed: yield speed; "
        "B: COR against speed, dashes: Mueller's elastic formula",
    )
    left, right = figure.subplots(1, 2)
    v, ratio = np.linspace(0.05, FASTEST, 200), np.linspace(0.0, THINNEST, 120)
    e = np.asarray(impacts(v, ratio[:, None]).restitution)
    filled = left.contourf(v, ratio, e, levels=np.arange(0.3, 1.001, 0.05), cmap="cividis")
    inks = [_style.INK if level > 0.65 else "white" for level in _LINES]
    lines = left.contour(v, ratio, e, levels=_LINES, colors=inks, linewidths=1)
    left.clabel(lines, fmt="%.1f", fontsize=10)
    left.plot(yield_speed_ratio(ETA * ratio**2), ratio, "--", color=_style.INK, linewidth=2)
    figure.colorbar(filled, ax=left, label=_style.RESTITUTION)
    left.set(xlabel=_style.SPEED, ylabel=_style.SLENDERNESS, title="A")
    left.grid(visible=False)
    for k, one in enumerate(_RATIOS):
        colour = (_style.BLUE, _style.SKY, _style.GREEN, _style.ORANGE, _style.VERMILION)[k]
        elastic = mueller(ETA * one**2 * v**0.2)
        right.plot(v, impacts(v, one).restitution, color=colour, label=f"R/H = {one:g}")
        right.plot(v, elastic, "--", color=colour, linewidth=1.2)
        yields = float(yield_speed_ratio(ETA * one**2))
        right.plot(yields, impacts(yields, one).restitution, "v", color=colour, markersize=9)
    right.set(xlabel=_style.SPEED, ylabel=_style.RESTITUTION)
    right.set(title="B", xlim=(0, FASTEST), ylim=(0.3, 1.01))
    _style.key(right, "Mueller, elastic", "--", 1.2)
    _style.key(right, "yield speed", "v", markersize=9)
    right.legend(loc="lower left", ncols=2)
    over = float(mueller(ETA * 0.25 * FASTEST**0.2) / impacts(FASTEST, 0.5).restitution - 1)
    return figure, {
        "COR at R/H = 1.8 and 7 V_Y0": float(e[-1, -1]),
        "Mueller over the model at R/H = 0.5, 7 V_Y0, less 1": over,
        "largest rise of COR with speed or R/H": float(
            max(np.diff(e, axis=0).max(), np.diff(e, axis=1).max())
        ),
    }
