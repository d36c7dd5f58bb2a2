"""SI units to dimensionless numbers, against the formulas of the paper (misprints mended)."""

import math

import numpy as np
import pytest

from contactlaw import laws
from contactlaw.equation.numbers import Impact
from contactlaw.physical.bodies import SphereOnPlate, TwoSpheres
from contactlaw.physical.materials import sphere_mass
from contactlaw.physical.scaling import plate_mobility, reduced

MYC = laws.law("myc")
R, H, V = 0.9e-3, 1e-3, 5.0


def plate_scales(pair, radius=R, thickness=H, speed=V):
    return SphereOnPlate(pair, MYC).numbers(Impact(speed, radius, thickness))


def test_inelasticity_is_eq_2(pair):
    """With the exponent 2/5 that Eq. 1 gives, not the printed 4/5."""
    e1, e2 = pair.sphere.plane_modulus, pair.plate.plane_modulus
    wave_speed = math.sqrt(e2 / pair.plate.density)
    eq_2 = (
        math.pi**0.6
        / math.sqrt(3)
        * (R / H) ** 2
        * (V / wave_speed) ** 0.2
        * (pair.sphere.density / pair.plate.density) ** 0.6
        * (e1 / (e1 + e2)) ** 0.4
    )
    assert plate_scales(pair).inelasticity == pytest.approx(eq_2, rel=1e-13)


def test_eta_of_the_paper(pair):
    # lambda at V_Y0 and R = H: 0.0751 for gamma-alumina on glass (PHYSICS, Eq. 10 corrected)
    at_yield = plate_scales(pair, thickness=R, speed=pair.yield_speed)
    assert at_yield.inelasticity == pytest.approx(0.0751, abs=5e-5)


def test_unit_of_time_is_that_of_the_substitution(pair):
    # T_H = R (pi rho1/(E* sqrt(V0)))^(2/5), above Eq. 5
    time = R * (math.pi * pair.sphere.density / (pair.effective_modulus * math.sqrt(V))) ** 0.4
    assert plate_scales(pair).time == pytest.approx(time, rel=1e-13)


def test_mobility_is_that_of_plate_theory(pair):
    # 1/(8 sqrt(D rho H)), the driving-point mobility of an infinite plate (Cremer & Heckl)
    stiffness = pair.plate.plane_modulus * H**3 / 12
    expected = 1 / (8 * math.sqrt(stiffness * pair.plate.density * H))
    assert plate_mobility(pair.plate, np.array(H)) == pytest.approx(expected, rel=1e-13)


def test_half_space_has_no_mobility(pair):
    assert plate_scales(pair, thickness=math.inf).inelasticity == 0.0


def test_yield_ratio_at_the_yield_speed(pair):
    # an elastic half-space impact at V_Y0 compresses to d_Y: w_m = (5/4)^(2/5) = y
    units = plate_scales(pair, thickness=math.inf, speed=pair.yield_speed)
    assert units.yield_ratio == pytest.approx((5 / 4) ** 0.4, rel=1e-13)


def test_a_huge_sphere_is_a_half_space(pair):
    from contactlaw import Pair

    twins = Pair(pair.sphere, pair.sphere)
    small, huge = np.array(R), np.array(1e6)
    bodies, solid = TwoSpheres(twins, MYC), sphere_mass(twins.sphere.density, small)
    size, mass = reduced(twins, small, huge)
    on_sphere = bodies.numbers(Impact(V, size, math.inf, mass / solid * (small / size) ** 3))
    on_wall = SphereOnPlate(twins, MYC).numbers(Impact(V, small, math.inf))
    for ours, limit in zip(on_sphere, on_wall, strict=True):
        assert ours == pytest.approx(limit, rel=1e-8)  # R/R2 = 1e-9
