"""Edges of walls, near which a plate gives way differently: where they are, and of which kind.

Each facet has a list of the edges of its wall that may be nearest to one of its points. An edge
counts for the faces that go on from it smoothly; where faces meet at an angle, a plate ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._errors import ArgumentError
from contactlaw._jit import kernel
from contactlaw.equation.edge import KINDS, Edge
from contactlaw.walls.memory import array_at
from contactlaw.walls.profile import TRIANGLE, in_half_plane, on_profile

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Rows = NDArray[np.void]
Sides = Edge | Sequence[Edge | None]  # of a plate: all four of a kind, or each of its own
Rims = Edge | Callable[[Floats], Sequence[Edge | None]]  # of a mesh, or by the edges' middles

EDGE = np.dtype(
    [("start", "f8", 3), ("along", "f8", 3), ("square", "f8")]  # along: to its end, of this square
    + [("kind", "i8"), ("facet", "i8")]  # kind: position in KINDS; facet: of which it is an edge
    + [("hole", "f8")],  # radius of the hole whose rim it is; inf for one that is straight
    align=True,
)

SMOOTH = math.cos(math.radians(20.0))  # least cosine between facets of one smooth surface
# Two vertices are one within four steps of single precision at the largest coordinate, to which
# programs round the copies of a vertex, and within this share of a triangle's shortest side, so that
# a fine mesh far from the origin keeps its shape. That side is the median of all triangles, since
# one sliver would part the copies of all vertices.
_ROUNDED, _SHARE = 4.0 * float(np.finfo(np.float32).eps), 0.1
_OUTSIDE = 0.5  # least mean cosine from which triangles lie outside of a line, all around it
_FACETS, _EDGES = 8, 4  # facets share a list of edges if they are so few, or the edges are


def edges_of(given: Any, starts: Floats, ends: Floats, facets: Any, holes: Any = math.inf) -> Rows:
    """Edges from their ends [m] and what a user gave as their kinds; those without one left out."""
    if callable(given):
        given = list(given(0.5 * (starts + ends)))
    kinds = [given] * len(starts) if given is None or isinstance(given, str) else given
    if not isinstance(kinds, Sequence) or len(kinds) != len(starts):
        reason = f"expected one kind for all or one for each of {len(starts)}"
        raise ArgumentError("edges", given, reason)
    for kind in [given, *kinds] if isinstance(given, str) else kinds:
        if kind is not None and kind not in KINDS:
            reason = f"must be one of {', '.join(KINDS)}, or None where a plate goes on"
            raise ArgumentError("edges", kind, reason)
    some = [n for n, kind in enumerate(kinds) if kind is not None]
    rows = np.zeros(len(some), EDGE)
    rows["start"], rows["along"] = starts[some], (ends - starts)[some]
    rows["square"] = (rows["along"] ** 2).sum(axis=1)
    rows["kind"], rows["facet"] = [KINDS.index(kinds[n]) for n in some], np.asarray(facets)[some]
    rows["hole"] = np.broadcast_to(holes, len(starts))[some]
    return rows


def boundary(vertices: Floats, triangles: Integers) -> tuple[Floats, Floats, Integers, Floats]:
    """Find the sides that one triangle alone has: starts and ends [m], its number, radii of holes.

    A closed line of such sides goes around a hole if the triangles lie outside of it.
    """
    _, first, count = np.unique(_sides(triangles)[0], return_index=True, return_counts=True)
    alone = np.sort(first[count == 1])
    facet, side = alone // 3, alone % 3
    corners = np.stack([triangles[facet, (side + n) % 3] for n in (0, 1)], axis=1)
    starts, ends = vertices[corners[:, 0]], vertices[corners[:, 1]]
    middles, lengths = 0.5 * (starts + ends), np.linalg.norm(ends - starts, axis=1)
    _, line = np.unique(_joined(len(vertices), corners)[corners[:, 0]], return_inverse=True)
    around = np.bincount(line, lengths)
    centre = np.stack([np.bincount(line, lengths * middles[:, n]) / around for n in range(3)], 1)
    out = _unit(middles - centre[line])
    sheet = _unit(vertices[triangles[facet]].mean(axis=1) - middles)
    outside = np.bincount(line, lengths * (out * sheet).sum(axis=1)) / around
    radii = np.where(outside > _OUTSIDE, around / (2.0 * math.pi), math.inf)
    return starts, ends, facet, radii[line]


def _unit(vectors: Floats) -> Floats:
    found: Floats = vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-300)[:, None]
    return found


def welded(vertices: Floats, triangles: Integers) -> tuple[Integers, float]:
    """Triangles with one number for all copies of a vertex; the distance within which they lie [m]."""
    from scipy.spatial import KDTree

    corners = vertices[triangles]
    close = min(_ROUNDED * abs(corners).max(), _SHARE * np.median(side_lengths(corners).min(axis=1)))
    places, first, place = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    pairs = KDTree(places).query_pairs(close, output_type="ndarray")
    return first[_joined(len(places), pairs)[place.ravel()]][triangles], close


def side_lengths(corners: Floats) -> Floats:
    """Lengths of triangles' sides, each from the corner before to that of its number."""
    lengths: Floats = np.linalg.norm(corners - np.roll(corners, 1, axis=-2), axis=-1)
    return lengths


def _sides(triangles: Integers) -> tuple[Integers, Integers]:
    """Numbers of the three sides of each triangle; pairs of triangles that share a side, shape (n, 2)."""
    ends = np.sort(np.stack((triangles, np.roll(triangles, -1, axis=1)), axis=2), axis=2)
    key = (ends[..., 0] * (triangles.max() + 1) + ends[..., 1]).ravel()
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(np.diff(key[order]) == 0)
    return key, np.stack((order[same], order[same + 1]), axis=1) // 3


def smooth_parts(triangles: Integers, normals: Floats) -> Integers:
    """Give the triangles that form one smooth surface the same number."""
    _, pairs = _sides(triangles)
    smooth = abs((normals[pairs[:, 0]] * normals[pairs[:, 1]]).sum(axis=1)) > SMOOTH
    return _joined(len(triangles), pairs[smooth])


def members(part: Integers) -> list[Integers]:
    """Places of the things that have the same number, for each number."""
    order = np.argsort(part, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(part[order])) + 1)


def _joined(count: int, pairs: Integers) -> Integers:
    """Give things that pairs join, directly or through others, the same number."""
    (one, other), part = pairs.T, np.arange(count)
    while (part[one] != part[other]).any():
        least = np.minimum(part[one], part[other])
        for end in (part[one], part[other]):  # a number stands for all triangles that have it
            np.minimum.at(part, end, least)
        while (part != part[part]).any():
            part = part[part]
    return part


def fill_edges(facets: Rows, corners: Floats, edges: Rows, part: Integers) -> Rows:
    """Write the lists of edges into facets of one wall; return the rows that they point to.

    `corners` has shape (n, m, 3), and `part` a number for each facet, equal for facets of one
    smooth surface.
    """
    lists = list(_lists(corners, edges, part))
    rows = np.concatenate([edges[:0], *(edges[near] for _, near, _ in lists)])
    at = rows.ctypes.data
    for some, near, clear in lists:
        facets["clear"][some] = clear
        facets["edges"][some], facets["edge_count"][some] = at, len(near)
        at += len(near) * EDGE.itemsize
    return rows


def _lists(corners: Floats, edges: Rows, part: Integers) -> Iterator[tuple[Integers, Integers, float]]:
    """Divide facets into groups; find edges nearest to a point of each, and the least distance."""
    mine, low, high = part[edges["facet"]], corners.min(axis=1), corners.max(axis=1)
    todo = [(some, np.flatnonzero(mine == part[some[0]])) for some in members(part) if len(edges)]
    while todo:
        some, near = todo.pop()
        first, last = low[some].min(axis=0), high[some].max(axis=0)
        d = _distances(edges[near], 0.5 * (first + last))
        # Points of the box are within half of its diagonal of its centre.
        least, size = d.min(initial=math.inf), np.linalg.norm(last - first)
        near = near[d <= least + size]
        if len(some) <= _FACETS or len(near) <= _EDGES:
            if len(near):
                yield some, near, least - 0.5 * size
            continue
        along = low[some, np.argmax(last - first)]
        halves = np.argpartition(along, len(some) // 2)
        todo += [(some[half], near) for half in np.split(halves, [len(some) // 2])]


def _distances(edges: Rows, point: Floats) -> Floats:
    from_start = point - edges["start"]
    share = (from_start * edges["along"]).sum(axis=1) / edges["square"]
    found: Floats = np.linalg.norm(from_start - np.clip(share, 0.0, 1.0)[:, None] * edges["along"], axis=1)
    return found


@kernel
def nearest_edge(facet: Any, p: tuple[float, float, float], reach: float) -> tuple[float, int, float]:
    """Distance of a facet's point from the nearest edge [m], its kind and the radius of its hole.

    Facets all of which are beyond the reach have the distance inf. The point is in the coordinates
    of the facet.
    """
    best, kind, hole = math.inf, 0, math.inf
    if facet.edge_count > 0 and facet.clear < reach:
        edges = array_at(facet.edges, facet.edge_count, EDGE)
        if facet.kind < TRIANGLE:  # its edges are circles, at a length along the profile each
            rho, z, _ = in_half_plane(facet, p)
            p = on_profile(facet, rho, z).t, 0.0, 0.0
        for n in range(len(edges)):
            edge = edges[n]
            start, along = edge.start, edge.along
            x, y, z = p[0] - start[0], p[1] - start[1], p[2] - start[2]
            share = (x * along[0] + y * along[1] + z * along[2]) / edge.square
            share = min(max(share, 0.0), 1.0)
            x, y, z = x - share * along[0], y - share * along[1], z - share * along[2]
            square = x * x + y * y + z * z
            if square < best:
                best, kind, hole = square, edge.kind, edge.hole
    return math.sqrt(best), kind, hole
