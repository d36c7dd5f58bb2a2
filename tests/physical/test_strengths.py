"""Impacts of pairs with rates of strain, beside those of the pair that is as strong as their rate makes it."""

import dataclasses
import math

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.laws.fem import RATIOS
from contactlaw.physical import rate
from contactlaw.physical.law import law_of
from contactlaw.physical.strengths import USUAL, knots


def metal(*known, **others):
    return cl.Material("body", *known, kind="metal", **others)


COPPER = metal(124e9, 0.34, 8960, 90e6, rate=(0.025, 1.0))
STEEL = metal(200e9, 0.3, 7800, 350e6, rate=(0.06, 1.0))
WEAK = metal(200e9, 0.3, 7800, 27.2e6 * math.exp(-4e-3), rate=(0.05, 1.0))
HARD = metal(200e9, 0.3, 7800, 400e6, rate=(0.06, 10.0))
PAIRS = {
    "usual": (COPPER, "glass"),
    "two metals": ("alloy-steel-4340", "copper-ofhc-annealed"),
    "two rates": (HARD, COPPER),
    "it does not yield in the fastest impacts": (
        dataclasses.replace(HARD, yield_strength=3e9, rate=(0.2, 1.0)),
        "glass",
    ),
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


@pytest.mark.parametrize(("slope", "rate0"), [(0.06, 1.0), (0.06, 1e3), (1e-9, 1e9), (0.3, 1e-3)])
def test_each_body_has_its_own_strength_at_the_rate_of_the_impact(slope, rate0):
    """Below rate0 of the weaker body, or above it alone, the other one had a strength too high."""
    alloy = metal(72e9, 0.33, 2770, 265e6, rate=(0.015, 10.0))
    pair = cl.Pair(alloy, metal(207e9, 0.3, 7850, 175e6, hardening=(380e6, 0.32), rate=(slope, rate0)))
    at = rate.SHARE * 2000.0 * (pair.yield_speed / 2.0) ** 0.3  # representative rate [1/s]
    factor = 1.0 + slope * math.log(max(at / rate0, 1.0))
    stronger = rate.strengthened(pair, rate.factors(pair, np.array([2.0]), np.array([1e-3])).item())
    assert stronger.plate.yield_strength == pytest.approx(175e6 * factor)
    assert stronger.plate.hardening == pytest.approx((380e6 * factor, 0.32))
    assert stronger.sphere.yield_strength == pytest.approx(265e6 * (1.0 + 0.015 * math.log(at / 10.0)))
    assert stronger.sphere.rate is None and rate.flow_with_rate(stronger, law_of(stronger, "fem")) is None


@pytest.mark.parametrize("bodies", PAIRS.values(), ids=PAIRS)
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
        cl.ImpactModel(cl.Pair(COPPER, "glass")).solve([1.0, 1e4], [1e-3, 1e-9], 1e-2)
