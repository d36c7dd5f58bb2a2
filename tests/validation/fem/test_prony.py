"""Finite elements with losses against closed forms, and against a solution of their own kind."""

import math

import numpy as np
import pytest

import contactlaw as cl
from validation.fem import elements, prony, solver
from validation.fem.cases import material
from validation.fem.impact import impact
from validation.fem.viscoelastic import ELASTIC_PEAK, ELASTIC_TIME, power_law, rebound

from .test_solver import block

NU, LOSS, TIME = 0.35, 0.2, 5e-5
LOSSY = cl.Material("lossy", 3e9, NU, 1200.0, loss_factor=(LOSS, 1e4))


@pytest.mark.parametrize("frequency", [1e4, 4e4])
def test_strained_block_stores_and_loses_as_its_springs_and_dashpots(frequency):
    """Axial strain of 1e-5 between walls, six cycles; the last one is compared."""
    one = block(1, 1, 1.0, 1.0, inner=10.0)
    body, strain, steps = solver.body(one, LOSSY, 0, 1.0, False, TIME), 1e-5, 4000
    omega, x, force = 2.0 * math.pi * frequency, one.nodes.copy(), np.zeros_like(one.nodes)
    phase = 2.0 * math.pi * (np.arange(6 * steps) + 0.5) / steps
    dt, stress, lost = 1.0 / frequency / steps, [], 0.0
    for n, speed in enumerate(strain * omega * np.cos(phase)):
        if n == 5 * steps:
            lost = body.work[2]
        v = np.column_stack([np.zeros(4), speed * one.nodes[:, 1]])
        x += dt * v
        elements.add_forces(body, x, v, dt, force)
        stress.append(body.stress[0].copy())
    last, turn = np.array(stress)[-steps:], np.exp(-1j * (phase[-steps:] + math.pi / steps))
    axial = 2j * np.mean(last[:, 1] * turn) / strain
    confined = LOSSY.youngs_modulus * (1.0 - NU) / (1.0 + NU) / (1.0 - 2.0 * NU)
    series = prony.response(prony.series(LOSSY, TIME), np.array([omega])).item() * confined
    ideal = prony.modulus(LOSSY, np.array([omega])).item() * confined
    assert (axial.real, axial.imag) == pytest.approx((series.real, series.imag), rel=5e-3)
    assert axial.real == pytest.approx(ideal.real, rel=5e-3)
    assert axial.imag / axial.real == pytest.approx(LOSS, rel=0.04)
    assert last[:, 0] == pytest.approx(NU / (1.0 - NU) * last[:, 1], rel=1e-6)
    loss = math.pi * series.imag * strain**2 * elements.volumes(body.elements, one.nodes).item()
    assert body.work[2] - lost == pytest.approx(loss, rel=5e-3)


@pytest.mark.parametrize("branches", ["standard solid", pytest.param("constant loss", marks=pytest.mark.long)])
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
    assert first == pytest.approx(1.15344, abs=2e-4)
    loss = []
    for x in (0.01, 0.02):
        # errors of the first order in the step: the dashpot's force is that of half a step before
        cor = [rebound(lambda t, x=x: t + x / 1.5 * (t > 0.0), steps).restitution for steps in (1000, 2000)]
        loss.append((1.0 - 2.0 * cor[1] + cor[0]) / x)
    assert 2.0 * loss[0] - loss[1] == pytest.approx(first, rel=2e-3)


def test_constant_loss_of_a_hertz_impact():
    """Values of record, and that they are no matter of steps or branches.

    The force of Lee & Radok carried on where the contact shrinks would pull at released points, and
    give 0.872, 0.761, 0.582.
    """
    for loss, cor in ((0.1, 0.8846), (0.2, 0.7801), (0.4, 0.6056)):
        assert rebound(power_law(loss), 1000).restitution == pytest.approx(cor, abs=1e-4)
        body = material(f"pmma, loss {loss} {0.5 / ELASTIC_TIME}")
        found = prony.series(body, ELASTIC_TIME)

        def relaxed(t, found=found):
            branches = -np.expm1(-t / found.times[:, None])
            return (found.whole - found.moduli.sum()) * t + found.moduli * found.times @ branches

        assert rebound(relaxed, 1000).restitution == pytest.approx(cor, rel=2e-3)
