"""LIGGGHTS with the exported normal model: built and run, beside the table and `softsphere`."""

import math
import os
import re
import shutil
import subprocess
from pathlib import Path

import metal
import numpy as np
import pytest
from places import ROOT

import contactlaw as cl
from contactlaw import cli
from contactlaw.equation.edge import KINDS
from contactlaw.softsphere import Contacts, time_step

TOOLS = "liggghts", "mpicxx", "mpirun.openmpi"
MISSING = [name for name in TOOLS if not shutil.which(name)]
if not Path("/usr/include/liggghts/fix_wall_gran_base.h").exists():
    MISSING.append("its headers")
needs_liggghts = pytest.mark.skipif(
    bool(MISSING),
    reason=f"LIGGGHTS: {', '.join(MISSING)} missing: `make test-engines` says what to install",
)
WARNINGS = "-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror"
WARNINGS += " -Wno-maybe-uninitialized"  # in LIGGGHTS's functions, as they are expanded in ours

MODELS = {
    "myc": (cl.Pair("gamma-alumina", "glass"), 0.9e-3),
    "fem": (cl.Pair("soda-lime-glass", "carbon-steel-1020"), 1e-3),
}
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
    """A folder in which LIGGGHTS runs with one library."""

    def __init__(self, folder, library, model, radius):
        self.folder, self.library, self.model, self.radius = folder, library, model, radius

    def step(self, *speeds):
        return min(time_step(self.model, v, self.radius, math.inf) for v in speeds)

    def beads(self, centres, velocities, name="beads.data"):
        """Write a file of beads, and return the line of a script that reads it."""
        centres, velocities = np.broadcast_arrays(centres, velocities)
        density = self.model.pair.sphere.density
        lines = ["beads", "", f"{len(centres)} atoms", "5 atom types", ""]
        lines += [f"-0.05 0.05 {axis}lo {axis}hi" for axis in "xyz"] + ["", "Atoms", ""]
        for n, (x, y, z) in enumerate(centres.tolist(), 1):
            lines.append(f"{n} 1 {2 * self.radius} {density} {x!r} {y!r} {z!r}")
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
            "start": start, "walls": walls, "step": 1e-7, "skin": 1e-3, "processors": "",
            "properties": PROPERTIES, "friction": " ".join(["0"] * 25), "every": 100_000,
            "thickness": " ".join(map(str, (1.0, *THICKNESS))), "dump": "dump.txt",
            "digits": " %.17g" * (len(COLUMNS) - 1),
        }  # fmt: skip
        assert changes.keys() <= values.keys()
        return SCRIPT.format_map(values | changes)

    def start(self, script, ranks=1):
        (self.folder / "in.script").write_text(script)
        load = f"LD_PRELOAD={self.library}"
        command = ["env", load, "liggghts"]
        if ranks > 1:
            command = [
                "mpirun.openmpi",
                "--oversubscribe",
                "-np",
                str(ranks),
                "-x",
                load,
                "liggghts",
            ]
        root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        return subprocess.run(
            [*command, "-in", "in.script", "-log", "none"],
            cwd=self.folder, env=os.environ | root, timeout=120,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
        )  # fmt: skip

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


def meshes(**kinds):
    """Plates of these atom types; LIGGGHTS needs all meshes in one wall."""
    lines = [
        f"fix {name} all mesh/surface file {name}.stl type {kind}" for name, kind in kinds.items()
    ]
    wall = "fix wall all wall/gran model contactlaw tangential contactlaw mesh"
    return "\n".join([*lines, f"{wall} n_meshes {len(kinds)} meshes {' '.join(kinds)}"])


@pytest.fixture(scope="module")
def libraries(tmp_path_factory):
    """Each law's library, built with warnings as errors."""
    made = {}
    for name, (pair, radius) in MODELS.items():
        folder, model = tmp_path_factory.mktemp(name) / "wall", cl.ImpactModel(pair, law=name)
        made[name] = built(folder, model), model, radius
    return made


def built(folder, model):
    cl.export.liggghts(folder, model)
    done = subprocess.run(
        ["sh", folder / "build.sh"], env=os.environ | {"CXXFLAGS": WARNINGS},
        capture_output=True, text=True,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    return folder / "wall_contactlaw.so"


@pytest.fixture
def scene(libraries, tmp_path):
    return Scene(tmp_path, *libraries["myc"])


def both_laws(function):
    return needs_liggghts(pytest.mark.parametrize("law", MODELS)(function))


@both_laws
def test_drops_have_the_restitution_of_the_table(law, libraries, tmp_path):
    """Plates of four thicknesses are in one scene, each a mesh with its own atom type."""
    scene = Scene(tmp_path, *libraries[law])
    r = scene.radius
    sheets, centres, rng = {}, [], np.random.default_rng(5)
    for n in range(len(THICKNESS)):
        x = -0.0375 + 0.025 * n
        scene.sheet(f"sheet{n}", (x - 0.011, -0.02), (x + 0.011, 0.02), parts=2)
        sheets[f"sheet{n}"] = n + 2
        centres += [(x + 0.003, -0.015 + 0.006 * k, r + 1e-5 * rng.random()) for k in range(5)]
    speed, thickness = np.tile(SPEEDS, 4), np.repeat(THICKNESS, 5)
    start = scene.beads(centres, [(0, 0, -v) for v in speed])
    script = scene.script(start, meshes(**sheets), step=scene.step(*SPEEDS), every=400)
    last = scene.run(script + "run 400")
    expected = scene.model.lookup(speed, r, thickness)
    assert (last["fz"][-1] == 0.0).all()
    assert np.abs(last["vz"][-1] / speed - expected.restitution).max() < 5e-4
    assert expected.restitution.min() < 0.6 < 0.84 < expected.restitution.max()


@both_laws
def test_beads_on_each_other_have_the_restitution_of_two_spheres(law, libraries, tmp_path):
    """In pairs of different speeds, the second bead of which is on another rank, too."""
    scene = Scene(tmp_path, *libraries[law])
    r, sphere = scene.radius, scene.model.pair.sphere
    centres = [(x, 0.008 * n, 0.02) for n in range(5) for x in (-r - 5e-7, r + 5e-7)]
    speed = 0.5 * np.repeat(SPEEDS, 2) * np.tile([1.0, -1.0], 5)
    start = scene.beads(centres, np.outer(speed, (1.0, 0.0, 0.0)))
    script = scene.script(start, "", step=0.5 * scene.step(*SPEEDS), every=2000, processors="{}")
    script = script.replace("gran model hertz", "gran model contactlaw") + "run 2000"
    one = scene.run(script.replace("{}", ""))["vx"][-1]
    two = scene.run(script.replace("{}", "processors 2 1 1"), ranks=2)["vx"][-1]
    expected = cl.restitution_sphere_sphere(sphere, sphere, SPEEDS, r, r, law=law)
    assert one == pytest.approx(two, rel=1e-12)
    assert one[::2] == pytest.approx(-one[1::2], rel=1e-12)
    assert -one[::2] / speed[::2] == pytest.approx(expected, abs=5e-4)
    assert expected.min() < (0.98 if law == "myc" else 1.0)


@needs_liggghts
def test_drops_near_edges_have_the_restitution_of_the_solver(scene):
    """One plate has an edge of each kind; three fixes give their distances."""
    sheets, centres, lines, v, s = {}, [], [], 5.0, 1.5e-3
    for n, kind in enumerate(KINDS):
        x = -0.0375 + 0.025 * n
        scene.sheet(kind, (x - 0.011, -0.02), (x + 0.011, 0.02))
        sheets[kind] = n + 2
        centres.append((x, 3e-3, scene.radius + GAP))
        distances = " ".join(str(s if m == n + 1 else 1000) for m in range(5))
        lines.append(f"fix p{kind} all property/global {kind}Edge peratomtype {distances}")
    start, walls = scene.beads(centres, (0, 0, -v)), "\n".join([*lines, meshes(**sheets)])
    last = scene.run(scene.script(start, walls, step=5e-8, every=600) + "run 600")
    for found, kind, h in zip(last["vz"][-1] / v, KINDS, THICKNESS, strict=False):
        near = scene.model.solve(v, scene.radius, h, edge=kind, edge_distance=s).restitution
        assert found == pytest.approx(near, abs=1e-3)
        assert abs(found - scene.model.restitution(v, scene.radius, h)) > 2e-3


@needs_liggghts
def test_a_metal_is_as_strong_as_each_impact_makes_it(tmp_path):
    """One plate for beads of three speeds."""
    r, h, speeds = 1e-3, 3e-3, np.array([0.5, 2.0, 15.0])
    scene = Scene(tmp_path, built(tmp_path / "wall", metal.MODEL), metal.MODEL, r)
    scene.sheet("sheet0", (-0.02, -0.02), (0.02, 0.02))
    centres = [(0.006 * n - 0.007, 0.003, r + 1e-6 * v) for n, v in enumerate(speeds)]
    start = scene.beads(centres, [(0, 0, -v) for v in speeds])
    step = time_step(metal.MODEL, speeds[-1], r, h, 1e-4)
    script = scene.script(start, meshes(sheet0=4), step=step, every=600)
    last = scene.run(script + "run 600")
    hits = [metal.at_strength(v, r).solve(v, r, h).restitution for v in speeds]
    assert last["vz"][-1] / speeds == pytest.approx(hits, rel=2e-3)


@needs_liggghts
def test_primitive_face_seam_edge_and_corner_are_one_plate(scene):
    r, v = scene.radius, 5.0
    scene.sheet(parts=2)
    places = {
        "face": (3e-3, 1e-3),
        "seam": (0.0, 2e-3),
        "diagonal": (5e-3, 5e-3),
        "knot": (0.0, 0.0),
    }
    places |= {"edge": (10e-3, 2e-3), "corner": (10e-3, 10e-3)}
    start = scene.beads([(*at, r + GAP) for at in places.values()], (0, 0, -v))
    on_mesh = scene.run(scene.script(start, meshes(sheet=3), every=200) + "run 200")
    on_plane = scene.run(scene.script(start, zplane(), every=200) + "run 200")
    expected = scene.model.restitution(v, r, THICKNESS[1])
    for speed, name in zip(on_mesh["vz"][-1], places, strict=True):
        assert speed / v == pytest.approx(expected, abs=5e-4), name
        assert speed == pytest.approx(on_plane["vz"][-1, 0], rel=1e-9), name
    assert np.abs(on_mesh["vx"][-1]).max() == np.abs(on_mesh["vy"][-1]).max() == 0.0


def bounce(scene, thickness, velocity, gap, step, plate):
    """Speed of a bead over a plate that is at these heights after each step, by `softsphere`."""
    contacts = Contacts(scene.model, scene.radius, thickness)
    z, v, mass = np.array([scene.radius + gap]), np.array([velocity]), contacts.mass
    for height in plate:
        v += 0.5 * step * contacts.force / mass
        z += step * v
        v += 0.5 * step * contacts.advance(scene.radius + height - z, step) / mass
    return v[0]


@both_laws
def test_only_motion_relative_to_the_plate_counts(law, libraries, tmp_path):
    scene = Scene(tmp_path, *libraries[law])
    r, drift = scene.radius, 3.0
    scene.sheet()
    walls = meshes(sheet=3)
    start = scene.beads([(1e-3, 2e-3, r + GAP)], (0, 0, -5.0))
    at_rest = scene.run(scene.script(start, walls, every=200) + "run 200")
    start = scene.beads([(1e-3, 2e-3, r + GAP)], (0, 0, -5.0 + drift))
    walls += f"\nfix drift all move/mesh mesh sheet linear 0 0 {drift}"
    moving = scene.run(scene.script(start, walls, every=200) + "run 200")
    assert moving["vz"][-1, 0] - drift == pytest.approx(at_rest["vz"][-1, 0], rel=1e-9)


@needs_liggghts
@pytest.mark.parametrize("frequency", [50.0, 5000.0])
def test_a_vibrating_plate(frequency, scene):
    """At 5 kHz the plate's speed changes by a tenth within the contact."""
    r, velocity, gap, step, steps = scene.radius, -2.0, GAP, 1e-7, 300
    omega = 2.0 * math.pi * frequency
    amplitude = 3.0 / omega
    scene.sheet()
    wiggle = f"wiggle amplitude 0 0 {amplitude!r} period {1.0 / frequency!r}"
    walls = meshes(sheet=3) + f"\nfix move_sheet all move/mesh mesh sheet {wiggle}"
    start = scene.beads([(1e-3, 2e-3, r + gap)], (0, 0, velocity))
    last = scene.run(scene.script(start, walls, every=steps) + f"run {steps}")
    speeds = 3.0 * np.cos(omega * step * np.arange(1, steps + 1))
    heights = np.cumsum(speeds) * step  # as LIGGGHTS moves the mesh
    expected = bounce(scene, THICKNESS[1], velocity, gap, step, heights)
    assert last["vz"][-1, 0] == pytest.approx(expected, abs=1e-6)
    if frequency < 1000.0:
        approach = 3.0 - velocity
        cor = scene.model.restitution(approach, r, THICKNESS[1])
        assert last["vz"][-1, 0] == pytest.approx(3.0 + cor * approach, abs=2e-3)


FRICTION = " ".join(["0.2"] * 25)


def shower(scene):
    """Beads that slide over seams of a plate, and across the border of two ranks in mid-contact."""
    scene.sheet(low=(-0.04, -0.04), high=(0.04, 0.04), parts=8)
    rng = np.random.default_rng(7)
    x, y = np.meshgrid(np.linspace(-0.036, 0.036, 11), np.linspace(-0.036, 0.036, 11))
    centres = np.column_stack([x.ravel(), y.ravel(), scene.radius + 1e-4 * rng.random(x.size)])
    velocities = rng.uniform((-8, -8, -9), (8, 8, -2), centres.shape)
    border = slice(5, None, 11)  # these touch after 4 us, then cross the border
    centres[border, 0], centres[border, 2] = -np.linspace(3e-5, 9e-5, 11), scene.radius + 2e-5
    velocities[border] = 10.0, 0.0, -5.0
    return scene.beads(centres, velocities)


@both_laws
def test_ranks_agree_in_every_digit(law, libraries, tmp_path):
    scene = Scene(tmp_path, *libraries[law])
    start = shower(scene)
    options = {"friction": FRICTION, "skin": 4e-5, "every": 10, "step": scene.step(9.0)}
    one = scene.run(scene.script(start, meshes(sheet=3), **options) + "run 600")
    plane = scene.run(scene.script(start, zplane(), **options) + "run 600")
    for name in COLUMNS:  # no seam of the mesh is felt
        assert one[name][-1] == pytest.approx(plane[name][-1], rel=1e-9), name
    options["processors"] = "processors 2 1 1"
    text = scene.script(start, meshes(sheet=3), **options)
    where = "dump ranks all custom 10 rank.% id fz\n"
    two = scene.run(text + where + "run 600", ranks=2)
    for name in COLUMNS:
        assert np.array_equal(one[name], two[name]), name
    assert np.abs(one["omegay"][-1]).max() > 100.0
    ranks = [moved_in_contact(scene.folder / f"rank.{k}") for k in (0, 1)]
    assert len(ranks[0][0] & ranks[1][1]) >= 3  # beads changed ranks in contact


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


@needs_liggghts
@pytest.mark.parametrize("wall", ["primitive", "mesh"])
@pytest.mark.parametrize("law", MODELS)
def test_a_run_in_parts_and_a_restart_in_contact_change_no_digit(law, wall, libraries, tmp_path):
    scene = Scene(tmp_path, *libraries[law])
    own = wall == "mesh"
    start, walls = shower(scene), meshes(sheet=3) if own else zplane(tangential="history")
    options = {"friction": FRICTION, "step": scene.step(9.0), "every": 20}
    whole = scene.run(scene.script(start, walls, **options) + "run 400")
    text = scene.script(start, walls, **options)
    parts = scene.run(text + "run 60\nrun 60\nwrite_restart middle\nrun 80\nrun 200")
    again = scene.run(scene.script("read_restart middle", walls, **options) + "run 280")
    assert (whole["fz"][6] > 0.0).sum() > 3  # step 120
    for other in (parts, again):
        # LIGGGHTS reads a sliding force off its spring again: the last digit of what friction moves
        sliding = () if own else ("x", "y", "vx", "vy", "omegax", "omegay")
        for name in COLUMNS:
            ours, theirs = other[name][-1], whole[name][-1]
            if name in sliding:
                assert ours == pytest.approx(theirs, rel=1e-12), name
            else:
                assert np.array_equal(ours, theirs), name


@both_laws
@pytest.mark.parametrize(("tangential", "arm"), [("contactlaw", 1e-9), ("history", 0.01)])
def test_a_sliding_bead_has_coulombs_friction(law, tangential, arm, libraries, tmp_path):
    """It slides from first touch to last: the tangential impulse is mu times the normal one."""
    scene = Scene(tmp_path, *libraries[law])
    start = scene.beads([(0.0, 0.0, scene.radius + GAP)], (20.0, 0.0, -4.0))
    walls = zplane(tangential=tangential)
    last = scene.run(scene.script(start, walls, friction=FRICTION, every=200) + "run 200")
    normal, along = last["vz"][-1, 0] + 4.0, 20.0 - last["vx"][-1, 0]
    cor = scene.model.restitution(4.0, scene.radius, THICKNESS[1])
    assert normal == pytest.approx(4.0 * (1.0 + cor), abs=2e-3)
    assert along == pytest.approx(0.2 * normal, rel=1e-9)
    # torque m r dv; LIGGGHTS's own model takes an arm shorter by half the overlap
    assert last["omegay"][-1, 0] == pytest.approx(2.5 * along / scene.radius, rel=arm)


PSI = np.array([0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0])


@needs_liggghts
@pytest.mark.parametrize("law", MODELS)
@pytest.mark.parametrize(("kind", "thickness"), [(3, 1e-3), (5, math.inf)])
def test_sliding_speed_is_that_of_the_integration(law, kind, thickness, libraries, tmp_path):
    """And all forces act at the contact point, 50 steps a contact."""
    scene = Scene(tmp_path, *libraries[law])
    r, mu, v = scene.radius, 0.2, 3.0
    step = float(scene.model.solve(v, r, thickness).contact_time) / 50
    places = [(0.008 * n - 0.036, 0.0, r + 3.3 * v * step) for n in range(PSI.size)]
    angle = np.linspace(0.0, 6.0, PSI.size)
    way = np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))
    start = scene.beads(places, (PSI * mu * v)[:, None] * way - (0.0, 0.0, v))
    script = scene.script(start, zplane(kind), friction=FRICTION, step=step, every=70)
    last = {name: values[-1] for name, values in scene.run(script + "run 70").items()}
    velocity = np.column_stack([last[name] for name in ("vx", "vy")])
    spin = np.column_stack([last[name] for name in ("omegax", "omegay")])
    point = velocity - r * spin[:, ::-1] * (1, -1)
    hit = scene.model.oblique(v, PSI * mu * v, r, thickness, mu, method="solve")
    error = (point * way[:, :2]).sum(axis=1) - hit.sliding_speed
    assert (last["vz"] > 0.0).all()
    assert np.abs(error).max() < 0.012 * mu * v
    gained = velocity - (PSI * mu * v)[:, None] * way[:, :2]
    assert 0.4 * r * spin == pytest.approx(gained[:, ::-1] * (1, -1), abs=1e-9)


@needs_liggghts
@pytest.mark.parametrize("share", [0.5, 0.97, 1.03])
def test_a_bead_that_cannot_roll_rests_on_an_incline_or_slides(share, scene):
    """`fix nve` moves a bead without turning it."""
    mu, g, steps, step = 0.2, 9.81, 50_000, 2e-7
    slope = math.atan(mu * share)
    start = scene.beads([(0.0, 0.0, scene.radius)], (0.0, 0.0, 0.0))
    script = scene.script(start, zplane(), friction=FRICTION, step=step, every=steps)
    tilt = f"fix tilt all gravity {g} vector {math.sin(slope)!r} 0 {-math.cos(slope)!r}\n"
    script = script.replace("nve/sphere", "nve") + tilt
    last = scene.run(script + f"run {steps}")
    if share > 1.0:
        pulled = g * (math.sin(slope) - mu * math.cos(slope)) * steps * step
        assert last["vx"][-1, 0] == pytest.approx(pulled, rel=0.08)
    else:
        assert abs(last["x"][-1, 0]) < 1e-5 * scene.radius
        assert abs(last["vx"][-1, 0]) < 1e-3 * g * steps * step


@needs_liggghts
def test_a_bead_that_sticks_has_mindlins_spring(scene):
    """Without slip a spring of stiffness 8 G* sqrt(r d) acts on 2/7 of the mass."""
    r, step, steps, sideways = scene.radius, 1e-7, 200, 1.0
    start, walls = scene.beads([(0.0, 0.0, r + GAP)], (sideways, 0.0, -5.0)), zplane(5, "history")
    rough = " ".join(["1e6"] * 25)
    found = scene.run(scene.script(start, walls, friction=rough, every=1) + f"run {steps}")
    pair = scene.model.pair
    compliance = [
        2 * (2 - one.poissons_ratio) * (1 + one.poissons_ratio) / one.youngs_modulus
        for one in (pair.sphere, pair.plate)
    ]
    contacts = Contacts(scene.model, r, THICKNESS[3])
    x, v, slip, u, mass = np.array([-GAP]), np.array([5.0]), 0.0, sideways, contacts.mass[0]
    pull, expected = 0.0, [sideways]
    for _ in range(steps):
        v -= 0.5 * step * contacts.force / mass
        u -= 0.5 * step * pull / (mass * 2 / 7)
        x += step * v
        slip = slip + step * u if contacts.advance(x, step)[0] > 0.0 else 0.0
        compression = max(x[0] - contacts.plate_displacement[0], 0.0)
        pull = 8.0 / sum(compliance) * math.sqrt(r * compression) * slip
        v -= 0.5 * step * contacts.force / mass
        u -= 0.5 * step * pull / (mass * 2 / 7)
        expected.append(sideways + 2 / 7 * (u - sideways))
    change = np.array(expected) - sideways
    assert change.min() < -0.25  # meanwhile the slip at the contact has changed its sign
    # LIGGGHTS lets the tangential force act at half the overlap
    assert found["vx"][:, 0] - sideways == pytest.approx(change, abs=0.01)


SOUND = "thickness all property/global plateThickness peratomtype 1.0 0.0005 0.001 0.003 1000.0"
WRONG = {
    "no thickness": ((f"fix {SOUND}", ""), "property storing value(s) for plateThickness"),
    "zero": (("0.001 0.003", "0 0.003"), "plateThickness requires values between 1e-09 and 1e+20"),
    "negative": (("0.001 0.003", "-1 0.003"), "plateThickness requires values between"),
    "no number": (("0.001 0.003", "thin 0.003"), "Expected floating point parameter"),
    "too few": ((" 1000.0", ""), "length should be equal to 5 (= number of atom types)"),
    "a scalar": ((SOUND[SOUND.index("perat") :], "scalar 0.001"), "vector style required"),
    "beads": (
        ("model hertz tangential history", "model contactlaw tangential contactlaw"),
        "Unknown normal model",
    ),
    "tangential": (
        ("contactlaw tangential contactlaw", "contactlaw tangential no_history"),
        "Unknown normal model",
    ),
    "option": (
        ("tangential contactlaw primitive", "tangential contactlaw damping on primitive"),
        "damping",
    ),
    "edge": (
        (
            "fix friction",
            "fix rim all property/global freeEdge peratomtype 1 1 -1 1 1\nfix friction",
        ),
        "freeEdge requires values between 0 and 1e+20",
    ),
    "units": (("units si", "units cgs"), "Normal model contactlaw is in SI units: take units si"),
    "step": (
        ("timestep 1e-07", "timestep 1e-6"),
        "timestep: too long for an impact at 5 m/s, which needs 20 steps; take",
    ),
    "blown up": (("timestep 1e-07", "timestep 1e-11"), "has the simulation blown up?"),
}


@needs_liggghts
def test_the_time_step_that_is_asked_for_will_do(scene):
    start = scene.beads([(0.0, 0.0, scene.radius + GAP)], (0, 0, -5.0))
    done = scene.start(scene.script(start, zplane(), step=1e-6) + "run 200\n")
    advised = float(re.search("take ([0-9.e-]+) s", done.stdout)[1])
    contact = scene.model.lookup(5.0, scene.radius, math.inf).contact_time
    assert advised == pytest.approx(contact / 20, rel=0.01)
    last = scene.run(scene.script(start, zplane(), step=0.999 * advised, every=100) + "run 100\n")
    cor = scene.model.restitution(5.0, scene.radius, THICKNESS[1])
    assert last["vz"][-1, 0] / 5.0 == pytest.approx(cor, abs=5e-4)


@needs_liggghts
@pytest.mark.parametrize("wrong", WRONG)
def test_liggghts_refuses(wrong, scene):
    (old, new), message = WRONG[wrong]
    speed = 2e5 if wrong == "blown up" else 5.0
    start = scene.beads([(0.0, 0.0, scene.radius + GAP)], (0, 0, -speed))
    text = scene.script(start, zplane()) + "run 200\n"
    assert text.count(old) == 1
    done = scene.start(text.replace(old, new))
    assert done.returncode != 0
    assert "ERROR" in done.stdout
    assert message in " ".join(done.stdout.split())


@needs_liggghts
def test_the_rain_comes_back_from_the_thick_sheet_faster(scene):
    """Every bead hits one of two plates at 3 m/s; beads that meet on the way lose more energy."""
    for path in (ROOT / "docs/examples/liggghts").iterdir():
        shutil.copy(path, scene.folder)
    done = scene.start((scene.folder / "in.rain").read_text())
    assert done.returncode == 0, done.stdout[-2000:]
    found = re.findall(r"upward speed over ([0-9.]+) mm: ([0-9.]+) m/s", done.stdout)
    for thickness, speed in found:
        cor = scene.model.restitution(3.0, 0.9e-3, 1e-3 * float(thickness))
        assert 0.75 < float(speed) / (3.0 * cor) < 1.0
    assert [thickness for thickness, _ in found] == ["0.5", "3"]
    assert float(found[0][1]) < 0.85 * float(found[1][1])


PLAIN = ["export", "liggghts", "--sphere", "gamma-alumina", "--plate", "glass"]
FILES = {
    "README.txt", "build.sh", "contactlaw.h", "contactlaw_beads.h", "normal_model_contactlaw.h",
    "tangential_model_contactlaw.h", "wall_contactlaw.cpp",
}  # fmt: skip


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize("law", MODELS)
def test_the_command_writes_the_same_files(law, tmp_path, capsys):
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law=law)
    cl.export.liggghts(tmp_path / "one", model)
    assert cli.main([*PLAIN, "--law", law, "--out", str(tmp_path / "two")]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'two'}\n"
    assert contents(tmp_path / "one") == contents(tmp_path / "two")
    cl.export.header(tmp_path / "contactlaw.h", model, "none")
    assert contents(tmp_path / "one")["contactlaw.h"] == (tmp_path / "contactlaw.h").read_bytes()


def test_files_are_replaced_and_others_stay(tmp_path):
    (tmp_path / "in.rain").write_text("mine")
    (tmp_path / "build.sh").write_text("old")
    assert cli.main([*PLAIN, "--out", str(tmp_path)]) == 0
    found = contents(tmp_path)
    assert found.keys() == FILES | {"in.rain"}
    assert found["in.rain"] == b"mine"
    assert b"old" not in found["build.sh"]
    assert len(found["README.txt"].splitlines()) <= 15
    del found["contactlaw_beads.h"]  # the same lines with longer names
    for content in found.values():
        assert max(map(len, content.decode().splitlines())) <= 100


@pytest.mark.parametrize(
    ("out", "message"),
    [
        ("nowhere/out", "--out: there is no folder nowhere"),
        ("file", "--out: file is no folder"),
        ("file/out", "--out: there is no folder file"),
    ],
)
def test_the_command_refuses_in_its_own_words(out, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("file").touch()
    assert cli.main([*PLAIN, "--out", out]) == 1
    assert message in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_failure_leaves_nothing_behind(tmp_path, monkeypatch):
    def full(path, content, write=Path.write_bytes):
        if path.name == "README.txt":
            raise OSError(28, "No space left on device")
        write(path, content)

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space"):
        cl.export.liggghts(tmp_path / "out", cl.ImpactModel(cl.Pair("gamma-alumina", "glass")))
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(TypeError, match=r"model: expected a contactlaw.ImpactModel, got 'myc'"):
        cl.export.liggghts(tmp_path / "out", "myc")
    assert list(tmp_path.iterdir()) == []
