"""Impacts in a cup and on a dome: finite elements, which have no R*, beside the model, which has."""

import math

import numpy as np
import pytest

from validation.fem import curved, mesh


@pytest.mark.parametrize("wall", [3.0, -3.0])
def test_a_bent_plate_is_round_below_the_sphere(wall):
    plate = mesh.bent(mesh.plate(1.0, 0.05, 0.3, 4.0, 10.0), wall, 1.35)
    r, z = plate.nodes[plate.surface].T
    near = r <= 1.35
    np.testing.assert_allclose(np.hypot(r, z - wall)[near], abs(wall))
    assert near.sum() > 10 and np.ptp(z[~near]) < 1e-12
    assert plate.nodes[:, 1].min() == -4.0


def test_the_model_has_the_rebound_of_finite_elements_in_a_cup_and_on_a_dome():
    """Within 0.02 at 5 m/s on coarse elements, of changes of the COR by up to 0.04."""
    (_, flat, own, _), *round_ = curved.compared(5.0, (math.inf, 4.0, -4.0), size=0.015)
    assert abs(own) < 0.02
    for wall, elements, error, force in round_:
        assert (elements - flat) * wall > 0.02 * abs(wall)
        assert abs(error - own) < 0.016 and abs(force) < 0.04
