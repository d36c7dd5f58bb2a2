"""Kogut & Etsion: two power laws fitted to finite elements; Etsion's unloading.

Kogut, Etsion, J. Appl. Mech. 69 (2002) 657, in units of yield, for d up to 110:

    f = d^1.5       d < 1
    f = 1.03 d^1.425    1 <= d <= 6       f = 1.40 d^1.263    6 <= d <= 110

As printed the force jumps by 3 % at d = 1 and by 1.7 % at d = 6. Here each branch begins where it
meets the one before: at 1.03^(1/0.075) = 1.483 and (1.40/1.03)^(1/0.162) = 6.65.

d_Y = (pi K H/(2 E*))^2 R* with the hardness H = 2.8 sigma_Y and K = 0.454 + 0.41 nu (Chang, Etsion,
Bogy, J. Tribol. 109 (1987) 257): a coefficient of (1.4 K)^2. Their flat is rigid; here E* accounts
for an elastic one.

Legend: d compression in units of d_Y; forces in units of F_Y.
"""

import functools

from contactlaw.laws import _etsion
from contactlaw.laws._branches import HERTZ, Loading
from contactlaw.laws._law import Law

PARAMETERS = ("poissons_ratio",)

_FIRST: float = 1.03 ** (1 / 0.075)
_SECOND: float = (1.40 / 1.03) ** (1 / 0.162)


@functools.lru_cache(maxsize=64)  # a fit to measurements makes a law for every trial
def law(poissons_ratio: float) -> Law:
    """Law of a sphere with this Poisson's ratio."""
    return Law.of(
        name="kogut_etsion",
        parameters={"poissons_ratio": poissons_ratio},
        source="Kogut, Etsion, J. Appl. Mech. 69 (2002) 657, joined continuously; unloading of "
        "Etsion, Kligerman, Kadin, Int. J. Solids Struct. 42 (2005) 3716",
        yield_coefficient=(1.4 * (0.454 + 0.41 * poissons_ratio)) ** 2,
        loading=[
            Loading(0.0, HERTZ),
            Loading(_FIRST, lambda d: 1.03 * d**1.425),
            Loading(_SECOND, lambda d: 1.40 * d**1.263),
        ],
        unloading=_etsion.UNLOADING,
        yield_strains=(0.0, 1 / 60),
    )
