"""The turning-point form: a closed form of the COR, contactlaw's own.

At the largest compression, where an impact turns, its unloading depends on two numbers only: the
force f and the span s of the unloading to come (in units of F_Y and d_Y). What follows is the
second half of an elastic impact, which one function G describes. So

    chi = v^(4/5) (1 + 0.6 J lambda + 0.0193 lambda^2)^(-2/3)      largest compression by Hertz
    d_m = chi, or beyond P the root of the loading work W          largest compression
    e   = sqrt(f s)/v G(lambda_Y sqrt(f/s))                        COR
    G(x) = exp(-(J/2) x (1 + 0.304 x + 0.190 x^2))
    W   = (2/5) chi^(5/2) (1 + 0.56 lambda (1 - P/chi)^(5/2))

with v = V0/V_Y0, lambda = lambda_Y v^(1/5), J = `WAVE_SLOPE`, and for the
`myc` law s = d_m up to yield, sqrt(2 d_m - 1) beyond. Four numbers are fitted (0.0193, 0.304,
0.190, 0.56), all else is derived: see ``validation/derivations/turning_point.md``.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw.laws.myc import P

Array = NDArray[np.float64]

WAVE_SLOPE: float = 0.8 * 1.25**1.6 * math.gamma(1.6) * math.gamma(0.5) / math.gamma(2.1)
"""-de/dlambda at lambda = 0, 1.7302: the integral of f^2 dt over a lossless Hertzian contact,
2 w_m^4 (2/5) B(8/5, 1/2) with w_m = (5/4)^(2/5) and u^2 = 1 - (w/w_m)^(5/2)."""

_SLOWEST = 1e-100  # V0/V_Y0 that replaces smaller ones: the COR is 1 there, and nothing is 0/0


def loading(lam: ArrayLike) -> Array:
    """Largest compression of an elastic impact over its lossless value, w_m/(5/4)^(2/5).

    Within 0.006 % up to lambda = 0.6, 0.06 % up to 1, 0.4 % up to 2.

    Examples
    --------
    >>> round(float(loading(0.5)), 4)
    0.7552
    """
    lam = np.asarray(lam)
    return np.asarray((1.0 + 0.6 * WAVE_SLOPE * lam + 0.0193 * lam**2) ** (-2.0 / 3.0))


def _release(x: Array) -> Array:
    """Rebound speed over its lossless value, G: within 0.08 % up to x = 0.8, 0.9 % up to 1."""
    share: Array = np.exp(-0.5 * WAVE_SLOPE * x * (1.0 + 0.304 * x + 0.190 * x**2))
    return share


def _work_ratio(lam: Array, chi: Array) -> Array:
    """Compute the loading work over that along Hertz's curve, which loses more to waves."""
    share: Array = 1.0 + 0.56 * lam * np.maximum(1.0 - P / chi, 0.0) ** 2.5
    return share


def at_turning_point(chi: Array) -> tuple[Array, Array]:
    """Force and span of unloading at the largest compression of impacts with checked overloads chi.

    Beyond P the linear branch takes the loading work 0.4 chi^(5/2) that Hertz's curve would take.
    """
    excess = 8.0 / 15.0 * chi**2.5 / math.sqrt(P) - 4.0 / 45.0 * P**2
    dm = np.where(chi < P, chi, P / 3.0 + np.sqrt(np.maximum(excess, 0.0)))
    force = np.where(chi < P, dm**1.5, math.sqrt(P) * (1.5 * dm - 0.5 * P))
    return force, np.where(dm < 1.0, dm, np.sqrt(np.maximum(2.0 * dm - 1.0, 0.0)))


def restitution(v: ArrayLike, lam_y: ArrayLike) -> Array:
    """COR of an impact on a plate, elastic or plastic, in the turning-point form.

    It is continuous, 1 at v = 0, and exact on the half-space. Otherwise it is within these of the
    solver, relatively; `contactlaw.ImpactModel` goes further:

        ==============  ========  ========
        lambda_Y up to  v <= 10   v <= 20
        ==============  ========  ========
        0.3             0.05 %    0.13 %
        0.4             0.05 %    0.5 %
        0.5             0.31 %    1.6 %
        ==============  ========  ========

    Lambda_Y = 0.5 is R/H = 2.6 for gamma-alumina on glass.

    Examples
    --------
    >>> restitution(3.0, [0.0, 0.0608, 0.2434]).round(4)
    array([0.9007, 0.7933, 0.5481])
    """
    v, lam_y = np.maximum(v, _SLOWEST), np.asarray(lam_y)
    lam = lam_y * v**0.2
    chi = v**0.8 * loading(lam)
    force, span = at_turning_point(chi * _work_ratio(lam, chi) ** 0.4)
    released = _release(lam_y * np.sqrt(force / span))
    return np.asarray(np.sqrt(force * span) / v * released)
