"""Formulas of the literature that only the report needs: as printed, fitted, or for a limit.

`closed_form` has what is correct, and says what arguments and errors mean; `eq_N` is an equation
of the paper as it is printed.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from contactlaw.physical.arguments import checked, shaped
from validation.paper.closed_form import TOO_THIN, Array, approximate_yield_speed_ratio, mueller, peng
from validation.paper.turning_point import INTEGRATE, WAVE_SLOPE


def raman(inelasticity: ArrayLike) -> float | Array:
    """COR of an elastic impact, Raman's form (1 - k lambda)/(1 + k lambda).

    Raman (Phys. Rev. 15 (1920) 277) takes the wave's energy to be k lambda times what the sphere
    brings and what it takes away. Here k = `turning_point.WAVE_SLOPE`/2 = 0.8651, which
    makes the slope at lambda = 0 exact. 0.3 % below `closed_form.zener` at lambda = 0.1,
    2.0 % at 0.25.

    Parameters
    ----------
    inelasticity : array_like
        lambda, from 0 to 1/k = 1.156, where the sphere would stay.

    Returns
    -------
    float or ndarray of float64

    Examples
    --------
    >>> from validation.paper.formulas import raman
    >>> raman([0.1, 0.25]).round(4)
    array([0.8408, 0.6444])
    """
    k = 0.5 * WAVE_SLOPE
    lam, shape = checked(inelasticity=(inelasticity, 0.0, 1.0 / k, "(beyond, the form has no rebound: take zener)"))
    return shaped((1.0 - k * lam) / (1.0 + k * lam), shape)


def thornton_asymptote(speed_ratio: ArrayLike) -> float | Array:
    """COR of `closed_form.thornton` far above yield, 1.185 v^(-1/4).

    Wu, Li, Thornton (Int. J. Impact Eng. 28 (2003) 929) find v^(-1/2) in place of v^(-1/4) once the
    deformation is finite, which no law here is made for.

    Parameters
    ----------
    speed_ratio : array_like
        V0/V_Y0 as there, from 5 to 1e6. Below 2 the power exceeds 1, and `thornton` costs no
        more.

    Returns
    -------
    float or ndarray of float64
        Above `thornton` by 2.5 % at v = 5, 1.2 % at 10, 0.12 % at 100.

    Examples
    --------
    >>> from validation.paper.formulas import thornton_asymptote
    >>> round(thornton_asymptote(100.0), 4)
    0.3747
    """
    v, shape = checked(speed_ratio=(speed_ratio, 5.0, 1e6, "(below, take thornton)"))
    factor = math.sqrt(1.2 * math.sqrt(3.0)) * (2.0 * math.sqrt(1.2)) ** -0.25
    return shaped(factor * v**-0.25, shape)


def eq_6(inelasticity: ArrayLike) -> float | Array:
    """Largest compression w_m of an elastic impact [V0 T_H]: w_m^-1.5 = lambda + (5/4)^(-3/5).

    Parameters
    ----------
    inelasticity : array_like
        lambda, from 0 to 100.

    Returns
    -------
    float or ndarray of float64
        Up to 3.1 % below `closed_form.elastic_compression`.

    Examples
    --------
    >>> from validation.paper.formulas import eq_6
    >>> eq_6([0.0, 0.5]).round(4)
    array([1.0934, 0.8088])
    """
    lam, shape = checked(inelasticity=(inelasticity, 0.0, 100.0, TOO_THIN))
    return shaped((lam + 1.25**-0.6) ** (-2.0 / 3.0), shape)


def eq_14(inelasticity_at_yield: ArrayLike) -> float | Array:
    """Speed V_Y/V_Y0 from which the sphere yields on a plate: q + (1 + q)^(-1/5).

    Parameters
    ----------
    inelasticity_at_yield : array_like
        lambda_Y = (4/5)^(3/5) q, from 0 to 5.

    Returns
    -------
    float or ndarray of float64
        Above `closed_form.yield_speed_ratio` by 1.2 % at lambda_Y = 0.243, 4.3 % at 2.3.

    Examples
    --------
    >>> from validation.paper.formulas import eq_14
    >>> eq_14([0.0, 0.2434]).round(4)
    array([1.    , 1.2304])
    """
    lam_y, shape = checked(inelasticity_at_yield=(inelasticity_at_yield, 0.0, 5.0, TOO_THIN))
    return shaped(approximate_yield_speed_ratio(lam_y), shape)


def eq_21(speed_ratio: ArrayLike) -> float | Array:
    """COR on a half-space, (1 - (1 - v^(-4/5))^2)^(1/4).

    Parameters
    ----------
    speed_ratio : array_like
        v = V0/V_Y0, from 0 to 1e6; 1 and below is elastic.

    Returns
    -------
    float or ndarray of float64
        Exact up to v = (d_P/d_Y)^(5/4) = 4.19, where loading leaves Hertz's curve; above
        `closed_form.half_space` by 2.0 % at v = 7, 4.4 % at 10.

    Examples
    --------
    >>> from validation.paper.formulas import eq_21
    >>> eq_21([2.0, 10.0]).round(4)
    array([0.9513, 0.735 ])
    """
    v, shape = checked(speed_ratio=(speed_ratio, 0.0, 1e6, "(it is V0 over the yield speed V_Y0)"))
    return shaped((1.0 - (1.0 - np.maximum(v, 1.0) ** -0.8) ** 2) ** 0.25, shape)


def eq_22(speed_ratio: ArrayLike, thickness_ratio: ArrayLike, eta: ArrayLike, c: ArrayLike = 0.0935) -> float | Array:
    """COR of an elastic-plastic impact on a plate, whose plastic branch jumps to 1 at yield.

    Parameters
    ----------
    speed_ratio, thickness_ratio, eta, c : array_like
        As of `closed_form.peng`, which has the factor that is missing here.

    Returns
    -------
    float or ndarray of float64
        Within 56 % of the solver for the paper's pair, R/H <= 1.8 and v <= 7; up to a factor of 3
        too high in the whole range.

    Examples
    --------
    >>> from validation.paper.formulas import eq_22
    >>> eq_22(3.0, [0.9, 1.8], eta=0.0751).round(4)
    array([0.8817, 0.8466])
    """
    continuous = peng(speed_ratio, thickness_ratio, eta, c)
    lam_y = np.multiply(eta, np.square(thickness_ratio))
    g = approximate_yield_speed_ratio(lam_y)
    at_yield = np.asarray(mueller(lam_y * g**0.2))
    printed: Array = continuous / np.where(np.greater(speed_ratio, g), at_yield, 1.0)
    return printed


def border(thickness_ratio: ArrayLike) -> float | Array:
    """Speed V0/V_Y0 at which plastic and wave loss are equal, Eq. 23.

    Parameters
    ----------
    thickness_ratio : array_like
        R/H, from 0 to 1.2, over which the fit was made, for gamma-alumina on glass.

    Returns
    -------
    float or ndarray of float64
        (1 + 1.001 (R/H)^2)^(5/2). For that pair 10 % low at R/H = 0.2 to 0.3, within 5.1 % from 0.5
        to 1, 7 % low at 1.2.

    Examples
    --------
    >>> from validation.paper.formulas import border
    >>> round(border(0.5), 3)
    1.748
    """
    ratio, shape = checked(thickness_ratio=(thickness_ratio, 0.0, 1.2, INTEGRATE))
    return shaped((1.0 + 1.001 * ratio**2) ** 2.5, shape)
