"""The C header of bodies with losses, beside the model."""

import header
import polymer
import pytest


@pytest.mark.parametrize("model", polymer.MODELS, ids=lambda model: repr(model.pair))
def test_an_impact_is_that_of_the_solver(model, tmp_path):
    library = header.Library(tmp_path, model)
    within = 2e-3 if model.pair.sphere.rate else 1e-5
    for speed, radius, thickness in polymer.DROPS:
        at = speed, radius, thickness
        hit = model.solve(*at)
        for name in ("looked_up", "rebounds"):
            assert library(name, *at) == pytest.approx(hit.restitution, rel=within), name
        assert library("drops", *at) == pytest.approx(hit.restitution, rel=5e-3)
        assert library("kept", *at) == pytest.approx(1.0, abs=1e-7)
        assert library("time_of", *at) == pytest.approx(hit.contact_time, rel=within)
        slid = model.oblique(speed, 1.0, radius, thickness, 0.2, method="solve").sliding_speed
        assert library("slides", *at) == pytest.approx(slid, abs=5e-3 * 0.2 * speed)
    assert "loss factor" in library.text
