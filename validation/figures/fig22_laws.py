"""Fig. 22: the COR by every law over the matrix of finite elements.

The COR hardly tells the laws of Stronge and MYC apart (5.2 and 4.6 % at worst), though their forces
differ by 40 %: a law that is too stiff in loading is so in unloading, too, and only its force tells
(Fig. 3). The laws with Etsion's unloading deviate from finite elements at the highest speeds;
Thornton's, which yields at 2.13 m/s, is low from the start. Jackson and Green made their fit for
metals, E*/sigma_Y above about 120; this pair has 23.
"""

from __future__ import annotations

from validation import figures
from validation.accuracy import compare
from validation.figures import chart

PART = figures.FINITE_ELEMENTS


def draw() -> chart.Drawn:
    """Draw a map of the error per law."""
    case = compare.comparison("matrix")
    cors = {chart.law(name)[-1]: cor for name, cor in compare.by_law().items()}
    figure = chart.error_maps(
        (15.0, 9.0),
        "By their COR, MYC and Stronge's law are right; by its force, MYC alone",
        "COR of the modified Zener equation with each law less that of finite elements, in percent "
        "of it; gamma-alumina on glass",
        {title: cor / case.fem["restitution"] - 1.0 for title, cor in cors.items()},
        widest=20.0,
    )
    return figure, {
        f"{title}: {kind} error": error
        for title, cor in cors.items()
        for kind, error in zip(("largest", "rms"), compare.deviation(cor, case), strict=True)
    }
