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

from contactlaw import laws
from contactlaw.style import INK
from validation import figures
from validation.figures import chart
from validation.figures.chart import RESTITUTION, SPEED, Panel
from validation.paper import setting
from validation.paper.evidence import slope
from validation.paper.formulas import thornton_asymptote
from validation.paper.setting import ETA, Array, all_laws, restitution, yield_unit

PART = figures.PAPER

_SLOWER = yield_unit(laws.law("thornton")) ** 1.25  # yield speed of its law in that of MYC
_MODERATE = 3.5  # V0/V_Y0
_ALIKE = "myc", "stronge", "kogut_etsion", "jackson_green"


def draw() -> chart.Drawn:
    """Draw one line per law in two panels."""
    across, up = SPEED.log(0.1, 0.3, 1, 3, 10, 30), RESTITUTION.between(0.3, 1.02)
    figure, (left, right) = chart.sheet(
        (12.0, 5.6),
        "Four laws agree within 7 % at moderate speeds, Thornton's does not",
        "COR against speed, gamma-alumina on glass; V$_{Y0}$ is the yield speed of MYC, 7.43 m/s",
        Panel(across, up, "half-space"),
        Panel(across, up, "plate as thick as the radius, R/H = 1"),
        sharey=True,
    )
    v = np.geomspace(0.1, 30.0, 160)
    cor: dict[tuple[str, float], Array] = {}
    for name, law in all_laws().items():
        for axes, lam_y in ((left, 0.0), (right, ETA)):
            e = cor[name, lam_y] = np.array([restitution(x, lam_y, law) for x in v])
            chart.of_law(axes, name, v, e)
    fast = v[v > 1.5]
    asymptote = np.asarray(thornton_asymptote(fast / _SLOWER))
    left.plot(fast, asymptote, ":", color=INK, label=r"Thornton, 1.185 v$^{-1/4}$")
    left.legend(loc="lower left")
    right.label_outer()
    moderate = v <= _MODERATE
    numbers: dict[str, float] = {}
    for title, lam_y in (("half-space", 0.0), ("R/H = 1", ETA)):
        others = [cor[name, lam_y] for name in _ALIKE]
        spread = np.min(others, axis=0) / np.max(others, axis=0)
        below = cor["thornton", lam_y] / cor["myc", lam_y]
        numbers |= {
            f"lowest over highest COR of four laws up to 3.5 V_Y0, {title}": spread[moderate].min(),
            f"Thornton over MYC up to 3.5 V_Y0, {title}": below[moderate].min(),
        }
    stronge, end = laws.law("stronge"), cor["thornton", 0.0][-1]
    return figure, {
        **numbers,
        "yield speed of Thornton's law [m/s]": _SLOWER * setting.SPEED,
        "Thornton over its asymptote at 30 V_Y0, half-space": end / asymptote[-1],
        "d ln e/d ln v of Stronge's law at 2.35 V_Y0, half-space": _slope(stronge, 2.35),
        "d ln e/d ln v of Stronge's law at 3.05 V_Y0, half-space": _slope(stronge, 3.05),
    }


def _slope(law: laws.Law, speed_ratio: float) -> float:
    down, up = (speed_ratio * math.exp(h) for h in (-1e-3, 1e-3))
    return slope((down, restitution(down, 0.0, law)), (up, restitution(up, 0.0, law)))
