"""Elasticities against difference quotients of solver and scipy, and invariants."""

import dataclasses
import math

import numpy as np
import pytest
from oracle import impact

import contactlaw as cl
from contactlaw import laws
from contactlaw.equation.numbers import Impact
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.law import law_of, pair_numbers

RADIUS = 0.9e-3


def integrated(name, pair, speed, thickness):
    """Compute ln(COR) by scipy, with the law's numbers from the materials in full precision."""
    law = law_of(pair, name)
    if law.from_pair:
        law = laws.exact(name, **pair_numbers(pair, name))
    units = SphereOnPlate(pair, law).numbers(Impact(speed, RADIUS, thickness))
    y = units.yield_ratio if law.yields else 1.0
    return math.log(impact(units.inelasticity, y, law)[0])


def changed(pair, body, field, factor):
    material = getattr(pair, body)
    other = dataclasses.replace(material, **{field: getattr(material, field) * factor})
    bodies = {"sphere": pair.sphere, "plate": pair.plate, body: other}
    return cl.Pair(**bodies)


def assert_units_change_nothing(moved):
    """Units of length, and of stress and density together, leave the COR as it is, within the stated error."""
    assert moved.radius == pytest.approx(-moved.thickness, abs=1e-5)
    stresses = moved.sphere_modulus + moved.plate_modulus + moved.yield_strength
    assert stresses + moved.sphere_density + moved.plate_density == pytest.approx(0.0, abs=1e-5)
    # Units of time change with V0, the root of stress over density.
    assert moved.speed == pytest.approx(-2 * stresses, abs=1e-5)


# next to a corner of the loading curve
CORNERS = {"kogut_etsion": 72.8, "jackson_green": 17.7}


@pytest.fixture(scope="module", params=laws.names())
def any_law(request, pair, model):
    """A model of each law; of the table, where the solver answers, only the span counts."""
    if request.param in ("hertz", "myc", "fem"):
        return cl.ImpactModel(pair, law=request.param)
    law = law_of(pair, request.param)
    spans = dataclasses.replace(model.table, law=law, certificate=None)
    return cl.ImpactModel(pair, law=request.param, table=spans)


def test_every_law_has_its_elasticities(any_law):
    """A law that depends on E*/sigma_Y of the pair is differentiated with respect to it too."""
    name, pair = any_law.law.partition("(")[0], any_law.pair
    v, h = CORNERS.get(name, 12.0), 0.7e-3
    ways = {
        "speed": lambda x: integrated(name, pair, v * x, h),
        "thickness": lambda x: integrated(name, pair, v, h * x),
        "sphere_modulus": lambda x: integrated(name, changed(pair, "sphere", "youngs_modulus", x), v, h),
        "yield_strength": lambda x: integrated(name, changed(pair, "sphere", "yield_strength", x), v, h),
    }
    ours = any_law.sensitivity(v, RADIUS, h)
    step = 5e-4
    for field, way in ways.items():
        expected = (way(math.exp(step)) - way(math.exp(-step))) / (2 * step)
        assert getattr(ours, field) == pytest.approx(expected, abs=2e-6), field
    assert_units_change_nothing(ours)  # which checks the modulus of the plate too


def test_below_yield_laws_are_one(any_law):
    ours = any_law.sensitivity(1.0, RADIUS, 0.7e-3)
    assert ours.yield_strength == 0.0
    if any_law.force_law.family == "fem":  # its loading is not Hertz's below yield
        return
    hertz = cl.ImpactModel(any_law.pair, law="hertz").sensitivity(1.0, RADIUS, 0.7e-3)
    for field, value in vars(hertz).items():
        assert getattr(ours, field) == pytest.approx(value, abs=1e-6)


# sphere, plate: the bead yields, the plate, both; nothing does
PAIRS = [
    ("gamma-alumina", "glass"),
    ("bearing-steel-52100", "aluminium-6061-t6"),
    ("carbon-steel-1020", "carbon-steel-1020"),
    ("soda-lime-glass", "alumina"),
]


@pytest.mark.parametrize("names", PAIRS, ids="-".join)
def test_units_change_nothing(names):
    """Eight inputs, each changed by itself, have three sums that are known."""
    model = cl.ImpactModel(cl.Pair(*names))
    ours = model.sensitivity(np.array([0.3, 1.0, 5.0]), 1e-3, np.array([0.8e-3, 2e-3, math.inf]))
    assert_units_change_nothing(ours)
    assert np.abs(ours.thickness[:2]).min() > 0.01 and ours.thickness[2] == 0.0
    if not model.force_law.yields:
        assert (ours.yield_strength == 0.0).all()


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
    metal = cl.Material("metal", 200e9, 0.3, 7800, kind="metal", **flow)
    plate = cl.Material("plate", 70e9, 0.22, 2500)
    impact = 3.0, 1e-3, 4e-3

    def cor(factor):
        known = metal.flow
        body = cl.Material(
            "metal",
            200e9,
            0.3,
            7800,
            yield_strength=factor * known.strength,
            hardening=(factor * known.hardening, known.exponent),
            kind="metal",
        )
        return cl.ImpactModel(cl.Pair(body, plate)).solve(*impact).restitution

    expected = math.log(cor(1.01) / cor(0.99)) / math.log(1.01 / 0.99)
    found = cl.ImpactModel(cl.Pair(metal, plate)).sensitivity(*impact)
    assert found.yield_strength == pytest.approx(expected, rel=1e-3)
    assert expected > 0.1


def test_on_a_half_space_the_plate_does_not_bend(model):
    one = model.sensitivity(20.0, RADIUS, math.inf)
    assert one.thickness == 0.0
    assert (one.radius, one.plate_density) == pytest.approx((0.0, 0.0), abs=1e-8)
    v = 20.0 / model.pair.yield_speed
    q = v**-0.8
    exact = -0.8 * q * (1 - q) / (2 * (1 - (1 - q) ** 2))  # Eq. 21
    assert one.speed == pytest.approx(exact, abs=1e-5)


def test_shapes_and_refusals(model):
    assert model.sensitivity([1.0, 2.0], RADIUS, [[1e-3], [2e-3], [3e-3]]).speed.shape == (3, 2)
    assert isinstance(model.sensitivity(1.0, RADIUS, 1e-3).speed, float)
    with pytest.raises(ValueError, match="outside the table"):
        model.sensitivity(5.0, RADIUS, 1e-5)
    with pytest.raises(ValueError, match="speed: got -1.0"):
        model.sensitivity(-1.0, RADIUS, 1e-3)
