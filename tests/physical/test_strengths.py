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
from contactlaw.physical.strengths import COARSE, USUAL, by_strength, knots


def metal(*known, **others):
    return cl.Material("body", *known, kind="metal", **others)


COPPER = metal(124e9, 0.34, 8960, 90e6, rate=(0.025, 1.0))
HARD = metal(200e9, 0.3, 7800, 3e9, rate=(0.2, 1.0))
PAIRS = [
    cl.Pair(COPPER, "glass"),
    cl.Pair("alloy-steel-4340", "copper-ofhc-annealed"),
    cl.Pair(dataclasses.replace(HARD, yield_strength=400e6, rate=(0.06, 10.0)), COPPER),
    cl.Pair(HARD, "glass"),  # it does not yield in the fastest impacts
]


@pytest.mark.parametrize("fineness", [USUAL, COARSE], ids=["usual", "coarse"])
@pytest.mark.parametrize("pair", PAIRS, ids=str)
def test_a_blend_of_two_laws_is_the_law_made_for_a_strength(pair, fineness):
    """Restitution at strengths between rungs, also beyond where the law of the strength ends.

    Only the ladder itself has strengths that are chosen; impacts have those of their rates.
    """
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


STEEL = metal(200e9, 0.3, 7800, 350e6, rate=(0.06, 1.0))
WEAK = metal(200e9, 0.3, 7800, 27.2e6 * math.exp(-4e-3), rate=(0.05, 1.0))
ODD = {
    "long array": (metal(11e9, 0.45, 7310, hardness=9e6, hardening=0.5, rate=(0.02, 1.0)), "glass"),
    "losses": (
        cl.Material("POM", 2.9e9, 0.37, 1410, 41e6, kind="polymer", rate=(0.05, 1.0), loss_factor=(0.5, 1e4)),
        "glass",
    ),
    "late": (metal(70e9, 0.33, 2700, 200e6, rate=(0.02, 1.0)), metal(70e9, 0.33, 2700, 150e6, rate=(0.2, 1e6))),
    "brittle": (STEEL, cl.Material("glass", 70e9, 0.21, 2500, kind="glass", hardness=3.9e9)),
    "just below E*/sigma_Y = 2000, above which the law is not known": (WEAK, "glass"),
    "steep": (metal(3e9, 0.4, 1200, 50e6, hardening=(1e9, 0.5), rate=(0.1, 1e-3)), "glass"),
    "the strain begins before yield at small strengths only": (
        metal(2.1235e9, 0.2356, 2889, 4.8614e6, rate=(0.04933, 0.01037)),
        metal(5.9647e9, 0.3594, 1332, 6.9909e6, hardening=(8.7117e6, 0.482), loss_factor=(0.01086, 1e3)),
    ),
    "the strengths are alike at three places within 0.003": (
        metal(41.7e9, 0.296, 9687, 62.72e6, hardening=(48.39e6, 0.6367), rate=(0.00507, 0.00328)),
        metal(40.53e9, 0.2916, 1192, 55.6e6, hardening=(183.5e6, 0.666), rate=(0.05375, 0.00355)),
    ),
}


@pytest.mark.parametrize("bodies", ODD.values(), ids=ODD)
def test_answers_and_flags_are_those_of_the_stronger_pair(bodies):
    """Long arrays, corners moved by losses or near an end, flags that change between."""
    pair = cl.Pair(*bodies)
    model, rng = cl.ImpactModel(pair), np.random.default_rng(2)
    v, r = (np.exp(rng.uniform(*np.log(ends), 8)) for ends in ((0.05, 60.0), (5e-6, 5e-3)))
    v[0], r[0] = 1e-4, 1e-2
    hit = model.solve(v, r, 2.0 * r)
    for n, factor in enumerate(rate.factors(pair, v, r).tolist()):
        exact = cl.ImpactModel(rate.strengthened(pair, factor)).solve(v[n], r[n], 2.0 * r[n])
        assert hit.restitution[n] == pytest.approx(exact.restitution, abs=7e-5)
        assert hit.flags[n] == exact.flags
    fine = model.solve(np.geomspace(0.03, 20.0, 60), 1e-3, 5e-3)
    energies = fine.restitution**2 + fine.plastic_fraction + fine.wave_fraction + fine.other_fraction
    np.testing.assert_allclose(energies, 1.0, atol=1e-6)


def test_a_table_may_end_next_to_a_corner():
    """The corner and the end, less than 1e-3 apart, were taken for one, and no table was made."""
    strength = cl.Pair(WEAK, "glass").effective_modulus / RATIOS[1] * math.exp(-4e-3)
    pair = cl.Pair(dataclasses.replace(WEAK, yield_strength=strength, rate=(3.4e-4, 1.0)), "glass")
    corner, end = knots(pair, USUAL.apart, rate.FASTEST, USUAL.near)[0][-2:]
    assert USUAL.near < end - corner < 1e-3
    model = cl.ImpactModel(pair)
    looked_up, exact = (answer([0.1, 3.0], 1e-3, 1e-2).restitution for answer in (model.lookup, model.solve))
    assert looked_up == pytest.approx(exact, abs=1e-4)


def test_a_rate_beyond_the_laws_is_refused():
    with pytest.raises(RuntimeError, match=r"V0/R = 1e.13 /s \(element 1\)"):
        cl.ImpactModel(PAIRS[0]).solve([1.0, 1e4], [1e-3, 1e-9], 1e-2)
