"""YADE's damping ratio against an independent integration."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from contactlaw.dashpot import betan


def restitution(beta):
    """COR of YADE's contact in units K = m = V = 1, by scipy; it ends where the force does."""

    def force(x, u):
        x = max(x, 0.0)
        return x**1.5 + 2 * beta * math.sqrt(1.5 * math.sqrt(x)) * u

    def parted(t, s):
        return force(*s) if t > 0.01 else 1.0

    parted.terminal, parted.direction = True, -1
    run = solve_ivp(
        lambda t, s: (s[1], -force(*s)), (0, 1e3), (0.0, 1.0), events=parted, method="DOP853", rtol=1e-11, atol=1e-14
    )
    return -run.y[1, -1]


@pytest.mark.parametrize("e", [0.06, 0.1353, 0.1354, 0.5, 0.9, 0.97, 0.999])
def test_yades_contact_has_the_cor_that_was_asked_for(e):
    assert restitution(betan(e)) == pytest.approx(e, abs=1e-8)


def test_small_losses_and_large_ones():
    assert betan(1.0) == 0.0
    loss = np.array([1e-9, 1e-6])
    assert betan(1 - loss) == pytest.approx(loss / math.pi * math.sqrt(5 / 6), rel=1e-5)
    assert betan(math.exp(-2)) == pytest.approx(math.sqrt(5 / 6), rel=1e-9)  # critical
    assert betan(1e-100) == pytest.approx(1e50 * math.sqrt(5 / 6) / 2, rel=1e-9)
    many = betan(np.linspace(0.01, 1, 1000).reshape(10, 100))
    assert many.shape == (10, 100)
    assert (np.diff(many.ravel()) < 0).all()


@pytest.mark.parametrize("e", [0.0, -0.5, 1.0001, math.nan, math.inf])
def test_what_no_damping_gives(e):
    with pytest.raises(ValueError, match="restitution: got"):
        betan(e)
