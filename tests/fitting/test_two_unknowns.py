"""Two unknowns at once: soft beads on a plate are told from hard ones on a thinner plate, or both are named."""

import dataclasses

import numpy as np
import pytest
from rebounds import RADIUS, rebounds

import contactlaw as cl

# One answer was 3130 +- 290 MPa and 0.509 +- 0.004 mm for 205 and 1.
PAIR = cl.Pair("stainless-steel-304", "alumina")
SPEED = np.geomspace(1.0, 12.0, 12)
UNKNOWN = "yield_strength", "thickness"


def test_exact_data_have_one_answer():
    found = cl.fit(PAIR, rebounds(PAIR, speed=SPEED, thickness=1e-3, without=UNKNOWN), UNKNOWN)
    truth = PAIR.sphere.yield_strength, 1e-3
    assert [found.values[name] for name in UNKNOWN] == pytest.approx(truth, rel=1e-6)
    assert not found.alternatives


def test_a_second_regime_that_fits_as_well_is_named():
    """Within 5 %, four of these rebounds also fit a hard bead on a thin plate."""
    data = rebounds(PAIR, speed=SPEED[::3], thickness=1e-3, without=UNKNOWN)
    data["restitution_error"] = 0.05 * data["restitution"]
    found = cl.fit(PAIR, data, UNKNOWN)
    assert found.alternatives
    for regime in found.alternatives:
        assert regime["thickness"] < 0.6e-3 and regime["yield_strength"] > 1e9
        bead = dataclasses.replace(found.pair.sphere, yield_strength=regime["yield_strength"])
        there = cl.ImpactModel(cl.Pair(bead, found.pair.plate)).solve(data["speed"], RADIUS, regime["thickness"])
        assert np.sqrt(np.mean((there.restitution / data["restitution"] - 1.0) ** 2)) < 0.05
    assert any("fitted as well by yield strength of the bead" in note for note in found.notes)
