"""Fig. 13: the COR by all laws, on the half-space and on a plate.

Four laws agree within 7 % up to 3.5 V_Y0 in both panels and part beyond. Thornton's, which yields
at 2.13 m/s, is up to 29 % below MYC's there; on the half-space it approaches its asymptote
1.185 v^(-1/4) (v by its own yield speed), Johnson's power, to 0.1 % at 30 V_Y0. Stronge's bends
between 2.4 and 3 V_Y0 on the half-space, where its unloading curve leaves the loading curve.
Jackson and Green made their fit for metals, E*/sigma_Y above about 120; this pair has 23.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure

from contactlaw import laws
from validation import figures
from validation.evidence import slope
from validation.figures import _style
from validation.formulas import thornton_asymptote
from validation.paper import ETA, SPEED, Array, all_laws, restitution, yield_unit

PART = figures.PAPER

_SLOWER = yield_unit(laws.law("thornton")) ** 1.25  # yield speed of its law in that of MYC
_MODERATE = 3.5  # V0/V_Y0
_ALIKE = "myc", "stronge", "kogut_etsion", "jackson_green"


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
    cor: dict[tuple[str, float], Array] = {}
    for name, law in all_laws().items():
        colour, line, title = _style.law(name)
        for axes, lam_y in ((left, 0.0), (right, ETA)):
            e = np.array([restitution(x, lam_y, law) for x in v])
            axes.plot(v, e, line, color=colour, linewidth=2.2, label=title)
            cor[name, lam_y] = e
    fast = v[v > 1.5]
    left.plot(
        fast, thornton_asymptote(fast / _SLOWER), ":", color=_style.INK,
        label=r"Thornton, 1.185 v$^{-1/4}$",
    )  # fmt: skip
    for axes, title in ((left, "half-space"), (right, "plate as thick as the radius, R/H = 1")):
        axes.set(xscale="log", xlabel=_style.SPEED, title=title, ylim=(0.3, 1.02))
        axes.set_xticks([0.1, 1, 10], ["0.1", "1", "10"])
    left.set_ylabel(_style.RESTITUTION)
    left.legend(loc="lower left")
    moderate = v <= _MODERATE
    numbers: dict[str, float] = {}
    for title, lam_y in (("half-space", 0.0), ("R/H = 1", ETA)):
        others = [e for (name, at), e in cor.items() if at == lam_y and name in _ALIKE]
        spread = np.min(others, axis=0) / np.max(others, axis=0)
        below = cor["thornton", lam_y] / cor["myc", lam_y]
        numbers |= {
            f"lowest over highest COR of four laws up to 3.5 V_Y0, {title}": spread[moderate].min(),
            f"Thornton over MYC up to 3.5 V_Y0, {title}": below[moderate].min(),
        }
    stronge = laws.law("stronge")
    numbers |= {
        "yield speed of Thornton's law [m/s]": _SLOWER * SPEED,
        "Thornton over its asymptote at 30 V_Y0, half-space": (
            cor["thornton", 0.0][-1] / thornton_asymptote(v[-1] / _SLOWER)
        ),
        "d ln e/d ln v of Stronge's law at 2.35 V_Y0, half-space": _slope(stronge, 2.35),
        "d ln e/d ln v of Stronge's law at 3.05 V_Y0, half-space": _slope(stronge, 3.05),
    }
    return figure, {name: float(number) for name, number in numbers.items()}


def _slope(law: laws.Law, speed_ratio: float) -> float:
    down, up = (speed_ratio * math.exp(h) for h in (-1e-3, 1e-3))
    return slope((down, restitution(down, 0.0, law)), (up, restitution(up, 0.0, law)))
