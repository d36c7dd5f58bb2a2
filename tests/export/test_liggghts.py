"""LIGGGHTS with the exported normal model: built and run, beside the table and `softsphere`."""

import math
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
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
SPEEDS = 1.0, 2.0, 5.0, 10.0, 20.0
GAP = 1.03e-5  # [m]; no whole number of steps
COLUMNS = "id", "x", "y", "z", "vx", "vy", "vz", "fz", "omegax", "omegay"
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
{properties}
fix friction all property/global coefficientFriction peratomtypepair 5 {friction}
fix thickness all property/global plateThickness peratomtype {thickness}
pair_style gran model hertz tangential history
pair_coeff * *
timestep {step}
{walls}
fix move all nve/sphere
dump d all custom {every} {dump} id x y z vx vy vz fz omegax omegay
dump_modify d sort id format "%d{digits}"
"""
PROPERTIES = "\n".join(
    f"fix p{n} all property/global {name} {kind} " + " ".join([value] * count)
    for n, (name, kind, value, count) in enumerate(
        [
            ("youngsModulus", "peratomtype", "1e10", 5),
            ("poissonsRatio", "peratomtype", "0.2", 5),
            ("coefficientRestitution", "peratomtypepair 5", "0.9", 25),
        ]
    )
)


class Scene:
    """A folder in which LIGGGHTS runs with a library."""

    def __init__(self, folder, library):
        self.folder, self.library = folder, library

    def beads(self, centres, velocities, name="beads.data"):
        """Write a file of beads, and return the line of a script that reads it."""
        centres, velocities = np.broadcast_arrays(centres, velocities)
        density = MODEL.pair.sphere.density
        lines = ["beads", "", f"{len(centres)} atoms", "5 atom types", ""]
        lines += [f"-0.05 0.05 {axis}lo {axis}hi" for axis in "xyz"] + ["", "Atoms", ""]
        for n, (x, y, z) in enumerate(centres.tolist(), 1):
            lines.append(f"{n} 1 {2 * RADIUS} {density} {x!r} {y!r} {z!r}")
        lines += ["", "Velocities", ""]
        for n, (u, v, w) in enumerate(velocities.tolist(), 1):
            lines.append(f"{n} {u!r} {v!r} {w!r} 0 0 0")
        (self.folder / name).write_text("\n".join(lines) + "\n")
        return f"read_data {name}"

    def sheet(self, name="sheet", low=(-0.01, -0.01), high=(0.01, 0.01), parts=1):
        """Write a rectangle in z = 0 as an STL file of squares, each two triangles."""
        lines = ["solid"]
        xs, ys = (np.linspace(low[k], high[k], parts + 1).tolist() for k in (0, 1))
        for a, b in zip(xs, xs[1:], strict=False):
            for c, d in zip(ys, ys[1:], strict=False):
                for corners in ([(a, c), (b, c), (b, d)], [(a, c), (b, d), (a, d)]):
                    lines += ["facet normal 0 0 1", "outer loop"]
                    lines += [f"vertex {x!r} {y!r} 0" for x, y in corners]
                    lines += ["endloop", "endfacet"]
        (self.folder / f"{name}.stl").write_text("\n".join([*lines, "endsolid"]) + "\n")

    def script(self, start, walls, **changes):
        values = {
            "start": start,
            "walls": walls,
            "step": 1e-7,
            "skin": 1e-3,
            "processors": "",
            "properties": PROPERTIES,
            "friction": " ".join(["0"] * 25),
            "every": 100_000,
            "thickness": " ".join(map(str, (1.0, *THICKNESS))),
            "dump": "dump.txt",
            "digits": " %.17g" * (len(COLUMNS) - 1),
        }
        assert changes.keys() <= values.keys()
        return SCRIPT.format_map(values | changes)

    def start(self, script, ranks=1):
        (self.folder / "in.script").write_text(script)
        load = f"LD_PRELOAD={self.library}"
        command = ["env", load, "liggghts"]
        if ranks > 1:
            run = f"mpirun.openmpi --oversubscribe -np {ranks} -x {load} liggghts"
            command = run.split()
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

    def run(self, script, ranks=1, dump="dump.txt"):
        """Columns of each dump, by name; the first axis is time."""
        done = self.start(script, ranks)
        assert done.returncode == 0, done.stdout[-2000:]
        rows = [
            np.loadtxt(part.splitlines()[8:], ndmin=2)
            for part in (self.folder / dump).read_text().split("ITEM: TIMESTEP\n")[1:]
        ]
        return dict(zip(COLUMNS, np.stack(rows).transpose(2, 0, 1), strict=True))


def zplane(kind=3, tangential="contactlaw"):
    model = f"model contactlaw tangential {tangential}"
    return f"fix wall all wall/gran {model} primitive type {kind} zplane 0"


def meshes(tangential="contactlaw", **kinds):
    """Plates of these atom types; LIGGGHTS needs all meshes in one wall."""
    lines = [f"fix {name} all mesh/surface file {name}.stl type {kind}" for name, kind in kinds.items()]
    wall = f"fix wall all wall/gran model contactlaw tangential {tangential} mesh"
    return "\n".join([*lines, f"{wall} n_meshes {len(kinds)} meshes {' '.join(kinds)}"])


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """The library, built with warnings as errors."""
    folder = tmp_path_factory.mktemp("liggghts") / "wall"
    cl.export.liggghts(folder, MODEL)
    done = subprocess.run(
        ["sh", folder / "build.sh"], env=os.environ | {"CXXFLAGS": WARNINGS}, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "")
    return folder / "wall_contactlaw.so"


@pytest.fixture
def scene(library, tmp_path):
    return Scene(tmp_path, library)


def step_for(*speeds):
    return min(time_step(MODEL, v, RADIUS, math.inf) for v in speeds)


def test_drops_have_the_restitution_of_the_table(scene):
    """Plates of four thicknesses are in one scene, each a mesh with its own atom type."""
    sheets, centres, rng = {}, [], np.random.default_rng(5)
    for n in range(len(THICKNESS)):
        x = -0.0375 + 0.025 * n
        scene.sheet(f"sheet{n}", (x - 0.011, -0.02), (x + 0.011, 0.02), parts=2)
        sheets[f"sheet{n}"] = n + 2
        y = -0.015 + 0.006 * np.arange(5)
        centres += [(x + 0.003, one, RADIUS + 1e-5 * rng.random()) for one in y]
    speed, thickness = np.tile(SPEEDS, 4), np.repeat(THICKNESS, 5)
    start = scene.beads(centres, [(0, 0, -v) for v in speed])
    script = scene.script(start, meshes(**sheets), step=step_for(*SPEEDS), every=400)
    last = scene.run(script + "run 400")
    expected = MODEL.lookup(speed, RADIUS, thickness)
    assert (last["fz"][-1] == 0.0).all()
    assert np.abs(last["vz"][-1] / speed - expected.restitution).max() < 5e-4
    assert expected.restitution.min() < 0.6 < 0.84 < expected.restitution.max()


@pytest.mark.parametrize("soft", [1.0, 5.0])
def test_a_scene_is_that_of_lammps(soft, scene):
    """The scene of all engines whose only wall is a plate, with friction and beads of two sizes."""
    scenes = pytest.importorskip("scenes")
    shared = scenes.SCENES["softened"]._replace(softening=soft)
    start = scene.beads(shared.place, shared.velocity)
    path = scene.folder / "beads.data"
    lines = path.read_text().splitlines()
    for n, radius in enumerate(shared.radius.tolist(), lines.index("Atoms") + 2):
        lines[n] = lines[n].replace(f" {2 * RADIUS} ", f" {2 * radius} ")
    path.write_text("\n".join([*lines, ""]))
    weight = f"fix weight all gravity {-scenes.GRAVITY} vector 0 0 -1\n"
    options = {"friction": " ".join(["0.3"] * 25), "step": scenes.DT, "every": shared.steps}
    script = scene.script(start, softening(soft) + weight + zplane(), **options)
    last = {name: values[-1] for name, values in scene.run(f"{script}run {shared.steps}").items()}
    wanted = scenes.by_attach(shared, MODEL)
    assert len(wanted.rows) >= 15
    assert np.column_stack([last[f"v{axis}"] for axis in "xyz"]) == pytest.approx(wanted.v, abs=2e-3)
    assert np.column_stack([last[axis] for axis in "xyz"]) == pytest.approx(wanted.x, abs=1e-6)
    assert np.column_stack([last[f"omega{axis}"] for axis in "xy"]) == pytest.approx(wanted.omega[:, :2], abs=10.0)


def softening(value):
    """Line of a script."""
    return f"fix softening all property/global softening scalar {value}\n"


@pytest.mark.parametrize("soft", [100, 1000])
def test_softened_drops_have_the_restitution_of_the_solver(soft, scene):
    """At 30 steps a contact; near an edge, too, and bead on bead."""
    speed, thickness = np.tile((0.3, 1.0, 3.0), 4), np.repeat(THICKNESS, 3)
    step, rng = time_step(MODEL, 3.0, RADIUS, math.inf, softening=soft), np.random.default_rng(3)
    sheets, centres, pairs = {}, [], []
    for n in range(4):
        x = -0.0375 + 0.025 * n
        scene.sheet(f"sheet{n}", (x - 0.011, -0.02), (x + 0.011, 0.02), parts=2)
        sheets[f"sheet{n}"] = n + 2
        centres += [(x, 0.006 * k - 0.006, RADIUS + 1e-5 * rng.random()) for k in range(3)]
        pairs += [(x, 0.0, 0.02), (x, 2.0 * RADIUS + 1e-6, 0.02)]
    rim = f"{softening(soft)}fix rim all property/global clampedEdge peratomtype 1 1 1e-3 1 1\n"
    velocities = [(0, 0, -v) for v in speed] + [(0, v, 0) for v in (0.5, -0.5, 1, -1, 2, -2, 5, -5)]
    script = scene.script(scene.beads(centres + pairs, velocities), rim + meshes("off", **sheets), step=step, every=300)
    last = scene.run(script.replace("gran model hertz", "gran model contactlaw") + "run 300")
    edge = {"edge": "clamped", "edge_distance": np.where(thickness == THICKNESS[1], 1e-3, math.inf)}
    expected = MODEL.solve(speed, RADIUS, thickness, **edge).restitution
    assert (last["fz"][-1] == 0.0).all()
    assert np.abs(last["vz"][-1, :12] / speed - expected).max() < 2e-3
    sphere = MODEL.pair.sphere
    expected = cl.restitution_sphere_sphere(sphere, sphere, [1.0, 2.0, 4.0, 10.0], RADIUS, RADIUS)
    assert last["vy"][-1, 13::2] / [0.5, 1, 2, 5] == pytest.approx(expected, abs=2e-3)


def test_a_softened_bead_that_is_struck_has_the_cor_of_its_new_speed(scene):
    """It comes at 0.2 m/s, and at 3 m/s from its ninth step in the contact on."""
    step = time_step(MODEL, 3.0, RADIUS, math.inf, softening=100)
    start = scene.beads([(0.0, 0.0, RADIUS + 0.1 * step)], (0, 0, -0.2))
    script = scene.script(start, softening(100) + zplane(2, "off"), step=step, every=8)
    speed = scene.run(script + "run 8\nvelocity all set 0 0 -3\nrun 200")["vz"][:, 0]
    brought = math.sqrt(3.0**2 + 0.2**2 - speed[1] ** 2)  # with what the spring had stored before
    assert speed[-1] / brought == pytest.approx(MODEL.restitution(3.0, RADIUS, THICKNESS[0]), abs=2e-3)


def test_softened_beads_come_to_rest(scene):
    """Two that fall on a plate, one that is put down and one that rolls, without creeping."""
    centres = [(0.01 * n, 0.0, RADIUS + gap) for n, gap in enumerate((2e-5, 5e-5, -1e-7, 0.0))]
    start, lines = scene.beads(centres, np.diag([0, 0, 0, 0.1])[:, 3:] * (1, 0, 0)), softening(1000)
    lines += "fix down all gravity 9.81 vector 0 0 -1\n" + zplane(2, "history")
    script = scene.script(start, lines, step=4e-6, every=5000, friction=FRICTION)
    found = scene.run(script + "run 30000")
    assert np.abs(found["vz"][1]).max() > 1e-3 > 1e-9 > np.abs(found["vz"][-1]).max()
    assert found["z"][-1] == pytest.approx(found["z"][-2], abs=1e-8 * RADIUS)
    assert found["vx"][-1] == pytest.approx([0.0, 0.0, 0.0, 0.1 / 1.4], abs=1e-4)


def test_beads_on_each_other_have_the_restitution_of_two_spheres(scene):
    """In pairs of different speeds, the second bead of which is on another rank, too."""
    r, sphere = RADIUS, MODEL.pair.sphere
    centres = [(x, 0.008 * n, 0.02) for n in range(5) for x in (-r - 5e-7, r + 5e-7)]
    speed = 0.5 * np.repeat(SPEEDS, 2) * np.tile([1.0, -1.0], 5)
    start = scene.beads(centres, np.outer(speed, (1.0, 0.0, 0.0)))
    script = scene.script(start, "", step=0.5 * step_for(*SPEEDS), every=2000, processors="{}")
    script = script.replace("gran model hertz", "gran model contactlaw") + "run 2000"
    one = scene.run(script.replace("{}", ""))["vx"][-1]
    two = scene.run(script.replace("{}", "processors 2 1 1"), ranks=2)["vx"][-1]
    expected = cl.restitution_sphere_sphere(sphere, sphere, SPEEDS, r, r)
    assert one == pytest.approx(two, rel=1e-12)
    assert one[::2] == pytest.approx(-one[1::2], rel=1e-12)
    assert -one[::2] / speed[::2] == pytest.approx(expected, abs=5e-4)
    assert expected.min() < 0.98


def test_drops_near_edges_have_the_restitution_of_the_solver(scene):
    """One plate has an edge of each kind; three fixes give their distances."""
    sheets, centres, lines, v, s = {}, [], [], 5.0, 1.5e-3
    for n, kind in enumerate(KINDS):
        x = -0.0375 + 0.025 * n
        scene.sheet(kind, (x - 0.011, -0.02), (x + 0.011, 0.02))
        sheets[kind] = n + 2
        centres.append((x, 3e-3, RADIUS + GAP))
        distances = " ".join(str(s if m == n + 1 else 1000) for m in range(5))
        lines.append(f"fix p{kind} all property/global {kind}Edge peratomtype {distances}")
    start, walls = scene.beads(centres, (0, 0, -v)), "\n".join([*lines, meshes(**sheets)])
    last = scene.run(scene.script(start, walls, step=5e-8, every=600) + "run 600")
    for found, kind, h in zip(last["vz"][-1] / v, KINDS, THICKNESS, strict=False):
        near = MODEL.solve(v, RADIUS, h, edge=kind, edge_distance=s).restitution
        assert found == pytest.approx(near, abs=1e-3)
        assert abs(found - MODEL.restitution(v, RADIUS, h)) > 2e-3


def test_a_bead_that_sticks_has_mindlins_spring(scene):
    """By its velocities: 8 G* sqrt(r d) times the slip of the surface, at a half-space."""
    step, pair = 1e-7, MODEL.pair
    start = scene.beads([(0.0, 0.0, RADIUS + GAP)], (1.0, 0.0, -5.0))
    script = scene.script(start, zplane(5, "history"), friction=" ".join(["1e6"] * 25), every=1)
    found = {name: one[:, 0] for name, one in scene.run(script + "run 200").items()}
    compliance = sum(
        2 * (2 - one.poissons_ratio) * (1 + one.poissons_ratio) / one.youngs_modulus
        for one in (pair.sphere, pair.plate)
    )
    depth = np.maximum(RADIUS - found["z"], 0.0)
    speed = found["vx"] - RADIUS * found["omegay"]
    slip = np.cumsum(0.5 * step * (speed + np.roll(speed, 1)) * (depth > 0.0))
    pull = 8.0 / compliance * np.sqrt(RADIUS * depth) * slip * (found["fz"] > 0.0)
    mass = 4 / 3 * math.pi * RADIUS**3 * pair.sphere.density
    pulled = -mass * np.gradient(found["vx"], step)
    assert min(pulled.max(), -pulled.min()) > 1.0  # [N]; the slip changes its sign
    assert pulled == pytest.approx(pull, abs=0.06 * pull.max())


FRICTION = " ".join(["0.2"] * 25)


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
    return scene.beads(centres, velocities)


def moved_in_contact(path):
    """Beads that leave a rank between two dumps, and that come to it, with a force on them."""
    left, came, before = set(), set(), None
    for part in path.read_text().split("ITEM: TIMESTEP\n")[1:]:
        rows = [line.split() for line in part.splitlines()[8:]]
        now = {int(n): float(force) > 0.0 for n, force in rows}
        if before is not None:
            left |= {n for n in before.keys() - now.keys() if before[n]}
            came |= {n for n in now.keys() - before.keys() if now[n]}
        before = now
    return left, came


@pytest.mark.parametrize("soft", [1, 100])
@pytest.mark.parametrize("wall", ["primitive", "mesh"])
def test_ranks_runs_in_parts_and_a_restart_in_contact_change_no_digit(wall, soft, scene):
    own = wall == "mesh"
    start, walls = shower(scene), meshes(sheet=3) if own else zplane(tangential="history")
    walls = softening(soft) + walls
    options = {"friction": FRICTION, "skin": 4e-5, "every": 10, "step": step_for(9.0)}
    text = scene.script(start, walls, **options)
    whole = scene.run(text + "run 400")
    others = [scene.run(text + "run 60\nrun 60\nwrite_restart middle\nrun 80\nrun 200")]
    text = scene.script("read_restart middle", walls, **options)
    others.append(scene.run(text + "run 280"))
    assert (whole["fz"][12] > 0.0).sum() > 3  # step 120
    assert np.abs(whole["omegay"][-1]).max() > 100.0
    if own:
        text = scene.script(start, walls, **options, processors="processors 2 1 1")
        others.append(scene.run(f"{text}dump ranks all custom 10 rank.% id fz\nrun 400", ranks=2))
        ranks = [moved_in_contact(scene.folder / f"rank.{k}") for k in (0, 1)]
        assert len(ranks[0][0] & ranks[1][1]) >= 3  # beads changed ranks in contact
        plane = scene.run(scene.script(start, softening(soft) + zplane(), **options) + "run 400")
        for name in COLUMNS:  # no seam of the mesh is felt
            assert whole[name][-1] == pytest.approx(plane[name][-1], rel=1e-9), name
    # LIGGGHTS reads a sliding force off its spring again: the last digit of what friction moves
    sliding = () if own else ("x", "y", "vx", "vy", "omegax", "omegay")
    for other in others:
        for name in COLUMNS:
            bound = 1e-12 if name in sliding else 0.0
            ours, theirs = other[name][-1], whole[name][-1]
            assert ours == pytest.approx(theirs, rel=bound, abs=0.0), name


PSI = np.array([0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0])


@pytest.mark.parametrize(("tangential", "soft"), [("contactlaw", 1), ("contactlaw", 100), ("history", 1)])
def test_sliding_speed_is_that_of_the_integration(tangential, soft, scene):
    """On a plate that moves; all forces act at the contact point, 50 steps a contact.

    LIGGGHTS's own friction is Coulomb's for a bead that slides from first touch to last, and takes
    an arm that is shorter by half the overlap.
    """
    own = tangential == "contactlaw"
    mu, v, thickness = 0.2, 3.0, THICKNESS[1]
    psi = PSI if own else PSI[PSI >= 8.0]
    step = float(MODEL.solve(v, RADIUS, thickness).contact_time) / 50 * soft**0.4
    places = [(0.008 * n - 0.036, 0.0, RADIUS + 3.3 * v * step) for n in range(psi.size)]
    angle = np.linspace(0.0, 6.0, psi.size)
    way = np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))
    drift = np.array([1.5, -1.0, 0.7])
    scene.sheet(low=(-0.04, -0.04), high=(0.04, 0.04))
    walls = meshes(sheet=3).replace("tangential contactlaw", f"tangential {tangential}")
    walls = softening(soft) + walls + "\nfix move_sheet all move/mesh mesh sheet linear {} {} {}".format(*drift)
    start = scene.beads(places, (psi * mu * v)[:, None] * way - (0.0, 0.0, v) + drift)
    script = scene.script(start, walls, friction=FRICTION, step=step, every=70)
    last = {name: values[-1] for name, values in scene.run(script + "run 70").items()}
    velocity = np.column_stack([last[name] for name in ("vx", "vy")]) - drift[:2]
    spin = np.column_stack([last[name] for name in ("omegax", "omegay")])
    hit = MODEL.oblique(v, psi * mu * v, RADIUS, thickness, mu, method="solve")
    assert last["vz"] - drift[2] == pytest.approx(hit.restitution * v, abs=2e-3)
    error = ((velocity - RADIUS * spin[:, ::-1] * (1, -1)) * way[:, :2]).sum(axis=1)
    error -= hit.sliding_speed
    assert np.abs(error).max() < 0.012 * mu * v
    gained = velocity - (psi * mu * v)[:, None] * way[:, :2]
    arm = 1e-9 if own else 0.01 * mu * v
    assert 0.4 * RADIUS * spin == pytest.approx(gained[:, ::-1] * (1, -1), abs=arm)


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
    "blown up": ("timestep 1e-07", "timestep 1e-11", "has the simulation blown up?"),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_liggghts_refuses(wrong, scene):
    old, new, message = WRONG[wrong]
    speed = 2e5 if wrong == "blown up" else 5.0
    start = scene.beads([(0.0, 0.0, RADIUS + GAP)], (0, 0, -speed))
    text = scene.script(start, zplane()) + "run 200\n"
    assert text.count(old) == 1
    done = scene.start(text.replace(old, new))
    assert done.returncode != 0
    assert "ERROR" in done.stdout
    assert message in " ".join(done.stdout.split())


def test_the_time_step_that_is_asked_for_will_do(scene):
    start = scene.beads([(0.0, 0.0, RADIUS + GAP)], (0, 0, -5.0))
    done = scene.start(scene.script(start, zplane(), step=1e-6) + "run 200\n")
    assert done.returncode != 0
    message = "timestep: too long for an impact at 5 m/s, which needs 20 steps; take ([0-9.e-]+) s"
    advised = float(re.search(message, " ".join(done.stdout.split()))[1])
    contact = MODEL.lookup(5.0, RADIUS, math.inf).contact_time
    assert advised == pytest.approx(contact / 20, rel=0.03)
    last = scene.run(scene.script(start, zplane(), step=0.999 * advised, every=100) + "run 100\n")
    cor = MODEL.restitution(5.0, RADIUS, THICKNESS[1])
    assert last["vz"][-1, 0] / 5.0 == pytest.approx(cor, abs=5e-4)


def test_the_rain_comes_back_from_the_thick_sheet_faster(scene):
    """Every bead hits one of two plates at 3 m/s; beads that meet on the way lose more energy."""
    for path in (ROOT / "docs/examples/liggghts").iterdir():
        shutil.copy(path, scene.folder)
    done = scene.start((scene.folder / "in.rain").read_text())
    assert done.returncode == 0, done.stdout[-2000:]
    found = re.findall(r"upward speed over ([0-9.]+) mm: ([0-9.]+) m/s", done.stdout)
    for thickness, speed in found:
        cor = MODEL.restitution(3.0, 0.9e-3, 1e-3 * float(thickness))
        assert 0.75 < float(speed) / (3.0 * cor) < 1.0
    assert [thickness for thickness, _ in found] == ["0.5", "3"]
    assert float(found[0][1]) < 0.85 * float(found[1][1])
