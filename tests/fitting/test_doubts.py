"""Doubts about fits of nonsense, which fits of honest data with noise do not raise."""

import dataclasses
import re

import numpy as np
import pytest
from lasting import long
from rebounds import RADIUS, STEEL, rebounds

import contactlaw as cl

DOUBT = re.compile(r"times (above|below) that|above 1:|no \w+ gives")
ALUMINA = cl.Pair("gamma-alumina", "glass")
FAST = np.geomspace(2.0, 40.0, 12)


def doubts(pair, data, unknown, stated=True):
    """Doubts in the notes or in the refusal of a fit."""
    data = {name: v for name, v in data.items() if name != unknown and (stated or not name.endswith("_error"))}
    try:
        notes = cl.fit(pair, data, unknown).notes
    except cl.UnidentifiedError as refused:
        notes = (str(refused),)
    return " | ".join(note for note in notes if DOUBT.search(note))


@pytest.mark.parametrize("seeds", [range(3), long(range(3, 8))], ids=["few", "more"])
@pytest.mark.parametrize("stated", [True, False])
@pytest.mark.parametrize(
    ("pair", "unknown", "speed"),
    [(STEEL, "thickness", None), (STEEL, "density", None), (ALUMINA, "yield_strength", FAST)],
)
def test_honest_data_raise_no_doubt(pair, unknown, speed, stated, seeds):
    for seed in seeds:
        assert doubts(pair, rebounds(pair, noise=0.01, seed=seed, speed=speed), unknown, stated) == ""


STRENGTH = r"yield strength of the bead is 2\d times below that of gamma-alumina, 472.5 MPa: units"


@pytest.mark.parametrize(
    ("pair", "unknown", "kind", "speed", "factor", "words"),
    [
        (ALUMINA, "yield_strength", "restitution", FAST, 1e-3, STRENGTH),
        (STEEL, "plate_density", "contact_time", None, 1e3, r"3.\d times below .*: units"),
    ],
)
def test_a_value_that_speeds_in_other_units_give_is_named_as_far_off(pair, unknown, kind, speed, factor, words):
    data = rebounds(pair, kinds=(kind,), noise=0.01, seed=2, speed=speed)
    data["speed"] = factor * data["speed"]
    assert re.search(words, doubts(pair, data, unknown))


def test_what_no_thickness_gives_is_refused_with_what_is_attainable():
    data = {"speed": 2.0, "radius": RADIUS, "restitution": 0.8}
    half_space = float(cl.ImpactModel(STEEL).solve(2.0, RADIUS, np.inf).restitution)
    with pytest.raises(cl.UnidentifiedError, match=rf"no thickness gives .* 0\.8 .* to {half_space:.3g}"):
        cl.fit(STEEL, data, "thickness")
    assert doubts(STEEL, data | {"restitution": half_space - 0.01}, "thickness") == ""
    data = rebounds(ALUMINA, noise=0.005)
    data["restitution"][3] = 1.05
    assert "COR of rebound 3 is above 1" in doubts(ALUMINA, data, "thickness")


@pytest.mark.parametrize("harder", [1.0, 1.5])
def test_the_body_that_yields_is_named_if_the_strength_of_the_other_was_asked_for(harder):
    pair = cl.Pair("soda-lime-glass", "steel-dc01")
    plate = dataclasses.replace(pair.plate, yield_strength=harder * pair.plate.yield_strength)
    data = rebounds(cl.Pair(pair.sphere, plate), kinds=("restitution",), noise=0.005, seed=1)
    with pytest.raises(cl.UnidentifiedError, match="plate_yield_strength"):
        cl.fit(pair, data, "yield_strength")
