"""The largest compression w_m of an impact that just yields: a polynomial in x for each law.

A law whose loading curve begins as Hertz's has the same w_m at all speeds below yield. One that is
stiffer has the loading work W(1) = 0.4/(1 - h) up to yield [F_Y d_Y], with h = 0 for Hertz's, and
acts as a Hertz contact of this work would: with lam' = lam (1 - h)^-0.4 and x = lam'/(lam' + 3)

    ln w_m = 0.4 ln(1.25 (1 - h)) + 2/3 ln(1 - x) + x (sum of c_ij h^i t^j),    t = 2.5 x - 1

The first term is exact for lam = 0; the second has the power with which w_m falls for large lam.
The sum was fitted to impacts under loading curves q^3 (1 + s q), integrated with an error of 1e-13
a step. Up to lam' = 12, where t is 1, ln w_m is within 4e-12 for Hertz's law, 6e-9 up to h = 0.06,
4e-7 up to h = 0.85. For larger lam' the sum keeps its value at t = 1, and w_m is within 5 %. For a
curve with higher powers of q it may err by 1 %. No rebound depends on it: w_m only makes the
overload.

Legend, as in `contactlaw.equation.zener`: lam inelasticity parameter lambda, w_m in V0 T_H.
"""

import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.force import BlendedLaw

_HALF = 3.0  # lam' at which x is 1/2
_DEGREES = np.array([16, 9, 7, 5, 3])  # of the polynomials in t, one for each power of h
_COEFFICIENTS = np.array(
    [
        -1.05309299172,
        0.236840570871,
        -0.0775610360321,
        0.0257709295179,
        -0.0100198589979,
        0.00367499432208,
        -0.00154922625697,
        0.000587833121799,
        -0.000264273519463,
        9.95622150578e-05,
        -4.58091060717e-05,
        1.79683917725e-05,
        -1.21438794163e-05,
        2.51917652816e-06,
        7.21195796599e-07,
        8.57342347159e-07,
        -1.42466937998e-06,
        -0.211822517,
        0.0762119709,
        -0.0274317445,
        0.0112439302,
        -0.00437576744,
        0.0018218584,
        -0.000676156913,
        0.000356533169,
        -0.000201989367,
        7.15213975e-05,
        0.00349793966,
        0.0139254816,
        -0.00756802879,
        0.00325493369,
        -0.00140843513,
        0.00084491684,
        -0.000575115411,
        0.000148121004,
        0.00219166796,
        -0.0022357261,
        -0.00120156006,
        0.00122911888,
        -0.000862555774,
        0.000312586496,
        -0.000508905259,
        -1.61784515e-05,
        0.000516079631,
        -0.00011221845,
    ]
)


@kernel
def compression(law: BlendedLaw, lam: float) -> float:
    """Largest compression of an impact that just yields."""
    softer = 0.4 / force.work_at_yield(law)  # 1 - h
    like_hertz = lam * softer**-0.4
    x, power, total, at = like_hertz / (like_hertz + _HALF), 1.0, 0.0, 0
    t = min(2.5 * x - 1.0, 1.0)
    for row in range(_DEGREES.size):
        value = 0.0
        for n in range(_DEGREES[row], -1, -1):
            value = value * t + _COEFFICIENTS[at + n]
        total += power * value
        power *= 1.0 - softer
        at += _DEGREES[row] + 1
    return float(math.exp(0.4 * math.log(1.25 * softer) + x * total) * (1.0 - x) ** (2.0 / 3.0))


@kernel(cache=True)
def fill(laws: Array, lam: Array, strength: Array, out: Array) -> None:
    """`compression` of many impacts, under the law of each one's strength."""
    for n in range(lam.size):
        out[n] = compression(force.at_strength(laws, strength[n]), lam[n])
