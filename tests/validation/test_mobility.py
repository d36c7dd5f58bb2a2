"""The mobility of an infinite plate, from elasticity alone, and the fit of it that the model takes.

Units: thickness, density and shear modulus of the plate are 1, so the frequency is omega H/c.
"""

import math

import numpy as np
import pytest

from contactlaw.equation import corrections
from validation.derivations.mobility import MEAN, SQUARE, elastic, energy, half_space, kirchhoff, panels, ratio

POISSON = [0.0, 0.2, 0.3, 0.35, 0.45]


def share(omega, poisson):
    """Mobility of the bending wave over Kirchhoff's, by an integral along a path around the poles.

    On the real axis the integrand is real; the arc ends beyond the last pole.
    """
    end = 2.0 * max(math.sqrt(8.0 * kirchhoff(poisson) * omega), 1.2 * omega)
    angle, weight = panels(np.linspace(0.0, math.pi, 9))
    k = end / 2.0 * (1.0 - np.cos(angle)) + 0.1j * end * np.sin(angle)
    step = end / 2.0 * np.sin(angle) + 0.1j * end * np.cos(angle)
    integral = np.sum(weight * step * k * elastic(k, omega, poisson, 1.0)[0])
    return float(abs(omega / (2.0 * math.pi) * integral.imag) / kirchhoff(poisson))


@pytest.mark.parametrize("poisson", POISSON)
def test_elastic_plate_at_low_frequency(poisson):
    first = 8.0 * kirchhoff(poisson) / 5.0
    second = (509.0 - 1158.0 * poisson + 817.0 * poisson**2) / (6720.0 * (1.0 - poisson))
    for omega, limit in ((0.01, 1e-7), (0.1, 1e-5), (0.5, 2e-3)):
        bending = share(omega, poisson)
        assert bending == pytest.approx(1.0 + first * omega + second * omega**2, rel=limit)


def test_half_space_of_miller_and_pursey():
    # mean power of a force of amplitude P: 4.836 (omega P)^2/(4 pi rho c_L^3), Poisson's ratio 1/4
    assert half_space(0.25) * ratio(0.25) ** -1.5 * 2.0 * math.pi == pytest.approx(4.836, rel=2e-4)


@pytest.mark.parametrize("poisson", [0.2, 0.35])
def test_energy_of_an_impact(poisson):
    echo = 0.5 / math.sqrt(ratio(poisson))
    first = 8.0 * kirchhoff(poisson) / 5.0 * MEAN
    thick = half_space(poisson) / kirchhoff(poisson) * SQUARE
    assert energy(0.01, poisson) == pytest.approx(1.0 + first * 0.01, abs=1e-4)
    # an echo needs the time 2 H/c_L: beyond h = c_L/(2 c) the plate is a half-space, exactly
    assert energy(1.05 * echo, poisson) == pytest.approx(thick * (1.05 * echo) ** 2, rel=3e-4)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.45])
def test_the_model_has_the_energy_of_an_impact(poisson):
    """The model is within 1.2 % of the integral, on plates of any thickness."""
    one = corrections.plate_corrections(poisson)
    for x in (0.1, 0.4, 0.65, 1.0):
        h = x * 0.5 / math.sqrt(ratio(poisson))
        phi = one.bulk_factor * h * h + corrections.near_field(one, h)
        assert phi == pytest.approx(energy(h, poisson), rel=1.2e-2)
