"""Finite elements with hardening and rate, against scipy, closed forms and CalculiX."""

import dataclasses

import numpy as np
import pytest
from scipy.optimize import brentq

import contactlaw as cl
from contactlaw.physical.flow import Flow
from tests.validation.fem.test_solver import STEEL, alone, block
from validation.fem import elements, store
from validation.fem.flow_stress import flow_stress, returned
from validation.fem.indentation import indent
from validation.fem.yielding import HARDENING, HARDENING_DEPTH, HARDENING_SIZE, RADIUS, SOFT

COPPER = Flow(90e6, 292e6, 0.31, 0.025, 1.0)
SHEAR = 45e9


@pytest.mark.parametrize("strain", [0.0, 1e-6, 0.05])
@pytest.mark.parametrize("over", [1e-7, 1e-3, 0.5])
@pytest.mark.parametrize("dt", [1e-11, 1e-9, 1e3])
def test_the_return_solves_its_equation(strain, over, dt):
    """brentq finds the same root; with dt = 1e3 s the rate is below rate0."""
    trial = COPPER.stress(strain) * (1.0 + over)

    def off(x):
        return trial - 3.0 * SHEAR * x - COPPER.stress(strain + x, x / dt)

    expected = brentq(off, 0.0, trial / (3.0 * SHEAR), xtol=1e-300, rtol=1e-14)
    found, stress = returned(flow_stress(COPPER), trial, strain, SHEAR, dt)
    assert found == pytest.approx(expected, rel=1e-9)
    assert stress == pytest.approx(COPPER.stress(strain + found, found / dt), rel=1e-9)


@pytest.mark.parametrize("rate", [1e2, 1e4])
def test_a_block_compressed_at_constant_speed_has_the_flow_stress(rate):
    """Uniaxial stress is sigma(strain, rate), the sides being free."""
    metal = dataclasses.replace(STEEL, hardening=(300e6, 0.4), rate=(0.05, 1.0))
    one = block(2, 2, 1e-3, 1e-3)
    body, x = alone(one, metal, yields=True)[0].plate, one.nodes.copy()
    bulk = body.bulk + 2.0 / 3.0 * body.shear
    steps = 4000
    dt = 0.05 / rate / steps
    for _ in range(steps):
        # the sides move at the rate that takes the stress across back to zero
        side = 0.3 * rate if body.plastic_strain[0] == 0.0 else 0.5 * rate
        side -= body.stress[:, 0].mean() / (2.0 * bulk * dt)
        v = x * [side, -rate]
        elements.add_forces(body, x, v, dt, np.zeros_like(x))
        x += dt * v
    stress = body.stress.mean(axis=0)
    assert abs(stress[0]) < 1e-3 * abs(stress[1])
    strain = body.plastic_strain[0]
    assert stress[0] - stress[1] == pytest.approx(metal.flow.stress(strain, rate), rel=2e-3)


def test_hardening_indentation_agrees_with_calculix():
    """CalculiX, an implicit program, ran the same mesh; a coarser one is computed here.

    Works are compared: the force steps by some per cent where a node joins the contact.
    """
    found, made = store.read("calculix_hardening")
    assert "hardening (500000000.0, 0.3)" in made["sphere"]
    theirs = _works(found["compression"], found["force"])
    ours = _works(found["own_compression"], found["own_force"])
    assert ours[0] == pytest.approx(theirs[0], rel=0.012)
    assert ours[1] / ours[0] == pytest.approx(theirs[1] / theirs[0], abs=0.005)
    soft = cl.Pair(SOFT, HARDENING.plate)
    hard, ideal = (
        _works(press.compression, press.force)
        for press in (indent(pair, RADIUS, HARDENING_DEPTH, size=2.0 * HARDENING_SIZE) for pair in (HARDENING, soft))
    )
    assert hard[0] == pytest.approx(theirs[0], rel=0.03)
    assert ideal[0] < 0.7 * theirs[0]


def _works(compression, force):
    """Works of loading and of unloading."""
    top = int(compression.argmax())
    up, down = slice(None, top + 1), slice(top, None)
    return [abs(np.trapezoid(force[part], compression[part])) for part in (up, down)]
