"""Random pairs of invented materials: a part of the campaign."""

import dataclasses

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.laws import fem
from validation.hostile import pairs

STEEL = cl.Material("steel", 200e9, 0.28, 7800, yield_strength=300e6)
ALUMINIUM = cl.Material("aluminium", 70e9, 0.33, 2700, yield_strength=300e6)


@pytest.mark.filterwarnings("ignore:.* as of no solid")  # strengths are drawn up to E*/5
@pytest.mark.parametrize("count", [3, pytest.param(12, marks=pytest.mark.long)])
def test_random_pairs_are_continuous_and_flagged(count):
    assert list(pairs.faults(count, seed=1)) == []


def test_the_campaign_finds_a_jump_where_the_weaker_body_changes(monkeypatch):
    """The jump came from taking Poisson's ratio of the weaker body alone."""

    def weaker(given, _):
        return {"sphere": float(given.weaker == "sphere"), "plate": float(given.weaker == "plate")}

    monkeypatch.setattr(fem.Given, "flow", weaker)
    found = list(pairs.steps(cl.Pair(STEEL, ALUMINIUM), np.array([0.5, 5.0]), 1e-2))
    assert any("ratio of the strengths" in fault for fault in found)


@pytest.mark.parametrize("ratio", [8.0, 3000.0])
def test_the_campaign_wants_the_flag(monkeypatch, ratio):
    pair = cl.Pair(STEEL, dataclasses.replace(STEEL, yield_strength=None))
    weak = dataclasses.replace(STEEL, yield_strength=pair.effective_modulus / ratio)
    hit = cl.Pair(weak, pair.plate)
    speed = np.array([1.0, 5.0]) if ratio > 10 else np.array([900.0, 1200.0])
    assert list(pairs.answers(hit, speed, 1e-2)) == []
    monkeypatch.setattr(pairs, "RATIOS", (1.0, 1e9))
    assert any(fault.startswith("flags") for fault in pairs.answers(hit, speed, 1e-2))
