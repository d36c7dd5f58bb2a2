"""Closed forms of the COR from the literature, corrected where they are misprinted.

Arguments are dimensionless. With the yield speed V_Y0 of the sphere on a half-space
(`Pair.yield_speed`, where the plate does not yield first):

    speed_ratio              v = V0/V_Y0
    inelasticity             lambda (Eq. 2 with the exponent 2/5); grows as the fifth root of speed
    inelasticity_at_yield    lambda_Y, its value at V_Y0: lambda = lambda_Y v^(1/5)
    thickness_ratio, eta     R/H, and the pair's eta (Eq. 10 corrected): lambda_Y = eta (R/H)^2

Equation numbers are those of Peng, Jin, Liu, Wei, Int. J. Solids Struct. 222-223 (2021) 111036.
The plastic forms are those of the `myc` law, d_P/d_Y = P, unless another law is named.

Arguments are broadcast. One that is no number, or lies outside the range that its function states,
raises ValueError. Errors of the forms are relative, against the solver, unless they say otherwise.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw.equation import zener as _zener
from contactlaw.equation.force import HERTZ
from contactlaw.laws import law
from contactlaw.physical.arguments import checked, shaped, within
from contactlaw.physical.pair import Pair
from contactlaw.physical.scaling import constants_of
from validation.paper.turning_point import FASTEST, INTEGRATE, LARGEST_AT_YIELD, at_turning_point

Array = NDArray[np.float64]

_RTOL = 1e-11  # relative tolerance of the integrations here
TOO_THIN = "(the plate is far too thin for the model)"
_RATIO = "(it is V0 over the yield speed V_Y0)"


def eta(pair: Pair) -> float:
    """Inelasticity at yield of a sphere as large as the plate is thick, Eq. 10 corrected.

    lambda_Y = eta (R/H)^2. Eq. 10 prints pi^3 for pi^(3/5), and 4/5 for the exponent 2/5 of
    E1'/(E1' + E2').

    Parameters
    ----------
    pair : Pair
        Materials; the sphere has a yield strength.

    Returns
    -------
    float

    Raises
    ------
    TypeError
        If it is no Pair.
    ValueError
        If the sphere has no yield strength.

    Examples
    --------
    >>> import contactlaw as cl
    >>> from validation.paper.closed_form import eta
    >>> round(eta(cl.Pair("gamma-alumina", "glass")), 4)
    0.0751
    """
    if not isinstance(pair, Pair):
        raise TypeError(f"pair: expected a contactlaw.Pair, got {pair!r}")
    pair.sphere.require_yield_strength("myc")
    elastic = dataclasses.replace(pair.plate, yield_strength=None)  # V_Y0 is the sphere's
    at_one = constants_of(pair, law("myc")).plate.inelasticity  # lambda at 1 m/s
    return at_one * math.pow(Pair(pair.sphere, elastic).yield_speed, 0.2)


def mueller(inelasticity: ArrayLike) -> float | Array:
    """COR of an elastic impact with a linearised force, Eq. 3.

    exp(-pi lambda/sqrt(4 - lambda^2)): a damped oscillator in place of Hertz's contact (Mueller et
    al., Chem. Eng. Sci. 138 (2015) 689). 2.4 % above `zener` at lambda = 0.25, 11 % below at 1.

    Parameters
    ----------
    inelasticity : array_like
        lambda, from 0 to 2, where the oscillator is damped critically and the sphere stays.

    Returns
    -------
    float or ndarray of float64

    Examples
    --------
    >>> from validation.paper.closed_form import mueller
    >>> mueller([0.1, 0.25]).round(4)
    array([0.8545, 0.6731])
    """
    lam, shape = checked(inelasticity=(inelasticity, 0.0, 2.0, "(beyond, Eq. 3 has no rebound: take zener)"))
    with np.errstate(divide="ignore"):  # at 2
        return shaped(np.exp(-math.pi * lam / np.sqrt(4.0 - lam**2)), shape)


def zener(inelasticity: ArrayLike) -> float | Array:
    """COR of an elastic impact by integration of Zener's equation, Eq. 5: no closed form.

    Parameters
    ----------
    inelasticity : array_like
        lambda, from 0 to 100.

    Returns
    -------
    float or ndarray of float64
        Within 1e-11 absolutely, 1e-7 relatively: at lambda = 100 the COR is 7e-11.

    Examples
    --------
    >>> from validation.paper.closed_form import zener
    >>> zener([0.1, 0.25]).round(4)
    array([0.8433, 0.6577])
    """
    lam, shape = checked(inelasticity=(inelasticity, 0.0, 100.0, TOO_THIN))
    return shaped(np.array([_zener.solve(HERTZ, one, 1.0, _RTOL).restitution for one in lam]), shape)


def elastic_compression(inelasticity: ArrayLike) -> float | Array:
    """Largest compression w_m of an elastic impact [V0 T_H]: Fig. 4.

    Parameters
    ----------
    inelasticity : array_like
        lambda, from 0 to 100.

    Returns
    -------
    float or ndarray of float64
        By integration, within 3e-11.

    Examples
    --------
    >>> from validation.paper.closed_form import elastic_compression
    >>> elastic_compression([0.0, 0.5]).round(4)
    array([1.0934, 0.8257])
    """
    lam, shape = checked(inelasticity=(inelasticity, 0.0, 100.0, TOO_THIN))
    return shaped(_elastic_compression(lam), shape)


def _elastic_compression(lam: Array) -> Array:
    return np.array([_zener.elastic_compression(HERTZ, one, _RTOL)[1] for one in lam])


def yield_speed_ratio(inelasticity_at_yield: ArrayLike) -> float | Array:
    """Speed V_Y/V_Y0 from which the sphere yields on a plate: Fig. 6.

    Parameters
    ----------
    inelasticity_at_yield : array_like
        lambda_Y, from 0 to 5.

    Returns
    -------
    float or ndarray of float64
        At which the integrated impact just reaches d_Y; within 1e-10.

    Examples
    --------
    >>> from validation.paper.closed_form import yield_speed_ratio
    >>> yield_speed_ratio([0.0, 0.2434]).round(4)
    array([1.    , 1.2156])
    """
    lam_y, shape = checked(inelasticity_at_yield=(inelasticity_at_yield, 0.0, 5.0, TOO_THIN))
    x = approximate_yield_speed_ratio(lam_y)
    for _ in range(30):  # the slope of the logarithms lies between 2/3 and 4/5
        w_m = _elastic_compression(lam_y * x**0.2)
        x = x * (1.25**-0.4 * x**0.8 * w_m) ** (-1.0 / 0.75)
    return shaped(x, shape)


def approximate_yield_speed_ratio(lam_y: Array) -> Array:
    """V_Y/V_Y0 by Eq. 14 for checked lambda_Y, on which Eq. 22 stands: at most 4.3 % high."""
    q = 1.25**0.6 * lam_y
    ratio: Array = q + (1.0 + q) ** -0.2
    return ratio


def thornton(speed_ratio: ArrayLike) -> float | Array:
    """COR on a half-space with the `thornton` law, in closed form (Thornton 1997, Eq. 22).

    Parameters
    ----------
    speed_ratio : array_like
        V0/V_Y0 with the yield speed of that law, from 0 to 1e6; 1 and below is elastic.

    Returns
    -------
    float or ndarray of float64
        Exact.

    Notes
    -----
    e = (6 sqrt(3)/5)^(1/2) (1 - x^2/6)^(1/2) (x/(x + 2 sqrt(6/5 - x^2/5)))^(1/4), x = V_Y0/V0.

    Examples
    --------
    >>> from validation.paper.closed_form import thornton
    >>> thornton([1.0, 5.0]).round(4)
    array([1.    , 0.7733])
    """
    v, shape = checked(speed_ratio=(speed_ratio, 0.0, 1e6, _RATIO))
    x = 1.0 / np.maximum(v, 1.0)
    share = x / (x + 2.0 * np.sqrt(1.2 - 0.2 * x**2))
    factor = math.sqrt(1.2 * math.sqrt(3.0))
    return shaped(factor * np.sqrt(1.0 - x**2 / 6.0) * share**0.25, shape)


def half_space(speed_ratio: ArrayLike) -> float | Array:
    """COR on a half-space, Eq. 21, and its continuation to where loading is linear.

    Parameters
    ----------
    speed_ratio : array_like
        V0/V_Y0, from 0 to 1e6; 1 and below is elastic.

    Returns
    -------
    float or ndarray of float64
        Exact; Eq. 21 up to v = P^(5/4) = 4.19, where loading leaves Hertz's curve.

    Examples
    --------
    >>> from validation.paper.closed_form import half_space
    >>> half_space([2.0, 10.0]).round(4)
    array([0.9513, 0.7042])
    """
    v, shape = checked(speed_ratio=(speed_ratio, 0.0, 1e6, _RATIO))
    v = np.maximum(v, 1.0)
    force, span = at_turning_point(v**0.8)
    return shaped(np.sqrt(force * span) / v, shape)


def peng(speed_ratio: ArrayLike, thickness_ratio: ArrayLike, eta: ArrayLike, c: ArrayLike = 0.0935) -> float | Array:
    """COR of an elastic-plastic impact on a plate, Eq. 22 made continuous.

    Parameters
    ----------
    speed_ratio : array_like
        V0/V_Y0, from 0 to 20.
    thickness_ratio : array_like
        R/H, from 0 to where eta (R/H)^2 = 0.5: 2.6 for gamma-alumina on glass.
    eta : array_like
        `eta` of the pair, from 1e-6 to 1000.
    c : array_like, optional
        Coefficient of (R/H)^2 in the exponent 1/4 + c (R/H)^2, from 0 to 1.

    Returns
    -------
    float or ndarray of float64
        Within 4.1 % of the solver for the paper's pair, R/H <= 1.8 and v <= 7, 24 % in the whole
        range.

    Notes
    -----
    The plastic branch, printed without, has the elastic COR at yield as a factor: Eq. 3 with lambda
    at V_Y = g V_Y0, g by Eq. 14. A fit shows that the printed c belongs to the form with the
    factor (see ``validation/derivations/errata.md``).

    Examples
    --------
    >>> from validation.paper.closed_form import peng
    >>> peng(3.0, [0.9, 1.8], eta=0.0751).round(4)
    array([0.8005, 0.5666])
    """
    v, ratio, at_unity, growth, shape = checked(
        speed_ratio=(speed_ratio, 0.0, FASTEST, INTEGRATE),
        thickness_ratio=(thickness_ratio, 0.0, math.inf, "(it is R/H)"),  # the limit is below
        eta=(eta, 1e-6, 1e3, "(closed_form.eta(pair) has it)"),
        c=(c, 0.0, 1.0, "(the paper prints 0.0935)"),
    )
    thinnest = np.sqrt(LARGEST_AT_YIELD / at_unity)
    if (ratio > thinnest).any():
        n = int(np.argmax(ratio > thinnest))
        remark = f"at eta = {at_unity[n]:g}, so that eta (R/H)^2 <= {LARGEST_AT_YIELD} {INTEGRATE}"
        within("thickness_ratio", ratio[n : n + 1], 0.0, float(thinnest[n]), remark)
    lam_y = at_unity * ratio**2
    g = approximate_yield_speed_ratio(lam_y)
    elastic = np.asarray(mueller(lam_y * np.minimum(v, g) ** 0.2))  # at yield, where v is beyond
    plastic = (1.0 - (1.0 - np.maximum(v / g, 1.0) ** -0.8) ** 2) ** (0.25 + growth * ratio**2)
    return shaped(elastic * plastic, shape)
