"""The matrix of finite elements as Figs. 7 and 10 show it: marks against the inelasticity."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from validation.fem import compare
from validation.figures import _style

SPEEDS = {  # V0/V_Y0, of those that the matrix has, and the colour of each
    0.6: _style.SKY,
    1.0: _style.BLUE,
    2.2: _style.GREEN,
    3.5: _style.PURPLE,
    7.0: _style.VERMILION,
}


def marks(axes: Axes, field: str, speed_ratio: float, unit: float = 1.0) -> None:
    """Mark a quantity of the impacts at one of `SPEEDS`, given in `unit`."""
    case = compare.comparison("matrix")
    here = np.isclose(case.speed_ratio, speed_ratio)
    axes.plot(
        case.inelasticity[here], case.fem[field][here] / unit, "X", color=SPEEDS[speed_ratio],
        markersize=9, markeredgecolor=_style.INK, clip_on=False, zorder=3,
    )  # fmt: skip
