"""Meshes of 8-node hexahedra for half a sphere and half a plate, finest at the contact.

The plane of incidence y = 0 is a plane of symmetry: the meshes fill y >= 0. z points up; the bodies
touch at the origin, the sphere above and the plate below. A box of equal cubes lies at the contact,
and shells around it grow with their distance.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Move = Callable[[Array], Array]

# Our choices.
_SPHERE_GROWTH = 1.7  # thickness of the first shell over that of a cube of the box
_PLATE_GROWTH = 0.11  # a ring of a plate over its distance: waves run through many
# In a plate with an edge, each row beyond the box of n cubes is wider than the last by this over n.
_ROW_GROWTH = 0.9
_FAR_BOX = 1.2  # half the width of the box around the far pole [R]
_LAYER_GROWTH = 1.2  # thickness of a layer of a plate over that of the one above it
_LAYERS = 7.0  # a layer is at most this part of the plate's thickness


class Mesh(NamedTuple):
    """Nodes and elements of one body.

    Node k of an element lies at xi, eta, zeta = -1 or 1 as bits 0, 1, 2 of k are 0 or 1.
    """

    nodes: Array  # (n, 3) [m]
    elements: Indices  # (m, 8)
    surface: NDArray[np.bool_]  # (n,), whether a node lies on the surface that may touch


def sphere(radius: float, core: float, n: int) -> Mesh:
    """Half a sphere, whose box at the contact has n cubes from the axis to `core` [m].

    A half-space of shells around a box is taken into the sphere by an inversion, which is
    conformal: cubes stay nearly cubes. A second box fills the surroundings of the far pole.

    Examples
    --------
    >>> mesh = sphere(1.0, 0.2, 6)
    >>> x = mesh.nodes[mesh.surface]
    >>> bool(np.allclose(x[:, 0]**2 + x[:, 1]**2 + (x[:, 2] - 1)**2, 1))
    True
    """
    far = 4.0 * radius / _FAR_BOX
    box, shells = (_box(n), _shells(n, _SPHERE_GROWTH / n, lambda s: core * s, lambda s: far * s / _squared(s)))
    near = [_inverted(block, radius) for block in (core * box, *shells)]
    cap = _inverted(_FAR_BOX * radius * box, radius)[::-1]
    cap[..., 2] = 2.0 * radius - cap[..., 2]
    surface = [block[..., 2] == 0.0 for block in (box, *shells)]
    return _joined([*near, cap], [*surface, surface[0][::-1]])


def half_space(core: float, n: int, width: float) -> Mesh:
    """Half of a half-ball of a radius `width`, which stands for a plate without a lower face.

    Examples
    --------
    >>> mesh = half_space(0.2, 6, 10.0)
    >>> [round(float(v), 6) for v in (*mesh.nodes.min(axis=0), *mesh.nodes.max(axis=0))]
    [-10.0, 0.0, -10.0, 10.0, 10.0, 0.0]
    """
    shells = _shells(n, _PLATE_GROWTH, lambda s: core * s, lambda s: width * s / np.sqrt(_squared(s)))
    blocks = [core * _box(n), *shells]
    surface = [block[..., 2] == 0.0 for block in blocks]
    for block in blocks:
        block[..., 2] = 0.0 - block[..., 2]
    return _joined([block[:, :, ::-1] for block in blocks], [s[:, :, ::-1] for s in surface])


def plate(core: float, n: int, thickness: float, width: float) -> Mesh:
    """Half of a round plate of a radius `width`, with layers that grow downwards.

    Examples
    --------
    >>> mesh = plate(0.2, 6, 1.0, 10.0)
    >>> [round(float(v), 6) for v in (*mesh.nodes.min(axis=0), *mesh.nodes.max(axis=0))]
    [-10.0, 0.0, -1.0, 10.0, 10.0, 0.0]
    """
    depth = _depths(core, n, thickness)
    shells = _shells(n, _PLATE_GROWTH, lambda s: core * s, lambda s: width * s / np.sqrt(_squared(s)))
    faces = [block[:, :, :1] for block in (core * _box(n), *shells[:3])]  # those at z = 0
    blocks, surface = [], []
    for face in faces:
        block = np.repeat(face, depth.size, axis=2)
        block[..., 2] = 0.0 - depth
        blocks.append(block)
        surface.append(block[..., 2] == 0.0)
    return _joined(blocks, surface)


def edged_plate(core: float, n: int, thickness: float, width: float, distance: float, hole: float = math.inf) -> Mesh:
    """Half of a plate whose free edge runs across the x axis at `distance`, more than `core`.

    The edge is straight, or the rim of a circular hole of the radius `hole`; the other edges are
    at least `width` away. The grid of a straight edge has rows along x and along y. For a hole it
    is bent by the exponential function, which is conformal: cubes stay nearly cubes.

    Examples
    --------
    >>> mesh = edged_plate(0.2, 6, 1.0, 10.0, 2.0)
    >>> [round(float(v), 6) for v in (*mesh.nodes.min(axis=0), *mesh.nodes.max(axis=0))]
    [-10.0, 0.0, -1.0, 2.0, 10.0, 0.0]
    """
    centre = hole + distance
    bent = math.isfinite(hole)
    ends = [distance, width, width]
    if bent:
        ends = [centre * v for v in (math.log(centre / hole), math.log1p(width / centre), math.pi)]
    ahead, behind, side = (_steps(end, core / n, core, 1.0 + _ROW_GROWTH / n) for end in ends)
    x, depth = np.concatenate([-behind[:0:-1], ahead]), _depths(core, n, thickness)
    points = np.stack(np.meshgrid(x, side, 0.0 - depth, indexing="ij"), axis=-1)
    if bent:
        moved = -centre * np.expm1(-(points[..., 0] + 1j * points[..., 1]) / centre)
        points[..., 0], points[..., 1] = moved.real, moved.imag
    fine = behind.size - 1 - n  # the first block begins with the finest rows, as in other meshes
    blocks = [points[fine:], points[: fine + 1]]
    return _joined(blocks, [block[..., 2] == 0.0 for block in blocks])


def top(mesh: Mesh) -> Indices:
    """Faces (m, 4) of the surface that may touch; node k at xi, eta as bits 0, 1 of k say."""
    found = []
    for axis, end in itertools.product(range(3), range(2)):
        corners = [k for k in range(8) if k >> axis & 1 == end]
        face = mesh.elements[:, corners]
        found.append(face[mesh.surface[face].all(axis=1)])
    return np.concatenate(found)


def areas(mesh: Mesh) -> Array:
    """Area of the surface that belongs to each node [m2]: a quarter of each of its faces."""
    faces = top(mesh)
    a, b, c, d = np.moveaxis(mesh.nodes[faces], 1, 0)
    size = 0.5 * np.linalg.norm(np.cross(d - a, c - b), axis=1)
    found = np.zeros(len(mesh.nodes))
    np.add.at(found, faces, 0.25 * size[:, None])
    return found


def _box(n: int) -> Array:
    """Points of the box |x| <= 1, 0 <= y <= 1, 0 <= z <= 1 in cubes of a width 1/n."""
    side = np.arange(n + 1) / n
    wide = np.arange(-n, n + 1) / n
    return np.stack(np.meshgrid(wide, side, side, indexing="ij"), axis=-1)


def _squared(s: Array) -> Array:
    squares: Array = (s * s).sum(axis=-1, keepdims=True)
    return squares


def _shells(n: int, growth: float, near: Move, far: Move) -> list[Array]:
    """Points between the outer faces of the box, moved by `near`, and these moved by `far`."""
    box = _box(n)
    faces = [(0, box[-1:]), (0, box[:1]), (1, box[:, -1:]), (2, box[:, :, -1:])]
    blocks: list[Array] = []
    rings = 1
    for axis, face in faces:
        inner, outer = np.log(np.sqrt(_squared(near(face)))), np.log(np.sqrt(_squared(far(face))))
        if not blocks:  # the same number for all faces, whose edges meet
            rings = max(math.ceil(float((outer - inner).mean()) / math.log1p(growth)), 1)
        share = np.arange(rings + 1) / rings
        if face[0, 0, 0, 0] == -1.0 and axis == 0:  # this one goes outwards against x
            share = share[::-1]
        shape = [1, 1, 1, 1]
        shape[axis] = rings + 1
        share = share.reshape(shape)
        blocks.append(face / np.sqrt(_squared(face)) * np.exp(inner + share * (outer - inner)))
    return blocks


def _inverted(u: Array, radius: float) -> Array:
    """Take the half-space z >= 0 into the sphere of this radius upon the origin."""
    shifted = u + np.array([0.0, 0.0, 2.0 * radius])
    image: Array = 4.0 * radius**2 * shifted / _squared(shifted)
    image[..., 2] = 2.0 * radius - image[..., 2]
    return image


def _depths(core: float, n: int, thickness: float) -> Array:
    """Depths of the layers of a plate, from the lower face to the upper one."""
    size = core / n
    return _steps(thickness, size, 0.6 * core, _LAYER_GROWTH, max(thickness / _LAYERS, size))[::-1]


def _steps(length: float, size: float, fine: float, growth: float, largest: float = math.inf) -> Array:
    """Places from 0 to length: steps of one size up to `fine`, which then grow to the largest."""
    steps = [size] * math.ceil(fine / size)
    while sum(steps) < length:
        steps.append(min(largest, growth * steps[-1]))
    place = np.concatenate([[0.0], np.cumsum(steps)])
    start = math.ceil(fine / size)
    place[start:] = place[start] + (place[start:] - place[start]) * (
        (length - place[start]) / (place[-1] - place[start])
    )
    return place


def _joined(blocks: list[Array], surface: list[NDArray[np.bool_]]) -> Mesh:
    """Make one mesh of blocks of points (i, j, k, 3); blocks share the points where they meet."""
    elements, first = [], 0
    for block in blocks:
        shape = block.shape[:3]
        index = first + np.arange(math.prod(shape)).reshape(shape)
        corners = [
            index[a : shape[0] - 1 + a, b : shape[1] - 1 + b, c : shape[2] - 1 + c].ravel()
            for c, b, a in itertools.product(range(2), repeat=3)
        ]
        elements.append(np.stack(corners, axis=-1))
        first += index.size
    points = np.concatenate([block.reshape(-1, 3) for block in blocks])
    touching = np.concatenate([on.ravel() for on in surface])
    size = np.abs(blocks[0][1, 0, 0] - blocks[0][0, 0, 0]).max()
    one, other = cKDTree(points).query_pairs(1e-3 * size, output_type="ndarray").T
    same = coo_matrix((np.ones(one.size), (one, other)), shape=(len(points), len(points)))
    number = connected_components(same, directed=False)[1]
    kept = np.unique(number, return_index=True)[1]
    nodes = points[kept]
    nodes[abs(nodes[:, 1]) < 1e-4 * size, 1] = 0.0  # the plane of symmetry, to the last bit
    return Mesh(nodes, number[np.concatenate(elements)].astype(np.int64), touching[kept])
