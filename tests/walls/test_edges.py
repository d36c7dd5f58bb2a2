"""Rims of meshes whose vertices, as files round them, differ in the last bits."""

import warnings

import numpy as np
import pytest
from scipy.spatial.transform import Rotation as Turn

from contactlaw.walls import Mesh
from contactlaw.walls.edges import smooth_parts


def sheet(rows, columns, size):
    """Corners of a flat sheet's triangles, shape (n, 3, 3), two for each cell."""
    i, j = (one.ravel() for one in np.mgrid[:rows, :columns])
    cell = np.stack([(i + a, j + b, 0 * i) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]).transpose(2, 0, 1)
    return size / rows * cell[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3)


def with_slivers(corners, rng):
    """Move a corner of every fifth cell's diagonal, or put one on it or on the first side."""
    triangles = []
    for n, (lower, upper) in enumerate(zip(corners[::2], corners[1::2], strict=True)):
        (a, b, c), share = lower, rng.uniform(0.2, 0.8)
        if n % 5 == 0:
            triangles += [[a, m := a + share * (c - a), c], lower, [m, c, upper[2]], [a, m, upper[2]]]
        elif n % 5 == 1:
            triangles += [[a, m := a + share * (b - a), b], [a, m, c], [m, b, c], upper]
        else:
            triangles += [lower, upper]
    return np.array(triangles)


def mesh(corners):
    with warnings.catch_warnings(action="ignore"):  # triangles are left out
        return Mesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3), 1e-3, edges="free")


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("kind", ["twins", "slivers", "slivers in doubles"])
def test_vertices_that_differ_in_the_last_bit_and_slivers_part_no_sheet(kind, seed):
    """Nor do twins of a third of the triangles, which differ so too."""
    rng = np.random.default_rng(seed)
    rows, columns = rng.integers(5, 25, 2)
    size = 10.0 ** rng.uniform(-3, 1)
    corners, away = sheet(rows, columns, size), 0.0
    if kind == "twins":
        away = size * rng.choice([0, 1, 10]) * rng.uniform(-1, 1, 3)
        corners = np.concatenate((corners, corners[rng.random(len(corners)) < 1 / 3][:, [1, 0, 2]]))
    else:
        corners = with_slivers(corners, rng)
    corners = Turn.random(rng=rng).apply(corners.reshape(-1, 3)) + away
    if kind != "slivers in doubles":  # each coordinate in single precision, up to a step off
        near = corners.astype(np.float32)
        corners = np.nextafter(near, near + rng.integers(-1, 2, near.shape)).astype(float)
    wall, width = mesh(corners.reshape(-1, 3, 3)), size * columns / rows
    assert np.sqrt(wall.rim["square"]).sum() == pytest.approx(2 * (size + width), rel=1e-5)
    assert wall.area.sum() == pytest.approx(size * width, rel=1e-5)
    a, b, c = wall.vertices[wall.triangles].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    # Beads show whether facets are one surface where they cross each seam; this kernel shows it of all.
    assert not smooth_parts(wall.triangles, normal / np.linalg.norm(normal, axis=1)[:, None]).any()


@pytest.mark.parametrize("far", [0.0, 100.0, 1e5])
def test_a_fine_mesh_far_from_the_origin_keeps_its_vertices(far):
    """In double precision, where single precision could not tell its cells apart."""
    wall = mesh(sheet(20, 20, 1e-3) + far)
    assert (len(wall.triangles), len(wall.rim)) == (800, 80)
