"""Walls as kernels read them: facets, and frames that move as one.

A *facet* is a rectangle or a triangle. A *frame* holds the facets of all walls of one motion, in
coordinates that do not change, and a grid by which those near a sphere are found.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw.walls.edges import fill_edges, smooth_parts
from contactlaw.walls.grid import GRID, FacetGrid
from contactlaw.walls.mesh import Mesh
from contactlaw.walls.motion import MOTION, POSE
from contactlaw.walls.plate import Plate, rim

Rows = NDArray[np.void]
Wall = Plate | Mesh

RECTANGLE, TRIANGLE = 4, 3
FACET = np.dtype(
    # a and b: along a rectangle's edges as unit vectors, or a triangle's edges themselves [m]
    [("corner", "f8", 3), ("normal", "f8", 3), ("a", "f8", 3), ("b", "f8", 3)]
    + [("length_a", "f8"), ("length_b", "f8"), ("between", "f8")]  # between: a . b
    + [(name, "i8") for name in ("kind", "plate_row", "frame", "wall", "triangle")]
    # address of the edges that are nearest to the facet's points, none of them within `clear` [m]
    + [("edges", "i8"), ("edge_count", "i8"), ("clear", "f8")],
    align=True,
)
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
        rows = _rectangle(wall) if isinstance(wall, Plate) else _triangles(wall)
        rows["plate_row"], rows["wall"] = plate_row, number
        held.append(_with_edges(wall, rows))
        groups.setdefault(wall.motion, []).append(rows)
    facets = np.concatenate([rows for parts in groups.values() for rows in parts])
    frames, first = np.zeros(len(groups), FRAME), 0
    for number, (motion, parts) in enumerate(groups.items()):
        frame, count = frames[number], sum(map(len, parts))
        facets["frame"][first : first + count] = number
        corners = corners_of(facets[first : first + count])
        if motion is not None:
            motion.fill(frame)
        grid = FacetGrid(corners, first, largest)
        grid.fill(frame)
        frame["fastest"] = 0.0 if motion is None else _fastest(motion, corners)
        held += [motion, grid]
        first += count
    return Framed(facets, frames, held)


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
    if not len(wall.rim):
        return rows[:0]
    part = smooth_parts(wall.vertices, wall.triangles, rows["normal"])
    return fill_edges(rows, corners_of(rows), wall.rim, part)


def corners_of(facets: Rows) -> NDArray[np.float64]:
    """Corners of facets, shape (n, 4, 3) [m]; of a triangle the third corner is there twice."""
    box = facets["kind"] == RECTANGLE
    a = facets["a"] * np.where(box, facets["length_a"], 1.0)[:, None]
    b = facets["b"] * np.where(box, facets["length_b"], 1.0)[:, None]
    here = facets["corner"]
    return np.stack((here, here + a, here + a * box[:, None] + b, here + b), axis=1)


def _fastest(motion: Any, corners: NDArray[np.float64]) -> float:
    """Upper bound of the speed of a frame's points [m/s]."""
    row = np.zeros(1, FRAME)[0]
    motion.fill(row)
    arm = np.linalg.norm(corners - row["hub"], axis=2).max()
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
