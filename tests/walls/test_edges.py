"""Rims of meshes whose vertices, as files round them, differ in the last bits."""

import warnings

import numpy as np
import pytest
from scipy.spatial.transform import Rotation as Turn

from contactlaw.walls import Mesh
from contactlaw.walls.edges import smooth_parts


def sheet(rows, columns, size=1.0):
    """Corners of a flat sheet's triangles, shape (n, 3, 3), two for each cell."""
    i, j = (one.ravel() for one in np.mgrid[:rows, :columns])
    cell = np.stack([(i + a, j + b, 0 * i) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]).transpose(2, 0, 1)
    return size / rows * cell[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3)


def wobbling(corners, rng):
    """Single precision, each coordinate of each corner up to a step off."""
    near = corners.astype(np.float32)
    return np.nextafter(near, near + rng.integers(-1, 2, near.shape)).astype(float)


def mesh(corners, **options):
    with warnings.catch_warnings(action="ignore"):  # triangles are left out
        return Mesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3), 1e-3, **options)


def parts(wall):
    a, b, c = (wall.vertices[wall.triangles[:, n]] for n in range(3))
    normal = np.cross(b - a, c - a)
    return len(set(smooth_parts(wall.triangles, normal / np.linalg.norm(normal, axis=1)[:, None])))


@pytest.mark.parametrize("seed", range(40))
def test_vertices_that_differ_in_the_last_bit_are_one(seed):
    """Twins of a third of the triangles, which differ so too, hide no rim."""
    rng = np.random.default_rng(seed)
    rows, columns = rng.integers(5, 40, 2)
    corners = sheet(rows, columns, 10.0 ** rng.uniform(-3, 1))
    size = np.ptp(corners)
    corners = Turn.random(rng=rng).apply(corners.reshape(-1, 3)) + size * rng.choice([0, 1, 10]) * rng.uniform(-1, 1, 3)
    corners = corners.reshape(-1, 3, 3)
    twins = corners[rng.random(len(corners)) < 1 / 3][:, [1, 0, 2]]
    found = mesh(wobbling(np.concatenate((corners, twins)), rng), edges="free")
    assert len(found.triangles) == 2 * rows * columns and found.dropped == len(twins)
    assert len(found.rim) == 2 * (rows + columns)
    assert found.rim["square"].max() < 1.01 * (size / max(rows, columns)) ** 2
    assert parts(found) == 1


@pytest.mark.parametrize("far", [0.0, 100.0, 1e5])
def test_a_fine_mesh_far_from_the_origin_keeps_its_vertices(far):
    """In double precision, where single precision could not tell its cells apart."""
    found = mesh(sheet(20, 20, 1e-3) + far, edges="free")
    assert (len(found.triangles), len(found.rim)) == (800, 80)


def with_slivers(corners, rng):
    """Move a corner of every fifth cell's diagonal, or put one on it or on the first side."""
    found = []
    for n, (lower, upper) in enumerate(zip(corners[::2], corners[1::2], strict=True)):
        if n % 5 == 0:
            a, b, c = lower
            found += [[a, m := a + rng.uniform(0.2, 0.8) * (c - a), c], lower, [m, c, upper[2]], [a, m, upper[2]]]
        elif n % 5 == 1:
            a, b, c = lower
            found += [[a, m := a + rng.uniform(0.2, 0.8) * (b - a), b], [a, m, c], [m, b, c], upper]
        else:
            found += [lower, upper]
    return np.array(found)


@pytest.mark.parametrize("wobble", [True, False])
@pytest.mark.parametrize("seed", range(5))
def test_slivers_part_no_sheet(seed, wobble):
    rng = np.random.default_rng(seed)
    corners = with_slivers(sheet(11, 8), rng)
    turned = Turn.random(rng=rng).apply(corners.reshape(-1, 3)).reshape(-1, 3, 3)
    for some in (corners, turned):
        found = mesh(wobbling(some, rng) if wobble else some, edges="free")
        assert np.sqrt(found.rim["square"]).sum() == pytest.approx(38 / 11, rel=1e-5)
        assert parts(found) == 1
        assert found.area.sum() == pytest.approx(8 / 11, rel=1e-5)
