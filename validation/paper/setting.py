"""The setting of Peng, Jin, Liu, Wei (2021): their pair, their bead, and impacts of it."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

import contactlaw as cl
from contactlaw import laws
from contactlaw.equation import zener
from contactlaw.laws.myc import C_YIELD
from contactlaw.physical.law import law_of
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.scaling import yield_scales
from validation.paper import closed_form

Array = NDArray[np.float64]

PAIR = cl.Pair("gamma-alumina", "glass")  # Table 1
RADIUS = 0.9e-3  # [m], section 3.1
SPEED = PAIR.yield_speed  # V_Y0 [m/s]
ETA = closed_form.eta(PAIR)
SHARE = PAIR.sphere.plane_modulus / (PAIR.sphere.plane_modulus + PAIR.plate.plane_modulus)
_MYC = laws.law("myc")
YIELD_COMPRESSION, FORCE = yield_scales(PAIR, C_YIELD, RADIUS)  # d_Y of MYC [m], F_Y [N]
THINNEST, FASTEST = 1.8, 7.0  # R/H and V0/V_Y0, to which the paper's finite elements reach


@functools.cache
def model(law: str = "myc") -> cl.ImpactModel:
    """Model of the pair; outside the table it integrates."""
    return cl.ImpactModel(PAIR, law=law, outside="solve")


def impacts(speed_ratio: ArrayLike, thickness_ratio: ArrayLike, law: str = "myc") -> Rebound:
    """Impacts of the paper's bead at V0/V_Y0 on plates of R/H (0: half-space)."""
    ratio = np.asarray(thickness_ratio, dtype=float)
    thickness = RADIUS / np.where(ratio > 0.0, ratio, 1.0)
    thickness = np.where(ratio > 0.0, thickness, math.inf)
    return model(law).solve(np.asarray(speed_ratio) * SPEED, RADIUS, thickness)


def largest(values: ArrayLike) -> float:
    """Find the largest magnitude.

    Examples
    --------
    >>> largest([-3.0, 2.0])
    3.0
    """
    return float(np.abs(values).max())


def extreme(values: ArrayLike) -> float:
    """Find the value of the largest magnitude, with its sign.

    Examples
    --------
    >>> extreme([-3.0, 2.0])
    -3.0
    """
    return float(max(np.ravel(values), key=abs))


def all_laws(pair: cl.Pair = PAIR) -> dict[str, laws.Law]:
    """Laws of the literature by their names, with the numbers that they take from the pair.

    Their contacts are Hertz's until they yield, so that they need lambda of a thin plate and d_Y
    only. The law ``"fem"`` is left out.
    """
    return {name: law_of(pair, name) for name in laws.names() if name != "fem"}


def yield_unit(law: laws.Law) -> float:
    """Yield compression of a law over that of MYC; 1 for a law that never yields."""
    assert _MYC.yield_coefficient is not None
    own = law.yield_coefficient
    return 1.0 if own is None else own / _MYC.yield_coefficient


def force(law: laws.Law, compression: Array) -> Array:
    """Compute the loading curve of any law in MYC's units: force [F_Y] at compressions [d_Y]."""
    unit = yield_unit(law)
    return np.array([unit**1.5 * law.loading(math.sqrt(d / unit)) for d in compression])


def unloading(law: laws.Law, largest: float) -> tuple[Array, Array]:
    """Unloading curve from a largest compression: compression [d_Y], force [F_Y], both MYC's."""
    unit = yield_unit(law)
    residual, curve = law.residual(largest / unit), law.unloading_curve(largest / unit)
    q = np.linspace(0.0, math.sqrt(largest / unit - residual), 200)
    down = np.array([law.unloading(x, curve) for x in q])
    return unit * (residual + q**2), unit**1.5 * down


def restitution(speed_ratio: float, inelasticity_at_yield: float, law: laws.Law) -> float:
    """COR of any law by integration; v and lambda_Y of MYC's yield speed."""
    lam = inelasticity_at_yield * speed_ratio**0.2
    y = yield_unit(law) * 1.25**0.4 * speed_ratio**-0.8
    return float(zener.solve(law.data, lam, y, 1e-10).restitution)


@functools.cache
def borderline(thickness_ratio: float) -> float:
    """V0/V_Y0 at which plastic and wave loss are equal in the model."""

    def excess(speed_ratio: float) -> float:
        one = impacts(speed_ratio, thickness_ratio)
        return float(one.plastic_fraction - one.wave_fraction)

    return float(brentq(excess, 1.0, 64.0))
