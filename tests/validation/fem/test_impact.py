"""Whole impacts by finite elements, on coarse meshes; `test_fit.py` computes a stored one again."""

import math

import numpy as np
import pytest

import contactlaw as cl
from validation.fem import solver
from validation.fem.impact import impact
from validation.fem.indentation import indent
from validation.paper.setting import PAIR
from validation.paper.setting import RADIUS as R


@pytest.fixture(scope="module")
def hit():
    """The paper's impact of Figs 11 to 13 on elements of 0.04 R."""
    return impact(PAIR, 26.0, R, 0.5e-3, size=0.04)


def test_hertz_is_the_limit_of_small_contacts():
    """Peak force and contact time on a block of 4.5 mm; the contact is 1/32 of the radius wide.

    Wider contacts are stiffer than Hertz's half-spaces, in proportion to their width.
    """
    found = impact(PAIR, 0.3, R, 4.5e-3, size=0.0065, width=4.5e-3, friction=0.0, yields=False)
    hertz = cl.ImpactModel(PAIR, law="hertz").solve(0.3, R, math.inf)
    assert found.peak_force == pytest.approx(hertz.peak_force, rel=0.01)
    assert found.contact_time == pytest.approx(hertz.contact_time, rel=0.01)


def test_energy_and_momentum_are_kept(hit):
    assert hit.balance < 0.01
    assert hit.hourglass < 0.02
    shares = hit.plastic + hit.wave + hit.vibration + hit.friction + hit.contact
    assert hit.restitution**2 + shares == pytest.approx(1.0, abs=0.01)
    n = int(hit.system.plate.elements.min())
    mass = 2 * math.pi * hit.system.mass[:n].sum()
    impulse = np.trapezoid(hit.force, hit.time)
    assert mass * 26.0 * (1 + hit.restitution) == pytest.approx(impulse, rel=1e-3)
    momentum = hit.system.mass @ hit.system.v[:, 1] * 2 * math.pi
    assert momentum == pytest.approx(-mass * 26.0, rel=1e-9)


@pytest.mark.parametrize(
    ("argument", "value"),
    [("size", 2.0), ("friction", -1.0), ("width", 1e-6), ("far", 0.0), ("hourglass_stiffness", math.nan)],
)
def test_wrong_arguments_are_refused(argument, value):
    with pytest.raises(ValueError, match=f"{argument}: got {value}; must lie between"):
        impact(PAIR, 26.0, R, 0.5e-3, **{argument: value})


def test_collapse_is_an_error(monkeypatch):
    """Steps far too long for central differences make the motion diverge."""
    monkeypatch.setattr(solver, "_COURANT", 4.0)
    with pytest.raises(RuntimeError, match="elements collapsed at speed 26 m/s.* coarser"):
        impact(PAIR, 26.0, R, 0.5e-3, size=0.08)
    with pytest.raises(RuntimeError, match="elements collapsed before depth"):
        indent(PAIR, R, 1e-5, size=0.08)


def test_a_sphere_that_stays_is_an_error(monkeypatch):
    monkeypatch.setattr("validation.fem.impact._GIVE_UP", 0.5)
    with pytest.raises(RuntimeError, match="still in contact"):
        impact(PAIR, 26.0, R, 0.5e-3, size=0.08)
