"""Fig. 10: contact time against lambda, with and without plastic flow.

Plastic flow shortens the contact by at most 9 % up to 7 V_Y0. Thinner plates prolong it, by 5 % at
R/H = 1.8 and V_Y0. Finite elements (crosses) have contacts up to 4 % shorter than the model's, rms
2.3 %: theirs are stiffer than Hertz's. Where the bead yields, Zener's model is 4 to 11 % long
beside them, as the paper says.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure

from validation import figures
from validation.evidence import contact_time_errors
from validation.figures import _matrix, _style
from validation.paper import impacts

PART = figures.PAPER


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw contact times per speed, elastic and with plastic flow."""
    figure = _style.figure(
        11.0,
        6.0,
        "Plastic flow shortens the contact by a tenth at most",
        "gamma-alumina of 0.9 mm radius on glass at multiples of the yield speed V$_{Y0}$; along "
        "each line radius over thickness, R/H, goes from 0.05 to 1.8",
    )
    axes = figure.subplots()
    ratio = np.linspace(0.05, 1.8, 60)
    shorter = 0.0
    for v, colour in _matrix.SPEEDS.items():
        one, elastic = impacts(v, ratio), np.asarray(impacts(v, ratio, law="hertz").contact_time)
        time = np.asarray(one.contact_time)
        axes.plot(one.inelasticity, time * 1e6, color=colour, label=f"{v:g} V$_{{Y0}}$")
        axes.plot(one.inelasticity, elastic * 1e6, "--", color=colour, linewidth=1.4)
        _matrix.marks(axes, "contact_time", v, unit=1e-6)
        shorter = max(shorter, float((1 - time / elastic).max()))
    axes.set(xlabel=_style.INELASTICITY, ylabel="contact time  [µs]", xlim=(0, 0.37))
    _style.key(axes, "modified Zener model", "-")
    _style.key(axes, "Zener's, elastic", "--", 1.4)
    _style.key(
        axes, "finite elements", "X", color=_style.PALE, markersize=9, markeredgecolor=_style.INK
    )
    axes.set_ylim(top=5.8)
    axes.legend(ncols=3, loc="upper right")
    model, zener = contact_time_errors()
    thin, thick = impacts(1.0, 1.8), impacts(1.0, 0.05)
    return figure, {
        "largest shortening by plastic flow up to 7 V_Y0": shorter,
        "R/H = 1.8 over 0.05 at V_Y0, contact time, less 1": float(
            thin.contact_time / thick.contact_time - 1
        ),
        "model over finite elements, less 1, least": float(model.min()),
        "model over finite elements, less 1, largest": float(model.max()),
        "model over finite elements, less 1, rms": math.sqrt(float((model**2).mean())),
        "Zener over finite elements, less 1, above yield, least": float(zener.min()),
        "Zener over finite elements, less 1, above yield, largest": float(zener.max()),
    }
