"""LIGGGHTS with the exported normal model: built and run, beside the table and `softsphere`."""

import math
import os
import re
import shutil
import subprocess
from pathlib import Path

import lammps_box as box
import numpy as np
import pytest
import scenes
import trimesh
from lasting import long
from once import once
from places import ROOT

import contactlaw as cl
from contactlaw.equation.edge import KINDS
from contactlaw.softsphere import time_step

TOOLS = "liggghts", "mpicxx", "mpirun.openmpi"
MISSING = [name for name in TOOLS if not shutil.which(name)]
if not Path("/usr/include/liggghts/fix_wall_gran_base.h").exists():
    MISSING.append("its headers")
pytestmark = pytest.mark.skipif(
    bool(MISSING), reason=f"LIGGGHTS: {', '.join(MISSING)} missing: `make test-engines` says what to install"
)
WARNINGS = "-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror"
WARNINGS += " -Wno-maybe-uninitialized"  # in LIGGGHTS's functions, as they are expanded in ours

MODEL, RADIUS = cl.ImpactModel(cl.Pair("gamma-alumina", "glass")), 0.9e-3
THICKNESS = 0.5e-3, 1e-3, 3e-3, 1e3  # of atom types 2 to 5; the last one is a half-space
GAP = 1.03e-5  # [m]; no whole number of steps
COLUMNS = "id", "x", "y", "z", "vx", "vy", "vz", "fx", "fz", "omegax", "omegay"
SCRIPT = """
units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
{processors}
hard_particles yes
{start}
neighbor {skin} bin
neigh_modify delay 0
fix modulus all property/global youngsModulus peratomtype 1e10 1e10 1e10 1e10 1e10
fix ratio all property/global poissonsRatio peratomtype 0.2 0.2 0.2 0.2 0.2
fix cor all property/global coefficientRestitution peratomtypepair 5 {cors}
fix friction all property/global coefficientFriction peratomtypepair 5 {friction}
fix thickness all property/global plateThickness peratomtype {thickness}
pair_style gran model {pair} tangential history
pair_coeff * *
timestep {step}
{walls}
fix move all nve/sphere
dump d all custom {every} dump.txt id x y z vx vy vz fx fz omegax omegay
dump_modify d sort id format "%d{digits}"
"""
BOX = "region box block -0.05 0.05 -0.05 0.05 -0.05 0.05 units box\ncreate_box 5 box"
BEAD = """
create_atoms 1 single {1!r} {2!r} {3!r} units box
set atom {0} diameter {7!r} density {8!r} vx {4!r} vy {5!r} vz {6!r}
"""


def pairs(value):
    """A property of 25 pairs of atom types."""
    return " ".join([str(value)] * 25)


OPTIONS = {
    "processors": "",
    "step": 1e-7,
    "skin": 1e-3,
    "cors": pairs(0.9),
    "friction": pairs(0),
    "every": 100_000,
    "thickness": " ".join(map(str, (1.0, *THICKNESS))),
    "pair": "hertz",
    "digits": " %.17g" * (len(COLUMNS) - 1),
}


def beads(centres, velocities, radius=RADIUS):
    """Lines of a script that make beads."""
    centres, velocities = np.broadcast_arrays(centres, velocities)
    rows = np.column_stack([centres, velocities, np.full(len(centres), 2 * radius)]).tolist()
    density = MODEL.pair.sphere.density
    return BOX + "".join(BEAD.format(n, *row, density) for n, row in enumerate(rows, 1))


class Scene:
    """A folder in which LIGGGHTS runs with a library."""

    def __init__(self, folder, library):
        self.folder, self.library = folder, library

    def sheet(self, name="sheet", low=(-0.01, -0.01), high=(0.01, 0.01), parts=1):
        """Write a rectangle in z = 0 as an STL file of squares, each two triangles."""
        corners, triangles = box.square(parts, 0.5)
        corners[:, :2] = low + (corners[:, :2] + 0.5) * np.subtract(high, low)
        trimesh.Trimesh(corners, triangles).export(self.folder / f"{name}.stl", file_type="stl_ascii")

    def script(self, start, walls, **changes):
        return SCRIPT.format_map(OPTIONS | changes | {"start": start, "walls": walls})

    def start(self, script, ranks=1):
        (self.folder / "in.script").write_text(script)
        load = f"LD_PRELOAD={self.library}"
        command = ["env", load, "liggghts"]
        if ranks > 1:
            command = f"mpirun.openmpi --oversubscribe -np {ranks} -x {load} liggghts".split()
        root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        return subprocess.run(
            [*command, "-in", "in.script", "-log", "none"],
            cwd=self.folder,
            env=os.environ | root,
            timeout=120,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )

    def run(self, script, ranks=1):
        """Columns of each dump, by name; the first axis is time."""
        done = self.start(script, ranks)
        assert done.returncode == 0, done.stdout[-2000:]
        parts = (self.folder / "dump.txt").read_text().split("ITEM: TIMESTEP\n")[1:]
        rows = [np.loadtxt(part.splitlines()[8:], ndmin=2) for part in parts]
        return dict(zip(COLUMNS, np.stack(rows).transpose(2, 0, 1), strict=True))


def zplane(kind=3, tangential="contactlaw"):
    model = f"model contactlaw tangential {tangential}"
    return f"fix wall all wall/gran {model} primitive type {kind} zplane 0"


def meshes(tangential="contactlaw", **kinds):
    """Plates of these atom types; LIGGGHTS needs all meshes in one wall."""
    lines = [f"fix {name} all mesh/surface file {name}.stl type {kind}" for name, kind in kinds.items()]
    wall = f"fix wall all wall/gran model contactlaw tangential {tangential} mesh"
    return "\n".join([*lines, f"{wall} n_meshes {len(kinds)} meshes {' '.join(kinds)}"])


def softening(value):
    """Line of a script."""
    return f"fix softening all property/global softening scalar {value}\n"


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """The library, built with warnings as errors."""

    def build(folder):
        cl.export.liggghts(folder, MODEL)
        flags = os.environ | {"CXXFLAGS": WARNINGS}
        done = subprocess.run(["sh", folder / "build.sh"], env=flags, capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, "")

    return once(tmp_path_factory, "liggghts", build) / "wall_contactlaw.so"


@pytest.fixture
def scene(library, tmp_path):
    return Scene(tmp_path, library)


CLAMPED = None, "clamped", None


@pytest.mark.parametrize(
    ("soft", "edges", "bound"), [(1, (None,) * 3, 5e-4), (1, KINDS, 1e-3), (100, CLAMPED, 2e-3), (1000, CLAMPED, 2e-3)]
)
def test_drops_have_the_restitution_of_the_solver(soft, edges, bound, scene):
    """On plates of four thicknesses, some near an edge, each a mesh with its own atom type; and bead on bead."""
    speeds, pair_speeds, s = (0.3, 1.0, 3.0) if soft > 1 else (1.0, 5.0, 20.0), np.array([1.0, 2.0, 4.0, 10.0]), 1e-3
    step = time_step(MODEL, max(speeds), RADIUS, math.inf, softening=soft)
    sheets, centres, lines = {}, [], [softening(soft)]
    for n, kind in enumerate((*edges, None)):
        x = -0.0375 + 0.025 * n
        scene.sheet(f"sheet{n}", (x - 0.011, -0.02), (x + 0.011, 0.02), parts=2)
        sheets[f"sheet{n}"] = n + 2
        centres += [(x + 0.003, 0.006 * k - 0.006, RADIUS + GAP * k / 3) for k in range(3)]
        if kind:
            distances = " ".join(str(s if m == n + 1 else 1000) for m in range(5))
            lines.append(f"fix {kind} all property/global {kind}Edge peratomtype {distances}\n")
    speed = np.tile(speeds, 4)
    centres += [(side * (RADIUS + 5e-7), 0.008 * n - 0.012, 0.02) for n in range(4) for side in (-1, 1)]
    velocities = [(0, 0, -v) for v in speed] + [(-0.5 * side * v, 0, 0) for v in pair_speeds for side in (-1, 1)]
    walls = "".join(lines) + meshes("off", **sheets)
    options = {"step": step, "every": 1500, "pair": "contactlaw"}
    last = scene.run(scene.script(beads(centres, velocities), walls, **options) + "run 1500")
    expected = [
        MODEL.solve(speeds, RADIUS, h, edge=kind or "free", edge_distance=s if kind else math.inf).restitution
        for h, kind in zip(THICKNESS, (*edges, None), strict=True)
    ]
    assert (last["fz"][-1] == 0.0).all()
    assert last["vz"][-1, :12] / speed == pytest.approx(np.ravel(expected), abs=bound)
    sphere = MODEL.pair.sphere
    expected = cl.restitution_sphere_sphere(sphere, sphere, pair_speeds, RADIUS, RADIUS)
    assert last["vx"][-1, 13::2] / (0.5 * pair_speeds) == pytest.approx(expected, abs=bound)


@pytest.mark.parametrize("soft", [1.0, 5.0])
def test_a_scene_is_that_of_lammps(soft, scene):
    """The scene of all engines whose only wall is a plate, with friction and beads of two sizes."""
    shared = scenes.SCENES["softened"]
    shared = shared._replace(softening=soft, kind=np.ones_like(shared.kind))
    start = beads(shared.place, shared.velocity, shared.radius)
    weight = f"fix weight all gravity {scenes.GRAVITY} vector 0 0 -1\n"
    options = {"friction": pairs(0.3), "step": scenes.DT, "every": shared.steps}
    script = scene.script(start, softening(soft) + weight + zplane(), **options)
    last = {name: values[-1] for name, values in scene.run(f"{script}run {shared.steps}").items()}
    wanted = scenes.by_attach(shared)
    assert len(wanted.rows) >= 15
    assert np.column_stack([last[f"v{axis}"] for axis in "xyz"]) == pytest.approx(wanted.v, abs=2e-3)
    assert np.column_stack([last[axis] for axis in "xyz"]) == pytest.approx(wanted.x, abs=1e-6)
    assert np.column_stack([last[f"omega{axis}"] for axis in "xy"]) == pytest.approx(wanted.omega[:, :2], abs=10.0)


def test_a_bead_that_sticks_has_mindlins_spring(scene):
    """By its velocities: 8 G* sqrt(r d) times the slip of the surface, at a half-space."""
    step, pair = 1e-7, MODEL.pair
    start = beads([(0.0, 0.0, RADIUS + GAP)], (1.0, 0.0, -5.0))
    script = scene.script(start, zplane(5, "history"), friction=pairs("1e6"), every=1)
    found = {name: one[:, 0] for name, one in scene.run(script + "run 200").items()}
    compliance = sum(
        2 * (2 - one.poissons_ratio) * (1 + one.poissons_ratio) / one.youngs_modulus
        for one in (pair.sphere, pair.plate)
    )
    depth = np.maximum(RADIUS - found["z"], 0.0)
    speed = found["vx"] - RADIUS * found["omegay"]
    slip = np.cumsum(0.5 * step * (speed + np.roll(speed, 1)) * (depth > 0.0))
    pull = 8.0 / compliance * np.sqrt(RADIUS * depth) * slip * (found["fz"] > 0.0)
    assert min(found["fx"].max(), -found["fx"].min()) > 1.0  # [N]; the slip changes its sign
    assert -found["fx"] == pytest.approx(pull, abs=0.06 * pull.max())


FRICTION = pairs(0.2)


def shower(scene):
    """Beads that slide over seams of a plate, and across the border of two ranks in mid-contact."""
    scene.sheet(low=(-0.04, -0.04), high=(0.04, 0.04), parts=8)
    rng = np.random.default_rng(7)
    x, y = np.meshgrid(np.linspace(-0.036, 0.036, 11), np.linspace(-0.036, 0.036, 11))
    centres = np.column_stack([x.ravel(), y.ravel(), RADIUS + 1e-4 * rng.random(x.size)])
    velocities = rng.uniform((-8, -8, -9), (8, 8, -2), centres.shape)
    border = slice(5, None, 11)  # these touch after 4 us, then cross the border
    centres[border, 0], centres[border, 2] = -np.linspace(3e-5, 9e-5, 11), RADIUS + 2e-5
    velocities[border] = 10.0, 0.0, -5.0
    return beads(centres, velocities)


@pytest.mark.parametrize("soft", [1, long(100)])
def test_ranks_runs_in_parts_and_a_restart_in_contact_change_no_digit(soft, scene):
    start, walls = shower(scene), softening(soft) + meshes(sheet=3)
    options = {"friction": FRICTION, "skin": 4e-5, "every": 10, "step": time_step(MODEL, 9.0, RADIUS, math.inf)}
    text = scene.script(start, walls, **options)
    whole = scene.run(text + "run 400")
    touching, right = whole["fz"] > 0.0, whole["x"] > 0.0  # the border of the ranks is at 0
    assert touching[12].sum() > 3  # step 120
    assert ((right[1:] > right[:-1]) & touching[1:] & touching[:-1]).any(axis=0).sum() >= 3
    assert np.abs(whole["omegay"][-1]).max() > 100.0
    others = [scene.run(text + "run 60\nrun 60\nwrite_restart middle\nrun 80\nrun 200")]
    others.append(scene.run(scene.script("read_restart middle", walls, **options) + "run 280"))
    others.append(scene.run(scene.script(start, walls, **options, processors="processors 2 1 1") + "run 400", ranks=2))
    plane = scene.run(scene.script(start, softening(soft) + zplane(), **options) + "run 400")
    for name in COLUMNS:
        assert all((other[name][-1] == whole[name][-1]).all() for other in others), name
        assert whole[name][-1] == pytest.approx(plane[name][-1], rel=1e-9), name  # no seam of the mesh is felt


SOUND = "thickness all property/global plateThickness peratomtype 1.0 0.0005 0.001 0.003 1000.0"
RIM = "fix rim all property/global freeEdge peratomtype 1 1 -1 1 1"
WRONG = {
    "no thickness": (f"fix {SOUND}", "", "property storing value(s) for plateThickness"),
    "zero": ("0.001 0.003", "0 0.003", "plateThickness requires values between 1e-09 and 1e+20"),
    "beads": ("model hertz tangential history", "model contactlaw tangential contactlaw", "Unknown normal model"),
    "tangential": ("contactlaw tangential contactlaw", "contactlaw tangential no_history", "Unknown normal model"),
    "option": ("tangential contactlaw primitive", "tangential contactlaw damping on primitive", "damping"),
    "edge": ("fix friction", f"{RIM}\nfix friction", "freeEdge requires values between 0 and"),
    "softening": ("fix friction", f"{softening(0.5)}fix friction", "softening requires values between 1 and"),
    "infinite": ("fix friction", f"{softening('inf')}fix friction", "Expected floating point parameter"),
    "another softening": ("run 200", f"run 40\n{softening(100)}run 20", "softening: 100, but 1 as a contact began"),
    "units": ("units si", "units cgs", "Normal model contactlaw is in SI units: take units si"),
    "too thin": ("0.001 0.003", "1e-6 0.003", "plates have to be at least 0.01 radii thick"),
    "too long": ("timestep 1e-07", "timestep 1e-06", "too long for an impact at 5 m/s, which needs 20 steps; take"),
    "blown up": ("timestep 1e-07", "timestep 1e-11", "has the simulation blown up?"),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_liggghts_refuses(wrong, scene):
    old, new, message = WRONG[wrong]
    speed = 2e5 if wrong == "blown up" else 5.0
    start = beads([(0.0, 0.0, RADIUS + GAP)], (0, 0, -speed))
    text = scene.script(start, zplane()) + "run 200\n"
    assert text.count(old) == 1
    done = scene.start(text.replace(old, new))
    assert done.returncode != 0
    assert "ERROR" in done.stdout
    said = " ".join(done.stdout.split())
    assert message in said
    if wrong == "too long":
        advised = float(re.search(r"take ([0-9.e-]+) s", said)[1])
        assert advised == pytest.approx(MODEL.lookup(5.0, RADIUS, math.inf).contact_time / 20, rel=0.03)


def test_the_rain_comes_back_from_the_thick_sheet_faster(scene):
    """Every bead hits one of two plates at 3 m/s; beads that meet on the way lose more energy."""
    for path in (ROOT / "docs/examples/liggghts").iterdir():
        shutil.copy(path, scene.folder)
    done = scene.start((scene.folder / "in.rain").read_text())
    assert done.returncode == 0, done.stdout[-2000:]
    found = re.findall(r"upward speed over ([0-9.]+) mm: ([0-9.]+) m/s", done.stdout)
    expected = MODEL.restitution(3.0, 0.9e-3, [0.5e-3, 3e-3])
    share = np.array([float(speed) for _, speed in found]) / (3.0 * expected)
    assert [thickness for thickness, _ in found] == ["0.5", "3"]
    assert ((0.75 < share) & (share < 1.0)).all()
