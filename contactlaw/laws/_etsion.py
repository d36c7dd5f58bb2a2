"""Unloading of an elastic-plastic sphere, as the laws of Kogut & Etsion and Jackson & Green use it.

Etsion, Kligerman, Kadin, Int. J. Solids Struct. 42 (2005) 3716, for dm up to 170:

    f = fm ((d - dr)/(dm - dr))^n      dr/dm = (1 - dm^-0.28)(1 - dm^-0.69)      n = 1.5 dm^-0.0331

Just above yield, n falls faster than dr rises: as printed, unloading from dm < 1.2 lies above
Hertz's curve, and from dm < 1.11 it returns more work than loading took, up to 0.05 %. There n is
the least exponent for which it does not, 1.5 (1 - dr/dm), which meets Hertz's slope at dm.

Legend: d compression, dm the largest so far, dr what remains of it, all in units of d_Y.
"""

from __future__ import annotations

import math

from contactlaw._jit import kernel


@kernel
def share(dm: float) -> float:
    """dr/dm, without cancellation near dm = 1."""
    if dm < 1.0:
        return 0.0
    log = math.log(dm)
    return math.expm1(-0.28 * log) * math.expm1(-0.69 * log)


@kernel
def residual(dm: float) -> float:
    """Compression left after unloading from dm."""
    return dm * share(dm)


@kernel
def exponent(dm: float) -> float:
    """Exponent n of the unloading curve from dm."""
    return 1.5 * max(math.pow(max(dm, 1.0), -0.0331), 1.0 - share(dm))


@kernel
def unloading_curve(dm: float, fm: float) -> tuple[float, float]:
    """Stiffness fm/(dm - dr)^n, and 2 n."""
    n = exponent(dm)
    return fm / (dm - residual(dm)) ** n, 2.0 * n


@kernel
def unloading(q: float, stiffness: float, twice: float) -> float:
    """Force at d = dr + q^2."""
    return math.copysign(stiffness * abs(q) ** twice, q)  # a trial step may pass q = 0


@kernel
def dissipation(dm: float, fm: float, loading_work: float) -> float:
    """Subtract the unloading work from the loading work."""
    x = share(dm)
    if max(dm, 1.0) ** -0.0331 <= 1.0 - x:
        # on Hertz's curve, 0.4 - (1 - x)/(n + 1) without cancellation
        return fm * dm * 0.16 * x / (1.0 - 0.6 * x)
    return loading_work - fm * dm * (1.0 - x) / (exponent(dm) + 1.0)


def _kink() -> float:
    """Largest dm whose exponent is not the printed one."""
    low, high = 1.1, 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        log = math.log(middle)
        lost = math.expm1(-0.28 * log) * math.expm1(-0.69 * log)
        low, high = (middle, high) if middle**-0.0331 < 1.0 - lost else (low, middle)
    return low


KINKS = (1.0, _kink())
