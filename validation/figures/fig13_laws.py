"""Fig. 13: the COR by all laws, on the half-space and on a plate.

Four laws agree within 7 % up to 3.5 V_Y0 and part beyond. Thornton's, which yields at 2.13 m/s, is
far lower; it approaches its asymptote 1.185 v^(-1/4) (v by its own yield speed), Johnson's power.
Stronge's bends from 2.4 to 3 V_Y0, where its unloading curve leaves the loading curve.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from contactlaw.closed_form import thornton_asymptote
from validation.figures import _style
from validation.paper import ETA, all_laws, restitution

_SLOWER = (0.25 / 0.68) ** 1.25  # yield speed of Thornton's law in that of MYC


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw one line per law in two panels."""
    figure = _style.figure(
        12.0,
        5.6,
        "Four laws agree within 7 % at moderate speeds, Thornton's does not",
        "COR against speed, gamma-alumina on glass; V$_{Y0}$ is the yield speed of MYC, 7.43 m/s",
    )
    left, right = figure.subplots(1, 2, sharey=True)
    v = np.geomspace(0.1, 30.0, 160)
    at = int(np.argmin(np.abs(v - 3.5)))
    cor = {}
    for law in all_laws():
        name = law.name.partition("(")[0]
        colour, line = _style.LAWS[name]
        for axes, lam_y in ((left, 0.0), (right, ETA)):
            e = np.array([restitution(x, lam_y, law) for x in v])
            axes.plot(v, e, line, color=colour, linewidth=2.2, label=_style.TITLES[name])
            cor[name, lam_y] = e[at]
    fast = v[v > 1.5]
    left.plot(
        fast, thornton_asymptote(fast / _SLOWER), ":", color=_style.INK, label=r"1.185 v$^{-1/4}$"
    )
    for axes, title in ((left, "half-space"), (right, "R/H = 1")):
        axes.set(xscale="log", xlabel="V$_0$ / V$_{Y0}$", title=title, ylim=(0.3, 1.02))
        axes.set_xticks([0.1, 1, 10], ["0.1", "1", "10"])
    left.set_ylabel("coefficient of restitution")
    left.legend(loc="lower left")
    plastic = [e for (name, lam_y), e in cor.items() if lam_y and name != "hertz"]
    others = [e for (name, lam_y), e in cor.items() if lam_y and name not in ("hertz", "thornton")]
    return figure, {
        "lowest over highest COR at 3.5 V_Y0, R/H = 1": min(plastic) / max(plastic),
        "the same without Thornton": min(others) / max(others),
    }
