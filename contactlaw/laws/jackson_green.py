"""Jackson & Green: hardness that falls as the contact grows; Etsion's unloading.

Jackson, Green, J. Tribol. 127 (2005) 343, in units of yield, with e_y = sigma_Y/E*:

    f = d^1.5                                                                      d < 1.9
    f = exp(-d^(5/12)/4) d^1.5 + (4 h/C) (1 - exp(-d^(5/9)/25)) d                  d >= 1.9
    h = H_G/sigma_Y = 2.84 (1 - exp(-0.82 (a/R)^-0.7))
    a/R = (pi C e_y/2) sqrt(d) (d/1.9)^(B/2),   B = 0.14 exp(23 e_y),   C = 1.295 exp(0.736 nu)

d_Y = (pi C sigma_Y/(2 E*))^2 R*, a coefficient of C^2/4. As printed the force jumps at d = 1.9,
by +7 % for nu = 0, +0.5 % for 0.3 and -3 % for 0.5. Here the second form takes over where it meets
Hertz's curve: at d = 4.1, 2.0 and 1.26 for stiff pairs with these nu, at 2.13 for the paper's pair.

Fitted for e_y from 0.001 to 0.008 or so; the paper's pair has 0.043.

Legend: d compression in units of d_Y; forces in units of F_Y.
"""

import functools
import math

import numpy as np
from numpy.polynomial import Polynomial

from contactlaw._bisect import bisect
from contactlaw._errors import ArgumentError
from contactlaw.laws import _etsion
from contactlaw.laws._branches import END, HERTZ, Array, Formula, Loading
from contactlaw.laws._law import Law

PARAMETERS = ("modulus_ratio", "poissons_ratio")

_SOFTEST = 10.0  # least E*/sigma_Y, our choice: below, contact radii exceed R at a few d_Y
_LARGEST = 200.0  # [d_Y]; the force has to rise up to here


@functools.lru_cache(maxsize=64)  # a fit to measurements makes a law for every trial
def law(modulus_ratio: float, poissons_ratio: float) -> Law:
    """Law of a pair with these E*/sigma_Y and Poisson's ratio of the sphere."""
    if modulus_ratio < _SOFTEST:
        limit = f"must be {_SOFTEST:g} or more"
        reason = f'E*/sigma_Y is {modulus_ratio:g}, {limit} (fitted above 120): take law="fem"'
        raise ArgumentError("law", "jackson_green", reason)
    c = 1.295 * math.exp(0.736 * poissons_ratio)
    half_b = 0.07 * math.exp(23.0 / modulus_ratio)
    radius_at_yield = 0.5 * math.pi * c / modulus_ratio / 1.9**half_b

    def plastic(d: Array) -> Array:
        radius = radius_at_yield * d ** (0.5 + half_b)
        hardness = -2.84 * np.expm1(-0.82 * radius**-0.7)
        elastic = np.exp(-0.25 * d ** (5 / 12)) * d**1.5
        return np.asarray(elastic - 4.0 / c * hardness * np.expm1(-0.04 * d ** (5 / 9)) * d)

    return Law.of(
        name="jackson_green",
        parameters={"modulus_ratio": modulus_ratio, "poissons_ratio": poissons_ratio},
        source="Jackson, Green, J. Tribol. 127 (2005) 343, joined continuously; unloading of "
        "Etsion, Kligerman, Kadin, Int. J. Solids Struct. 42 (2005) 3716",
        yield_coefficient=0.25 * c * c,
        loading=[
            Loading(0.0, HERTZ),
            Loading(_meeting(plastic, modulus_ratio, poissons_ratio), plastic),
            *_tangent(plastic),
        ],
        unloading=_etsion.UNLOADING,
        yield_strains=(0.0, 1 / 60),
    )


def _tangent(plastic: Formula) -> tuple[Loading, ...]:
    """Branch from `_LARGEST` on, for soft pairs whose printed force falls somewhere beyond."""
    if (np.diff(plastic(np.geomspace(_LARGEST, END, 1000))) > 0.0).all():
        return ()
    below, above = plastic(_LARGEST * np.array([1.0 - 1e-5, 1.0 + 1e-5]))
    slope = (above - below) / (2e-5 * _LARGEST)
    start = plastic(np.array(_LARGEST)) - slope * _LARGEST
    return (Loading(_LARGEST, Polynomial([start, 0.0, slope])),)


def _meeting(plastic: Formula, modulus_ratio: float, poissons_ratio: float) -> float:
    """Compression at which the plastic form falls below Hertz's curve."""
    low, high = _etsion.KINK, 10.0
    force = plastic(np.geomspace(high, _LARGEST, 200))
    above, below = (plastic(np.array(d)) > d**1.5 for d in (low, high))
    if not above or below or (np.diff(force) <= 0.0).any():
        raise ArgumentError(
            "law",
            "jackson_green",
            f"with E*/sigma_Y = {modulus_ratio:g} and Poisson's ratio {poissons_ratio:g} it does "
            "not leave Hertz's curve after yield and rise: it was fitted for E*/sigma_Y above "
            '120; take law="fem"',
        )
    return float(bisect(lambda d: plastic(d) > d**1.5, low, high))
