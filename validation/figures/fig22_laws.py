"""Fig. 22: the COR by every law over the matrix of finite elements.

The COR hardly tells the laws of Stronge and MYC apart (5.2 and 4.6 % at worst), though their forces
differ by 40 %: what is too stiff loads and unloads so. It takes the force, Fig. 3, to judge. The
laws with Etsion's unloading part from the finite elements at the highest speeds; Thornton's, which
yields at 2.13 m/s, is low from the start. Jackson and Green made their fit for metals, E*/sigma_Y
above about 120; this pair has 23.
"""

from __future__ import annotations

import math

from matplotlib.figure import Figure

from validation import figures
from validation.fem import compare
from validation.figures import _style
from validation.figures.fig16_errors import error_map

PART = figures.FINITE_ELEMENTS


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw a map of the error per law."""
    case, cor = compare.comparison("matrix"), compare.by_law()
    figure = _style.figure(
        15.0,
        9.0,
        "By their COR, MYC and Stronge's law are right; by its force, MYC alone",
        "COR of the modified Zener equation with each law less that of finite elements, in percent "
        "of it; gamma-alumina on glass",
    )
    numbers = {}
    panels = figure.subplots(2, math.ceil(len(cor) / 2))
    for n, (name, values) in enumerate(cor.items()):
        axes = panels.flat[n]
        title = _style.law(name)[2]
        error_map(axes, title, values / case.fem["restitution"] - 1.0, widest=20.0)
        largest, rms = compare.deviation(values, case)
        numbers[f"{title}: largest error"] = float(largest)
        numbers[f"{title}: rms error"] = float(rms)
    return figure, numbers
