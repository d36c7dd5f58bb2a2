"""Layered plates, shells, cups and domes by finite elements, beside the model."""

import math

import pytest
from lasting import long

import contactlaw as cl
from validation.fem import curved, walls

LINER = cl.Validity.LINER


@pytest.mark.parametrize(
    ("plate", "most", "flag"),
    [
        ((("steel", 0.3), ("steel", 0.2)), 0.003, False),  # layers of one material change nothing
        ((("aluminium", 0.25), ("steel", 0.25)), 0.003, False),
        ((("ceramic", 0.5), ("steel", 0.5)), 0.005, False),
        long((("polymer", 0.25), ("steel", 0.25)), 0.025, True),
    ],
)
def test_layers_are_as_near_to_finite_elements_as_their_flags_say(plate, most, flag):
    found = walls.layered(plate, size=0.03)
    assert abs(found.error) < most and bool(found.flags & LINER) is flag


@pytest.mark.parametrize("wall", [15.0, -15.0])
def test_shells_swing_back_as_finite_elements_do(wall):
    """Without the swing the model would be 0.05 lower."""
    found = walls.curved(0.5, wall)
    assert found.flags == 0 and abs(found.error) < 0.01


@pytest.mark.long
def test_unflagged_walls_are_within_a_hundredth():
    layers = [walls.layered(plate) for plate in walls.LINERS + walls.CORES]
    right = [one for one in layers if not one.flags & LINER]
    assert len(right) >= 8 and max(abs(one.error) / one.restitution for one in right) < 0.01
    assert max(abs(one.error) for one in layers) < 0.14  # as LINER says
    assert max(abs(walls.curved(*one).error) for one in walls.SHELLS) < 0.01


@pytest.mark.long
def test_the_model_has_the_rebound_of_finite_elements_in_a_cup_and_on_a_dome():
    """Within 0.02 at 5 m/s on coarse elements, of changes of the COR by up to 0.04."""
    (_, flat, own, _), *round_ = curved.compared(5.0, (math.inf, 4.0, -4.0), size=0.015)
    assert abs(own) < 0.02
    for wall, elements, error, force in round_:
        assert (elements - flat) * wall > 0.02 * abs(wall)
        assert abs(error - own) < 0.016 and abs(force) < 0.04
