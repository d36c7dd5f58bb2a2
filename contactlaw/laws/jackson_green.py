"""Jackson & Green: hardness that falls as the contact grows; Etsion's unloading.

Jackson, Green, J. Tribol. 127 (2005) 343, in units of yield, with e_y = sigma_Y/E*:

    f = d^1.5                                                                      d < 1.9
    f = exp(-d^(5/12)/4) d^1.5 + (4 h/C) (1 - exp(-d^(5/9)/25)) d                  d >= 1.9
    h = H_G/sigma_Y = 2.84 (1 - exp(-0.82 (a/R)^-0.7))
    a/R = (pi C e_y/2) sqrt(d) (d/1.9)^(B/2),   B = 0.14 exp(23 e_y),   C = 1.295 exp(0.736 nu)

d_Y = (pi C sigma_Y/(2 E*))^2 R*, a coefficient of C^2/4. As printed the force jumps at d = 1.9,
by +7 % for nu = 0, +0.5 % for 0.3 and -3 % for 0.5. Here the second form takes over where it meets
Hertz's curve: at 4.1, 2.0 and 1.26 for stiff pairs, at 2.13 for the paper's.

Fitted for e_y from 0.001 to 0.008 or so; the paper's pair has 0.043.

Legend: d compression, dm the largest so far, in units of d_Y; forces in units of F_Y; q = sqrt(d)
while loading.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np

from contactlaw._jit import kernel
from contactlaw.laws import Law, _etsion

PARAMETERS = ("modulus_ratio", "poissons_ratio")

_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(24)  # 1e-13 of the loading work up to d = 200
_SOFTEST = 10.0  # E*/sigma_Y; our choice: contact radii above R at a few d_Y
_LARGEST = 200.0  # force has to rise up to here


@functools.cache
def law(modulus_ratio: float, poissons_ratio: float) -> Law:
    """Law of a pair with these E*/sigma_Y and Poisson's ratio of the sphere."""
    c = 1.295 * math.exp(0.736 * poissons_ratio)
    half_b = 0.07 * math.exp(23.0 / modulus_ratio)
    radius_at_yield = 0.5 * math.pi * c / modulus_ratio / 1.9**half_b

    @kernel
    def plastic(d: float) -> float:
        radius = radius_at_yield * d ** (0.5 + half_b)
        hardness = -2.84 * math.expm1(-0.82 * radius**-0.7)
        elastic = math.exp(-0.25 * d ** (5 / 12)) * d * math.sqrt(d)
        return elastic - 4.0 / c * hardness * math.expm1(-0.04 * d ** (5 / 9)) * d

    first = _meeting(plastic, modulus_ratio, poissons_ratio)
    root_first = math.sqrt(first)

    @kernel
    def loading(q: float) -> float:
        return q * q * q if q < root_first else plastic(q * q)

    @kernel
    def loading_work(d: float) -> float:
        work = 0.4 * math.pow(min(d, first), 2.5)
        if d > first:  # by Gauss in ln d
            half = 0.5 * math.log(d / first)
            for k in range(_PLACES.size):
                at = first * math.exp(half * (1.0 + _PLACES[k]))
                work += half * _WEIGHTS[k] * at * plastic(at)
        return work

    @kernel
    def unloading_curve(dm: float) -> tuple[float, float]:
        return _etsion.unloading_curve(dm, loading(math.sqrt(dm)))

    @kernel
    def dissipation(dm: float) -> float:
        return _etsion.dissipation(dm, loading(math.sqrt(dm)), loading_work(dm))

    return Law(
        name=f"jackson_green({modulus_ratio:.6g},{poissons_ratio:.6g})",
        source="Jackson, Green, J. Tribol. 127 (2005) 343, joined continuously; unloading of "
        "Etsion, Kligerman, Kadin, Int. J. Solids Struct. 42 (2005) 3716",
        yield_coefficient=0.25 * c * c,
        loading_kinks=(first,),
        unloading_kinks=_etsion.KINKS,
        loading=loading,
        residual=_etsion.residual,
        unloading_curve=unloading_curve,
        unloading=_etsion.unloading,
        dissipation=dissipation,
        yield_strains=(0.0, 1 / 60),
    )


def _meeting(
    plastic: Callable[[float], float], modulus_ratio: float, poissons_ratio: float
) -> float:
    """Compression at which the plastic form falls below Hertz's curve."""
    low, high = _etsion.KINKS[-1], 10.0
    force = np.array([plastic(d) for d in np.geomspace(high, _LARGEST, 200)])
    above, below = (plastic(d) > d**1.5 for d in (low, high))
    if modulus_ratio < _SOFTEST:
        raise ValueError(
            f"law: 'jackson_green' with E*/sigma_Y = {modulus_ratio:g}: must be {_SOFTEST:g} or "
            "more, it was fitted above 120; take another law"
        )
    if not above or below or (np.diff(force) <= 0.0).any():
        raise ValueError(
            f"law: 'jackson_green' with E*/sigma_Y = {modulus_ratio:g} and Poisson's ratio "
            f"{poissons_ratio:g} does not leave Hertz's curve after yield and rise: it was fitted "
            "for E*/sigma_Y above 120; take another law"
        )
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if plastic(middle) > middle**1.5 else (low, middle)
    return low
