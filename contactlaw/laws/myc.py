"""MYC: elastic, then linear plastic loading; Hertz-like unloading to a residual compression.

Majeed, Yigit, Christoforou, Compos. Part B 43 (2012) 1244; as used by Peng, Jin, Liu, Wei,
Int. J. Solids Struct. 222-223 (2021) 111036, Eqs. 16-18 (with the misprints of the Hertz branches
and of d_r mended).

Legend: d compression, dm the largest so far, dr what remains of it, all in units of d_Y; forces in
units of F_Y; q = sqrt(d) while loading and sqrt(d - dr) while unloading; P = d_P/d_Y, where loading
leaves Hertz's curve along its tangent. Between d = 1 and P only the unloading is plastic.
"""

from __future__ import annotations

import math

from contactlaw._jit import kernel
from contactlaw.laws import Law

_C_YIELD = 0.68  # Eq. 18, d_Y = 0.68 pi^2 sigma_Y^2 R*/E*^2
_C_PLASTIC = 2.14  # Eq. 18, d_P = 2.14 pi^2 sigma_Y^2 R*/E*^2
_P = _C_PLASTIC / _C_YIELD
_ROOT_P = math.sqrt(_P)


@kernel
def _loading(q: float) -> float:
    """Eq. 16, loading phases 1 and 2, at d = q^2."""
    if q < _ROOT_P:
        return q * q * q
    return _ROOT_P * (1.5 * q * q - 0.5 * _P)


@kernel
def _residual(dm: float) -> float:
    """Eq. 17, dm - sqrt(2 dm - 1), written without its cancellation near dm = 1."""
    if dm < 1.0:
        return 0.0
    return (dm - 1.0) ** 2 / (dm + math.sqrt(2.0 * dm - 1.0))


@kernel
def _unloading_curve(dm: float) -> tuple[float, float]:
    """Stiffness fm/(dm - dr)^1.5; no second parameter."""
    span = dm - _residual(dm)
    return _loading(math.sqrt(dm)) / (span * math.sqrt(span)), 0.0


@kernel
def _unloading(q: float, stiffness: float, _: float) -> float:
    """Eq. 16, unloading phases 1 and 2, at d = dr + q^2."""
    return stiffness * (q * q * q)


@kernel
def _dissipation(dm: float) -> float:
    """Area between Eq. 16's loading and unloading curves."""
    dr = _residual(dm)
    if dm < _P:
        # 0.4 dm^2.5 - 0.4 dm^1.5 (dm - dr): the difference taken by hand keeps its digits
        return 0.4 * dm * math.sqrt(dm) * dr
    loading_work = _ROOT_P * (0.75 * dm * dm - 0.5 * _P * dm + 0.15 * _P * _P)
    return loading_work - 0.4 * _loading(math.sqrt(dm)) * (dm - dr)


LAW = Law(
    name="myc",
    source="Majeed, Yigit, Christoforou 2012; Peng et al. 2021, Eqs. 16-18",
    yield_coefficient=_C_YIELD,
    loading_kinks=(_P,),
    unloading_kinks=(1.0,),
    loading=_loading,
    residual=_residual,
    unloading_curve=_unloading_curve,
    unloading=_unloading,
    dissipation=_dissipation,
    yield_strains=(1 / 40, 1 / 20),
)
