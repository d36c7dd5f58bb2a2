"""Kogut & Etsion: two power laws fitted to finite elements; Etsion's unloading.

Kogut, Etsion, J. Appl. Mech. 69 (2002) 657, in units of yield, for d up to 110:

    f = d^1.5       d < 1
    f = 1.03 d^1.425    1 <= d <= 6       f = 1.40 d^1.263    6 <= d <= 110

As printed the force jumps by 3 % at d = 1 and by 1.7 % at d = 6. Here each branch begins where it
meets the one before: at 1.03^(1/0.075) = 1.483 and (1.40/1.03)^(1/0.162) = 6.65.

d_Y = (pi K H/(2 E*))^2 R* with the hardness H = 2.8 sigma_Y and K = 0.454 + 0.41 nu (Chang, Etsion,
Bogy, J. Tribol. 109 (1987) 257): a coefficient of (1.4 K)^2. Their flat is rigid; with an elastic
one E* takes its place.

Legend: d compression, dm the largest so far, in units of d_Y; forces in units of F_Y; q = sqrt(d)
while loading.
"""

from __future__ import annotations

import functools
import math

from contactlaw._jit import kernel
from contactlaw.laws import Law, _etsion

PARAMETERS = ("poissons_ratio",)

_FIRST: float = 1.03 ** (1 / 0.075)
_SECOND: float = (1.40 / 1.03) ** (1 / 0.162)
_ROOT_FIRST, _ROOT_SECOND = _FIRST**0.5, _SECOND**0.5
# integrals of the branches before each kink, less what the branch after it would have there
_AT_FIRST: float = 0.4 * _FIRST**2.5 - 1.03 / 2.425 * _FIRST**2.425
_AT_SECOND: float = _AT_FIRST + 1.03 / 2.425 * _SECOND**2.425 - 1.40 / 2.263 * _SECOND**2.263


@kernel
def _loading(q: float) -> float:
    """At d = q^2."""
    if q < _ROOT_FIRST:
        return q * q * q
    return 1.03 * math.pow(q, 2.85) if q < _ROOT_SECOND else 1.40 * math.pow(q, 2.526)


@kernel
def _loading_work(d: float) -> float:
    """Integral of the loading curve."""
    if d < _FIRST:
        return 0.4 * math.pow(d, 2.5)
    if d < _SECOND:
        return _AT_FIRST + 1.03 / 2.425 * math.pow(d, 2.425)
    return _AT_SECOND + 1.40 / 2.263 * math.pow(d, 2.263)


@kernel
def _unloading_curve(dm: float) -> tuple[float, float]:
    return _etsion.unloading_curve(dm, _loading(math.sqrt(dm)))


@kernel
def _dissipation(dm: float) -> float:
    return _etsion.dissipation(dm, _loading(math.sqrt(dm)), _loading_work(dm))


@functools.cache
def law(poissons_ratio: float) -> Law:
    """Law of a sphere with this Poisson's ratio."""
    return Law(
        name=f"kogut_etsion({poissons_ratio:.6g})",
        source="Kogut, Etsion, J. Appl. Mech. 69 (2002) 657, joined continuously; unloading of "
        "Etsion, Kligerman, Kadin, Int. J. Solids Struct. 42 (2005) 3716",
        yield_coefficient=(1.4 * (0.454 + 0.41 * poissons_ratio)) ** 2,
        loading_kinks=(_FIRST, _SECOND),
        unloading_kinks=_etsion.KINKS,
        loading=_loading,
        residual=_etsion.residual,
        unloading_curve=_unloading_curve,
        unloading=_etsion.unloading,
        dissipation=_dissipation,
        yield_strains=(0.0, 1 / 60),
    )
