"""Laws of a pair at any strength, in one array, beside laws that are made for the strength."""

import dataclasses
import math

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.equation import force, zener
from contactlaw.laws.fem import RATIOS
from contactlaw.physical import rate
from contactlaw.physical.law import law_for_pair
from contactlaw.physical.strengths import COARSE, USUAL, by_strength, formulas_at, knots

COPPER = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", rate=(0.025, 1.0))
HARD = cl.Material("hard", 200e9, 0.3, 7800, 3e9, kind="metal", rate=(0.2, 1.0))
PAIRS = [
    cl.Pair(COPPER, "glass"),
    cl.Pair("alloy-steel-4340", "copper-ofhc-annealed"),
    cl.Pair(dataclasses.replace(HARD, yield_strength=400e6, rate=(0.06, 10.0)), COPPER),
    cl.Pair(HARD, "glass"),  # it does not yield in the fastest impacts
]


@pytest.mark.parametrize("fineness", [USUAL, COARSE], ids=["usual", "coarse"])
@pytest.mark.parametrize("pair", PAIRS, ids=str)
def test_a_blend_of_two_laws_is_the_law_made_for_a_strength(pair, fineness):
    """Restitution at strengths between rungs, also beyond where the law of the strength ends."""
    law = cl.ImpactModel(pair).force_law
    laws, rng = by_strength(pair, law, fineness), np.random.default_rng(0)
    ends, most = knots(pair, fineness.apart, fineness.fastest, fineness.near)
    for strength in [*rng.uniform(0.0, ends[-1], 6), most]:
        stronger = rate.strengthened(pair, math.exp(strength))
        one = law_for_pair(stronger, law)
        scale = force.growth_at(laws, strength) * law.scale
        assert scale == pytest.approx(one.scale, rel=1e-4)
        assert force.scale_at(laws, strength, force.LOG_ONSET) * law.scale == pytest.approx(
            one.onset or one.scale, rel=1e-4
        )
        lam, chi = rng.uniform(0.0, 1.0, 30), np.geomspace(0.3, 1.5 * one.range[1], 30)
        exact, blended = (
            zener._run(zener.TO_THE_END, data, lam, unit / chi, 1e-10, strength=strength)
            for data, unit in ((one.data, 1.0), (laws, scale / one.scale))
        )
        inside = exact.peak_compression * chi < one.range[1]
        np.testing.assert_allclose(
            blended.restitution[inside], exact.restitution[inside], atol=7e-5 if fineness is USUAL else 1e-4
        )
        np.testing.assert_allclose(blended.restitution, exact.restitution, atol=2e-4 if fineness is USUAL else 4e-4)
        energies = blended.restitution**2 + blended.plastic_fraction + blended.wave_fraction + blended.other_fraction
        np.testing.assert_allclose(energies, 1.0, atol=1e-7 if fineness is USUAL else 1e-6)


def test_the_error_of_a_blend_falls_with_the_square_of_the_distance_of_its_laws():
    pair = cl.Pair(dataclasses.replace(HARD, yield_strength=400e6, rate=(0.06, 10.0)), "glass")
    law, flow, strength, errors = cl.ImpactModel(pair).force_law, rate.leading(pair), 0.2, []
    one = law_for_pair(rate.strengthened(pair, math.exp(strength)), law)
    exact = zener.solve(one.data, 0.1, 0.1, 1e-11).restitution
    for apart in (0.2, 0.1, 0.05):
        ends = [rate.rate_at(flow, math.exp(strength + step)) / rate.SHARE for step in (-0.5 * apart, 0.5 * apart)]
        laws = by_strength(pair, law, USUAL._replace(apart=1.01 * apart, slowest=ends[0], fastest=ends[1]))
        assert len(force.rungs(laws)) == 2
        y = 0.1 * force.growth_at(laws, strength) * law.scale / one.scale
        errors.append(abs(zener.solve(laws, 0.1, y, 1e-11, strength).restitution - exact))
    assert np.diff(np.log2(errors)) == pytest.approx(-2.0, abs=0.3)


def metal(*known, **others):
    return cl.Material("body", *known, kind="metal", **others)


SOFT = metal(11e9, 0.45, 7310, hardness=9e6, hardening=0.5, rate=(0.02, 1.0))
POM = cl.Material("POM", 2.9e9, 0.37, 1410, 41e6, kind="polymer", rate=(0.05, 1.0), loss_factor=(0.5, 1e4))
LATE = metal(70e9, 0.33, 2700, 150e6, rate=(0.2, 1e6))
STEEL = metal(200e9, 0.3, 7800, 350e6, rate=(0.06, 1.0))
BRITTLE = cl.Material("glass", 70e9, 0.21, 2500, kind="glass", hardness=3.9e9)
# just below E*/sigma_Y = 2000, above which the law is not known
WEAK = metal(200e9, 0.3, 7800, 27.2e6 * math.exp(-4e-3), rate=(0.05, 1.0))
STEEP = metal(3e9, 0.4, 1200, 50e6, hardening=(1e9, 0.5), rate=(0.1, 1e-3))
ODD = [
    (SOFT, "glass"),
    (POM, "glass"),
    (metal(70e9, 0.33, 2700, 200e6, rate=(0.02, 1.0)), LATE),
    (STEEL, BRITTLE),
    (WEAK, "glass"),
    (STEEP, "glass"),
]


@pytest.mark.parametrize("bodies", ODD, ids=["long", "losses", "late", "brittle", "weak", "steep"])
def test_answers_and_flags_are_those_of_the_stronger_pair(bodies):
    """Long arrays, corners moved by losses or near an end, flags that change between."""
    pair = cl.Pair(*bodies)
    model, rng = cl.ImpactModel(pair), np.random.default_rng(2)
    v, r = (np.exp(rng.uniform(*np.log(ends), 8)) for ends in ((0.05, 60.0), (5e-6, 5e-3)))
    v[0], r[0] = 1e-4, 1e-2
    found = model.solve(v, r, 2.0 * r)
    factors = rate.factors(pair, v, r)
    for n, factor in enumerate(factors.tolist()):
        exact = cl.ImpactModel(rate.strengthened(pair, factor)).solve(v[n], r[n], 2.0 * r[n])
        assert found.restitution[n] == pytest.approx(exact.restitution, abs=7e-5)
        assert found.flags[n] == exact.flags


@pytest.mark.parametrize(
    ("sphere", "plate"),
    [
        # The strain begins before yield at small strengths, and not at larger ones.
        (
            metal(2.1235e9, 0.2356, 2889, 4.8614e6, rate=(0.04933, 0.01037)),
            metal(5.9647e9, 0.3594, 1332, 6.9909e6, hardening=(8.7117e6, 0.482), loss_factor=(0.01086, 1e3)),
        ),
        # The strengths are alike at three places within 0.003.
        (
            metal(41.7e9, 0.296, 9687, 62.72e6, hardening=(48.39e6, 0.6367), rate=(0.00507, 0.00328)),
            metal(40.53e9, 0.2916, 1192, 55.6e6, hardening=(183.5e6, 0.666), rate=(0.05375, 0.00355)),
        ),
    ],
    ids=["start", "alike"],
)
def test_no_corner_is_missed(sphere, plate):
    pair = cl.Pair(sphere, plate)
    model = cl.ImpactModel(pair, outside="solve")
    law, laws = model.force_law, by_strength(pair, model.force_law)
    for strength in np.linspace(0.0, force.rungs(laws)[-1, force.STRENGTH], 300):
        scale = formulas_at(pair, strength)["scale"]
        assert force.growth_at(laws, strength) * law.scale == pytest.approx(scale, rel=5e-4)
    speed = np.geomspace(0.03, 20.0, 60)
    hit = model.solve(speed, 1e-3, 5e-3)
    energies = hit.restitution**2 + hit.plastic_fraction + hit.wave_fraction + hit.other_fraction
    np.testing.assert_allclose(energies, 1.0, atol=1e-6)


def test_a_table_may_end_next_to_a_corner():
    """The corner and the end were taken for one, and no table was made."""
    strength = cl.Pair(WEAK, "glass").effective_modulus / RATIOS[1] * math.exp(-4e-3)
    pair = cl.Pair(dataclasses.replace(WEAK, yield_strength=strength, rate=(3.4e-4, 1.0)), "glass")
    corner, end = knots(pair, USUAL.apart, rate.FASTEST, USUAL.near)[0][-2:]
    assert USUAL.near < end - corner < 1e-3
    model = cl.ImpactModel(pair)
    found, exact = (how([0.1, 3.0], 1e-3, 1e-2).restitution for how in (model.lookup, model.solve))
    assert found == pytest.approx(exact, abs=1e-4)


def test_a_rate_beyond_the_laws_is_refused():
    with pytest.raises(RuntimeError, match=r"V0/R = 1e.13 /s \(element 1\)"):
        cl.ImpactModel(PAIRS[0]).solve([1.0, 1e4], [1e-3, 1e-9], 1e-2)


def test_a_pair_without_a_rate_has_its_own_law():
    law = cl.ImpactModel(cl.Pair("glass", "glass")).force_law
    assert by_strength(cl.Pair("glass", "glass"), law) is law.data
    assert force.growth_at(law.data, 1.0) == force.scale_at(law.data, 1.0, force.LOG_ONSET) == 1.0
