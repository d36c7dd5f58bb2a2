"""Walls that move in LAMMPS: where they are, what a bead feels, and what they give it."""

import math

import numpy as np
import pytest
from lammps_box import R, above, dropped, flat, scene, state
from scipy.spatial.transform import Rotation as Turn

from contactlaw.engines.lammps import Mesh, Rotation, Tabulated, Translation, Vibration
from contactlaw.walls.frame import FRAME
from contactlaw.walls.motion import move_one


def placed(motion, time, dt=1e-6):
    """Row of numbers of a motion at a time."""
    rows = np.zeros(1, FRAME)
    motion.fill(rows[0])
    move_one(rows[0], time, dt)
    return rows[0]


@pytest.mark.parametrize("time", [0.0, 0.013, 7.7])
def test_a_rotation_is_that_of_scipy(time):
    axis = np.array([1.0, -2.0, 0.5])
    row = placed(Rotation(tuple(axis), 3.3, (0.1, 0.2, 0.3)), time)
    expected = Turn.from_rotvec(3.3 * time * axis / np.linalg.norm(axis)).as_matrix()
    assert row["turn"].reshape(3, 3) == pytest.approx(expected, abs=1e-13)
    assert not row["shift"].any() and not row["rate"].any()


@pytest.mark.parametrize("time", [0.0, 0.0031, 0.05])
def test_shifts_and_rates_are_those_of_the_formulas(time):
    swing = Vibration((1e-3, 0, -2e-3), 50.0, phase=0.4)
    row, omega = placed(swing, time), 2 * math.pi * 50
    assert row["shift"] == pytest.approx(np.array([1e-3, 0, -2e-3]) * math.sin(omega * time + 0.4), abs=1e-15)
    speed = np.array([1e-3, 0, -2e-3]) * omega
    # a mean over one step and over two differs from the rate in mid-step by (omega dt)^2/24, /6
    assert row["half_rate"] == pytest.approx(speed * math.cos(omega * (time - 0.5e-6) + 0.4), rel=1e-7, abs=1e-9)
    assert row["rate"] == pytest.approx(speed * math.cos(omega * time + 0.4), rel=1e-7, abs=1e-9)
    row = placed(Translation((1, 2, 3)), time)
    assert row["shift"] == pytest.approx(np.array([1, 2, 3]) * time, rel=1e-15)
    assert row["rate"].tolist() == [1, 2, 3]


def test_a_table_is_followed_and_ends():
    table = Tabulated([0.1, 0.2, 0.4], [[0, 0, 0], [0, 1, 0], [2, 1, 0]])
    for time, shift, rate in (
        (0.0, (0, 0, 0), (0, 0, 0)),
        (0.15, (0, 0.5, 0), (0, 10, 0)),
        (0.3, (1, 1, 0), (10, 0, 0)),
        (0.5, (2, 1, 0), (0, 0, 0)),
    ):
        row = placed(table, time)
        assert row["shift"] == pytest.approx(shift, abs=1e-12)
        assert row["rate"] == pytest.approx(rate, abs=1e-9)


PLACE = above(1e-5, 0.001, 0.002)


@pytest.mark.parametrize("wind", [(0, 0, 1.5), (0, 0, -2), (3, -1, 2)])
def test_galilean_shift(model, wind):
    """An impact is the same in any inertial frame."""
    wind = np.array(wind, dtype=float)
    still, ends = dropped(model, [flat(1e-3)], PLACE, (1, 2, -5), friction=0.2)
    plate = flat(1e-3, motion=Translation(tuple(wind)))
    moving, others = dropped(model, [plate], PLACE, (1, 2, -5) + wind, friction=0.2)
    for name in ("approach_speed", "restitution", "contact_time", "peak_force", "wave_energy"):
        assert moving[name] == pytest.approx(still[name], rel=1e-9), name
    assert others["v"][0] - wind == pytest.approx(ends["v"][0], rel=1e-9)
    assert others["omega"] == pytest.approx(ends["omega"], rel=1e-9)


def test_a_drum_turns_a_bead(model):
    """At the bottom a bead ends up rolling in place, its surface as fast as the wall."""
    speed, radius = 50.0, 0.018
    drum = Mesh.cylinder((0, -0.03, 0), (0, 0.03, 0), radius, 1e-3, facets=360, motion=Rotation((0, 1, 0), speed))
    start = 0, 0.001, -(radius * math.cos(math.pi / 360) - R - 1e-9)
    lmp, _ = scene(model, [drum], start, (0, 0, 0), gravity=1e4, dt=2e-7, friction=0.5)
    lmp.command("run 40000")
    found = []
    for _ in range(300):
        lmp.command("run 50")
        now = state(lmp)
        x, v, omega = now["x"][0], now["v"][0], now["omega"][0]
        out = np.array([x[0], 0, x[2]]) / math.hypot(x[0], x[2])
        surface = v + R * np.cross(omega, out)
        found.append(surface - np.cross([0, speed, 0], (math.hypot(x[0], x[2]) + R) * out))
    assert abs(np.mean(found, axis=0)).max() < 0.02 * speed * radius


def test_the_walls_go_on_when_the_clock_is_reset(model):
    """The time of the walls is the sum of the steps, also when the step changes."""
    plate = flat(1e-3, motion=Vibration((0, 0, 1e-4), 500.0))
    lmp, walls = scene(model, [plate], (0, 0, 0.02), (0, 0, 0))
    lmp.commands_string("run 100\nreset_timestep 0\nrun 50\nreset_timestep 7000\nrun 50")
    assert walls.time == pytest.approx(200e-7, rel=1e-12)
    lmp.commands_string("timestep 2e-7\nrun 100")
    assert walls.time == pytest.approx(400e-7, rel=1e-12)


def test_a_bead_at_the_meeting_of_two_motions_has_one_contact(model):
    """One plate stands still; its neighbour slides along their seam."""
    still = flat(1e-3, x=-0.05, width=0.05)
    sliding = flat(1e-3, x=0.0, width=0.05, motion=Translation((0, 1.0, 0)))
    for x in (-1e-5, 0.0, 1e-5):
        (row,), _ = dropped(model, [still, sliding], above(1e-5, x), steps=400)
        assert row["restitution"] == pytest.approx(model.restitution(5.0, R, 1e-3), abs=5e-4)


def test_a_wall_too_fast_for_the_step(model):
    plate = flat(1e-3, motion=Translation((0, 0, 20.0)))
    lmp, _ = scene(model, [plate], (0, 0, 0.02), (0, 0, 0), dt=1e-4)
    with pytest.raises(RuntimeError, match="further than its radius"):
        lmp.command("run 200")
