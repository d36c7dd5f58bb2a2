"""Beads of rigid bodies in LAMMPS beside an integration of a dumbbell that shares no code."""

import functools

import numpy as np
import pytest
from dumbbell import ACROSS, ALONG, impact, response
from lammps_box import ALIKE, MASS, PAIR, R, attach, flat, quiet, state
from lasting import long

import contactlaw as cl
from contactlaw.engines.record import Kind

H, N, SLIDE, DT = 0.5e-3, 30, 0.3, 5e-8
MODEL = cl.ImpactModel(PAIR, law="myc")
BOX = "boundary p p f\nregion box block -0.05 0.05 -0.05 0.05 -0.01 0.05"
RIGID = "fix body all rigid/small molecule"


def thrown(axes, friction=0.0, softening=1.0, density=PAIR.sphere.density, thickness=H, pieces=0, more=""):
    """Dumbbells whose lower spheres fall onto a plate; the first one lies across the border of the box."""
    lmp = quiet(f"units si\natom_style sphere\natom_modify map array\n{BOX}\ncreate_box 1 box")
    for n, axis in enumerate(axes):
        x, y, z = -0.05 + 0.016 * (n % 6), 0.016 * (n // 6) - 0.045, R + 1e-6
        upper = np.array([x, y, z]) - 2 * R * axis
        across = int(upper[0] < -0.05)
        upper[0] += 0.1 * across
        lmp.commands_string(f"""
            create_atoms 1 single {x} {y} {z}
            create_atoms 1 single {" ".join(map(str, upper))}
            set atom {2 * n + 2} image {-across} 0 0""")
    lmp.commands_string(f"""
        comm_modify cutoff 0.01
        fix number all property/atom mol
        set group all diameter {2 * R} density {density}
        variable body atom ceil(id/2)
        set group all mol v_body
        velocity all set {SLIDE} 0 -1
        thermo_style custom step
        timestep {DT * softening**0.4}
        {more if pieces else RIGID}""")
    walls = attach(lmp, MODEL, [flat(thickness)], friction=friction, softening=softening, rigid="body")
    # In the set-up of a run, LAMMPS's bodies hear of no force by a fix that was made after theirs.
    lmp.command(RIGID if pieces else "run 1200")
    for _ in range(pieces):
        lmp.command(f"run {1200 // pieces}")
    return lmp, walls, np.sort(walls.record().rows, order="bead")


def orientations():
    """Axes to the lower sphere; of a flatter dumbbell the other sphere would touch soon after."""
    height = np.linspace(0.15, 0.97, N)
    angle = np.random.default_rng(5).uniform(0, 2 * np.pi, N)
    side = np.sqrt(1 - height**2)
    return np.stack([side * np.cos(angle), side * np.sin(angle), -height], axis=1)


AXES, FEW = orientations(), orientations()[::6]


def masses(axes):
    return np.array([1 / response(axis) for axis in axes])


@functools.cache
def on_springs(friction):
    """Velocity of the contact point and contact time of each dumbbell, by the integration."""
    return [impact(H, axis, (SLIDE, 0.0, -1.0), friction) for axis in AXES]


def energies(lmp):
    """Kinetic energy of each dumbbell now."""
    now = state(lmp)
    axes, middle, spin = now["x"][::2] - now["x"][1::2], 0.5 * (now["v"][::2] + now["v"][1::2]), now["omega"][::2]
    axes[:, :2] -= 0.1 * np.round(axes[:, :2] / 0.1)
    along = (axes * spin).sum(axis=1) ** 2 / (axes**2).sum(axis=1)
    turning = ACROSS * ((spin**2).sum(axis=1) - along) + ALONG * along
    return MASS * (middle**2).sum(axis=1) + 0.5 * turning


@pytest.mark.parametrize(("friction", "softening"), [(0.0, 1), (0.5, 1), long(3.0, 1), (0.0, 50), (0.5, 50)])
def test_a_dumbbell_rebounds_as_a_rigid_body_on_springs(friction, softening):
    lmp, _, rows = thrown(AXES, friction, softening)
    first = rows[np.unique(rows["bead"], return_index=True)[1]]
    assert first["bead"].tolist() == list(range(1, 2 * N, 2)) and (first["kind"] == Kind.OF_BODY).all()
    # at first touch; the record has it at the end
    assert first["mass"] == pytest.approx(masses(AXES), rel=2e-3 * softening**0.4)
    for row, (v, time) in zip(first, on_springs(friction), strict=True):
        assert row["restitution"] == pytest.approx(v[2], abs=1.5e-3)
        assert row["contact_time"] == pytest.approx(time, rel=5e-3)
        if friction:
            assert row["sliding_speed_after"] == pytest.approx(v[0], abs=0.02 * friction)
    lost = sum(first[name] for name in first.dtype.names if name.endswith("_energy"))
    came = MASS * (1 + SLIDE**2)
    assert (energies(lmp) + lost) / came == pytest.approx(1.0, abs=1e-5 if softening == 1 else 1e-4)


def test_a_softened_body_rebounds_no_faster_than_it_came():
    """It turns in the long contact, which throws its point up."""
    _, _, rows = thrown(AXES, softening=90.0, thickness=6.8e-3)
    first = rows[np.unique(rows["bead"], return_index=True)[1]]
    hit = MODEL.solve(1.0, R, 6.8e-3, mass=masses(AXES))
    assert (first["kind"] == Kind.OF_BODY).all() and first["restitution"].max() < 1.0
    assert first["restitution"] == pytest.approx(hit.restitution, abs=1e-4)


def test_bodies_of_any_mass_rebound_as_their_mass_at_the_contact_says():
    """Overlapping spheres of clumps are given a density of their own."""
    _, _, rows = thrown(FEW, density=2 * PAIR.sphere.density)
    assert rows["mass"] == pytest.approx(2 * masses(FEW), rel=3e-3)
    assert rows["restitution"] == pytest.approx(MODEL.solve(1.0, R, H, mass=rows["mass"]).restitution, abs=1e-3)


def test_a_run_may_be_cut_into_pieces_and_go_on_from_a_restart_in_mid_contact(tmp_path):
    _, _, cut = thrown(FEW, 0.3, pieces=24)
    _, _, whole = thrown(FEW, 0.3, pieces=1, more=f"restart 100 {tmp_path}/at")
    assert cut["restitution"] == pytest.approx(whole["restitution"], abs=1e-9)
    assert (whole["time"] < 100 * DT).all() and (whole["time"] + whole["contact_time"] > 100 * DT).all()
    lmp = quiet(f"read_restart {tmp_path}/at.100\nfix number all property/atom mol\ntimestep {DT}")
    lmp.command("comm_modify cutoff 0.01")
    walls = attach(lmp, MODEL, [flat(H)], friction=0.3, rigid="body")
    lmp.commands_string(f"{RIGID}\nthermo_style custom step")
    lmp.command("run 1100")
    rows = np.sort(walls.record().rows, order="bead")
    for name in ALIKE:
        assert rows[name] == pytest.approx(whole[name], rel=1e-9, abs=1e-12), name


def parts(lmp):
    return [name for name in lmp.available_ids("fix") + lmp.available_ids("compute") if "contactlaw" in name]


def test_two_spheres_of_a_body_that_touch_at_once_are_counted():
    _, walls, rows = thrown(np.array([[1.0, 0.0, 0.0]]))
    assert rows["bead"].tolist() == [1, 2] and (rows["kind"] == Kind.STRUCK).all()
    assert walls.record().left_out.startswith("Of 2 contacts, 100 % were struck by another bead while they touched")


def test_bodies_may_come_and_go():
    lmp, walls, _ = thrown(AXES[:1])
    x, v = (lmp.numpy.extract_atom(name) for name in ("x", "v"))
    lmp.command("unfix body")
    for n, height in enumerate((R + 1e-6, 3 * R)):  # they fly alone now
        x[n], v[n] = (0.01, 0.0, height), (0.0, 0.0, -1.0)
    lmp.commands_string("set group all image 0 0 0\nfix move all nve/sphere\nrun 1000")
    free = walls.record().rows[-1]
    assert free["kind"] == Kind.IMPACT and free["mass"] == pytest.approx(MASS)
    lmp.command("unfix move")
    lmp.command(RIGID)
    lmp.command("velocity all set 0 0 -1")
    lmp.command("run 4000")
    last = walls.record().rows[-1]
    assert last["kind"] == Kind.OF_BODY and last["mass"] > 1.1 * free["mass"]
    walls.detach()
    assert not parts(lmp)
