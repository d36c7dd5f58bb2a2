"""Contacts of bodies with losses, step by step, are those of the solver."""

import polymer
import pytest
from verlet import drop, fallen

from contactlaw.softsphere import Contacts, law_of, resized, unit_spring


@pytest.mark.parametrize("model", polymer.MODELS, ids=lambda model: repr(model.pair))
@pytest.mark.parametrize(("speed", "radius", "thickness"), polymer.DROPS)
def test_a_drop_is_that_of_the_solver(model, speed, radius, thickness):
    hit = model.solve(speed, radius, thickness)
    spring = resized(unit_spring(model, thickness), radius)
    law = law_of(model)
    found = [drop(law, spring, speed, hit.contact_time / 50, phase) for phase in (0.1, 0.5, 0.9)]
    assert found == pytest.approx([hit.restitution] * 3, rel=5e-3)
    found = fallen(Contacts(model, radius, thickness), speed, hit.contact_time / 50)
    assert found == pytest.approx(hit.restitution, rel=5e-3)
