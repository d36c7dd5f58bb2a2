"""What walls bear, beside closed forms."""

import math

import lammps_box as box
import numpy as np
import pytest

import contactlaw as cl
from contactlaw.engines.lammps import Cylinder, Plate, Rotation, Translation
from contactlaw.softsphere import time_step

R, G = box.R, 9.81
MODEL = cl.ImpactModel(box.PAIR)


@pytest.mark.parametrize("motion", [None, Translation((10.0, 0, 0))])
def test_a_plate_bears_the_weight_of_the_beads_on_it(motion):
    """Also one that moves: its torque is about the origin, and without friction it gives no power."""
    dt = time_step(MODEL, 0.3, R, 1e-3, softening=1000.0)
    place = [(0.01, 0.02, R), (-0.03, 0.01, R)]
    wall = Plate((-10, -0.05, 0), (20, 0, 0), (0, 0.1, 0), 1e-3, motion=motion)
    lmp, walls = box.scene(MODEL, [wall], place, (0, 0, 0), gravity=G, dt=dt, softening=1000.0)
    with pytest.raises(ValueError, match="duration: got 0.0; loads are means over time: simulate some steps first"):
        walls.loads()
    lmp.command(f"run {math.ceil(0.5 / dt / 100) * 100}")
    walls.loads()
    lmp.command("run 2001")
    loads, weight = walls.loads(), box.MASS * G
    assert loads.duration == pytest.approx(2001 * dt)
    np.testing.assert_allclose(loads.force, [(0, 0, -2 * weight)], rtol=1e-6, atol=1e-6 * weight)
    np.testing.assert_allclose(loads.torque, [(-0.03 * weight, -0.02 * weight, 0)], rtol=1e-6, atol=1e-9 * weight)
    walls.detach()
    with pytest.raises(RuntimeError, match="loads: the walls were detached"):
        walls.loads()


@pytest.mark.parametrize("softening", [1.0, 100.0])
def test_what_a_drum_bears_is_what_its_beads_get(softening):
    """Momentum of the beads, power by torque, and the work that the record has of each contact."""
    turn, n = 100.0, 5
    drum = Cylinder((0, -0.05, 0), (0, 0.05, 0), 8e-3, 1e-3, motion=Rotation((0, 1, 0), turn))
    place, velocity = [(0, y, 0.16 * y) for y in np.linspace(-0.03, 0.03, n)], (1, 0, 0)
    dt = time_step(MODEL, 3.0, R, 1e-3, softening=softening)
    lmp, walls = box.scene(MODEL, [drum], place, velocity, gravity=G, dt=dt, friction=0.3, softening=softening)
    lmp.command(f"run {round(0.05 / dt)}")
    while (box.state(lmp)["d2_contactlaw"][:, box.PLATE] != 0.0).any():
        lmp.command("run 20")
    loads, rows, now = walls.loads(), walls.collisions(), box.state(lmp)
    assert len(rows) > 15
    gained = box.MASS * (now["v"] - velocity).sum(axis=0)
    weight = n * box.MASS * G
    fallen = np.array([0, 0, -weight])
    np.testing.assert_allclose(loads.force[0], fallen - gained / loads.duration, rtol=1e-4, atol=1e-6 * weight)
    assert loads.power[0] == pytest.approx(-turn * loads.torque[0, 1], rel=1e-12)
    assert loads.power[0] * loads.duration == pytest.approx(rows["wall_work"].sum(), rel=1e-9)
    assert loads.power[0] > 0.0
