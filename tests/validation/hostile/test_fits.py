"""A part of `python -m validation.hostile fits`, and what it found at first."""

import dataclasses

import numpy as np
import pytest

import contactlaw as cl
from validation.hostile import fits
from validation.inverse.model import true

# One answer was 3130 +- 290 MPa and 0.509 +- 0.004 mm for 205 and 1.
STEEL_ON_ALUMINA = fits.Case(
    cl.Pair("stainless-steel-304", "alumina"),
    1e-3,
    1e-3,
    np.geomspace(1.0, 12.0, 12),
    ("restitution",),
    ("yield_strength", "thickness"),
)


def test_exact_data_of_a_soft_bead_are_not_those_of_a_hard_one_on_a_thin_plate():
    found = cl.fit(STEEL_ON_ALUMINA.pair, STEEL_ON_ALUMINA.data(), STEEL_ON_ALUMINA.unknown)
    for name in found.unknown:
        assert abs(found.values[name] / true(STEEL_ON_ALUMINA, name) - 1.0) < 1e-6
    assert not found.alternatives


def test_a_second_regime_that_fits_as_well_is_told():
    """Within 5 %, four of these rebounds also fit a hard bead on a thin plate."""
    data = {name: values if name == "radius" else values[::3] for name, values in STEEL_ON_ALUMINA.data().items()}
    data["restitution_error"] = 0.05 * data["restitution"]
    found = cl.fit(STEEL_ON_ALUMINA.pair, data, STEEL_ON_ALUMINA.unknown)
    assert found.alternatives
    for other in found.alternatives:
        assert other["thickness"] < 0.6e-3 and other["yield_strength"] > 1e9
        pair = cl.Pair(dataclasses.replace(found.pair.sphere, yield_strength=other["yield_strength"]), found.pair.plate)
        there = cl.ImpactModel(pair, outside="solve").solve(data["speed"], 1e-3, other["thickness"])
        off = there.restitution / data["restitution"] - 1.0
        assert np.sqrt(np.mean(off**2)) < 0.05
    assert any("fitted as well by yield strength of the bead" in note for note in found.notes)


@pytest.mark.parametrize(("count", "seed"), [(2, 1), pytest.param(8, 3, marks=pytest.mark.long)])
def test_random_fits_of_two_unknowns(count, seed):
    assert not list(fits.faults(count, seed))
