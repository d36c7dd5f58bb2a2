"""Elastic beads on rims, holes and corners of meshes in LAMMPS keep their energy."""

import itertools
import math

import lammps_box as box
import numpy as np
import pytest
from scipy.spatial import ConvexHull

import contactlaw as cl
from contactlaw.walls import Mesh

trimesh = pytest.importorskip("trimesh", reason="trimesh is missing: pip install contactlaw[lammps]")

R = box.R
FLIGHT = 3e-5  # distance of a bead from the walls at the start [m]


def hull(points, out):
    """Make the convex hull of points, then move its corners outwards by shares."""
    return Mesh(points * (1.0 + out)[:, None], ConvexHull(points).simplices.astype(np.int64), math.inf)


def random_points(count):
    points = np.random.default_rng(1).normal(size=(count, 3))
    return points * 3.0 * R / np.linalg.norm(points, axis=1)[:, None]


SCENES = {
    "cylinder of 360": Mesh.cylinder((0, 0, 0), (0, 0, 0.02), 0.02, math.inf, facets=360),
    "spike": Mesh.cone((0, 0, 0), (0, 0, 0.02), 0.006, 0.0, math.inf, facets=24),
    "hole of 4, 0.6 R": box.hole(4, 0.6 * R),
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
    return start[good], -(random.uniform(1.0, 8.0, count)[:, None] * direction)[good], size[good]


@pytest.mark.parametrize("name", SCENES)
def test_beads_on_rims_holes_and_corners_keep_their_energy(name):
    """The last sample without contact counts: a bead between two walls may touch one at the end."""
    places, velocities, radii = (part[:60] for part in shots(np.random.default_rng(1), SCENES[name], 75))
    lmp, _ = box.scene(cl.ImpactModel(box.PAIR, law="hertz"), [SCENES[name]], places, velocities, radius=radii)
    square = np.full(60, math.nan)
    for _ in range(8):
        lmp.command("run 250")
        now = box.state(lmp)
        free = ~now["d2_contactlaw"][:, box.PLATE :].any(axis=1)
        square[free] = (now["v"] ** 2).sum(axis=1)[free]
    lmp.close()
    assert np.abs(square / (velocities**2).sum(axis=1) - 1.0).max() <= 1e-6
