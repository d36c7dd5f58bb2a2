"""Walls that move in LAMMPS: where they are, what a bead feels, and what they give it."""

import math

import numpy as np
import pytest
from lammps_box import ABOVE, ALIKE, R, above, attach, dropped, flat, make, quiet, restarted, scene, state
from scipy.spatial.transform import Rotation as Turn

from contactlaw.engines.lammps import Cylinder, Mesh, Plate, Rotation, Tabulated, Translation, Vibration
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


def settled(model, motion, gap=5e-5, **options):
    """A bead that lies still for 0.12 s before a plate is attached under it."""
    lmp = make(above(gap), (0, 0, 0), dt=1e-3)
    lmp.commands_string("run 120\ntimestep 1e-7")
    return lmp, attach(lmp, model, [flat(1e-3, motion=motion)], **options)


@pytest.mark.parametrize("motion", [Translation((0, 0, 0.05)), Vibration((0, 0, 0.5e-4), 250.0), None])
def test_a_wall_starts_where_it_was_given_when_it_is_attached(model, motion, tmp_path):
    """Of walls that began at time 0 the bead would be 6 mm deep in the first, and below the second."""
    if motion is None:  # with a table
        motion = Tabulated([0.0, 1e-3, 2e-3], [[0, 0, 0], [0, 0, 5e-5], [0, 0, 1e-4]])
    lmp, walls = settled(model, motion, gap=4.5e-5)
    assert walls.start == pytest.approx(0.12, rel=1e-12)
    lmp.command("run 15000")
    (row,) = walls.collisions()
    touch = {Translation: 0.9e-3, Vibration: math.asin(0.9) / (500 * math.pi), Tabulated: 0.9e-3}[type(motion)]
    assert row["time"] - 0.12 == pytest.approx(touch, rel=1e-4)
    assert row["wall_start"] == pytest.approx(0.12, rel=1e-12)
    # Where it was then on the wall is known in the picture of the walls at the start.
    assert walls.record().surface.point[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)


def test_a_wall_that_turns_starts_unturned_unless_another_time_is_given(model):
    for start, angle in ((None, 0.0), (0.02, 0.1 * 7.0)):
        lmp, walls = settled(model, Rotation((0, 0, 1), 7.0), start=start)
        lmp.command("run 0")
        turn = walls._contacts.scene.frames["turn"][0]
        assert turn[:2] == pytest.approx([math.cos(angle), -math.sin(angle)], abs=1e-12)
    with pytest.raises(ValueError, match="start: got nan; must be finite"):
        attach(make(ABOVE), model, [flat(1e-3)], start=math.nan)


def test_a_restart_goes_on_with_the_motion(model, tmp_path):
    """Also of a bead that no wall has come near so far."""
    motion = Vibration((0, 0, 0.5e-4), 250.0)
    lmp, walls = settled(model, motion, gap=4.5e-5)
    lmp.commands_string(
        f"run 3000\nwrite_restart {tmp_path}/early\nrun 4250\nwrite_restart {tmp_path}/touching\nrun 7750"
    )
    (whole,), end = walls.collisions(), state(lmp)
    for name, steps in ("early", 12000), ("touching", 7750):
        lmp = restarted(tmp_path / name)
        walls = attach(lmp, model, [flat(1e-3, motion=motion)])
        assert walls.start == pytest.approx(0.12, rel=1e-12)
        lmp.command(f"run {steps}")
        (row,) = walls.collisions()
        assert [row[one] for one in ALIKE] == pytest.approx([whole[one] for one in ALIKE], rel=1e-7, abs=1e-15)
        assert state(lmp)["v"] == pytest.approx(end["v"], rel=1e-9)


def test_a_restart_of_an_older_version_is_refused(model, tmp_path):
    lmp, _ = scene(model)
    lmp.command("run 50")
    lmp.numpy.extract_atom("d2_contactlaw")[0, 2] = 40.0  # the number of columns, as 0.3 has it
    lmp.command(f"write_restart {tmp_path}/old")
    with pytest.raises(ValueError, match="the restart file is of contactlaw 0.3"):
        attach(restarted(tmp_path / "old"), model, [flat(1e-3)])


PERIODIC = """
    units si
    atom_style sphere
    boundary p f f
    neighbor 0.002 bin
    neigh_modify delay 0 every 1 check yes
    comm_modify cutoff 0.004
    region box block 0 0.02 -0.01 0.01 -0.002 0.02
    create_box 1 box
    create_atoms 1 single 0.01995 0 0.00091
    set group all diameter 1.8e-3 density 879
    velocity all set 15 0 -1
    fix move all nve/sphere
    timestep 1e-7
"""
FLAT = Plate((0, -0.01, 0), (0.02, 0, 0), (0, 0.02, 0), 1e-3)
CORNERS = [(0, -0.01, 0), (0.02, -0.01, 0), (0.02, 0.01, 0), (0, 0.01, 0)]


@pytest.mark.parametrize(
    "wall", [FLAT, Mesh(CORNERS, [(0, 1, 2), (0, 2, 3)], 1e-3), Cylinder((0, 0, -0.05), (0.02, 0, -0.05), 0.05, 1e-3)]
)
def test_a_wall_that_ends_at_a_periodic_boundary_holds_a_bead_that_strays_past_it(model, wall):
    """LAMMPS takes the bead back into the box up to half a neighbour skin later."""
    lmp = quiet(PERIODIC)
    walls = attach(lmp, model, [wall])
    lmp.command("run 800")
    assert walls.collisions()["restitution"] == pytest.approx(model.restitution(1.0, R, 1e-3), abs=2e-3)


@pytest.mark.parametrize(
    ("commands", "words"),
    [
        ("change_box all triclinic", "box: it is triclinic"),
        ("fix deform all deform 1 x erate 10\nrun 50", "box: a periodic side changes its length"),
    ],
)
def test_what_walls_cannot_follow_is_refused(model, commands, words):
    lmp = quiet(PERIODIC)
    attach(lmp, model, [FLAT])
    with pytest.raises(RuntimeError, match=words):
        lmp.commands_string(commands)
    if "triclinic" in commands:
        with pytest.raises(RuntimeError, match=words):
            attach(quiet(f"{PERIODIC}\n{commands}"), model, [FLAT])


def test_the_speed_of_a_wall_counts_where_beads_are_looked_at(model):
    """A wall at 5 m/s, and a bead that lies still."""
    lmp, _ = scene(model, [flat(1e-3, height=-0.01, motion=Translation((0, 0, 5.0)))], ABOVE, (0, 0, 0), dt=2e-4)
    with pytest.raises(RuntimeError, match="at 5 m/s relative to a wall it flies further than its radius"):
        lmp.command("run 0")
