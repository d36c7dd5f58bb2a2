"""Impacts in a cup and on a dome: finite elements, which have no R*, beside the model, which has."""

import math

import pytest

from validation.fem import curved


@pytest.mark.long
def test_the_model_has_the_rebound_of_finite_elements_in_a_cup_and_on_a_dome():
    """Within 0.02 at 5 m/s on coarse elements, of changes of the COR by up to 0.04."""
    (_, flat, own, _), *round_ = curved.compared(5.0, (math.inf, 4.0, -4.0), size=0.015)
    assert abs(own) < 0.02
    for wall, elements, error, force in round_:
        assert (elements - flat) * wall > 0.02 * abs(wall)
        assert abs(error - own) < 0.016 and abs(force) < 0.04
