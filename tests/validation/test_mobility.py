"""The mobility of an infinite plate, from elasticity alone, and the fit of it that the model takes.

Units: thickness, density and shear modulus of the plate are 1, so the frequency is omega H/c.
"""

import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import jv

from contactlaw.equation import corrections
from validation.derivations.mobility import (
    MEAN,
    SQUARE,
    elastic,
    energy,
    half_space,
    kirchhoff,
    panels,
    ratio,
    regular,
)

Complex = NDArray[np.complex128]
Compliance = Callable[[Complex], Complex]

BENDING, EXTENSION = 0, 1
POISSON = [0.0, 0.2, 0.3, 0.35, 0.45]


def mindlin(omega: float, poisson: float, shear: float, radius: float = 0.0) -> Compliance:
    """Deflection of a Mindlin plate, averaged over the disc that carries the load."""

    def compliance(k: Complex) -> Complex:
        x = k * k
        bending = x / (6.0 * (1.0 - poisson)) + shear - omega**2 / 12.0
        disc = 2.0 * jv(1, k * radius) / (k * radius) if radius else np.ones_like(k)
        return disc**2 * bending / ((shear * x - omega**2) * bending - shear**2 * x)

    return compliance


def mode(omega: float, poisson: float, which: int) -> Compliance:
    return lambda k: elastic(k, omega, poisson, 1.0)[which]


def share(compliance: Compliance, omega: float, poisson: float) -> float:
    """Real part of the mobility over Kirchhoff's, by an integral along a path around the poles.

    On the real axis the integrand is real; the arc ends beyond the last pole.
    """
    end = 2.0 * max(math.sqrt(8.0 * kirchhoff(poisson) * omega), 1.2 * omega)
    angle, weight = panels(np.linspace(0.0, math.pi, 9))
    k = end / 2.0 * (1.0 - np.cos(angle)) + 0.1j * end * np.sin(angle)
    step = end / 2.0 * np.sin(angle) + 0.1j * end * np.cos(angle)
    integral = np.sum(weight * step * k * compliance(k))
    return float(abs(omega / (2.0 * math.pi) * integral.imag) / kirchhoff(poisson))


@pytest.mark.parametrize("poisson", POISSON)
@pytest.mark.parametrize("shear", [math.pi**2 / 12.0, 5.0 / 6.0])
def test_mindlin_plate(poisson: float, shear: float) -> None:
    omega = 1e-3
    slope = (share(mindlin(omega, poisson, shear), omega, poisson) - 1.0) / omega
    assert slope == pytest.approx(1.0 / (8.0 * kirchhoff(poisson) * shear), rel=1e-3)


def test_disc_of_load_takes_its_square_off_the_slope() -> None:
    omega, poisson, shear, radius = 1e-3, 0.3, math.pi**2 / 12.0, 0.2
    point = share(mindlin(omega, poisson, shear), omega, poisson)
    disc = share(mindlin(omega, poisson, shear, radius), omega, poisson)
    assert (point - disc) / omega == pytest.approx(2.0 * kirchhoff(poisson) * radius**2, rel=1e-2)


@pytest.mark.parametrize("poisson", POISSON)
def test_elastic_plate_at_low_frequency(poisson: float) -> None:
    first = 8.0 * kirchhoff(poisson) / 5.0
    second = (509.0 - 1158.0 * poisson + 817.0 * poisson**2) / (6720.0 * (1.0 - poisson))
    for omega, limit in ((0.01, 1e-7), (0.1, 1e-5), (0.5, 2e-3)):
        bending = share(mode(omega, poisson, BENDING), omega, poisson)
        assert bending == pytest.approx(1.0 + first * omega + second * omega**2, rel=limit)


@pytest.mark.parametrize("poisson", POISSON)
def test_mindlin_lacks_the_strain_across_the_thickness(poisson: float) -> None:
    omega, root = 1e-3, 8.0 * kirchhoff(poisson)
    plate = share(mindlin(omega, poisson, 5.0 / (6.0 - poisson)), omega, poisson)
    bending = share(mode(omega, poisson, BENDING), omega, poisson)
    strain = root * poisson / (6.0 * (1.0 - poisson))
    assert (plate - bending) / omega == pytest.approx(strain, abs=5e-4)


def test_lamb_mode_carries_all_of_it() -> None:
    omega, poisson = 1.0, 0.3

    def inverse(k: float) -> float:
        return float(1.0 / mode(omega, poisson, BENDING)(np.array([k + 0j]))[0].real)

    root = brentq(inverse, 1.1, 3.0, xtol=1e-13)
    slope = (inverse(root + 1e-4) - inverse(root - 1e-4)) / 2e-4
    residue = omega / 2.0 * root / abs(slope) / kirchhoff(poisson)
    path = share(mode(omega, poisson, BENDING), omega, poisson)
    assert residue == pytest.approx(path, rel=1e-6)


def test_extensional_mode_is_of_third_order() -> None:
    omega, poisson = 0.1, 0.3
    extension = share(mode(omega, poisson, EXTENSION), omega, poisson)
    assert extension * kirchhoff(poisson) == pytest.approx(
        (omega * poisson) ** 2 * omega / 64, rel=1e-3
    )


@pytest.mark.parametrize("poisson", [0.2, 0.3, 0.35])
def test_local_give_of_the_plate(poisson: float) -> None:
    decay = 0.003  # in exp(decay t): the part in phase with the force, without oscillation
    excess = regular(-1j * decay, poisson, 1.0).real / kirchhoff(poisson) - 1.0
    give = 2.0 * kirchhoff(poisson) / (1.0 - poisson) * excess / decay  # in F/(E2' H)
    assert give == pytest.approx(-0.6 / math.pi * math.log(decay) - 0.665, abs=3e-3)


def test_half_space_of_miller_and_pursey() -> None:
    # mean power of a force of amplitude P: 4.836 (omega P)^2/(4 pi rho c_L^3), Poisson's ratio 1/4
    assert half_space(0.25) * ratio(0.25) ** -1.5 * 2.0 * math.pi == pytest.approx(4.836, rel=2e-4)


@pytest.mark.parametrize("poisson", [0.2, 0.35])
def test_energy_of_an_impact(poisson: float) -> None:
    echo = 0.5 / math.sqrt(ratio(poisson))
    first = 8.0 * kirchhoff(poisson) / 5.0 * MEAN
    thick = half_space(poisson) / kirchhoff(poisson) * SQUARE
    power = 6.0 / echo**1.2

    def fit(h: float) -> float:
        thin = 1.0 + first * h + 0.95 * h**2
        return float((thin**power + (thick * h**2) ** power) ** (1.0 / power))

    assert energy(0.01, poisson) == pytest.approx(1.0 + first * 0.01, abs=1e-4)
    for h in (0.05, 0.3, 0.6):
        assert energy(h, poisson) == pytest.approx(fit(h), rel=8e-3)
    # an echo needs the time 2 H/c_L: beyond h = c_L/(2 c) the plate is a half-space, exactly
    assert energy(1.05 * echo, poisson) == pytest.approx(thick * (1.05 * echo) ** 2, rel=3e-4)


RATIOS = np.linspace(0.0, 0.45, 10)


def phi(one: corrections.PlateCorrections, h: float) -> float:
    """Factor phi on the mobility of a thin plate."""
    return one.bulk_factor * h * h + corrections.near_field(one, h)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.45])
def test_the_model_has_the_energy_of_an_impact(poisson: float) -> None:
    """The model is within 1.2 % of the integral, on plates of any thickness."""
    one = corrections.plate_corrections(poisson)
    for x in (0.1, 0.4, 0.65, 1.0):
        h = x * 0.5 / math.sqrt(ratio(poisson))
        assert phi(one, h) == pytest.approx(energy(h, poisson), rel=1.2e-2)


@pytest.mark.parametrize("poisson", RATIOS)
def test_a_thicker_plate_never_takes_more(poisson: float) -> None:
    """The factor over h^2 falls to that of the half-space, and never below it."""
    one = corrections.plate_corrections(poisson)
    h = np.linspace(1e-3, 1.5, 1500)
    over = np.array([phi(one, each) / each**2 for each in h])
    assert (np.diff(over) <= 1e-12 * over[1:]).all()
    assert over.min() >= one.bulk_factor * (1.0 - 1e-12)


@pytest.mark.parametrize("poisson", RATIOS)
@pytest.mark.parametrize("far", [0.01, 0.1, 0.5, 2.0])  # lambda of a half-space
def test_lambda_falls_with_the_thickness(poisson: float, far: float) -> None:
    """Lambda falls for any sphere, although losses lengthen only contacts with thin plates."""
    one = corrections.plate_corrections(poisson)
    h = np.geomspace(0.02, 30.0, 1000)
    thin = far / one.bulk_factor / h**2
    lam = [
        corrections.with_corrections(one, t, each, t * each**2, 0.0)
        for t, each in zip(thin, h, strict=True)
    ]
    assert (np.diff(lam) <= 1e-12 * np.array(lam[1:])).all()
