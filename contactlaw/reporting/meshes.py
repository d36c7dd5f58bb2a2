"""The walls of a record as meshes: for a record that does not know them itself."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw._errors import ArgumentError
from contactlaw.record.file import Record, Surface
from contactlaw.walls.mesh import Mesh

_TOO_LARGE = 300.0  # [extent of the contacts on it]: a mesh in millimetres is 1000 times as large
_APART = 1e-3  # [extent of the mesh]; contacts farther from their triangles are of walls that move


def with_meshes(record: Record, meshes: Sequence[Mesh]) -> Record:
    """Give a record the meshes of its walls that are meshes, in the order of their numbers.

    Raises
    ------
    ValueError
        If their number is another one, a triangle of the record is in none, or they are far larger
        than the places of the contacts, as meshes in millimetres are.
    """
    rows, point = record.rows, record.points
    plates = np.unique(rows["plate"][rows["triangle"] >= 0])
    if plates.size != len(meshes):
        reason = f"got {len(meshes)} for the {plates.size} walls of the record that are meshes"
        raise ArgumentError("meshes", None, reason)
    corners: list[Array] = []
    wall: list[Integers] = []
    triangle = np.full(rows.size, -1)
    for plate, mesh in zip(plates.tolist(), meshes, strict=True):
        here = np.flatnonzero(rows["plate"] == plate)
        hit = rows["triangle"][here]
        found = np.searchsorted(mesh.kept, hit).clip(max=len(mesh.kept) - 1)
        if (lacks := mesh.kept[found] != hit).any():
            lost = f"triangle {hit[lacks][0]}, which the record has hits on"
            reason = f"number {len(corners) + 1} is not the mesh of wall {plate}: it has no {lost}"
            raise ArgumentError("meshes", None, reason)
        triangle[here] = found + sum(len(one) for one in corners)
        corners.append(mesh.vertices[mesh.triangles])
        wall.append(np.full(len(mesh.triangles), plate))
    surface = Surface(np.concatenate(corners), np.concatenate(wall), triangle, point)
    extent, reach = (float(np.ptp(one.reshape(-1, 3), axis=0).max()) for one in (surface.corners, point[triangle >= 0]))
    if extent > _TOO_LARGE * reach > 0.0:
        wide = f"the mesh is {extent:.3g} m wide, the contacts on it are within {reach:.3g} m"
        remedy = "give the length of its unit, 1e-3 for a drawing in millimetres"
        raise ArgumentError("scale", None, f"{wide}: {remedy}")
    still = _still(surface, point, _APART * extent)
    return dataclasses.replace(record, surface=surface if still else surface._replace(point=None))


def _still(surface: Surface, point: Array, apart: float) -> bool:
    """Whether the contact points are on their triangles, as on walls that do not move."""
    hit = surface.triangle >= 0
    a, b, c = np.moveaxis(surface.corners[surface.triangle[hit]], 1, 0)
    normal = np.cross(b - a, c - a)
    height = ((point[hit] - a) * normal).sum(axis=1) / np.linalg.norm(normal, axis=1)
    return bool((abs(height) <= apart).all())
