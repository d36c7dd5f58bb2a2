"""Thornton: linear plastic loading at a constant contact pressure; unloading of a flattened sphere.

Thornton, J. Appl. Mech. 64 (1997) 383. Beyond yield the pressure over the contact is cut off at
p_y, so the force rises by pi p_y R* per compression, which is Hertz's slope at yield. Unloading is
Hertz's with the radius R_p of the flattened sphere, such that the contact area at the largest
compression is that of Hertz, a^2 = R* d: R_p/R* = dm^1.5/fm.

d_Y = pi^2 p_y^2 R*/(4 E*^2); p_y = sigma_Y in Peng et al. 2021 and here, so that the coefficient is
0.25. (Von Mises' criterion puts it at p_y = 1.6 sigma_Y: a yield compression of 0.64.)

Legend: d compression, dm the largest so far, dr what remains of it, all in units of d_Y; forces in
units of F_Y; q = sqrt(d) while loading and sqrt(d - dr) while unloading; g = sqrt(dm).
"""

from __future__ import annotations

import math

from contactlaw._jit import kernel
from contactlaw.laws import Law


@kernel
def _loading(q: float) -> float:
    """F_Y + pi p_y R* (d - d_Y), scaled, at d = q^2."""
    return q * q * q if q < 1.0 else 1.5 * q * q - 0.5


@kernel
def _residual(dm: float) -> float:
    """Return dm - fm/g, fm = 1.5 g^2 - 0.5; the span fm/g is that of Hertz with R_p."""
    if dm < 1.0:
        return 0.0
    g = math.sqrt(dm)
    return (g - 1.0) ** 2 * (g + 0.5) / g


@kernel
def _unloading_curve(dm: float) -> tuple[float, float]:
    """Stiffness sqrt(R_p/R*); no second parameter."""
    g = math.sqrt(dm)
    return g * math.sqrt(g / _loading(g)), 0.0


@kernel
def _unloading(q: float, stiffness: float, _: float) -> float:
    """Hertz with R_p, at d = dr + q^2."""
    return stiffness * (q * q * q)


@kernel
def _dissipation(dm: float) -> float:
    """0.75 dm^2 - 0.5 dm + 0.15 - 0.4 fm^2/g, with its double root at g = 1 taken out."""
    if dm < 1.0:
        return 0.0
    g = math.sqrt(dm)
    return (g - 1.0) ** 2 * (((0.75 * g + 0.6) * g - 0.05) * g - 0.1) / g


LAW = Law(
    name="thornton",
    source="Thornton, J. Appl. Mech. 64 (1997) 383; p_y = sigma_Y as in Peng et al. 2021",
    yield_coefficient=0.25,
    loading_kinks=(1.0,),
    unloading_kinks=(1.0,),
    loading=_loading,
    residual=_residual,
    unloading_curve=_unloading_curve,
    unloading=_unloading,
    dissipation=_dissipation,
)
