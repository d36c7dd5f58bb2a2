"""Finite elements with losses against closed forms, and against a solution of their own kind."""

import math

import numpy as np
import pytest

import contactlaw as cl
from validation.fem import prony
from validation.fem.impact import impact
from validation.fem.viscoelastic import ELASTIC_PEAK, ELASTIC_TIME, power_law, rebound

NU, LOSS, TIME = 0.35, 0.2, 5e-5
LOSSY = cl.Material("lossy", 3e9, NU, 1200.0, loss_factor=(LOSS, 1e4))


@pytest.mark.long
@pytest.mark.parametrize("branches", ["standard solid", "constant loss"])
def test_impact_of_lossy_bodies_is_hertzs_with_memory(branches, monkeypatch):
    """Contact of 1/37 of the radius, on a plate of ten times the modulus."""
    plate = cl.Material("plate", 3e10, NU, 3000.0, loss_factor=(LOSS, 1e4))
    hertz = cl.ImpactModel(cl.Pair(LOSSY, plate), law="hertz").solve(0.1, 1e-3, math.inf)
    time = float(hertz.contact_time)
    relaxed, sphere = (power_law(LOSS), cl.Material("sphere", 3e9, NU, 1200.0, loss_factor=(LOSS, 0.5 / time)))
    plate = cl.Material("plate", 3e10, NU, 3000.0, loss_factor=sphere.loss_factor)
    if branches == "standard solid":
        monkeypatch.setattr(prony, "series", lambda *_: prony.Prony(np.array([0.6]), np.array([0.25 * time]), 1.0))
        tau = 0.25 * ELASTIC_TIME
        relaxed = lambda t: 0.4 * t - 0.6 * tau * np.expm1(-t / tau)  # noqa: E731
    wanted = rebound(relaxed, 2000)
    pair, sizes = cl.Pair(sphere, plate), (0.1, 1e-3, 5e-3)
    found = impact(pair, *sizes, size=6e-3, width=1e-2, friction=0.0, yields=False)
    assert found.restitution == pytest.approx(wanted.restitution, rel=0.01)
    assert found.contact_time / time == pytest.approx(wanted.contact_time / ELASTIC_TIME, rel=0.02)
    force = wanted.peak_force / ELASTIC_PEAK[0] * hertz.peak_force
    assert found.peak_force == pytest.approx(force, rel=0.02)
    approach = wanted.peak_approach / ELASTIC_PEAK[1] * hertz.peak_compression
    assert found.peak_compression == pytest.approx(approach, rel=0.02)
    assert found.balance < 2e-3
    shares = found.viscous + found.wave + found.vibration + found.contact
    assert found.restitution**2 + shares == pytest.approx(1.0, abs=2e-3)


def test_weak_viscosity_is_kuwabaras_and_konos():
    """COR 1 - C x, x = 1.5 A V^0.2 (Ramirez et al., Phys. Rev. E 60 (1999) 4465).

    C from the loss of an elastic impact, 3 A times the integral of sqrt(d) d'.
    """
    beta = math.gamma(0.6) * math.gamma(1.5) / math.gamma(2.1)
    first = 2.0 * 1.25**0.6 * 0.4 * beta
    loss = []
    for x in (0.01, 0.02):
        # errors of the first order in the step: the dashpot's force is that of half a step before
        cor = [rebound(lambda t, x=x: t + x / 1.5 * (t > 0.0), steps).restitution for steps in (1000, 2000)]
        loss.append((1.0 - 2.0 * cor[1] + cor[0]) / x)
    assert 2.0 * loss[0] - loss[1] == pytest.approx(first, rel=2e-3)
