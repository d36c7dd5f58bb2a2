"""Hertz: elastic at every compression (Johnson, Contact Mechanics, 1985, Eq. 4.23)."""

from __future__ import annotations

from contactlaw._jit import kernel
from contactlaw.laws import Law


@kernel
def _loading(q: float) -> float:
    return q * q * q


@kernel
def _residual(dm: float) -> float:
    return 0.0


@kernel
def _unloading_curve(dm: float) -> tuple[float, float]:
    return 0.0, 0.0


@kernel
def _unloading(q: float, _a: float, _b: float) -> float:
    return q * q * q


@kernel
def _dissipation(dm: float) -> float:
    return 0.0


LAW = Law(
    name="hertz",
    source="Hertz 1882; Johnson, Contact Mechanics (1985), Eq. 4.23",
    yield_coefficient=None,
    loading_kinks=(),
    unloading_kinks=(),
    loading=_loading,
    residual=_residual,
    unloading_curve=_unloading_curve,
    unloading=_unloading,
    dissipation=_dissipation,
)
