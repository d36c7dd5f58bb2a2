"""Contacts of a pair with a rate of strain, step by step: each has the strength of its impact."""

import dataclasses

import metal
import numpy as np
import pytest
from verlet import drop

import contactlaw as cl
from contactlaw.softsphere import PARTED, advance, law_of, resized, unit_spring

LAW = law_of(metal.MODEL)


@pytest.mark.parametrize("speed", [16.0, 24.0])
def test_two_bodies_have_rates_of_their_own(speed):
    """Levels knew that of the weaker body alone, which reaches the other's rate0 at 15.9 m/s."""
    model, radius, thickness = cl.ImpactModel(metal.STEEP), 0.12178e-3, 0.57e-3
    hit = model.solve(speed, radius, thickness)
    spring = resized(unit_spring(model, thickness), radius)
    found = drop(law_of(model), spring, speed, hit.contact_time / 200, 0.3)
    assert found == pytest.approx(hit.restitution, rel=4e-4)


def test_below_its_rate0_a_pair_is_as_without_a_rate():
    slow = cl.Pair(dataclasses.replace(metal.PAIR.sphere, rate=(0.07, 1e5)), "glass")
    slow = cl.ImpactModel(slow)
    plain = cl.ImpactModel(metal.PLAIN)
    laws = law_of(slow), law_of(plain)
    assert laws[1] is plain.force_law.data
    overlaps = np.concatenate((np.linspace(0.0, 1e-5, 40), np.linspace(1e-5, -1e-6, 40)))
    for thickness in (1e-3, np.inf):
        states = [PARTED, PARTED]
        springs = [resized(unit_spring(one, thickness), 1e-3) for one in (slow, plain)]
        for overlap in overlaps:
            states = [
                advance(law, spring, state, overlap, 1e-8)
                for law, spring, state in zip(laws, springs, states, strict=True)
            ]
            np.testing.assert_allclose(states[0], states[1], rtol=2e-5, atol=5e-6)  # forces to 42 N


def test_a_contact_keeps_its_strength():
    """A bead that comes back slowly into its dent finds it as it has left it."""
    spring = resized(unit_spring(metal.MODEL, np.inf), 1e-3)
    state, x, dt, held = PARTED, 0.0, 2e-8, []
    for way in (5.0, -1.0, 1e-3):
        for _ in range(60 if way > 0.0 else 140):
            x += way * dt
            state = advance(LAW, spring, state, x, dt)
            held.append((state.stiffening, state.strength))
    assert state.largest_compression > 5e-6
    assert held[0] == (0.0, 0.0)
    assert len(set(held[1:])) == 1
    assert 0.9 < held[-1][0] < 1.1
    factor = np.exp(held[-1][1])
    assert factor == pytest.approx(metal.rate.factors(metal.PAIR, 5.0, 1e-3), rel=1e-6)
