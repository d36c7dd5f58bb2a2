"""Fig. 10: contact time against lambda, with and without plastic flow.

Plastic flow shortens the contact by at most 9 % up to 7 V_Y0: Zener's model is slightly long, as
the paper says. Thinner plates prolong it, by 5 % at R/H = 1.8 and V_Y0. Finite elements (crosses)
have contacts up to 4 % shorter: theirs are stiffer than Hertz's.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from validation.fem import compare
from validation.figures import _style
from validation.paper import impacts

_SPEEDS = (0.6, 1.0, 2.2, 3.5, 7.0)  # where there are finite elements


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw contact times per speed, elastic and with plastic flow."""
    figure = _style.figure(
        11.0,
        6.0,
        "Plastic flow shortens the contact by a tenth at most",
        "gamma-alumina of 0.9 mm radius on glass; lines: modified Zener model, dashes: Zener's, "
        "elastic, crosses: finite elements; along each line R/H goes from 0.05 to 1.8",
    )
    axes = figure.subplots()
    ratio = np.linspace(0.05, 1.8, 60)
    colours = (_style.SKY, _style.BLUE, _style.GREEN, _style.PURPLE, _style.VERMILION)
    shorter = 0.0
    case = compare.comparison("matrix")
    for v, colour in zip(_SPEEDS, colours, strict=True):
        one, elastic = impacts(v, ratio), impacts(v, ratio, law="hertz")
        lam = np.asarray(one.inelasticity)
        axes.plot(lam, one.contact_time * 1e6, color=colour, label=f"{v:g} V$_{{Y0}}$")
        axes.plot(lam, elastic.contact_time * 1e6, "--", color=colour, linewidth=1.4)
        here = np.isclose(case.speed_ratio, v)
        fem = case.fem["contact_time"][here] * 1e6
        axes.plot(case.inelasticity[here], fem, "X", color=colour, markersize=8)
        shorter = max(shorter, float((1 - one.contact_time / elastic.contact_time).max()))
    axes.set(xlabel=r"inelasticity  $\lambda$", ylabel="contact time  [us]", xlim=(0, 0.37))
    axes.legend(ncols=2)
    thin, thick = impacts(1.0, 1.8), impacts(1.0, 0.05)
    return figure, {
        "largest shortening by plastic flow up to 7 V_Y0": shorter,
        "R/H = 1.8 over 0.05 at V_Y0, contact time, less 1": float(
            thin.contact_time / thick.contact_time - 1
        ),
    }
