"""MYC: elastic, then linear plastic loading; Hertz-like unloading to a residual compression.

Majeed, Yigit, Christoforou, Compos. Part B 43 (2012) 1244; as used by Peng, Jin, Liu, Wei,
Int. J. Solids Struct. 222-223 (2021) 111036, Eqs. 16-18 (with the misprints of the Hertz branches
and of d_r mended).

Legend: d compression, dm the largest so far, dr what remains of it, all in units of d_Y; forces in
units of F_Y; q = sqrt(d); P = d_P/d_Y, where loading leaves Hertz's curve along its tangent.
Between d = 1 and P only the unloading is plastic.
"""

import math

import numpy as np
from numpy.polynomial import Polynomial

from contactlaw.laws._branches import HERTZ, Array, Loading, Unloading
from contactlaw.laws._law import Law

C_YIELD = 0.68  # Eq. 18, d_Y = 0.68 pi^2 sigma_Y^2 R*/E*^2
C_PLASTIC = 2.14  # Eq. 18, d_P = 2.14 pi^2 sigma_Y^2 R*/E*^2
P = C_PLASTIC / C_YIELD


def residual(dm: Array) -> Array:
    """Eq. 17, dm - sqrt(2 dm - 1), over (dm - 1)^2."""
    return 1.0 / (dm + np.sqrt(2.0 * dm - 1.0))


def _loss(dm: Array) -> Array:
    """0.4 dm^2.5 - 0.4 dm^1.5 (dm - dr) below P, over (dm - 1)^2."""
    return 0.4 * dm**1.5 * residual(dm)


LAW = Law.of(
    name="myc",
    source="Majeed, Yigit, Christoforou 2012; Peng et al. 2021, Eqs. 16-18",
    yield_coefficient=C_YIELD,
    loading=[
        Loading(0.0, HERTZ),
        Loading(P, Polynomial([-0.5 * P**1.5, 0.0, 1.5 * math.sqrt(P)])),  # Eq. 16, phase 2
    ],
    unloading=[Unloading(1.0, residual, loss=_loss, order=2.0, loss_order=2.0), Unloading(P, residual, order=2.0)],
    yield_strains=(1 / 40, 1 / 20),
)
