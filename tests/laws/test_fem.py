"""The law fem where people meet it: flags of other laws, energies, tables, engines, two beads."""

import dataclasses
import functools
import math
import warnings

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import Validity, explain, laws
from contactlaw.physical.law import law_of
from validation.fem import census

R = 1e-3
ENERGIES = ("plastic_fraction", "wave_fraction", "other_fraction")


@pytest.fixture(autouse=True, scope="module")
def no_folder():
    """Keep the tables of the many pairs here out of the user's cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("CONTACTLAW_NO_CACHE", "1")
        yield


@functools.cache
def model_of(sphere, plate, law="fem"):
    return cl.ImpactModel(cl.Pair(sphere, plate), law=law)


@functools.cache
def solver_of(pair):
    """A model that only solves: its table belongs to another law and is not used."""
    spans = model_of("gamma-alumina", "glass").table
    table = dataclasses.replace(spans, law=law_of(pair, "fem"), certificate=None)
    return cl.ImpactModel(pair, law="fem", table=table)


# Pairs and speeds for which a user chose a law that does not suit them.


@pytest.mark.parametrize(
    ("modulus", "density", "kind", "depends"),
    [
        (2.9e9, 1410.0, None, True),  # POM without a kind
        (2.9e9, 1410.0, "polymer", True),
        (12e9, 1410.0, "polymer", True),
        (2.9e9, 1410.0, "ceramic", False),  # a porous granule, say
        (2.9e9, 7850.0, None, False),  # steel, softened for DEM
        (12.23e9, 879.0, None, False),  # gamma-alumina
    ],
)
@pytest.mark.parametrize("body", ["sphere", "plate"])
def test_what_is_as_soft_and_light_as_a_polymer_is_taken_for_one(modulus, density, kind, depends, body):
    own = cl.Material("POM", modulus, 0.37, density, yield_strength=65e6, kind=kind)
    pair = cl.Pair(**({"sphere": "glass", "plate": "glass"} | {body: own}))
    flags = cl.ImpactModel(pair, law="hertz").lookup(0.1, R, 5e-3).flags
    assert bool(flags & Validity.RATE_DEPENDENT) == depends


@pytest.mark.parametrize("law", ["fem", "hertz"])
def test_glass_may_break_under_alumina(law):
    model = model_of("alumina", "soda-lime-glass", law)
    assert not model.lookup(1.0, R, 5e-3).flags & Validity.DAMAGE
    hard = model.lookup(10.0, R, 5e-3).flags
    assert hard & Validity.DAMAGE and not hard & Validity.DAMAGE & Validity.ACCURACY
    assert "break" in " ".join(explain(hard))


# The law itself.


def test_it_takes_its_numbers_from_the_pair():
    pair = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
    law = law_of(pair, "fem")
    assert law.from_pair == laws.parameters("fem")
    ratios = [pair.effective_modulus / body.yield_strength for body in (pair.sphere, pair.plate)]
    share = pair.effective_modulus / pair.plate.plane_modulus
    numbers = (*ratios, share, pair.sphere.poissons_ratio, pair.plate.poissons_ratio)
    assert law.name == f"fem({','.join(f'{number:.6g}' for number in numbers)})"
    assert law == laws.law(law.name)


@pytest.mark.parametrize("pair", [("alumina", "soda-lime-glass"), ("copper-c11000", "alumina")])
def test_it_is_stiffer_than_hertz_and_gives_back_no_more(pair):
    law = law_of(cl.Pair(*pair), "fem")
    deepest = law.range[1]
    end = 1.0 if law.yields else deepest
    d = np.geomspace(1e-4 * end, end, 50)
    stiffer = np.array([law.loading(math.sqrt(one)) for one in d]) / d**1.5
    assert (stiffer > 1.0).all() and (np.diff(stiffer) > 0.0).all()
    assert stiffer[-1] < 1.5
    for dm in np.geomspace(1e-3 * end, deepest, 30):
        assert law.dissipation(dm) >= 0.0
        assert 0.0 <= law.residual(dm) < dm
        assert law.residual(dm) == 0.0 or dm > 1.0


def test_slow_impacts_on_thin_plates_are_those_of_zener():
    """In small, long contacts the difference from Zener's goes as lambda h, or V^(2/5)."""
    glass = cl.Pair("soda-lime-glass", "soda-lime-glass")
    ours, zener = solver_of(glass), cl.ImpactModel(glass, law="hertz")
    off = [
        ours.solve(v, R, R, rtol=1e-13).restitution - zener.solve(v, R, R, rtol=1e-13).restitution
        for v in (1e-10, 1e-15)
    ]
    assert 1e-7 < abs(off[0]) < 1e-5
    assert off[1] / off[0] == pytest.approx(0.01, rel=0.02)


# Between bodies alike, and beyond the campaign.


def answered(pair, speed, thickness=math.inf):
    """Integrate impacts of beads of a millimetre, without a table."""
    return cl.ImpactModel(pair).solve(speed, R, thickness, rtol=1e-10)


FASTER_THAN_ITS_WAVES = [  # elastic spheres at a tenth of sqrt(E*/rho1), plates of 20 to 700 m/s
    (cl.Pair(cl.Material("a", 547e9, 0.341, 1374), cl.Material("b", 50.7e6, 0.143, 18135)), 19.4),
    (cl.Pair(cl.Material("a", 29.6e9, 0.273, 879), cl.Material("b", 10.8e6, 0.375, 19641)), 11.9),
    (cl.Pair(cl.Material("a", 132e9, 0.214, 573), cl.Material("b", 4.43e9, 0.0879, 8517)), 275.0),
]


@pytest.mark.parametrize(("pair", "speed"), FASTER_THAN_ITS_WAVES)
def test_thicker_plates_take_no_more_however_fast_the_impact(pair, speed):
    """Speeds are up to seven times the limit of FAST_IMPACT, and R/H up to 5."""
    hit = cl.ImpactModel(pair).solve(speed, R, R * np.geomspace(0.2, 100.0, 400), rtol=1e-10)
    assert (np.diff(hit.inelasticity) <= 1e-9 * hit.inelasticity[1:]).all()
    assert (np.diff(hit.wave_fraction) <= 1e-7).all()
    assert hit.flags.min() & Validity.FAST_IMPACT


def soft(strength):
    """Indium of some strength under bearing steel."""
    return cl.Pair("bearing-steel-52100", cl.Material("indium", 12.7e9, 0.45, 7310, yield_strength=strength))


def test_soft_bodies_follow_the_slope_of_the_law():
    """Contacts of one depth cost the more of the COR the weaker the body is: e^2 goes as sigma_Y/E.

    Complete flow is rigid-plastic: force and depth go by the strength alone, and what comes back
    of a depth by the strength over the modulus.
    """
    cor = []
    for strength in (7e6, 1e6, 1e5, 1e3, 1.0):
        pair = soft(strength)
        # the speed that leads a third of the way, in depth, to where the law ends
        law = law_of(pair, "fem")
        speed = np.geomspace(1e-3, 1.0, 3000) * 3.0 * math.sqrt(strength / 1e6)
        hit = answered(pair, speed)
        at = np.argmin(np.abs(np.asarray(hit.peak_compression) - 0.03 * R))
        assert hit.peak_compression[at] == pytest.approx(0.03 * R, rel=0.01)
        assert 0.03 < law.range[1] * law.scale
        cor.append(hit.restitution[at] / math.sqrt(strength))
        slope = np.diff(np.log(hit.restitution)) / np.diff(np.log(speed))
        assert (slope[at - 300 : at] < -0.2).all()  # Johnson's -1/4, and more for a flattened body
    assert cor == pytest.approx(np.full(5, cor[-1]), rel=0.05)


@pytest.mark.filterwarnings("ignore:.* no solid is so strong")
@pytest.mark.parametrize(
    ("strength", "speed", "yields", "flagged"),
    [
        (8e6, 0.1, True, False),
        (4.5e6, 0.1, True, True),
        (4.5e6, 1e-7, False, False),
        (7.2e8, 1e3, True, False),
        (2e9, 1e3, True, True),
        (2e9, 10.0, False, False),
    ],
)
def test_untried_strengths_are_flagged_once_a_body_yields(strength, speed, yields, flagged):
    """E*/sigma_Y is 1858, 3303, 21 and 7 here; finite elements have 11 to 3000."""
    hit = answered(soft(strength), np.array([speed]))
    assert (hit.plastic_fraction[0] > 0.0) == yields
    assert bool(hit.flags[0] & Validity.UNTRIED_STRENGTH) == flagged


@pytest.mark.filterwarnings("ignore:.* no solid is so strong")
def test_an_untried_strength_of_the_stronger_body_counts_where_it_yields():
    """Steels with strengths of E*/12, and of less than 1/0.36 of that, hit each other."""
    steel = cl.Material("a", 200e9, 0.3, 7850)
    strength = cl.Pair(steel, steel).effective_modulus / 12.0
    for share, flagged in ((1.05, False), (1.2, True), (2.7, True), (2.9, False)):
        bodies = [dataclasses.replace(steel, yield_strength=one) for one in (strength, strength * share)]
        hit = answered(cl.Pair(*bodies), np.array([900.0]))
        assert hit.plastic_fraction[0] > 0.0
        assert bool(hit.flags[0] & Validity.UNTRIED_STRENGTH) == flagged


@pytest.mark.parametrize(
    "strength", [pytest.param(1.0, marks=pytest.mark.long), 1e6]
)  # the longest table, and an everyday one
def test_every_soft_body_makes_a_model(strength):
    """Some tables once exceeded the settings; their errors are like those of any pair."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model = cl.ImpactModel(soft(strength))
        assert model.table.law.yields
    speed = np.geomspace(1e-3, 1.0, 7) * math.sqrt(strength / 1e6)
    looked, exact = (ask(speed, R, 5 * R).restitution for ask in (model.lookup, model.solve))
    assert looked == pytest.approx(exact, abs=1e-5)


def test_the_weakest_material_has_a_law():
    body = cl.Material("weakest", 1e9, 0.0, 1000, yield_strength=1e-3)
    law = law_of(cl.Pair(body, "alumina"), "fem")
    assert law.range[1] * law.scale == pytest.approx(0.1)


def test_nothing_jumps_where_a_body_is_so_strong_that_it_does_not_yield():
    """A body that would yield near the end of the law is elastic; the other side hardly differs."""
    steel = cl.Material("a", 200e9, 0.3, 7800)
    modulus = cl.Pair(steel, steel).effective_modulus
    speed, cor, yields = np.linspace(300.0, 700.0, 5), [], []
    for ratio in np.linspace(5.5, 5.95, 46):
        pair = cl.Pair(dataclasses.replace(steel, yield_strength=modulus / ratio), steel)
        hit = answered(pair, speed)
        yields.append(law_of(pair, "fem").yields)
        cor.append(hit.restitution)
    assert not yields[0] and yields[-1]
    assert np.abs(np.diff(cor, axis=0)).max() < 1e-3
    assert np.abs(np.diff(cor, n=2, axis=0)).max() < 2e-4


# Numbers of everyday impacts.


def test_energies_sum_to_one():
    """The shares sum to one in 200 impacts of random pairs."""
    for case in census.draw(71, 200):
        model = solver_of(cl.Pair(case.sphere, case.plate))
        hit = model.solve(case.speed, case.radius, case.thickness, rtol=1e-10)
        lost = [getattr(hit, name) for name in ENERGIES]
        assert hit.restitution**2 + sum(lost) == pytest.approx(1.0, abs=1e-8), case
        assert min(lost) >= -1e-12, case
        yields = hit.overload > 1.0 and model.force_law.yields
        assert (hit.plastic_fraction > 0.0) == yields, case


PAIRS = [(case.sphere, case.plate) for case in census.draw(72, 20)]


@pytest.mark.parametrize(
    "pair", [*PAIRS[:5], *(pytest.param(pair, marks=pytest.mark.long) for pair in PAIRS[5:])], ids="-".join
)
def test_tables_are_near_the_solver(pair):
    model = model_of(*pair)
    rng = np.random.default_rng(73)
    speed, thickness = (np.exp(rng.uniform(*np.log(limits), 50)) for limits in (census.SPEED, census.THICKNESS))
    looked, exact = (ask(speed, R, thickness) for ask in (model.lookup, model.solve))
    assert looked.restitution == pytest.approx(exact.restitution, abs=1e-5)
    assert model.restitution(speed, R, thickness) == pytest.approx(looked.restitution, abs=1e-10)
    for name in ("contact_time", "peak_force", "peak_compression", "wave_fraction"):
        assert getattr(looked, name) == pytest.approx(getattr(exact, name), rel=5e-4), name
    # Lambda by formulas that share no code with the table.
    assert looked.inelasticity == pytest.approx(exact.inelasticity, rel=1e-10)
    assert looked.overload == pytest.approx(exact.overload, rel=1e-7)  # by a polynomial for w_m
    assert np.array_equal(looked.flags, exact.flags)


# Two beads.


def test_equal_beads_both_yield():
    """Their law is that of two equal bodies, whatever the plate of the pair is made of."""
    steel = "carbon-steel-1020"
    model = model_of(steel, "soda-lime-glass")
    beads = model._beads(None)
    twins, law = beads.pair, beads.law
    assert (twins.sphere, twins.plate) == (cl.material(steel),) * 2
    assert law == law_of(twins, "fem") and law != model.force_law
    speed = np.array([0.1, 1.0, 5.0])
    hit = model.lookup_sphere_sphere(speed, R, R)
    same = cl.restitution_sphere_sphere(steel, steel, speed, R, R, law="fem")
    assert hit.restitution.tolist() == same.tolist()
    assert model.sphere_sphere_curve(R, R)(1.0) == pytest.approx(same[1], abs=1e-12)
    assert (hit.plastic_fraction > 0.1).all() and (hit.wave_fraction == 0.0).all()
    assert (np.diff(hit.restitution) < 0.0).all()
    lost = hit.plastic_fraction + hit.other_fraction
    assert hit.restitution**2 + lost == pytest.approx(np.ones(3), abs=1e-4)  # the table's
    # beside one that is as stiff but does not yield, one flows where two did
    hard = dataclasses.replace(cl.material(steel), yield_strength=None)
    alone = [cl.restitution_sphere_sphere(*pair, speed[:2], R, R, law="fem") for pair in ((steel, hard), (hard, steel))]
    assert alone[0].tolist() == alone[1].tolist()
    assert (alone[0] > same[:2] + 0.005).all()


def test_radii_matter_by_the_yield_speed_alone():
    """V_Y^2 goes as R*^3/m*, and there is no wave."""
    steel = "carbon-steel-1020"
    for other in (0.3 * R, 3.0 * R):
        share = math.sqrt((R**3 + other**3) / (R + other) ** 3)
        ours = cl.restitution_sphere_sphere(steel, steel, share, R, other, law="fem")
        equal = cl.restitution_sphere_sphere(steel, steel, 0.5, R, R, law="fem")
        assert ours == pytest.approx(equal, rel=1e-9)
