"""Contacts of bodies with losses, step by step, are those of the solver."""

import numpy as np
import polymer
import pytest
from verlet import drop

from contactlaw.softsphere import Contacts, resized, unit_spring


@pytest.mark.parametrize("model", polymer.MODELS, ids=lambda model: repr(model.pair))
@pytest.mark.parametrize(("speed", "radius", "thickness"), polymer.DROPS)
def test_a_drop_is_that_of_the_solver(model, speed, radius, thickness):
    hit = model.solve(speed, radius, thickness)
    spring = resized(unit_spring(model, thickness), radius)
    law = model.force_law.data
    found = [drop(law, spring, speed, hit.contact_time / 50, phase) for phase in (0.1, 0.5, 0.9)]
    assert found == pytest.approx([hit.restitution] * 3, rel=5e-3)
    contacts, dt = Contacts(model, radius, thickness), hit.contact_time / 50
    overlap, u = np.zeros(1), np.array([speed])
    for _ in range(200):
        u -= 0.5 * dt * contacts.force / contacts.mass
        overlap += dt * u
        u -= 0.5 * dt * contacts.advance(overlap, dt) / contacts.mass
    assert -u[0] / speed == pytest.approx(hit.restitution, rel=5e-3)
