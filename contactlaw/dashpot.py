"""The damping of an engine that gives a COR: Hertz's spring with a dashpot beside it.

Legend: x overlap, u its rate, c damping, beta = c / (2 sqrt(m k)) with the tangent stiffness k.

    m u' = -K x^1.5 - c u,    c = 2 beta sqrt(m k),    k = 1.5 K sqrt(x)

In y = (4/5) x^(5/4) over a time that runs as x^(1/4) this is a linear oscillator (Antypov, Elliott,
EPL 94 (2011) 50004), of damping ratio zeta = sqrt(6/5) beta. A contact that must not pull ends
where the force has fallen to zero, before x has: for zeta = sin(a) that gives
e = exp(-(pi - 2 a) tan(a)), for zeta = cosh(b) it gives e = exp(-2 b/tanh(b)).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._bisect import bisect
from contactlaw.physical.arguments import checked, shaped

__all__ = ["betan"]

_CRITICAL = 2.0  # -ln e at zeta = 1


def betan(restitution: ArrayLike) -> float | Array:
    """Damping ratio ``betan`` that gives a COR in YADE.

    Parameters
    ----------
    restitution : array_like
        Coefficient of restitution wanted [-], from 1e-300 to 1.

    Returns
    -------
    float or ndarray of float64
        ``betan`` of YADE's ``Ip2_FrictMat_FrictMat_MindlinPhys`` [-], for
        ``Law2_ScGeom_MindlinPhys_Mindlin`` without adhesion, which lets no contact pull. YADE's own
        ``en`` goes through a fit that is wrong above 0.94.

    Raises
    ------
    ValueError
        If a COR is outside 1e-300 to 1.

    Notes
    -----
    Exact but for the engine's time step: 6e-3 in COR at 50 steps a contact, 5.6e-4 at 400.

    Examples
    --------
    >>> from contactlaw import dashpot
    >>> dashpot.betan([0.5, 0.9, 1.0]).round(4)
    array([0.233 , 0.0313, 0.    ])
    """
    remark = "[-]: damping alone does not stop a bead"
    e, shape = checked(restitution=(restitution, 1e-300, 1.0, remark))
    loss = -np.log(e)
    under, over = np.minimum(loss, _CRITICAL), np.maximum(loss, _CRITICAL)
    zero, most = np.zeros_like(loss), np.full_like(loss, 0.5 * math.pi)
    angle = bisect(lambda a: np.tan(a) * (math.pi - 2.0 * a) < under, zero, most)
    beyond = bisect(lambda b: 2.0 * b / np.tanh(b) < over, zero, 0.5 * over)
    ratio = np.where(loss < _CRITICAL, np.sin(angle), np.cosh(beyond))
    return shaped(math.sqrt(5.0 / 6.0) * ratio, shape)
