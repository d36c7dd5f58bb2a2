"""Evidence for the errata: the numbers that tell a misprint from a model."""

from __future__ import annotations

import math

import numpy as np

from contactlaw import closed_form
from contactlaw.closed_form import yield_speed_ratio
from validation.fem import compare, store
from validation.paper import (
    ETA,
    PAIR,
    RADIUS,
    SHARE,
    SPEED,
    THINNEST,
    YIELD_COMPRESSION,
)


def exponent_of_moduli() -> float:
    """Find the exponent of E1'/(E1' + E2') in lambda = alpha m/T_H of Eq. 1, at fixed V_W."""

    def log_lam(plate: float) -> tuple[float, float]:  # E1' = rho1 = rho2/E2' = R = H = V0 = 1
        modulus = plate / (1.0 + plate)
        density = plate  # keeps V_W
        mobility = math.sqrt(3.0) / (4.0 * density)
        time = math.pow(math.pi / modulus, 0.4)
        lam = mobility * 4.0 / 3.0 * math.pi / time
        return math.log(lam * density**0.6), math.log(1.0 / (1.0 + plate))

    (one, x), (two, y) = log_lam(1.0), log_lam(1.001)
    return (two - one) / (y - x)


def left_side_of_eq_8(speed_ratio: float | None) -> float:
    """Compute the left side of Eq. 8 at R/H = 1.8 and V_Y of Eq. 11, in units of d_Y.

    With V0/V_Y0 = `speed_ratio` in the time scale, as printed, or with V_Y (None).
    """
    q = 1.25**0.6 * ETA * THINNEST**2
    x = 1.0 + q
    for _ in range(30):  # Newton for Eq. 11, x - x^(-1/5) = q
        x -= (x - x**-0.2 - q) / (1.0 + 0.2 * x**-1.2)
    v = x if speed_ratio is None else speed_ratio
    scale = math.pi * PAIR.sphere.density / (PAIR.effective_modulus * math.sqrt(v * SPEED))
    w_m = (ETA * THINNEST**2 * x**0.2 + 1.25**-0.6) ** (-2.0 / 3.0)
    return x * SPEED * RADIUS * math.pow(scale, 0.4) * w_m / YIELD_COMPRESSION


def fitted_c(
    surface: np.ndarray, v: np.ndarray, ratio: np.ndarray, *, factor: bool, exponent: float
) -> float:
    """Fit c of Eq. 22 to COR over (R/H, v) by least squares, with or without the elastic factor.

    `exponent` is that of E1'/(E1' + E2') in the eta from which g comes; lambda has 2/5.
    """
    lam_y = ETA * ratio[:, None] ** 2
    g = np.asarray(yield_speed_ratio(lam_y * SHARE ** (exponent - 0.4), printed=True))
    elastic = np.asarray(closed_form.mueller(lam_y * np.minimum(v, g) ** 0.2))
    if not factor:
        elastic = np.where(v > g, 1.0, elastic)
    base = 1.0 - (1.0 - np.maximum(v / g, 1.0) ** -0.8) ** 2

    def squares(c: float) -> float:
        form = elastic * base ** (0.25 + c * ratio[:, None] ** 2)
        return float(((form - surface) ** 2).sum())

    low, high = 0.0, 0.6
    for _ in range(60):  # golden section: one minimum
        third = 0.381966 * (high - low)
        if squares(low + third) < squares(high - third):
            high -= third
        else:
            low += third
    return low


def eq_22_against_impacts() -> float:
    """Find the largest relative difference of Eq. 22, continuous, from finite elements."""
    return float(compare.errors(compare.comparison("matrix"))["Eq. 22, continuous"][0])


def nearest_harmless_edge() -> float:
    """Find the distance [m] from which on the edge changes the COR by less than 0.2 %."""
    edge = store.read("edge").data
    change = np.abs(edge["restitution"] / edge["restitution"][-1] - 1.0)
    felt = np.flatnonzero(change > 2e-3)
    return float(edge["width"][felt[-1] + 1])
