"""Unloading of an elastic-plastic sphere, as the laws of Kogut & Etsion and Jackson & Green use it.

Etsion, Kligerman, Kadin, Int. J. Solids Struct. 42 (2005) 3716, for dm up to 170:

    f = fm ((d - dr)/(dm - dr))^n      dr/dm = (1 - dm^-0.28)(1 - dm^-0.69)      n = 1.5 dm^-0.0331

Just above yield, n falls faster than dr rises: as printed, unloading from dm < 1.2 lies above
Hertz's curve, and from dm < 1.11 it returns more work than loading took, up to 0.05 %. There n is
1.5 (1 - dr/dm) instead, the least exponent without either: unloading begins with Hertz's slope.

Legend: d compression, dm the largest so far, dr what remains of it, all in units of d_Y; x = dr/dm.
"""

import numpy as np

from contactlaw._bisect import bisect
from contactlaw.laws._branches import Array, Unloading


def share(dm: Array) -> Array:
    """dr/dm, without cancellation near dm = 1."""
    log = np.log(dm)
    return np.asarray(np.expm1(-0.28 * log) * np.expm1(-0.69 * log))


def _residual(dm: Array) -> Array:
    """Residual compression, over (dm - 1)^2."""
    return dm * share(dm) / (dm - 1.0) ** 2


def _next_to_yield(dm: Array) -> Array:
    """Exponent of the unloading curve below `KINK`."""
    return 1.5 * (1.0 - share(dm))


def _printed(dm: Array) -> Array:
    """Exponent of the unloading curve from `KINK` on."""
    return 1.5 * dm**-0.0331


def _loss_next_to_yield(dm: Array) -> Array:
    """Loss below `KINK`, dm^2.5 (0.4 - (1 - x)/(n + 1)), over (dm - 1)^2."""
    x = share(dm)
    return dm**2.5 * 0.16 * x / (1.0 - 0.6 * x) / (dm - 1.0) ** 2


KINK = float(bisect(lambda dm: dm**-0.0331 < 1.0 - share(dm), 1.1, 2.0))
"""Largest dm at which the exponent is 1.5 (1 - dr/dm), not the printed one."""

UNLOADING = (
    Unloading(1.0, _residual, _next_to_yield, _loss_next_to_yield, order=2.0, loss_order=2.0),
    Unloading(KINK, _residual, _printed, order=2.0),
)
"""For laws that load along Hertz's curve beyond `KINK`."""
