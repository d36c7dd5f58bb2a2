"""Contacts of a pair with a rate of strain, step by step: each has the strength of its impact."""

import dataclasses

import metal
import numpy as np
import pytest
from verlet import drop

import contactlaw as cl
from contactlaw.softsphere import PARTED, advance, law_of, resized, unit_spring


def restitution(model, radius, thickness, speed):
    """COR in 200 steps, and that of the solver."""
    hit, spring = model.solve(speed, radius, thickness), resized(unit_spring(model, thickness), radius)
    return drop(law_of(model), spring, speed, hit.contact_time / 200, 0.3), hit.restitution


@pytest.mark.parametrize("speed", [16.0, 24.0])
def test_two_bodies_have_rates_of_their_own(speed):
    """Levels knew that of the weaker body alone, which reaches the other's rate0 at 15.9 m/s."""
    stepped, solved = restitution(cl.ImpactModel(metal.STEEP), 0.12178e-3, 0.57e-3, speed)
    assert stepped == pytest.approx(solved, rel=4e-4)


@pytest.mark.parametrize("thickness", [1e-3, np.inf])
def test_below_its_rate0_a_pair_is_as_without_a_rate(thickness):
    slow = cl.ImpactModel(cl.Pair(dataclasses.replace(metal.PAIR.sphere, rate=(0.07, 1e5)), "glass"))
    plain = cl.ImpactModel(metal.PLAIN)
    assert law_of(plain) is plain.force_law.data
    stepped, expected = (restitution(model, 1e-3, thickness, 5.0)[0] for model in (slow, plain))
    assert stepped == pytest.approx(expected, rel=2e-5)


def test_a_contact_keeps_its_strength():
    """A bead that comes back slowly into its dent finds it as it has left it."""
    law, spring = law_of(metal.MODEL), resized(unit_spring(metal.MODEL, np.inf), 1e-3)
    state, x, dt, held = PARTED, 0.0, 2e-8, []
    for way in (5.0, -1.0, 1e-3):
        for _ in range(60 if way > 0.0 else 140):
            x += way * dt
            state = advance(law, spring, state, x, dt)
            held.append((state.stiffening, state.strength))
    assert state.largest_compression > 5e-6
    assert held[0] == (0.0, 0.0)
    assert len(set(held[1:])) == 1
    assert 0.9 < held[-1][0] < 1.1
    factor = np.exp(held[-1][1])
    assert factor == pytest.approx(metal.rate.factors(metal.PAIR, 5.0, 1e-3), rel=1e-6)
