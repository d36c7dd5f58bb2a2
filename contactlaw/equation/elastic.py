"""The largest compression w_m of an impact that just yields: a polynomial in x for each law.

A law whose loading curve begins as Hertz's has the same w_m at all speeds below yield. One that is
stiffer has the loading work W(1) = 0.4/(1 - h) up to yield [F_Y d_Y], with h = 0 for Hertz's, and
acts as a Hertz contact of this work would: with lam' = lam (1 - h)^-0.4 and x = lam'/(lam' + 3)

    ln w_m = 0.4 ln(1.25 (1 - h)) + 2/3 ln(1 - x) + x (sum of c_ij h^i x^j)

The first term is exact for lam = 0; the second has the power with which w_m falls for large lam.
The sum was fitted to impacts under loading curves q^3 (1 + s q), integrated with an error of 1e-13
a step: ln w_m is within 1.1e-6 up to lam' = 12 and h = 0.85, and within 4e-5 beyond. For a curve
with higher powers of q it may err by 0.5 %. No rebound depends on it: w_m only makes the overload.

Legend, as in `contactlaw.equation.zener`: lam inelasticity parameter lambda, w_m in V0 T_H.
"""

import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation import force

_HALF = 3.0  # lam' at which x is 1/2
_SERIES = np.array(  # rows: powers of h; columns: powers of x
    [
        [-1.40965113, 1.36600028, -1.92575575, 3.09994068, -4.99004044, 6.61936002, -6.14168231, 3.38402824]
        + [-0.823570307],
        [-0.334176038, 0.497772508, -0.774604581, 1.05462439, -0.900254636, 0.0293106854, 0.87934868, -0.863860929]
        + [0.278434921],
        [-0.0240893232, 0.130042023, -0.255942058, 0.437348079, -0.673074325, 0.85565986, -0.801243145, 0.469177794]
        + [-0.124658918],
        [0.000792355213, 0.0223936904, -0.116094492, 0.274554483, -0.430013103, 0.466393608, -0.326144083, 0.123559327]
        + [-0.0168794594],
    ]
)


@kernel
def compression(law: Array, lam: float) -> float:
    """Largest compression of an impact that just yields."""
    softer = 0.4 / force.work_at_yield(law)  # 1 - h
    own = lam * softer**-0.4
    x, log_w, power = own / (own + _HALF), 0.4 * math.log(1.25 * softer), 1.0
    for row in range(_SERIES.shape[0]):
        total = 0.0
        for column in range(_SERIES.shape[1] - 1, -1, -1):
            total = total * x + _SERIES[row, column]
        log_w += power * x * total
        power *= 1.0 - softer
    return math.exp(log_w) * (1.0 - x) ** (2.0 / 3.0)


@kernel(cache=True)
def fill(laws: Array, lam: Array, strength: Array, out: Array) -> None:
    """`compression` of many impacts, under the law of each one's strength."""
    room = np.empty(force.room_for(laws))
    for n in range(lam.size):
        law = laws if room.size == 0 else force.at_strength(laws, strength[n], room)
        out[n] = compression(law, lam[n])
