"""Laws of a pair at any strength, in one array, beside laws that are made for the strength."""

import dataclasses
import math

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.equation import force
from contactlaw.physical import rate
from contactlaw.physical.law import law_for_pair
from contactlaw.physical.strengths import COARSE, USUAL, by_strength, knots

COPPER = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", rate=(0.025, 1.0))
HARD = cl.Material("hard", 200e9, 0.3, 7800, 3e9, kind="metal", rate=(0.2, 1.0))
PAIRS = [
    cl.Pair(COPPER, "glass"),
    cl.Pair("alloy-steel-4340", "copper-ofhc-annealed"),
    cl.Pair(dataclasses.replace(HARD, yield_strength=400e6, rate=(0.06, 10.0)), COPPER),
    cl.Pair(HARD, "glass"),  # it does not yield in the fastest impacts
]


@pytest.mark.parametrize(("fineness", "error"), [(USUAL, 4e-7), (COARSE, 2e-5)])
@pytest.mark.parametrize("pair", PAIRS, ids=str)
def test_a_law_is_that_made_for_its_strength(pair, fineness, error):
    law = cl.ImpactModel(pair).force_law
    laws, room = by_strength(pair, law, fineness), np.empty(force.ROOM)
    ends, most = knots(pair, fineness.piece, fineness.fastest)
    assert force.widest(laws) <= force.room_for(laws) == force.ROOM
    for strength in [*np.random.default_rng(0).uniform(0.0, ends[-1], 4), most]:
        stronger = rate.strengthened(pair, math.exp(strength))
        one, own = law_for_pair(stronger, law), force.at_strength(laws, strength, room)
        assert force.growth_at(laws, strength) == pytest.approx(one.scale / law.scale, rel=error)
        onset = force.onset_at(laws, strength) * law.scale
        assert onset == pytest.approx(one.onset or one.scale, rel=error)
        for d in np.geomspace(0.05, 0.99 * one.range[1], 20):
            peak = one.loading(math.sqrt(d))
            assert force.loading(own, math.sqrt(d)) == pytest.approx(peak, rel=error)
            for found, exact in (
                (force.residual(own, d), one.residual(d)),
                (force.unloading(own, d).exponent, one.unloading_curve(d).exponent),
            ):
                assert found == pytest.approx(exact, abs=error * d, rel=error)
            lost = one.dissipation(d)
            assert force.loss(own, d) == pytest.approx(lost, abs=10 * error * peak * d)


def test_a_pair_without_a_rate_has_its_own_law():
    law = cl.ImpactModel(cl.Pair("glass", "glass")).force_law
    assert by_strength(cl.Pair("glass", "glass"), law) is law.data
    assert force.room_for(law.data) == force.widest(law.data) == 0
    assert force.growth_at(law.data, 1.0) == force.onset_at(law.data, 1.0) == 1.0
