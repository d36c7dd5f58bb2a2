"""What walls bear, beside closed forms."""

import lammps_box as box
import numpy as np
import pytest

import contactlaw as cl
from contactlaw.engines.lammps import Plate, Translation
from contactlaw.softsphere import time_step

R, G = box.R, 9.81
MODEL = cl.ImpactModel(box.PAIR)


def test_beads_come_to_rest_on_a_plate_which_bears_their_weight():
    """It moves along, and up, for which it has to give power. Its torque is about the origin."""
    rise = 0.005
    dt = time_step(MODEL, 0.3, R, 1e-3, softening=1000.0)
    place = [(0.01, 0.02, R + 1e-3), (-0.03, 0.01, R + 1e-3)]
    wall = Plate((-10, -0.05, 0), (20, 0, 0), (0, 0.1, 0), 1e-3, motion=Translation((1.0, 0, rise)))
    lmp, walls = box.scene(MODEL, [wall], place, (0, 0, 0), gravity=G, dt=dt, softening=1000.0)
    with pytest.raises(ValueError, match="duration: got 0.0; loads are means over time: simulate some steps first"):
        walls.loads()
    lmp.command(f"run {round(3.0 / dt)}")
    assert abs(box.state(lmp)["v"] - [0, 0, rise]).max() < 1e-12
    walls.loads()
    lmp.command("run 2001")
    loads, weight = walls.loads(), box.MASS * G
    assert loads.duration == pytest.approx(2001 * dt)
    np.testing.assert_allclose(loads.force, [(0, 0, -2 * weight)], rtol=1e-9, atol=1e-9 * weight)
    np.testing.assert_allclose(loads.torque, [(-0.03 * weight, -0.02 * weight, 0)], rtol=1e-9, atol=1e-9 * weight)
    assert loads.power == pytest.approx([2 * weight * rise], rel=1e-9, abs=1e-9 * weight)
    assert len(walls.collisions()) > 6
    walls.detach()
    with pytest.raises(RuntimeError, match="loads: the walls were detached"):
        walls.loads()
