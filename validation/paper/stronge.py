"""Stronge's force curve, with which the paper compares its own: elastic, elastic-plastic, plastic.

Stronge, Impact Mechanics (2000), chapter 6, in units of yield, with s = 2 d - 1:

    f = s (1 + ln(s)/3.3)      1 <= d < d_p     elastic-plastic
    f = (2.8/1.1) s            d >= d_p         fully plastic

The mean pressure is 1.1 sigma_Y at yield and 2.8 sigma_Y when fully plastic (Johnson, Contact
Mechanics, 1985, section 6.3); with Hertz, 1.1 sigma_Y gives d_Y = (3.3 pi/4)^2 sigma_Y^2 R*/E*^2.
The force is continuous at d_p = 82.5; the 84 in print would jump by 0.2 %. Contacts unload along
f = fm ((d - dr)/(dm - dr))^1.5 with dm - dr = sqrt(2 dm - 1).

Legend: d compression, dm the largest so far, dr what remains of it, all in units of d_Y; forces in
units of F_Y.
"""

import math

import numpy as np

from contactlaw.laws.myc import C_YIELD
from validation.paper.setting import Array

_UNIT = (3.3 / 4.0) ** 2 / C_YIELD  # yield compression over that of MYC
_PRESSURES = 2.8 / 1.1  # mean pressure when fully plastic, over that at yield


def force(compression: Array) -> Array:
    """Compute the loading curve in MYC's units: force [F_Y] at compressions [d_Y]."""
    d = compression / _UNIT
    s = np.maximum(2.0 * d - 1.0, 1.0)
    yielded = s * np.minimum(1.0 + np.log(s) / 3.3, _PRESSURES)
    return np.asarray(_UNIT**1.5 * np.where(d < 1.0, d**1.5, yielded))


def unloading(largest: float) -> tuple[Array, Array]:
    """Unloading curve from a largest compression: compression [d_Y], force [F_Y], both MYC's.

    From 2.2 d_Y on: below, the printed curve would lie above the loading curve.
    """
    span = _UNIT * math.sqrt(2.0 * largest / _UNIT - 1.0)
    share = np.linspace(0.0, 1.0, 200) ** 2
    return largest - span + span * share, force(np.array(largest)) * share**1.5
