"""Fig. 10: contact time against lambda, with and without plastic flow.

Plastic flow shortens the contact by at most 9 % up to 7 V_Y0. Thinner plates prolong it, by 5 % at
R/H = 1.8 and V_Y0. Finite elements (crosses) have contacts up to 4 % shorter than the model's, rms
2.3 %: theirs are stiffer than Hertz's. Where the bead yields, Zener's model is 4 to 11 % long
beside them, as the paper says.
"""

from __future__ import annotations

import math

import numpy as np

from validation import figures
from validation.figures import chart
from validation.figures.chart import INELASTICITY, SPEEDS, Axis, Panel
from validation.paper.elements import contact_time_errors
from validation.paper.setting import impacts

PART = figures.PAPER


def draw() -> chart.Drawn:
    """Draw contact times per speed, elastic and with plastic flow."""
    figure, (axes,) = chart.sheet(
        (11.0, 6.0),
        "Plastic flow shortens the contact by a tenth at most",
        "gamma-alumina of 0.9 mm radius on glass at multiples of the yield speed V$_{Y0}$; along "
        "each line radius over thickness, R/H, goes from 0.05 to 1.8",
        Panel(INELASTICITY.between(0, 0.37), Axis("contact time  [µs]").between(2.6, 5.8)),
    )
    ratio = np.linspace(0.05, 1.8, 60)
    shorter = 0.0
    for v, colour in SPEEDS.items():
        one, elastic = impacts(v, ratio), np.asarray(impacts(v, ratio, law="hertz").contact_time)
        time = np.asarray(one.contact_time)
        axes.plot(one.inelasticity, time * 1e6, color=colour, label=f"{v:g} V$_{{Y0}}$")
        axes.plot(one.inelasticity, elastic * 1e6, "--", color=colour, linewidth=1.4)
        chart.matrix(axes, "contact_time", v, unit=1e-6)
        shorter = max(shorter, float((1 - time / elastic).max()))
    chart.key(axes, "modified Zener model", "-")
    chart.key(axes, "Zener's, elastic", "--", linewidth=1.4)
    chart.cross(axes, [], [], label="finite elements")
    axes.legend(ncols=3, loc="upper right")
    model, zener = contact_time_errors()
    thin, thick = impacts(1.0, 1.8).contact_time, impacts(1.0, 0.05).contact_time
    return figure, {
        "largest shortening by plastic flow up to 7 V_Y0": shorter,
        "R/H = 1.8 over 0.05 at V_Y0, contact time, less 1": thin / thick - 1,
        "model over finite elements, less 1, least": model.min(),
        "model over finite elements, less 1, largest": model.max(),
        "model over finite elements, less 1, rms": math.sqrt((model**2).mean()),
        "Zener over finite elements, less 1, above yield, least": zener.min(),
        "Zener over finite elements, less 1, above yield, largest": zener.max(),
    }
