"""Scenes that every engine runs alike: beads of two sizes over walls, by `attach` and by a loop of one's own.

An engine is a function of a `Scene` that gives an `Outcome`. To add one, write such a function.
YADE runs a scene of its own, that of the example of `docs/engines.md`.
"""

import importlib.util
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from loops import loop
from places import ROOT

import contactlaw as cl
from contactlaw.record.columns import IMPACT
from contactlaw.stepping import Clock, WallContacts
from contactlaw.stepping.step import FIRST, ROWS, RUN, SLIDING, WIDTH, Beads, begin, step
from contactlaw.walls import Cone, Cylinder, Disc, Mesh, Plate, Rotation, Sphere, Tabulated, Translation, Vibration

PAIR, FIRST_ID = cl.Pair("gamma-alumina", "glass"), 2**40 + 1  # IDs that need more than 32 bits
DT, GRAVITY = 1e-7, -9.81


class Scene(NamedTuple):
    """Walls, beads that fall on them, and contacts."""

    walls: Any
    place: Any
    velocity: Any
    radius: Any
    friction: float = 0.3
    softening: float = 1.0
    steps: int = 2500


class Outcome(NamedTuple):
    """Record by bead and time, places, velocities and spins at the end."""

    rows: Any
    x: Any
    v: Any
    omega: Any


def _beads(half, height, speed, n=24):
    rng = np.random.default_rng(11)
    place = np.stack(np.meshgrid(*(np.linspace(-half, half, 5),) * 2, indexing="ij"), -1).reshape(-1, 2)[:n]
    velocity = rng.uniform(-1.0, 1.0, (n, 3)) + [0.0, 0.0, -speed]
    return np.column_stack((place, np.full(n, height))), velocity, rng.choice([0.6e-3, 0.9e-3], n)


def _floor(thickness=1e-3, **more):
    return Plate((-0.02, -0.02, 0.0), (0.04, 0, 0), (0, 0.04, 0), thickness, **more)


def _hole():
    line = np.linspace(-0.02, 0.02, 9)
    corners = np.array([(x, y, 0.0) for x in line for y in line])
    cells = [i * 9 + j for i in range(8) for j in range(8) if not {i, j} <= {3, 4}]
    return Mesh(corners, [t for a in cells for t in ((a, a + 9, a + 10), (a, a + 10, a + 1))], 0.8e-3, edges="free")


_FALL = _beads(8e-3, 1.1e-3, 4.0)
_TABLE = Tabulated([0.0, 1e-4, 3e-4], [[0, 0, 0], [0, 0, 5e-5], [0, 0, -5e-5]])
SCENES = {
    "plates": Scene([_floor(edges="free"), Plate((9e-3, -0.02, 0), (0, 0.04, 0), (0, 0, 0.02), 2e-3)], *_FALL),
    "hole": Scene([_hole()], *_FALL),
    "drum": Scene(
        [
            Cylinder((0, -0.02, 9e-3), (0, 0.02, 9e-3), 9e-3, 1e-3, motion=Rotation((0, 1, 0), 50.0, (0, 0, 9e-3))),
            Disc((0, 7e-3, 9e-3), (0, 1, 0), 9e-3, 1e-3),
        ],
        *_beads(3e-3, 2.5e-3, 8.0),
    ),
    "bowl": Scene(
        [Sphere((0, 0, 9e-3), 9e-3, 1e-3), Cone((0, 0, 9e-3), (0, 0, 0), 12e-3, 6e-3, 1e-3)],
        *_beads(2e-3, 2.5e-3, 10.0),
    ),
    "moving": Scene(
        [
            _floor(motion=_TABLE),
            Plate((6e-3, -0.02, 1e-4), (0.01, 0, 0), (0, 0.04, 0), 1e-3, motion=Vibration((0, 0, 5e-5), 2000.0)),
            Plate((-0.019, -0.02, 1e-4), (0.013, 0, 0), (0, 0.04, 0), 1e-3, motion=Translation((0.5, 0, 0.05))),
        ],
        *_FALL,
    ),
    "shells": Scene(
        [
            Plate((-0.02, -0.02, 0), (0.02, 0, 0), (0, 0.04, 0), cl.Shell(0.5e-3, 0.05, "sphere")),
            Plate((0, -0.02, 0), (0.02, 0, 0), (0, 0.04, 0), cl.Foundation(0.5e-3, 1e11)),
        ],
        *_FALL,
    ),
    "softened": Scene([_floor()], *_FALL, softening=5.0),
}

# The beads and plates of docs/examples/yade_softsphere.py.
YADE = Scene(
    [Plate((0.01 * n - 4e-3, -0.01, 0), (8e-3, 0, 0), (0, 0.02, 0), h) for n, h in enumerate((0.5e-3, 1e-3, 3e-3))],
    np.array([(0.01 * n, 0.0, 0.99e-3) for n in range(3)]),
    np.tile((3.0, 0.0, -5.0), (3, 1)),
    np.full(3, 0.9e-3),
    friction=0.2,
    softening=100.0,
    steps=2000,
)


def model():
    return cl.ImpactModel(PAIR, law="myc")


def by_attach(scene, mine=None, **lammps):
    """By LAMMPS."""
    import lammps_box as box

    lmp = box.make(scene.place, scene.velocity, scene.radius, gravity=-GRAVITY, dt=DT, **lammps)
    walls = box.attach(lmp, mine or model(), scene.walls, friction=scene.friction, softening=scene.softening)
    lmp.command(f"run {scene.steps}")
    now, rows = box.state(lmp), np.sort(walls.collisions(), order=["bead", "time"])
    lmp.close()
    return Outcome(rows, now["x"], now["v"], now["omega"])


@loop
def _fly(scene, runs, beads, dt, steps):
    push = 0.5 * dt / beads.mass[:, None]
    turn = push / (0.4 * beads.radius[:, None] ** 2)
    for number in range(steps + 1):
        if number > 0:
            beads.v[:] += push * beads.force
            beads.omega[:] += turn * beads.torque
            beads.x[:] += dt * beads.v
        beads.force[:] = beads.torque[:] = 0.0
        clock = Clock(number * dt, dt, dt, number > 0)
        begin(scene, runs, clock, beads, number % 100 == 0)
        if step(scene, runs, clock, beads, 0) < beads.n:
            return
        beads.force[:, 2] += beads.mass * GRAVITY
        if number > 0:
            beads.v[:] += push * beads.force
            beads.omega[:] += turn * beads.torque


def by_loop(scene, mine=None):
    """By velocity Verlet and the kernel of a step, without an engine."""
    n, mine = len(scene.radius), mine or model()
    contacts = WallContacts(
        scene.walls,
        mine,
        scene.radius.max(),
        np.zeros(1000 + ROWS, IMPACT),
        friction=scene.friction,
        softening=scene.softening,
    )
    runs = np.zeros(1, RUN)
    runs["length"] = runs["time"] = runs["mass"] = runs["group"] = 1
    width = FIRST + contacts.places * (WIDTH + SLIDING * (scene.friction > 0.0))
    history, last = np.zeros((n, width)), np.zeros(n)
    mass = 4.0 / 3.0 * math.pi * mine.pair.sphere.density * scene.radius**3
    x, v, (omega, force, torque) = scene.place.copy(), scene.velocity.copy(), np.zeros((3, n, 3))
    ints = np.arange(FIRST_ID, FIRST_ID + n), np.ones(n, np.int32), np.ones(n, np.int32)
    memory = last, history.ctypes.data, 8 * width, contacts.places, 0
    beads = Beads(n, *ints, x, v, omega, scene.radius, mass, force, torque, *memory)
    _fly(contacts.scene, runs, beads, DT, scene.steps)
    assert runs["error"][0] == 0.0, runs
    rows = np.sort(contacts.scene.impacts[: contacts.scene.status["impacts"][0]], order=["bead", "time"])
    rows["bead"] -= FIRST_ID - 1
    return Outcome(rows, x, v, omega)


def by_yade(folder):
    """What the example prints in YADE: of each plate its thickness [mm], COR, COR integrated, and both tangential CORs.

    YADE has the system's Python and numpy; what else contactlaw needs is linked to in `folder`.
    """
    if not shutil.which("yade"):
        pytest.skip("YADE: yade is missing: apt-get install --no-install-recommends yade")
    version = "import sys; sys.exit(sys.version_info[:2] != " + repr(sys.version_info[:2]) + ")"
    if subprocess.run(["/usr/bin/python3", "-c", version]).returncode:
        pytest.skip("YADE: the system's Python has another version than this one, whose packages it cannot use")
    for name in "contactlaw", "numba", "llvmlite", "h5py", "platformdirs", "filelock", "tqdm":
        package = Path(importlib.util.find_spec(name).origin).parent
        for part in package, package.with_name(f"{name}.libs"):
            (folder / part.name).symlink_to(part)
    script, kept = ROOT / "docs/examples/yade_softsphere.py", str(folder / "machine-code")  # of another numpy
    environment = os.environ | {"PYTHONPATH": str(folder), "NUMBA_CACHE_DIR": kept}
    done = subprocess.run(["yade", "-x", "-n", script], env=environment, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    number = r"([\d.]+)"
    line = rf"{number} mm: COR {number}, integrated {number};\s+along {number}, integrated {number}"
    return np.array(re.findall(line, done.stdout), float)
