"""Closed forms of the COR from the literature: corrected where they are misprinted, and as printed.

Arguments are dimensionless, numbers or arrays that broadcast; they are not checked against the ranges
that the functions state. With the yield speed V_Y0 of the sphere on a half-space (`Pair.yield_speed`,
where the plate does not yield first):

    v        V0/V_Y0
    lam      lambda, the inelasticity (Eq. 2 with the exponent 2/5); grows as the fifth root of speed
    lam_y    lambda_Y, its value at V_Y0: lambda = lambda_Y v^(1/5)
    ratio    R/H; with the pair's eta (Eq. 10 corrected), lambda_Y = eta (R/H)^2

Equation numbers are those of Peng, Jin, Liu, Wei, Int. J. Solids Struct. 222-223 (2021) 111036;
`eq_N` is an equation as it is printed. The plastic forms are those of the `myc` law, d_P/d_Y = P,
unless another law is named. Errors of the forms are relative, against the solver, unless they say
otherwise.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw.equation import zener as _zener
from contactlaw.equation.force import HERTZ
from contactlaw.laws import law
from contactlaw.physical.pair import Pair
from contactlaw.physical.scaling import constants_of
from validation.paper.turning_point import WAVE_SLOPE, at_turning_point

Array = NDArray[np.float64]

_RTOL = 1e-11  # relative tolerance of the integrations here
_THORNTON = math.sqrt(1.2 * math.sqrt(3.0))
_C = 0.0935  # coefficient of (R/H)^2 in the exponent of Eq. 22


def eta(pair: Pair) -> float:
    """Inelasticity at yield of a sphere as large as the plate is thick, Eq. 10 corrected.

    lambda_Y = eta (R/H)^2. Eq. 10 prints pi^3 for pi^(3/5), and 4/5 for the exponent 2/5 of
    E1'/(E1' + E2'). A sphere without a yield strength is a ValueError.

    Examples
    --------
    >>> import contactlaw as cl
    >>> round(eta(cl.Pair("gamma-alumina", "glass")), 4)
    0.0751
    """
    pair.sphere.require_yield_strength("myc")
    elastic = dataclasses.replace(pair.plate, yield_strength=None)  # V_Y0 is the sphere's
    at_one = constants_of(pair, law("myc")).plate.inelasticity  # lambda at 1 m/s
    return at_one * math.pow(Pair(pair.sphere, elastic).yield_speed, 0.2)


def mueller(lam: ArrayLike) -> Array:
    """COR of an elastic impact with a linearised force, Eq. 3, for lambda from 0 to 2.

    exp(-pi lambda/sqrt(4 - lambda^2)): a damped oscillator in place of Hertz's contact (Mueller et
    al., Chem. Eng. Sci. 138 (2015) 689). 2.4 % above `zener` at lambda = 0.25, 11 % below at 1. At
    2 the oscillator is damped critically, and the sphere stays.

    Examples
    --------
    >>> mueller([0.1, 0.25]).round(4)
    array([0.8545, 0.6731])
    """
    lam = np.asarray(lam, dtype=np.float64)
    with np.errstate(divide="ignore"):  # at 2
        return np.asarray(np.exp(-math.pi * lam / np.sqrt(4.0 - lam**2)))


def raman(lam: ArrayLike) -> Array:
    """COR of an elastic impact, Raman's form (1 - k lambda)/(1 + k lambda), up to lambda = 1/k.

    Raman (Phys. Rev. 15 (1920) 277) takes the wave's energy to be k lambda times what the sphere
    brings and what it takes away. Here k = `WAVE_SLOPE`/2 = 0.8651, which makes the slope at
    lambda = 0 exact. 0.3 % below `zener` at lambda = 0.1, 2.0 % at 0.25; at 1/k the sphere stays.

    Examples
    --------
    >>> raman([0.1, 0.25]).round(4)
    array([0.8408, 0.6444])
    """
    loss = 0.5 * WAVE_SLOPE * np.asarray(lam)
    return np.asarray((1.0 - loss) / (1.0 + loss))


def zener(lam: ArrayLike) -> Array:
    """COR of an elastic impact by integration of Zener's equation, Eq. 5: no closed form.

    Within 1e-11 absolutely, 1e-7 relatively: at lambda = 100 the COR is 7e-11.

    Examples
    --------
    >>> zener([0.1, 0.25]).round(4)
    array([0.8433, 0.6577])
    """
    return np.asarray(np.vectorize(lambda one: _zener.solve(HERTZ, one, 1.0, _RTOL).restitution, otypes=[float])(lam))


def elastic_compression(lam: ArrayLike) -> Array:
    """Largest compression w_m of an elastic impact [V0 T_H], by integration, within 3e-11: Fig. 4.

    Examples
    --------
    >>> elastic_compression([0.0, 0.5]).round(4)
    array([1.0934, 0.8257])
    """
    return np.vectorize(  # type: ignore[no-any-return]
        lambda one: _zener.solve(HERTZ, one, 1.0, _RTOL).peak_compression, otypes=[float]
    )(lam)


def eq_6(lam: ArrayLike) -> Array:
    """Largest compression w_m of an elastic impact [V0 T_H]: w_m^-1.5 = lambda + (5/4)^(-3/5).

    Up to 3.1 % below `elastic_compression`.

    Examples
    --------
    >>> eq_6([0.0, 0.5]).round(4)
    array([1.0934, 0.8088])
    """
    return np.asarray((np.asarray(lam) + 1.25**-0.6) ** (-2.0 / 3.0))


def yield_speed_ratio(lam_y: ArrayLike) -> Array:
    """Speed V_Y/V_Y0 from which the sphere yields on a plate, for lambda_Y up to 5: Fig. 6.

    At it the integrated impact just reaches d_Y; within 1e-10.

    Examples
    --------
    >>> yield_speed_ratio([0.0, 0.2434]).round(4)
    array([1.    , 1.2156])
    """
    lam_y = np.asarray(lam_y, dtype=np.float64)
    x = eq_14(lam_y)
    for _ in range(30):  # the slope of the logarithms lies between 2/3 and 4/5
        w_m = elastic_compression(lam_y * x**0.2)
        x = x * (1.25**-0.4 * x**0.8 * w_m) ** (-1.0 / 0.75)
    return x


def eq_14(lam_y: ArrayLike) -> Array:
    """Speed V_Y/V_Y0 from which the sphere yields on a plate: q + (1 + q)^(-1/5).

    lambda_Y = (4/5)^(3/5) q. Above `yield_speed_ratio` by 1.2 % at lambda_Y = 0.243, by 4.3 % at
    2.3, which is most.

    Examples
    --------
    >>> eq_14([0.0, 0.2434]).round(4)
    array([1.    , 1.2304])
    """
    q = 1.25**0.6 * np.asarray(lam_y)
    return np.asarray(q + (1.0 + q) ** -0.2)


def thornton(v: ArrayLike) -> Array:
    """COR on a half-space with the `thornton` law, in closed form (Thornton 1997, Eq. 22): exact.

    V_Y0 is the yield speed of that law; up to it, impacts are elastic. With x = V_Y0/V0,
    e = (6 sqrt(3)/5)^(1/2) (1 - x^2/6)^(1/2) (x/(x + 2 sqrt(6/5 - x^2/5)))^(1/4).

    Examples
    --------
    >>> thornton([1.0, 5.0]).round(4)
    array([1.    , 0.7733])
    """
    x = 1.0 / np.maximum(v, 1.0)
    share = x / (x + 2.0 * np.sqrt(1.2 - 0.2 * x**2))
    return np.asarray(_THORNTON * np.sqrt(1.0 - x**2 / 6.0) * share**0.25)


def half_space(v: ArrayLike) -> Array:
    """COR on a half-space, exactly: Eq. 21, and its continuation to where loading is linear.

    That is from v = P^(5/4) = 4.19 on, where loading leaves Hertz's curve.

    Examples
    --------
    >>> half_space([2.0, 10.0]).round(4)
    array([0.9513, 0.7042])
    """
    v = np.maximum(v, 1.0)
    force, span = at_turning_point(v**0.8)
    return np.asarray(np.sqrt(force * span) / v)


def eq_21(v: ArrayLike) -> Array:
    """COR on a half-space, (1 - (1 - v^(-4/5))^2)^(1/4).

    Exact up to v = (d_P/d_Y)^(5/4) = 4.19; above `half_space` by 2.0 % at v = 7, 4.4 % at 10.

    Examples
    --------
    >>> eq_21([2.0, 10.0]).round(4)
    array([0.9513, 0.735 ])
    """
    return np.asarray((1.0 - (1.0 - np.maximum(v, 1.0) ** -0.8) ** 2) ** 0.25)


def peng(v: ArrayLike, ratio: ArrayLike, eta: float) -> Array:
    """COR of an elastic-plastic impact on a plate, Eq. 22 made continuous.

    The plastic branch, printed without, has the elastic COR at yield as a factor: Eq. 3 with lambda
    at V_Y = g V_Y0, g by Eq. 14. A fit shows that the printed coefficient belongs to the form with
    the factor (see ``validation/derivations/errata.md``). Within 4.1 % of the solver for the paper's
    pair, R/H <= 1.8 and v <= 7; 24 % for v <= 20 and lambda_Y <= 0.5.

    Examples
    --------
    >>> peng(3.0, [0.9, 1.8], eta=0.0751).round(4)
    array([0.8005, 0.5666])
    """
    v, ratio = np.asarray(v, dtype=np.float64), np.asarray(ratio, dtype=np.float64)
    lam_y = eta * ratio**2
    g = eq_14(lam_y)
    elastic = mueller(lam_y * np.minimum(v, g) ** 0.2)  # at yield, where v is beyond
    plastic = (1.0 - (1.0 - np.maximum(v / g, 1.0) ** -0.8) ** 2) ** (0.25 + _C * ratio**2)
    return np.asarray(elastic * plastic)


def eq_22(v: ArrayLike, ratio: ArrayLike, eta: float) -> Array:
    """COR of an elastic-plastic impact on a plate, whose plastic branch jumps to 1 at yield.

    Within 56 % of the solver for the paper's pair, R/H <= 1.8 and v <= 7; up to a factor of 3 too
    high for v <= 20 and lambda_Y <= 0.5.

    Examples
    --------
    >>> eq_22(3.0, [0.9, 1.8], eta=0.0751).round(4)
    array([0.8817, 0.8466])
    """
    lam_y = eta * np.square(ratio)
    g = eq_14(lam_y)
    return np.asarray(peng(v, ratio, eta) / np.where(np.greater(v, g), mueller(lam_y * g**0.2), 1.0))


def border(ratio: ArrayLike) -> Array:
    """Speed V0/V_Y0 at which plastic and wave loss are equal, Eq. 23: (1 + 1.001 (R/H)^2)^(5/2).

    The fit was made over R/H from 0 to 1.2, for gamma-alumina on glass. For that pair 10 % low at
    R/H = 0.2 to 0.3, within 5.1 % from 0.5 to 1, 7 % low at 1.2.

    Examples
    --------
    >>> round(float(border(0.5)), 3)
    1.748
    """
    return np.asarray((1.0 + 1.001 * np.square(ratio)) ** 2.5)


def stronge(compression: Array) -> Array:
    """Stronge's force [F_Y of MYC] at compressions [d_Y of MYC] while they grow.

    Stronge, Impact Mechanics (2000), chapter 6, in units of its own yield, with s = 2 d - 1:
    f = s (1 + ln(s)/3.3) from d = 1 on, and f = (2.8/1.1) s from where both are equal, at 82.5 (the
    84 in print would jump by 0.2 %). The mean pressure is 1.1 sigma_Y at yield and 2.8 sigma_Y when
    fully plastic (Johnson, Contact Mechanics, 1985, section 6.3).
    """
    unit = 3.3**2 / 16.0 / 0.68  # yield compression over that of MYC
    d = compression / unit
    s = np.maximum(2.0 * d - 1.0, 1.0)
    return np.asarray(unit**1.5 * np.where(d < 1.0, d**1.5, s * np.minimum(1.0 + np.log(s) / 3.3, 2.8 / 1.1)))
