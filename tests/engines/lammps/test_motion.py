"""Walls that move in LAMMPS: where they are, what a bead feels, and what they give it."""

import math

import numpy as np
import pytest
from lammps_box import ALIKE, R, above, attach, dropped, flat, make, quiet, restarted, scene
from scipy.spatial.transform import Rotation as Turn

from contactlaw.engines.lammps import Cylinder, Mesh, Plate, Rotation, Tabulated, Translation, Vibration
from contactlaw.walls.frame import FRAME
from contactlaw.walls.motion import move_one


def placed(motion, time, dt=1e-6):
    """Row of numbers of a motion at a time, which beads show only where they touch."""
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


MOVED = np.array([1.0, 2.0, 3.0])
TIMES, PLACES = [0.1, 0.2, 0.4], [[0, 0, 0], [0, 1, 0], [2, 1, 0]]
# Motions, and their shifts and rates by the formulas.
FORMULAS = {
    "translation": (Translation(MOVED), lambda t: MOVED * t, lambda t: MOVED),
    "vibration": (
        Vibration(1e-3 * MOVED, 50.0, phase=0.4),
        lambda t: 1e-3 * MOVED * math.sin(100 * math.pi * t + 0.4),
        lambda t: 0.1 * math.pi * MOVED * math.cos(100 * math.pi * t + 0.4),
    ),
    "table": (
        Tabulated(TIMES, PLACES),
        lambda t: [np.interp(t, TIMES, column) for column in np.transpose(PLACES)],
        lambda t: [10.0 * (0.2 < t < 0.4), 10.0 * (0.1 < t < 0.2), 0.0],
    ),
}


@pytest.mark.parametrize("time", [0.0, 0.0031, 0.15, 0.3, 0.5])
@pytest.mark.parametrize("name", FORMULAS)
def test_shifts_and_rates_are_those_of_the_formulas(name, time):
    motion, shift, rate = FORMULAS[name]
    row = placed(motion, time)
    assert row["shift"] == pytest.approx(shift(time), abs=1e-12)
    # a mean over one step and over two differs from the rate in mid-step by (omega dt)^2/24, /6
    assert row["half_rate"] == pytest.approx(rate(time - 0.5e-6), rel=1e-7, abs=1e-9)
    assert row["rate"] == pytest.approx(rate(time), rel=1e-7, abs=1e-9)


@pytest.mark.parametrize("wind", [(0, 0, 1.5), (0, 0, -2), (3, -1, 2)])
def test_an_impact_is_the_same_in_any_inertial_frame(model, wind):
    place, velocity, moves = above(1e-5, 0.001, 0.002), np.array([1.0, 2.0, -5.0]), Translation(wind)
    still, ends = dropped(model, [flat(1e-3)], place, velocity, friction=0.2)
    moving, others = dropped(model, [flat(1e-3, motion=moves)], place, velocity + wind, friction=0.2)
    for name in ("approach_speed", "restitution", "contact_time", "peak_force", "wave_energy"):
        assert moving[name] == pytest.approx(still[name], rel=1e-9), name
    assert others["v"] - wind == pytest.approx(ends["v"], rel=1e-9)
    assert others["omega"] == pytest.approx(ends["omega"], rel=1e-9)


def test_a_bead_that_moves_with_a_turning_plate_does_not_slide_on_it(model):
    plate = flat(1e-3, motion=Rotation((0, 0, 1), 40.0))
    (row,), _ = dropped(model, [plate], above(1e-5, 0.02, 0.01), (-0.4, 0.8, -5), friction=0.2)
    assert row["sliding_speed"] == pytest.approx(0.0, abs=1e-3)


def test_the_walls_go_on_when_the_clock_is_reset(model):
    """The time of the walls is the sum of the steps, also when the step changes; impacts have LAMMPS's."""
    plate = flat(1e-3, motion=Vibration((0, 0, 1e-9), 500.0))
    lmp, walls = scene(model, [plate])
    lmp.commands_string("run 100\nreset_timestep 0\nrun 50\nreset_timestep 7000\nrun 50")
    assert walls.time == pytest.approx(200e-7, rel=1e-12)
    lmp.commands_string("timestep 2e-7\nrun 300")
    assert walls.time == pytest.approx(800e-7, rel=1e-12)


@pytest.mark.parametrize("x", [-1e-5, 0.0, 1e-5])
def test_a_bead_at_the_meeting_of_two_motions_has_one_contact(model, x):
    """One plate stands still; its neighbour slides along their seam."""
    still = flat(1e-3, x=-0.05, width=0.05)
    sliding = flat(1e-3, x=0.0, width=0.05, motion=Translation((0, 1.0, 0)))
    (row,), _ = dropped(model, [still, sliding], above(1e-5, x), steps=400)
    assert row["restitution"] == pytest.approx(model.restitution(5.0, R, 1e-3), abs=5e-4)


def settled(model, motion, **options):
    """A bead that lies still for 0.12 s before a plate is attached under it."""
    lmp = make(above(4.5e-5), (0, 0, 0), dt=1e-3)
    lmp.commands_string("run 120\ntimestep 1e-7")
    return lmp, attach(lmp, model, [flat(1e-3, motion=motion)], **options)


RISES, SWINGS = Translation((0, 0, 0.05)), Vibration((0, 0, 0.5e-4), 250.0)
TABLE = Tabulated([0.0, 1e-3, 2e-3], [[0, 0, 0], [0, 0, 5e-5], [0, 0, 1e-4]])


@pytest.mark.parametrize(
    ("motion", "start", "touch"),
    [
        (RISES, None, 0.9e-3),
        (SWINGS, None, math.asin(0.9) / (500 * math.pi)),
        (TABLE, None, 0.9e-3),
        (RISES, 0.1198, 0.9e-3),
    ],
)
def test_a_wall_starts_where_it_was_given_when_it_is_attached(model, motion, start, touch):
    """Or at another time. Had they begun at time 0, the bead would be 6 mm deep in the first wall."""
    lmp, walls = settled(model, motion, start=start)
    assert walls.start == pytest.approx(start or 0.12, rel=1e-12)
    lmp.command("run 15000")
    (row,) = walls.collisions()
    assert row["time"] - walls.start == pytest.approx(touch, rel=1e-4)
    assert row["wall_start"] == pytest.approx(walls.start, rel=1e-12)
    # Where it was then on the wall is known in the picture of the walls at the start.
    assert walls.record().surface.point[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)


def test_a_restart_goes_on_with_the_motion(model, tmp_path):
    """Also of a bead that no wall has come near so far."""
    lmp, walls = settled(model, SWINGS)
    lmp.commands_string(f"run 3000\nwrite_restart {tmp_path}/early\nrun 12000")
    lmp = restarted(tmp_path / "early")
    again = attach(lmp, model, [flat(1e-3, motion=SWINGS)])
    assert again.start == pytest.approx(0.12, rel=1e-12)
    lmp.command("run 12000")
    (whole,), (row,) = walls.collisions(), again.collisions()
    assert [row[one] for one in ALIKE] == pytest.approx([whole[one] for one in ALIKE], rel=1e-7, abs=1e-15)


def test_a_restart_of_other_contacts_or_an_older_version_is_refused(model, tmp_path):
    lmp, _ = scene(model, dt=5e-7, softening=7.0)
    lmp.commands_string(f"run 50\nwrite_restart {tmp_path}/touching")
    for contact in ({"softening": 30.0}, {}, {"softening": 7.0, "parcel": 2.0}):
        again = restarted(tmp_path / "touching")
        attach(again, model, [flat(1e-3)], **contact)
        with pytest.raises(RuntimeError, match="a wall with softening 7, parcel 1; give the walls these numbers"):
            again.command("run 0")
    with pytest.raises(ValueError, match="plates, friction: beads are in contact with other"):
        attach(restarted(tmp_path / "touching"), model, [flat(1e-3)], friction=0.3)
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
