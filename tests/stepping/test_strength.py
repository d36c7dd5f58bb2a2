"""Contacts of a pair with a rate of strain, step by step: each has the strength of its impact."""

import metal
import pytest
from verlet import drop

import contactlaw as cl
from contactlaw.softsphere import law_of, resized, unit_spring


@pytest.mark.parametrize("speed", [16.0, 24.0])
def test_two_bodies_have_rates_of_their_own(speed):
    """Levels knew that of the weaker body alone, which reaches the other's rate0 at 15.9 m/s."""
    model, radius, thickness = cl.ImpactModel(metal.STEEP), 0.12178e-3, 0.57e-3
    hit, spring = model.solve(speed, radius, thickness), resized(unit_spring(model, thickness), radius)
    stepped = drop(law_of(model), spring, speed, hit.contact_time / 200, 0.3)
    assert stepped == pytest.approx(hit.restitution, rel=4e-4)
