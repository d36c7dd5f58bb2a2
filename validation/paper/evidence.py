"""What the equations and the model say of the paper's claims: the numbers of `claims`.

`elements` has those that need finite elements. Largest means the largest magnitude.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import SupportsFloat

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, newton

import contactlaw as cl
from contactlaw import laws
from contactlaw.equation import numbers as dimensionless
from contactlaw.equation.numbers import Impact
from contactlaw.laws.myc import P
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.materials import sphere_mass
from contactlaw.physical.scaling import plate_mobility, yield_scales
from validation.paper import closed_form
from validation.paper.closed_form import elastic_compression, yield_speed_ratio
from validation.paper.setting import (
    ETA,
    FASTEST,
    PAIR,
    RADIUS,
    SHARE,
    SPEED,
    THINNEST,
    YIELD_COMPRESSION,
    Array,
    borderline,
    impacts,
    largest,
)
from validation.paper.verdicts import Numbers

MASS = sphere_mass(PAIR.sphere.density, np.array(RADIUS)).item()  # [kg]
STRENGTH = PAIR.sphere.require_yield_strength("myc")  # [Pa]
MYC = laws.law("myc")
Q_THINNEST = 1.25**0.6 * ETA * THINNEST**2  # q of Eq. 9 at R/H = 1.8
# V0/V_Y0 and R/H of `surface`
V, RATIO = np.linspace(0.05, FASTEST, 120), np.linspace(0.02, THINNEST, 46)[:, None]
Q = np.linspace(0.0, 20.0, 200_001)  # q of Eqs. 11 to 14
_H = 1e-6  # step of difference quotients


def numbers(pair: cl.Pair, speed: float) -> dimensionless.Numbers:
    """Numbers of an impact of the paper's bead, of any materials, on a plate with R = H."""
    return SphereOnPlate(pair, MYC).numbers(Impact(speed, RADIUS, RADIUS))


def slope(one: tuple[float, float], two: tuple[float, float]) -> float:
    """Exponent of a power law through two points (x, y)."""
    return math.log(two[1] / one[1]) / math.log(two[0] / one[0])


def power(y: Callable[[float], SupportsFloat], one: float, two: float) -> float:
    """Exponent of the power law through y at two x."""
    return slope((one, float(y(one))), (two, float(y(two))))


def hertz_time(speed_ratio: float = 1.0, mass: float = 1.0) -> float:
    """Contact time [s] by Hertz's law on a half-space, with the bead's mass times a factor."""
    pair = cl.Pair(replace(PAIR.sphere, density=mass * PAIR.sphere.density), PAIR.plate)
    model = cl.ImpactModel(pair, law="hertz", outside="solve")
    return float(model.lookup(speed_ratio * SPEED, RADIUS, math.inf).contact_time)


def mueller_error() -> float:
    """Find the largest absolute error of Eq. 3 where the COR of Zener's model exceeds 0.2."""
    lam = np.linspace(0.0, 0.95, 96)
    zener = closed_form.zener(lam)
    return largest((closed_form.mueller(lam) - zener)[zener > 0.2])


def alpha() -> Numbers:
    """Mobility of the plate, by Eq. 1 and by the package, over that of an infinite plate."""
    glass, thickness = PAIR.plate, 1e-3
    root = math.sqrt(3.0 * glass.density * (1.0 - glass.poissons_ratio**2) / glass.youngs_modulus)
    bending = glass.plane_modulus * thickness**3 / 12.0
    impedance = 8.0 * math.sqrt(bending * glass.density * thickness)
    return {
        "printed": impedance * root / (4.0 * glass.density * thickness**2),
        "ours": impedance * float(plate_mobility(glass, np.array(thickness))),
    }


def exponent_of_moduli() -> float:
    """Find the exponent of E1'/(E1' + E2') in lambda of the package, at fixed V_W."""

    def point(factor: float) -> tuple[float, float]:
        plate = PAIR.plate
        density, modulus = factor * plate.density, factor * plate.youngs_modulus  # keeps V_W
        pair = cl.Pair(PAIR.sphere, replace(plate, density=density, youngs_modulus=modulus))
        lam = float(numbers(pair, SPEED).inelasticity)
        share = pair.sphere.plane_modulus / (pair.sphere.plane_modulus + pair.plate.plane_modulus)
        return share, lam * density**0.6

    return slope(point(1.0), point(1.001))


def thornton_yield_speed() -> float:
    """V_Y0 [m/s] with the d_Y of Thornton's law."""
    compression, force = yield_scales(PAIR, laws.law("thornton").yield_coefficient or 0.0, RADIUS)
    return math.sqrt(0.8 * force * compression / MASS)


def factor_of_davies() -> float:
    """Thornton's V_Y0 in units of (sigma_Y^5 R^3/(E*^4 m))^0.5."""
    unit = math.sqrt(STRENGTH**5 * RADIUS**3 / (PAIR.effective_modulus**4 * MASS))
    return thornton_yield_speed() / unit


def factor_of_eq_4() -> float:
    """MYC's V_Y0 in units of (pi^4 sigma_Y^5/(rho1 E*^4))^0.5."""
    unit = math.pi**2 * math.sqrt(STRENGTH**5 / PAIR.sphere.density) / PAIR.effective_modulus**2
    return SPEED / unit


def scale_of_time() -> float:
    """Time scale of the package over that of section 3.2."""
    scale = math.pi * PAIR.sphere.density / (PAIR.effective_modulus * math.sqrt(5.0))
    ours = float(numbers(PAIR, 5.0).time)
    return ours / (RADIUS * math.pow(scale, 0.4))


def slope_of_eq_6(largest_inelasticity: float) -> float:
    """Slope of w_m^-1.5 over lambda from 0 to 0.5 or 2 by least squares; the intercept is exact."""
    lam = np.linspace(0.0, 2.0, 81)
    rise = elastic_compression(lam) ** -1.5 - 1.25**-0.6
    part = lam <= largest_inelasticity
    return float((lam * rise)[part].sum() / (lam[part] ** 2).sum())


def eq_10(power_of_pi: float, exponent: float) -> float:
    """Compute eta from the materials by Eq. 10, with its two exponents in doubt as arguments.

    Examples
    --------
    >>> from validation.paper.evidence import eq_10
    >>> round(eq_10(3.0, 0.8), 3), round(eq_10(0.6, 0.4), 4)
    (0.539, 0.0751)
    """
    sphere, plate = PAIR.sphere, PAIR.plate
    wave_speed = math.sqrt(plate.plane_modulus / plate.density)
    densities, speeds = sphere.density / plate.density, SPEED / wave_speed
    moduli = math.pow(SHARE, exponent)
    factor = math.pow(math.pi, power_of_pi) / math.sqrt(3.0)
    return factor * math.pow(densities, 0.6) * moduli * math.pow(speeds, 0.2)


def left_side_of_eq_9(speed_ratio: float) -> float:
    """Compute the left side of Eq. 9 at R/H = 1.8; it is 1 at V_Y/V_Y0."""
    lam = float(impacts(speed_ratio, THINNEST).inelasticity)
    return math.pow(0.8, 0.4) * math.pow(speed_ratio, 0.8) * math.pow(lam + 1.25**-0.6, -2.0 / 3.0)


def yield_speed_of_eq_9() -> float:
    """Find V_Y/V_Y0 of Eq. 9 at R/H = 1.8."""
    return float(brentq(lambda x: left_side_of_eq_9(x) - 1.0, 1.0, 2.0))


def left_side_of_eq_8(speed_ratio: float | None) -> float:
    """Compute the left side of Eq. 8 at R/H = 1.8 and V_Y of Eq. 9, in units of d_Y.

    With V0/V_Y0 = `speed_ratio` in the time scale, as printed, or with V_Y (None).
    """
    x = yield_speed_of_eq_9()
    v = x if speed_ratio is None else speed_ratio
    scale = math.pi * PAIR.sphere.density / (PAIR.effective_modulus * math.sqrt(v * SPEED))
    lam = float(impacts(x, THINNEST).inelasticity)
    w_m = float(closed_form.eq_6(lam))
    return x * SPEED * RADIUS * math.pow(scale, 0.4) * w_m / YIELD_COMPRESSION


def eq_11(q: ArrayLike) -> Array:
    """Solve Eq. 11, x - x^(-1/5) = q, for x = V_Y/V_Y0 by Newton's method."""
    start = 1.0 + np.asarray(q)
    found: Array = newton(lambda x: x - x**-0.2 - q, start, lambda x: 1.0 + 0.2 * x**-1.2)
    return found


def eq_12() -> Numbers:
    """Compute both sides of Eq. 12 from the root of Eq. 9, and its right side mended."""
    x = yield_speed_of_eq_9()
    return {"printed": x**0.2, "ours": x - Q_THINNEST, "mended": x**-0.2}


def bound_of_eq_13() -> Array:
    """Bound of Eq. 14's residual over `Q`."""
    bound: Array = (1.0 - (Q + 1.0) ** -0.2) / (1.0 + Q * (Q + 1.0) ** 0.2)
    return bound


def sum_of_eq_13(exponent: float) -> float:
    """Largest difference of the series of Eq. 13, with (q + 1)^exponent, from its closed form."""
    step = (1.0 - (Q + 1.0) ** exponent) / (Q + 1.0)
    series = sum(step**k for k in range(1, 60)) / (Q + 1.0) ** 0.2
    return largest(series - bound_of_eq_13())


def eq_14_against_eq_11() -> tuple[float, float]:
    """Find the largest error of Eq. 14 against Eq. 11: in V_Y/V_Y0, and relative."""
    solved = eq_11(Q)
    error = np.abs(Q + (1.0 + Q) ** -0.2 - solved)
    return float(error.max()), float((error / solved).max())


def eq_14_error(at_yield: Array) -> float:
    """Find the largest relative error of Eq. 14 over lambda_Y."""
    return largest(closed_form.eq_14(at_yield) / yield_speed_ratio(at_yield) - 1.0)


def slope_of_loading(d: float) -> float:
    """Slope of MYC's loading curve at d [d_Y], more than 1e-6 from a kink, in units of F_Y/d_Y."""
    after, before = (MYC.loading(math.sqrt(d + step)) for step in (_H, -_H))
    return (after - before) / (2.0 * _H)


def slope_of_unloading() -> float:
    """Slope of MYC's unloading from x3 = 5 d_Y, half way to d_r, in units of F_m/(x3 - d_r)."""
    top = 5.0
    span, curve = top - MYC.residual(top), MYC.unloading_curve(top)
    down = [MYC.unloading(math.sqrt(0.5 * span + step), curve) for step in (-_H, _H)]
    return (down[1] - down[0]) / (2.0 * _H) * span / MYC.loading(math.sqrt(top))


@functools.cache
def surface() -> Array:
    """COR of the model over `V`, one row for each of `RATIO`."""
    return np.asarray(impacts(V, RATIO).restitution)


def eq_21_error() -> float:
    """Largest error of Eq. 21 from yield to the speed at which loading leaves Hertz's curve."""
    slow = np.linspace(1.0, P**1.25, 50)
    return largest(closed_form.eq_21(slow) / np.asarray(impacts(slow, 0.0).restitution) - 1)


def fitted_c(*, factor: bool = True, exponent: float = 0.4) -> float:
    """Fit c of Eq. 22 to `surface` by least squares, with or without the elastic factor.

    `exponent` is that of E1'/(E1' + E2') in the eta from which g comes; lambda has 2/5. (Hence not
    `closed_form.peng`, where one eta serves both.)
    """
    lam_y = ETA * RATIO**2
    g = closed_form.eq_14(lam_y * SHARE ** (exponent - 0.4))
    elastic = closed_form.mueller(lam_y * np.minimum(V, g) ** 0.2)
    if not factor:
        elastic = np.where(V > g, 1.0, elastic)
    base = 1.0 - (1.0 - np.maximum(V / g, 1.0) ** -0.8) ** 2

    def slope_of_squares(c: float) -> float:  # half of their derivative
        form = elastic * base ** (0.25 + c * RATIO**2)
        return float(((form - surface()) * form * np.log(base) * RATIO**2).sum())

    return float(brentq(slope_of_squares, 0.0, 0.6))


def fitted_border(thinnest: float) -> float:
    """Fit the coefficient of Eq. 23 to the model's border over R/H 0.1 to `thinnest`."""
    ratio = np.linspace(0.1, thinnest, round((thinnest - 0.1) / 0.05) + 1)
    excess = np.array([borderline(float(x)) for x in ratio]) ** 0.4 - 1.0
    return float((excess * ratio**2).sum() / (ratio**4).sum())


def eq_23_error() -> float:
    """Largest relative error of Eq. 23 in speed, R/H 0.1 to 1.2."""
    ratio = np.linspace(0.1, 1.2, 23)
    return largest(closed_form.border(ratio) / np.array([borderline(float(x)) for x in ratio]) - 1)


def plastic_share(speed_ratio: float) -> float:
    """Share of plastic flow in what an impact at R/H = 0.2 loses."""
    one = impacts(speed_ratio, 0.2)
    return float(one.plastic_fraction / (one.plastic_fraction + one.wave_fraction))


def contact_times(law: str = "myc") -> Array:
    """Contact times [s] from 0.2 to 7 V_Y0, one row for each R/H from 0.05 to 1.8."""
    v, ratio = np.linspace(0.2, FASTEST, 120), np.linspace(0.05, THINNEST, 15)
    return np.asarray(impacts(v, ratio[:, None], law).contact_time)
