"""Each limit is flagged on its far side and not on its near side."""

import math

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import Validity, explain

R = 0.9e-3


def flags(model, speed=2.0, radius=R, thickness=1e-3):
    return model.lookup(speed, radius, thickness).flags


def test_inside_every_limit(model):
    assert flags(model) == Validity(0)


def test_thin_plate(model):
    assert flags(model, thickness=R / 1.79) == Validity(0)
    assert flags(model, thickness=R / 1.81) == Validity.THIN_PLATE


def test_a_thinner_plate_for_the_law_fem():
    """Whether or not a body yields."""
    steel = (
        cl.ImpactModel(cl.Pair("glass", "tungsten-carbide")),
        cl.ImpactModel(cl.Pair("aluminium-2024-t3", "bearing-steel-52100")),
    )
    for model in steel:
        for slenderness, thin in ((5.79, 0), (5.81, Validity.THIN_PLATE)):
            assert model.solve(0.5, R, R / slenderness).flags == thin


def test_fast_impact(model):
    assert flags(model, speed=6.99 * model.pair.yield_speed) == Validity(0)
    assert flags(model, speed=7.01 * model.pair.yield_speed) == Validity.FAST_IMPACT


def test_thick_plate(model):
    glass = model.pair.plate
    nu = glass.poissons_ratio
    # pressure wave speed of an elastic solid, sqrt((lambda + 2 mu)/rho)
    mu = glass.youngs_modulus / 2 / (1 + nu)
    lame = glass.youngs_modulus * nu / (1 + nu) / (1 - 2 * nu)
    wave_speed = math.sqrt((lame + 2 * mu) / glass.density)
    limit = model.lookup(2.0, R, 8e-3).contact_time * wave_speed / 6
    assert flags(model, thickness=0.99 * limit) == Validity(0)
    assert flags(model, thickness=1.01 * limit) == Validity.THICK_PLATE
    assert flags(model, thickness=math.inf) == Validity(0)  # no thickness to cross


def test_soft_plate():
    bearing, mild = "bearing-steel-52100", "carbon-steel-1020"
    soft = cl.ImpactModel(cl.Pair(bearing, mild), law="myc")
    assert soft.lookup(0.5, 1e-3, 2e-3).flags & Validity.SOFT_PLATE
    hard = cl.ImpactModel(cl.Pair(mild, bearing), law="myc", outside="clamp")
    assert not hard.lookup(0.005, 1e-3, 2e-3).flags & Validity.SOFT_PLATE


def test_other_law(model):
    steel = cl.ImpactModel(cl.Pair("bearing-steel-52100", "soda-lime-glass"), law="myc")
    speed = steel.pair.yield_speed
    assert not steel.lookup(1.99 * speed, R, 2e-3).flags & Validity.OTHER_LAW
    assert steel.lookup(2.01 * speed, R, 2e-3).flags & Validity.OTHER_LAW
    assert not flags(model, speed=3.0 * model.pair.yield_speed) & Validity.OTHER_LAW
    fits = cl.ImpactModel(steel.pair, law="kogut_etsion", outside="solve")
    assert not fits.solve(3.0 * speed, R, 2e-3).flags & Validity.OTHER_LAW
    elastic = cl.ImpactModel(steel.pair, law="hertz")  # is wrong as soon as the bead yields
    assert not elastic.lookup(0.99 * speed, R, 2e-3).flags & Validity.OTHER_LAW
    assert elastic.lookup(1.01 * speed, R, 2e-3).flags & Validity.OTHER_LAW
    metal = cl.ImpactModel(model.pair, law="kogut_etsion", outside="solve")
    assert metal.solve(3.0 * model.pair.yield_speed, R, 2e-3).flags & Validity.OTHER_LAW


@pytest.mark.parametrize("law", ["fem", "myc"])
def test_a_strength_from_hardness_is_flagged_where_such_a_body_yields(law):
    """Plates of 0.35 and 0.37 of its strength: next to the first such a bead does not yield."""
    ball = cl.Material("ball", 207e9, 0.3, 7850, hardness=1.8e9, kind="metal")
    known = cl.Material("ball", 207e9, 0.3, 7850, hardness=1.8e9, kind="metal", hardening=0.2)
    plates = [
        cl.Material("plate", 70e9, 0.33, 2700, yield_strength=share * ball.strength) for share in (2.0, 0.37, 0.35)
    ]
    hardened = [(known, plates[0])] if law == "fem" else []  # other laws refuse hardening
    for bodies in [*((ball, plate) for plate in plates), *hardened]:
        model, first = cl.ImpactModel(cl.Pair(*bodies), law), cl.Pair(*bodies).yield_speed
        flagged = Validity.FROM_HARDNESS * (bodies[0] is ball and bodies[1] is not plates[2])
        for speed, expected in ((0.9 * first, 0), (1.1 * first, flagged)):
            assert model.solve(speed, R, 1.0).flags & Validity.FROM_HARDNESS == expected


def test_two_beads_have_the_flags_of_their_own_yield_speed(model):
    """V^2 goes as R*^3/m*; a bead as large as a wall is a half-space."""
    beads = cl.ImpactModel(cl.Pair(model.pair.sphere, model.pair.sphere), law="myc")
    for other in (0.1 * R, R, 1e3):
        share = math.sqrt((R**3 + other**3) / (R + other) ** 3)
        for factor, flag in ((6.99, 0), (7.01, Validity.FAST_IMPACT)):
            speed = factor * share * beads.pair.yield_speed
            hit = beads.lookup_sphere_sphere(speed, R, other)
            assert hit.flags & Validity.FAST_IMPACT == flag


def test_every_flag_has_words():
    single = [flag for flag in Validity if flag != Validity.ACCURACY]
    assert {flag.value for flag in single} == {1 << n for n in range(len(single))}
    assert all(len(explain(flag)) == 1 for flag in single)
    assert explain(0) == () and len(explain(sum(single))) == len(single)
    assert sum(single) & ~Validity.ACCURACY == Validity.DAMAGE  # no limit of accuracy


def test_flags_of_arrays(model):
    both = model.lookup(2.0, R, [1e-3, 0.4e-3]).flags
    assert both.tolist() == [0, int(Validity.THIN_PLATE)]


@pytest.mark.parametrize("bead, speed", [("glass", 2.0), ("aluminium-6061-t6", 3.0)])
@pytest.mark.parametrize("thickness, bound", [(1.0, 0.0025), (0.7, 0.006), (0.5, 0.06)])
def test_edges_hardly_matter_beyond_the_edge_distance(bead, speed, thickness, bound):
    """For inelasticities of 0.2 to 1, as its docstring says."""
    model, h = cl.ImpactModel(cl.Pair(bead, "glass")), thickness * R
    far = model.solve(speed, R, h)
    beyond = np.linspace(1.0, 2.0, 9) * cl.edge_distance(model.pair.plate, h, far.contact_time)
    for edge in ("free", "supported", "clamped"):
        near = model.solve(speed, R, h, edge=edge, edge_distance=beyond).restitution
        assert np.abs(near - far.restitution).max() < min(0.003, bound * far.restitution), edge
        near = model.solve(speed, R, h, edge=edge, edge_distance=0.5 * beyond[0]).restitution
        assert abs(near - far.restitution) > 0.01 * far.restitution, edge


@pytest.mark.parametrize("bad", [0.0, -1e-3, math.nan, "thick"])
def test_edge_distance_refuses(bad):
    glass = cl.material("glass")
    with pytest.raises(ValueError, match="^thickness: "):
        cl.edge_distance(glass, bad, 5e-6)
    with pytest.raises(ValueError, match="^contact_time: "):
        cl.edge_distance(glass, 1e-3, bad)
    assert cl.edge_distance(glass, [1e-3, 4e-3], 5e-6).shape == (2,)
