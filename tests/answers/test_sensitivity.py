"""Elasticities against difference quotients of the solver, and invariants."""

import dataclasses
import math

import kinds
import numpy as np
import polymer
import pytest

import contactlaw as cl
from contactlaw import laws
from contactlaw.physical.law import law_for_pair, law_of

RADIUS = 0.9e-3


def log_cor(name, pair, speed, thickness):
    """With the law's numbers of the pair in full precision."""
    model = cl.ImpactModel(pair, law_for_pair(pair, law_of(pair, name)))
    return math.log(model.solve(speed, RADIUS, thickness, rtol=1e-13).restitution)


def slope(log_cor, step):
    return (log_cor(math.exp(step)) - log_cor(math.exp(-step))) / (2.0 * step)


def changed(pair, field, factor):
    sphere = dataclasses.replace(pair.sphere, **{field: factor * getattr(pair.sphere, field)})
    return cl.Pair(sphere, pair.plate)


def assert_units_change_nothing(ours):
    """Units of length, and of stress and density together, leave the COR as it is, within the stated error."""
    assert ours.radius == pytest.approx(-ours.thickness, abs=1e-5)
    stresses = ours.sphere_modulus + ours.plate_modulus + ours.yield_strength
    assert stresses + ours.sphere_density + ours.plate_density == pytest.approx(0.0, abs=1e-5)
    # Units of time change with V0, the root of stress over density.
    assert ours.speed == pytest.approx(-2 * stresses, abs=1e-5)


# next to a corner of the loading curve
CORNERS = {"kogut_etsion": 72.8, "jackson_green": 17.7}


@pytest.mark.parametrize("name", laws.names())
def test_every_law_has_its_elasticities(name, pair):
    """A law that depends on E*/sigma_Y of the pair is differentiated with respect to it too."""
    v, h = CORNERS.get(name, 12.0), 0.7e-3
    model = cl.ImpactModel(pair, law=name)
    ours = model.sensitivity(v, RADIUS, h)
    for field, by in (
        ("speed", lambda x: log_cor(name, pair, v * x, h)),
        ("thickness", lambda x: log_cor(name, pair, v, h * x)),
        ("sphere_modulus", lambda x: log_cor(name, changed(pair, "youngs_modulus", x), v, h)),
        ("yield_strength", lambda x: log_cor(name, changed(pair, "yield_strength", x), v, h)),
    ):
        assert getattr(ours, field) == pytest.approx(slope(by, 5e-4), abs=2e-6), field
    assert_units_change_nothing(ours)  # which checks the modulus of the plate too
    slow = model.sensitivity(1.0, RADIUS, h)
    assert slow.yield_strength == 0.0
    if name != "fem":  # its loading is not Hertz's below yield
        hertz = cl.ImpactModel(pair, law="hertz").sensitivity(1.0, RADIUS, h)
        assert list(vars(slow).values()) == pytest.approx(list(vars(hertz).values()), abs=1e-6)


@pytest.mark.parametrize(
    "names",
    [
        ("gamma-alumina", "glass"),  # the bead yields
        ("bearing-steel-52100", "aluminium-6061-t6"),  # the plate yields
        ("carbon-steel-1020", "carbon-steel-1020"),  # both yield
        ("soda-lime-glass", "alumina"),  # nothing does
    ],
    ids="-".join,
)
def test_units_change_nothing(names):
    """Eight inputs, each changed by itself, have three sums that are known."""
    model = cl.ImpactModel(cl.Pair(*names))
    ours = model.sensitivity(np.array([0.3, 1.0, 5.0]), 1e-3, np.array([0.8e-3, 2e-3, math.inf]))
    assert_units_change_nothing(ours)
    assert np.abs(ours.thickness[:2]).min() > 0.01 and ours.thickness[2] == 0.0
    assert model.force_law.yields or (ours.yield_strength == 0.0).all()


@pytest.mark.parametrize(
    ("bead", "least"), [(kinds.COPPER, 5e-3), (polymer.RATED, 2e-3)], ids=["rate", "rate and losses"]
)
def test_radius_and_speed_move_the_rate_and_the_frequency_of_an_impact(bead, least):
    ours = cl.ImpactModel(cl.Pair(bead, "glass")).sensitivity(3.0, 1e-3, 2e-3)
    assert abs(ours.radius + ours.thickness) > least  # without rate and losses they cancel

    def log_cor(speed=1.0, radius=1.0, **factors):
        other = dataclasses.replace(bead, **{name: by * getattr(bead, name) for name, by in factors.items()})
        model = cl.ImpactModel(cl.Pair(other, "glass"))
        return math.log(model.solve(3.0 * speed, 1e-3 * radius, 2e-3, rtol=1e-13).restitution)

    for field, name, error in (
        ("speed", "speed", 1e-4),
        ("radius", "radius", 1e-4),
        ("sphere_density", "density", 2e-3),  # the numbers of a law are rounded
        ("yield_strength", "yield_strength", 2e-3),
    ):
        expected = slope(lambda x, name=name: log_cor(**{name: x}), 1e-3)
        assert getattr(ours, field) == pytest.approx(expected, abs=error), field


def test_fem_with_numbers_in_its_name_holds_them_fixed(pair, monkeypatch):
    monkeypatch.setenv("CONTACTLAW_NO_CACHE", "1")
    own = cl.ImpactModel(pair, law="fem")
    named = cl.ImpactModel(pair, law=own.law, table=own.table)
    ours, fixed = (one.sensitivity(12.0, RADIUS, 1e-3) for one in (own, named))
    assert fixed.yield_strength == 0.0 < ours.yield_strength
    assert fixed.speed == pytest.approx(ours.speed, abs=1e-5)  # six digits
    assert fixed.sphere_modulus != pytest.approx(ours.sphere_modulus, abs=1e-3)


@pytest.mark.parametrize(
    "flow",
    [{"yield_strength": 300e6, "hardening": (500e6, 0.3)}, {"hardness": 1.2e9}, {"hardness": 1.2e9, "hardening": 0.3}],
)
def test_the_strength_is_the_whole_flow_stress(flow):
    """A factor on A and B, whether they are given or follow from a hardness."""

    def pair(**flow):
        return cl.Pair(cl.Material("metal", 200e9, 0.3, 7800, kind="metal", **flow), "glass")

    known = pair(**flow).sphere.flow

    def log_cor(factor):
        hardening = factor * known.hardening, known.exponent
        model = cl.ImpactModel(pair(yield_strength=factor * known.strength, hardening=hardening))
        return math.log(model.solve(3.0, 1e-3, 4e-3).restitution)

    expected = slope(log_cor, 0.01)
    ours = cl.ImpactModel(pair(**flow)).sensitivity(3.0, 1e-3, 4e-3)
    assert ours.yield_strength == pytest.approx(expected, rel=1e-3)
    assert expected > 0.1
