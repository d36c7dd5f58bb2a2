"""Stronge: elastic, elastic-plastic, fully plastic; Hertz-like unloading to a residual compression.

Stronge, Impact Mechanics (2000), chapter 6, in units of yield, with s = 2 d - 1:

    f = s (1 + ln(s)/3.3)      1 <= d < d_p     elastic-plastic
    f = (2.8/1.1) s            d >= d_p         fully plastic

Where the constants come from. The mean pressure is 1.1 sigma_Y at yield and 2.8 sigma_Y when fully
plastic (Johnson, Contact Mechanics, 1985, section 6.3); with Hertz, 1.1 sigma_Y gives
d_Y = (3.3 pi/4)^2 sigma_Y^2 R*/E*^2, a coefficient of 0.6806. Between the two the pressure follows
the expanding cavity, which adds sigma_Y/3 per unit of ln(a^2) (Johnson, Eq. 6.38): relative to 1.1
that is 1/3.3. The area grows without piling up, a^2 = R* (2 d - d_Y). Continuity of the force at
d_p: 1 + ln(s)/3.3 = 2.8/1.1, s = exp(5.1), d_p = 82.5; the 84 in print would jump by 0.2 %.

At d = 1 the slope jumps from Hertz's 1.5 to 2 + 2/3.3: up to d = 8 this contact is stiffer than an
elastic one, and up to d = 15 its force is larger. Unloading from just above yield along
f = fm ((d - dr)/(dm - dr))^1.5 with Stronge's dm - dr = sqrt(2 dm - 1) would therefore lie above
the loading curve and return more work than loading took (COR above 1). Here the contact unloads
along the loading curve wherever the printed unloading curve would lie above it; from dm = 2.2 on it
nowhere does.

Legend: d compression, dm the largest so far, dr what remains of it, all in units of d_Y; forces in
units of F_Y; s = 2 d - 1; k = fm/(dm - dr)^1.5, the stiffness of the printed unloading curve.
"""

import math

import numpy as np
from numpy.typing import NDArray

from contactlaw.laws._branches import HERTZ, Array, Loading, Unloading, bisect
from contactlaw.laws._law import Law
from contactlaw.laws.myc import residual  # dm - sqrt(2 dm - 1), over (dm - 1)^2

_C_YIELD = (3.3 / 4.0) ** 2  # d_Y over pi^2 sigma_Y^2 R*/E*^2
_PRESSURES = 2.8 / 1.1  # mean pressure when fully plastic, over that at yield
_P = 0.5 * (math.exp(3.3 * (_PRESSURES - 1.0)) + 1.0)  # d_p


def _elastic_plastic(d: Array) -> Array:
    s = 2.0 * d - 1.0
    return s * (1.0 + np.log(s) / 3.3)


def _work(d: Array) -> Array:
    """Integral of the loading curve from 1 on, up to _P."""
    s = 2.0 * d - 1.0
    return 0.25 * (s * s - 1.0) + (s * s * (2.0 * np.log(s) - 1.0) + 1.0) / (8.0 * 3.3)


def _log_stiffness(dm: Array) -> Array:
    """Logarithm of k, accurate next to dm = 1, where k is 1; dm - dr is sqrt(s)."""
    log = np.log(2.0 * dm - 1.0)
    return 0.25 * log + np.log1p(log / 3.3)


def _cap_low(dm: Array) -> Array:
    """Compression at which k (d - dr)^1.5 meets Hertz's d^1.5."""
    dr = residual(dm) * (dm - 1.0) ** 2
    return dr * np.exp(2.0 / 3.0 * _log_stiffness(dm)) / np.expm1(2.0 / 3.0 * _log_stiffness(dm))


def _cap_high(dm: Array) -> Array:
    """Compression, between 1 and dm, from which the printed curve lies above the loading curve."""
    dr, stiffness = residual(dm) * (dm - 1.0) ** 2, np.exp(_log_stiffness(dm))
    return np.asarray(bisect(lambda d: stiffness * (d - dr) ** 1.5 > _elastic_plastic(d), np.ones_like(dm), dm))


def _loss_below(dm: Array) -> Array:
    """Area between the curves below `_cap_low`: 0.4 low^2.5 (1 - k (1 - dr/low)^2.5)."""
    low = _cap_low(dm)
    left = residual(dm) * (dm - 1.0) ** 2 / low
    return np.asarray(-0.4 * low**2.5 * np.expm1(_log_stiffness(dm) + 2.5 * np.log1p(-left)))


def _loss_next_to_yield(dm: Array) -> Array:
    """`_loss_below` over (dm - 1)^3.5: its low and its bracket both begin as dm - 1."""
    return _loss_below(dm) / (dm - 1.0) ** 3.5


def _loss_between(dm: Array) -> Array:
    """Area between the curves below `_cap_low` and above `_cap_high`."""
    high, dr = _cap_high(dm), residual(dm) * (dm - 1.0) ** 2
    back = 0.4 * np.exp(_log_stiffness(dm)) * ((dm - dr) ** 2.5 - (high - dr) ** 2.5)
    return _loss_below(dm) + (_work(dm) - _work(high) - back)


def _unloading_is_flatter(dm: Array) -> NDArray[np.bool_]:
    """Whether the printed unloading curve is flatter than the loading curve at dm."""
    s = 2.0 * dm - 1.0
    return 1.5 * _elastic_plastic(dm) / np.sqrt(s) < 2.0 * (1.0 + np.log(s) / 3.3) + 2.0 / 3.3


LEAVES_AT_ONCE = float(bisect(_unloading_is_flatter, 1.01, 2.2))
"""From this dm on unloading leaves the loading curve at once, and meets it again."""
UNCAPPED = float(bisect(lambda dm: _cap_low(dm) < 1.0, 1.01, 3.0))
"""From this dm on the printed unloading curve nowhere lies above the loading curve."""


LAW = Law.of(
    name="stronge",
    source="Stronge, Impact Mechanics (2000), chapter 6; d_p by continuity, see the module",
    yield_coefficient=_C_YIELD,
    loading=[Loading(0.0, HERTZ), Loading(1.0, _elastic_plastic), Loading(_P, lambda d: _PRESSURES * (2.0 * d - 1.0))],
    unloading=[
        Unloading(1.0, residual, loss=_loss_next_to_yield, order=2.0, loss_order=3.5, cap=(_cap_low, None)),
        Unloading(LEAVES_AT_ONCE, residual, loss=_loss_between, order=2.0, cap=(_cap_low, _cap_high)),
        Unloading(UNCAPPED, residual, order=2.0),
    ],
)
