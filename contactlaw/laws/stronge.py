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
the loading curve and return more work than loading took (COR above 1). Here the contact goes back
along the loading curve wherever the printed unloading curve would lie above it; from dm = 2.2 on it
nowhere does.

Legend: d compression, dm the largest so far, dr what remains of it, all in units of d_Y; forces in
units of F_Y; q = sqrt(d) while loading and sqrt(d - dr) while unloading.
"""

from __future__ import annotations

import math

from contactlaw._jit import kernel
from contactlaw.laws import Law, myc

_C_YIELD = (3.3 / 4.0) ** 2  # of pi^2 sigma_Y^2 R*/E*^2
_PRESSURES = 2.8 / 1.1  # fully plastic over yield
_S_PLASTIC = math.exp(3.3 * (_PRESSURES - 1.0))
_P = 0.5 * (_S_PLASTIC + 1.0)
_residual = myc.LAW.residual  # dm - sqrt(2 dm - 1)


@kernel
def _loading(q: float) -> float:
    """At d = q^2."""
    if q < 1.0:
        return q * q * q
    s = 2.0 * q * q - 1.0
    return s * (1.0 + math.log(s) / 3.3) if s < _S_PLASTIC else _PRESSURES * s


@kernel
def _loading_work(d: float) -> float:
    """Integral of the loading curve."""
    if d < 1.0:
        return 0.4 * d * d * math.sqrt(d)
    s = 2.0 * d - 1.0
    e = min(s, _S_PLASTIC)
    work = 0.4 + 0.25 * (e * e - 1.0) + (e * e * (2.0 * math.log(e) - 1.0) + 1.0) / (8.0 * 3.3)
    return work + 0.25 * _PRESSURES * (s * s - e * e)


@kernel
def _unloading_curve(dm: float) -> tuple[float, float]:
    """Stiffness fm/(dm - dr)^1.5, and dr."""
    dr = _residual(dm)
    span = dm - dr
    return _loading(math.sqrt(dm)) / (span * math.sqrt(span)), dr


@kernel
def _unloading(q: float, stiffness: float, dr: float) -> float:
    """At d = dr + q^2: the printed curve, or the loading curve where that is lower."""
    return min(stiffness * (q * q * q), _loading(math.sqrt(dr + q * q)))


@kernel
def _parting(dm: float, stiffness: float, dr: float) -> tuple[float, float]:
    """Compressions between which the printed unloading curve would lie above the loading curve."""
    ratio = stiffness ** (2.0 / 3.0)
    if ratio * (1.0 - dr) <= 1.0:  # it does so at d = 1 if anywhere
        return dm, dm
    low, high = 1.0, dm
    if 1.5 * stiffness * math.sqrt(dm - dr) * (2.0 * dm - 1.0) > 2.0 * _loading(math.sqrt(dm)) + (
        2.0 / 3.3
    ) * (2.0 * dm - 1.0):  # steeper than loading at dm: they cross once more
        for _ in range(60):
            middle = 0.5 * (low + high)
            above = stiffness * (middle - dr) ** 1.5 > _loading(math.sqrt(middle))
            low, high = (middle, high) if above else (low, middle)
    return ratio * dr / (ratio - 1.0), high


@kernel
def _dissipation(dm: float) -> float:
    """Area between loading and unloading, on either side of the stretch where they are one."""
    if dm <= 1.0:
        return 0.0
    stiffness, dr = _unloading_curve(dm)
    low, high = _parting(dm, stiffness, dr)
    below = _loading_work(low) - 0.4 * stiffness * math.pow(low - dr, 2.5)
    above = 0.4 * stiffness * (math.pow(dm - dr, 2.5) - math.pow(high - dr, 2.5))
    return below + (_loading_work(dm) - _loading_work(high) - above)


LAW = Law(
    name="stronge",
    source="Stronge, Impact Mechanics (2000), chapter 6; d_p by continuity, see the module",
    yield_coefficient=_C_YIELD,
    loading_kinks=(1.0, _P),
    unloading_kinks=(1.0,),
    loading=_loading,
    residual=_residual,
    unloading_curve=_unloading_curve,
    unloading=_unloading,
    dissipation=_dissipation,
)
