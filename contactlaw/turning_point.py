"""The turning-point form: a closed form of the COR, contactlaw's own.

At its largest compression, where it turns, an impact has forgotten its past but for two numbers:
the force f and the span s of the unloading to come (in units of F_Y and d_Y). What follows is the
second half of an elastic impact, of which one function G is all there is to know. So

    chi = v^(4/5) (1 + 0.6 J lambda + 0.0193 lambda^2)^(-2/3)      how far Hertz's loading gets
    d_m = chi, or beyond P the root of the loading work W          where the impact turns
    e   = sqrt(f s)/v G(lambda_Y sqrt(f/s))                        what comes back
    G(x) = exp(-(J/2) x (1 + 0.304 x + 0.190 x^2))
    W   = (2/5) chi^(5/2) (1 + 0.56 lambda (1 - P/chi)^(5/2))

with v = V0/V_Y0, lambda = lambda_Y v^(1/5), J = `contactlaw.closed_form.WAVE_SLOPE`, and for the
`myc` law s = d_m up to yield, sqrt(2 d_m - 1) beyond. Four numbers are fitted (0.0193, 0.304,
0.190, 0.56), all else is derived: see ``validation/derivations/turning_point.md``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw.arguments import shaped
from contactlaw.closed_form import WAVE_SLOPE, P, at_turning_point, checked

Array = NDArray[np.float64]


def loading(lam: Array) -> Array:
    """Largest elastic compression over its lossless value: within 0.006 % up to lambda = 0.6."""
    share: Array = (1.0 + 0.6 * WAVE_SLOPE * lam + 0.0193 * lam**2) ** (-2.0 / 3.0)
    return share


def release(x: Array) -> Array:
    """Rebound speed over its lossless value, G: within 0.08 % up to x = 0.8."""
    share: Array = np.exp(-0.5 * WAVE_SLOPE * x * (1.0 + 0.304 * x + 0.190 * x**2))
    return share


def work(lam: Array, chi: Array) -> Array:
    """Relate the loading work to that of Hertz's curve, which radiates a little more."""
    share: Array = 1.0 + 0.56 * lam * np.maximum(1.0 - P / chi, 0.0) ** 2.5
    return share


def restitution(speed_ratio: ArrayLike, inelasticity_at_yield: ArrayLike) -> float | Array:
    """COR of an impact on a plate, elastic or plastic, in the turning-point form.

    Parameters
    ----------
    speed_ratio : array_like
        V0/V_Y0, from above 0 to 20.
    inelasticity_at_yield : array_like
        lambda_Y, from 0 to 0.3 (R/H up to 2 for gamma-alumina on glass).

    Returns
    -------
    float or ndarray of float64
        Within 0.15 % of the solver, 0.05 % up to v = 10; continuous; exact on the half-space.

    Examples
    --------
    >>> from contactlaw import turning_point
    >>> turning_point.restitution(3.0, [0.0, 0.0608, 0.2434]).round(4)
    array([0.9007, 0.7933, 0.5481])
    """
    v, lam_y, shape = checked(
        speed_ratio=(speed_ratio, 1e-9, 1e6),
        inelasticity_at_yield=(inelasticity_at_yield, 0.0, 5.0),
    )
    lam = lam_y * v**0.2
    chi = v**0.8 * loading(lam)
    force, span = at_turning_point(chi * work(lam, chi) ** 0.4)
    released = release(lam_y * np.sqrt(force / span))
    return shaped(np.sqrt(force * span) / v * released, shape)
