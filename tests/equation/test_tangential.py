"""Tangential motion of a contact against 400 springs of scipy, closed forms and limits."""

import math

import numpy as np
import pytest
from overloads import solved_at
from springs import slide

from contactlaw import laws
from contactlaw.table.slides import after

MYC = laws.law("myc")
PSI = np.array([0.0, 0.02, 0.1, 0.3, 0.7, 1.0, 1.5, 2.2, 3.0, 4.0, 5.0, 6.0, 7.0, 9.0, 12.0])


def solved(lam, chi, law=MYC):
    """Outcome of one impact, and its yield ratio."""
    return solved_at(law, np.array([lam]), np.array([chi]), 1e-11)


@pytest.mark.parametrize("kappa", [0.8, *(pytest.param(kappa, marks=pytest.mark.long) for kappa in (0.6, 1.0))])
@pytest.mark.parametrize(("lam", "chi"), [(0.0, 0.9), (0.3, 3.0), (1.0, 12.0), (2.0, 40.0)])
def test_springs_of_scipy(lam, chi, kappa):
    found = solved(lam, chi)
    ours = after(MYC.data, found, kappa, PSI[None])[0]
    y = found.yield_ratio[0]
    assert np.abs(ours - slide(lam, y, kappa, PSI)).max() < 1e-3


def test_full_sliding_takes_the_whole_impulse():
    for lam, chi in ((0.0, 0.9), (0.5, 5.0), (2.0, 30.0)):
        found = solved(lam, chi)
        for samples, springs in ((11, 2), (801, 64)):
            speed = after(MYC.data, found, 0.8, np.array([[20.0, -20.0]]), samples, springs)[0]
            left = 20.0 - 3.5 * (1.0 + found.restitution[0])
            assert speed == pytest.approx([left, -left], abs=1e-9)


@pytest.mark.parametrize(("kappa", "beta"), [(2 / 3, 0.11), (0.83, -0.24), (1.0, -0.39)])
def test_a_contact_that_sticks(kappa, beta):
    # the limit of small psi, found by another program and given with two digits
    speed = after(MYC.data, solved(0.0, 0.9), kappa, np.array([[1e-4]]))[0, 0]
    assert -speed / 1e-4 == pytest.approx(beta, abs=0.01)


def test_no_impact_makes_energy():
    generator = np.random.default_rng(0)
    worst = -math.inf
    for _ in range(200):
        lam, chi = generator.uniform(0, 1.5) ** 2, np.exp(generator.uniform(-1, 3.6))
        psi = generator.uniform(-12, 12, 500)
        kappa = generator.uniform(0.66, 1.34)
        speed = after(MYC.data, solved(lam, chi), kappa, psi[None], 101, 8)[0]
        worst = max(worst, (np.abs(speed) - np.abs(psi)).max())
    assert worst < 1e-12
