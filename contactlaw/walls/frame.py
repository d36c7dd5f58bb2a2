"""Walls as kernels read them: facets, and frames that move as one.

A *facet* is a rectangle, a triangle or a round wall. A *frame* holds the facets of all walls of one
motion, in coordinates that do not change, and a grid by which those near a sphere are found.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw.walls.edges import fill_edges, smooth_parts
from contactlaw.walls.facet import FACET
from contactlaw.walls.grid import GRID, FacetGrid
from contactlaw.walls.mesh import Mesh
from contactlaw.walls.motion import MOTION, POSE
from contactlaw.walls.plate import Plate, rim
from contactlaw.walls.profile import ARC, RECTANGLE, TRIANGLE
from contactlaw.walls.round import Profile, Round, places

Rows = NDArray[np.void]
Wall = Plate | Mesh | Round

_CIRCLES = 65  # of a round wall, from which its box is found
FRAME = np.dtype(
    [*MOTION, *POSE, *GRID, ("fastest", "f8")],  # fastest: bound of the speed of all points [m/s]
    align=True,
)


class Framed(NamedTuple):
    """Walls as rows for the kernels, and the objects whose memory the frames point to."""

    facets: Rows
    frames: Rows
    held: list[Any]


def framed(walls: Sequence[Wall], plate_rows: Sequence[Any], largest: float) -> Framed:
    """Facets and frames of walls.

    `plate_rows` has for each wall the number of its plate row, or one number for each of its
    triangles; `largest` is the radius of the largest sphere [m], 0 if that is not known yet.
    """
    groups: dict[Any, list[Rows]] = {}
    held: list[Any] = []
    for number, (wall, plate_row) in enumerate(zip(walls, plate_rows, strict=True)):
        rows = _rows(wall)
        rows["plate_row"], rows["wall"] = plate_row, number
        held.append(_with_edges(wall, rows))
        groups.setdefault(wall.motion, []).append(rows)
    facets = np.concatenate([rows for parts in groups.values() for rows in parts])
    frames, first = np.zeros(len(groups), FRAME), 0
    for number, (motion, parts) in enumerate(groups.items()):
        frame, count = frames[number], sum(map(len, parts))
        facets["frame"][first : first + count] = number
        own = facets[first : first + count]
        boxes = boxes_of(own)
        if motion is not None:
            motion.fill(frame)
        grid = FacetGrid(own, boxes, first, largest)
        grid.fill(frame)
        frame["fastest"] = 0.0 if motion is None else _fastest(motion, boxes)
        held += [motion, grid]
        first += count
    return Framed(facets, frames, held)


def _rows(wall: Wall) -> Rows:
    if isinstance(wall, Plate):
        return _rectangle(wall)
    return _triangles(wall) if isinstance(wall, Mesh) else _round(wall.profile())


def _round(profile: Profile) -> Rows:
    row = np.zeros(1, FACET)
    row["kind"], row["triangle"] = profile.kind, -1
    row["corner"], row["normal"] = profile.origin, profile.axis
    row["b"], row["length_a"] = profile.shape, profile.length
    across = np.cross(profile.axis, np.eye(3)[np.argmin(abs(profile.axis))])
    row["a"] = across / np.linalg.norm(across)
    return row


def _rectangle(plate: Plate) -> Rows:
    row = np.zeros(1, FACET)
    a, b = np.asarray(plate.edge_a, dtype=float), np.asarray(plate.edge_b, dtype=float)
    row["kind"], row["triangle"] = RECTANGLE, -1
    row["corner"] = plate.corner
    row["length_a"], row["length_b"] = np.linalg.norm(a), np.linalg.norm(b)
    row["a"], row["b"] = a / row["length_a"], b / row["length_b"]
    row["normal"] = np.cross(row["a"], row["b"])
    return row


def _triangles(mesh: Mesh) -> Rows:
    rows = np.zeros(len(mesh.triangles), FACET)
    first, second, third = (mesh.vertices[mesh.triangles[:, n]] for n in range(3))
    rows["kind"], rows["triangle"] = TRIANGLE, mesh.kept
    rows["corner"], rows["a"], rows["b"] = first, second - first, third - first
    rows["length_a"] = np.linalg.norm(rows["a"], axis=1)
    rows["length_b"] = np.linalg.norm(rows["b"], axis=1)
    rows["between"] = (rows["a"] * rows["b"]).sum(axis=1)
    normal = np.cross(rows["a"], rows["b"])
    rows["normal"] = normal / np.linalg.norm(normal, axis=1)[:, None]
    return rows


def _with_edges(wall: Wall, rows: Rows) -> Rows:
    """Write the edges of a wall into its facets; return the rows that they point to."""
    if isinstance(wall, Plate):
        return fill_edges(rows, corners_of(rows), rim(wall), np.zeros(1, int))
    if isinstance(wall, Round):
        found = wall.rim()
        rows["edges"], rows["edge_count"] = found.ctypes.data, len(found)
        return found
    if not len(wall.rim):
        return rows[:0]
    part = smooth_parts(wall.triangles, rows["normal"])
    return fill_edges(rows, corners_of(rows), wall.rim, part)


def corners_of(facets: Rows) -> NDArray[np.float64]:
    """Corners of facets, shape (n, 4, 3) [m]; of a triangle the third corner is there twice."""
    box = facets["kind"] == RECTANGLE
    a = facets["a"] * np.where(box, facets["length_a"], 1.0)[:, None]
    b = facets["b"] * np.where(box, facets["length_b"], 1.0)[:, None]
    here = facets["corner"]
    return np.stack((here, here + a, here + a * box[:, None] + b, here + b), axis=1)


def profile_of(row: Any) -> Profile:
    """Profile of a round facet."""
    return Profile(row["kind"], row["corner"], row["normal"], row["b"], row["length_a"])


def boxes_of(facets: Rows) -> NDArray[np.float64]:
    """Lowest and highest coordinates of facets, shape (n, 2, 3) [m]."""
    corners = corners_of(facets)
    boxes = np.stack((corners.min(axis=1), corners.max(axis=1)), axis=1)
    for n in np.flatnonzero(facets["kind"] < TRIANGLE):
        profile = profile_of(facets[n])
        rho, height = places(profile, _CIRCLES)
        # A circle of radius rho reaches so far across its axis; between two of a sphere it bulges.
        bulge = profile.length**2 / (2.0 * profile.shape[0] * (_CIRCLES - 1) ** 2) if profile.kind == ARC else 0.0
        middle = profile.origin + np.outer(height, profile.axis)
        reach = np.outer(rho, np.sqrt(np.maximum(1.0 - profile.axis**2, 0.0))) + bulge
        boxes[n] = (middle - reach).min(axis=0), (middle + reach).max(axis=0)
    return boxes


def _fastest(motion: Any, boxes: NDArray[np.float64]) -> float:
    """Upper bound of the speed of a frame's points [m/s]."""
    row = np.zeros(1, FRAME)[0]
    motion.fill(row)
    arm = np.linalg.norm(abs(boxes - row["hub"]).max(axis=(0, 1)))
    table = 0.0
    if row["count"]:
        steps = np.diff(motion.displacements, axis=0) / np.diff(motion.times)[:, None]
        table = float(np.linalg.norm(steps, axis=1).max())
    return float(
        np.linalg.norm(row["velocity"])
        + abs(row["spin"]) * arm
        + row["frequency"] * np.linalg.norm(row["amplitude"])
        + table
    )
