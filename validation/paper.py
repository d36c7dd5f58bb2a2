"""What Peng, Jin, Liu, Wei (2021) compute with: their pair, their bead, and impacts of it."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import ArrayLike

import contactlaw as cl
from contactlaw import closed_form, laws, zener
from contactlaw.impact import Rebound, law_of

PAIR = cl.Pair("gamma-alumina", "glass")  # Table 1
RADIUS = 0.9e-3  # [m], section 3.1
SPEED = PAIR.yield_speed  # V_Y0 [m/s]
ETA = closed_form.eta(PAIR)
SHARE = PAIR.sphere.plane_modulus / (PAIR.sphere.plane_modulus + PAIR.plate.plane_modulus)
YIELD_COMPRESSION = (
    0.68 * (math.pi * 472.5e6 / PAIR.effective_modulus) ** 2 * RADIUS
)  # d_Y of MYC [m], Eq. 18
FORCE = 4 / 3 * PAIR.effective_modulus * math.sqrt(RADIUS) * YIELD_COMPRESSION**1.5  # F_Y [N]
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
    return model(law).lookup(np.asarray(speed_ratio) * SPEED, RADIUS, thickness)


def all_laws() -> list[laws.Law]:
    """Every registered law, with the numbers that it takes from the pair."""
    return [law_of(PAIR, name) for name in laws.names()]


def force(law: laws.Law, compression: np.ndarray) -> np.ndarray:
    """Compute the loading curve of any law in MYC's units: force [F_Y] at compressions [d_Y]."""
    if law.yield_coefficient is None:
        return np.asarray(compression) ** 1.5
    unit = law.yield_coefficient / 0.68  # its d_Y in MYC's
    return unit**1.5 * np.array([law.loading(math.sqrt(d / unit)) for d in compression])


def unloading(law: laws.Law, largest: float) -> tuple[np.ndarray, np.ndarray]:
    """Unloading curve from a largest compression: compression [d_Y], force [F_Y], both MYC's."""
    unit = 1.0 if law.yield_coefficient is None else law.yield_coefficient / 0.68
    residual, curve = law.residual(largest / unit), law.unloading_curve(largest / unit)
    q = np.linspace(0.0, math.sqrt(largest / unit - residual), 200)
    down = np.array([law.unloading(x, *curve) for x in q])
    return unit * (residual + q**2), unit**1.5 * down


def restitution(speed_ratio: float, inelasticity_at_yield: float, law: laws.Law) -> float:
    """COR of any law by integration; v and lambda_Y of MYC's yield speed."""
    unit = 1.0 if law.yield_coefficient is None else law.yield_coefficient / 0.68
    lam = inelasticity_at_yield * speed_ratio**0.2
    y = unit * 1.25**0.4 * speed_ratio**-0.8
    return zener.solve(law.functions, lam, y, 1e-10).restitution


def borderline(thickness_ratio: float) -> float:
    """V0/V_Y0 at which plastic and wave loss are equal, by bisection in the model."""
    low, high = 1.0, 64.0
    for _ in range(50):
        middle = math.sqrt(low * high)
        one = impacts(middle, thickness_ratio)
        if one.plastic_fraction < one.wave_fraction:
            low = middle
        else:
            high = middle
    return low
