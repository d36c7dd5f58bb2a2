"""Evidence for the errata: the numbers that tell misprints from errors of the model."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq, newton

import contactlaw as cl
from contactlaw import laws
from contactlaw.physical.scaling import ContactConstants, scales, sphere_on_plate
from validation.accuracy import compare
from validation.fem import store
from validation.paper import closed_form, formulas
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
    unloading,
)

FASTEST_COMPRESSION = 4.77  # largest compression at 7 V_Y0 on a half-space [d_Y]


def contact(pair: cl.Pair, law: str, thickness_ratio: float) -> ContactConstants:
    """Contact of the paper's bead, of any materials, with a plate of R/H (0: half-space)."""
    thickness = RADIUS / thickness_ratio if thickness_ratio > 0.0 else math.inf
    return sphere_on_plate(pair, laws.law(law), np.array(RADIUS), np.array(thickness))


def slope(one: tuple[float, float], two: tuple[float, float]) -> float:
    """Exponent of a power law through two points (x, y)."""
    return math.log(two[1] / one[1]) / math.log(two[0] / one[0])


def exponent_of_moduli() -> float:
    """Find the exponent of E1'/(E1' + E2') in lambda of the package, at fixed V_W."""

    def point(factor: float) -> tuple[float, float]:
        plate = PAIR.plate
        density, modulus = factor * plate.density, factor * plate.youngs_modulus  # keeps V_W
        pair = cl.Pair(PAIR.sphere, replace(plate, density=density, youngs_modulus=modulus))
        lam = float(scales(contact(pair, "myc", 1.0), np.array(SPEED)).inelasticity)
        share = pair.sphere.plane_modulus / (pair.sphere.plane_modulus + pair.plate.plane_modulus)
        return share, lam * density**0.6

    return slope(point(1.0), point(1.001))


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
    w_m = float(formulas.eq_6(lam))
    return x * SPEED * RADIUS * math.pow(scale, 0.4) * w_m / YIELD_COMPRESSION


def eq_11(q: Array) -> Array:
    """Solve Eq. 11, x - x^(-1/5) = q, for x = V_Y/V_Y0 by Newton's method."""
    found: Array = newton(lambda x: x - x**-0.2 - q, 1.0 + q, lambda x: 1.0 + 0.2 * x**-1.2)
    return found


def fitted_c(
    surface: Array, v: Array, ratio: Array, *, factor: bool = True, exponent: float = 0.4
) -> float:
    """Fit c of Eq. 22 to COR over (R/H, v) by least squares, with or without the elastic factor.

    `exponent` is that of E1'/(E1' + E2') in the eta from which g comes; lambda has 2/5. (Hence not
    `closed_form.peng`, where one eta serves both.)
    """
    lam_y = ETA * ratio[:, None] ** 2
    g = np.asarray(formulas.eq_14(lam_y * SHARE ** (exponent - 0.4)))
    elastic = np.asarray(closed_form.mueller(lam_y * np.minimum(v, g) ** 0.2))
    if not factor:
        elastic = np.where(v > g, 1.0, elastic)
    base = 1.0 - (1.0 - np.maximum(v / g, 1.0) ** -0.8) ** 2

    def slope_of_squares(c: float) -> float:  # half of their derivative
        form = elastic * base ** (0.25 + c * ratio[:, None] ** 2)
        return float(((form - surface) * form * np.log(base) * ratio[:, None] ** 2).sum())

    return float(brentq(slope_of_squares, 0.0, 0.6))


def fitted_border(thinnest: float) -> float:
    """Fit the coefficient of Eq. 23 to the model's border over R/H 0.1 to `thinnest`."""
    ratio = np.linspace(0.1, thinnest, round((thinnest - 0.1) / 0.05) + 1)
    excess = np.array([borderline(float(x)) for x in ratio]) ** 0.4 - 1.0
    return float((excess * ratio**2).sum() / (ratio**4).sum())


def taken_by_thick_plate() -> tuple[float, float]:
    """Find the largest share of the energy that a plate of 10 R takes in finite elements.

    The second number is its share at 7 V_Y0 over that of plastic flow.
    """
    case = compare.comparison("matrix")
    thick = np.isclose(case.slenderness, 0.1)
    fastest = thick & np.isclose(case.speed_ratio, FASTEST)
    wave = case.fem["wave"]
    return float(wave[thick].max()), (wave[fastest] / case.fem["plastic"][fastest]).item()


def zener_time_on_the_thinnest() -> float:
    """Find Zener's contact time over that of finite elements at R/H = 2.5, below yield."""
    case = compare.comparison("limits")
    here = np.isclose(case.slenderness, 2.5) & ~case.yielded
    return float((case.model["contact_time"] / case.fem["contact_time"])[here].item())


def bending_by_transits() -> tuple[float, float]:
    """Energy that the plate takes in finite elements over that of the model's bending wave.

    Largest ratio where the contact lasts for less than 6 transits H/c_L of the plate's thickness,
    and where it lasts for more than 8.
    """
    case = compare.comparison("matrix")
    plate = PAIR.plate
    nu = plate.poissons_ratio
    stiffness = plate.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    transit = case.fem["thickness"] / math.sqrt(stiffness / plate.density)
    transits = case.fem["contact_time"] / transit
    more = case.fem["wave"] / case.model["wave_fraction"]
    return float(more[transits < 6.0].max()), float(more[transits > 8.0].max())


def contact_time_errors() -> tuple[Array, Array]:
    """Errors of contact times relative to finite elements.

    The modified Zener model's over the whole matrix; Zener's where the bead yields.
    """
    case = compare.comparison("matrix")
    fem = case.fem["contact_time"]
    elastic = np.asarray(impacts(case.speed_ratio, case.slenderness, law="hertz").contact_time)
    return case.model["contact_time"] / fem - 1.0, (elastic / fem - 1.0)[case.yielded]


def last_touch() -> float:
    """Find the time [s] at which the bead leaves the plate in the finite elements of Fig. 13."""
    data = store.read("paper").data
    return float(data["time"][data["force"] > 0.0].max())


def eq_22_against_impacts() -> tuple[float, float]:
    """Find the largest relative difference of Eq. 22, continuous and printed, from impacts."""
    found = compare.errors(compare.comparison("matrix"))
    return float(found["Eq. 22, continuous"][0]), float(found["Eq. 22, printed"][0])


def eq_22_on_thin_plates() -> tuple[float, float, float]:
    """R/H at which the continuous form errs most; its error at R/H = 1.8 and on thicker plates."""
    case = compare.comparison("matrix")
    off = np.abs(case.restitution["Eq. 22, continuous"] / case.fem["restitution"] - 1.0)
    thin = np.isclose(case.slenderness, THINNEST)
    return float(case.slenderness[off.argmax()]), float(off[thin].max()), float(off[~thin].max())


def elastic_forms_against_impacts() -> dict[str, tuple[float, float, float]]:
    """Find how far Zener's and Raman's models are from finite elements.

    Largest relative difference while the bead does not yield; least excess where it does, on the
    two thickest plates; least excess at 7 V_Y0.
    """
    case = compare.comparison("matrix")
    raman = np.asarray(formulas.raman(case.inelasticity))
    forms = {"Zener": case.restitution["Zener"], "Raman": raman}
    fastest = case.speed_ratio > 0.99 * FASTEST
    thick = case.slenderness < 0.3
    found = {}
    for name, cor in forms.items():
        off = cor / case.fem["restitution"] - 1.0
        found[name] = (
            float(np.abs(off[~case.yielded]).max()),
            float(off[case.yielded & thick].min()),
            float(off[fastest].min()),
        )
    return found


def unloading_error() -> float:
    """Find the largest error of MYC's unloading from 5 and 10 d_Y, over the largest force."""
    law, worst = laws.law("myc"), 0.0
    for depth in (5.0, 10.0):
        back, load = unloading(law, depth)
        found = compare.force_at(f"{depth:g}", back, loading=False)
        worst = max(worst, float(np.abs(load - found).max() / found.max()))
    return worst


def nearest_harmless_edge() -> float:
    """Find the distance [m] from which on the edge changes the COR by less than 0.2 %."""
    edge = store.read("edge").data
    change = np.abs(edge["restitution"] / edge["restitution"][-1] - 1.0)
    felt = np.flatnonzero(change > 2e-3)
    return float(edge["width"][felt[-1] + 1])
