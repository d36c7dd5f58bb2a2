"""The surface of the walls: how much energy each part of it takes, and files for other programs."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._arrays import Array, Integers
from contactlaw.record.file import Surface

_FEW = 3.0  # impacts in a square whose side is the reach of the average
_FINEST, _COARSEST = 1.0 / 60.0, 1.0 / 12.0  # limits of this reach [largest extent of the walls]
_GRID, _CELLS = 0.125, 2e6  # cell of the grid for the average [reach], and most cells


class EnergyMap(NamedTuple):
    """What parts of the walls take: corners (k, 3, 3) [m], and columns of k numbers.

    The density is energy over area [J/m2], an average over the neighbourhood on the same wall. Of
    contacts whose points are unknown each part of their triangle has its share, by its area.
    """

    corners: Array
    impacts: Array  # number of contacts on each triangle
    energy: Array  # that these took [J]
    density: Array


def energy_map(surface: Surface, energy: Array) -> EnergyMap:
    """Sum up energies [J] by parts of a surface, which are small where triangles are large."""
    corners, hit = surface.corners, surface.triangle >= 0
    extent = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    reach = math.sqrt(_FEW * areas(corners).sum() / max(1, hit.sum()))
    reach = np.clip(reach, _FINEST * extent, _COARSEST * extent)
    where, point = surface.triangle, surface.point
    if point is None:  # parts of triangles are found for the triangles alone
        where, point = where[:0], np.empty((0, 3))
    else:
        where, point = where[hit], point[hit]
    corners, where, whole = refined(corners, where, point, 0.7 * reach)
    count, wall = len(corners), surface.wall[whole]
    share = areas(corners) / areas(surface.corners)[whole]

    def summed(values: Array) -> Array:
        if surface.point is None:
            on = np.bincount(surface.triangle[hit], values, len(surface.corners))
            return np.asarray(on[whole] * share)
        return np.bincount(where, values, count).astype(float)

    taken, density = summed(energy[hit]), np.empty(count)
    for one in np.unique(wall):
        here = wall == one
        density[here] = averaged(corners[here], taken[here], reach)
    return EnergyMap(corners, summed(np.ones(hit.sum())), taken, density)


def areas(corners: NDArray[np.floating]) -> Array:
    """Areas of triangles [m2], from their corners (n, 3, 3) [m]."""
    edge = np.diff(corners.astype(float), axis=1)
    area: Array = 0.5 * np.linalg.norm(np.cross(edge[:, 0], edge[:, 1]), axis=1)
    return area


def refined(corners: Array, triangle: Integers, point: Array, longest: float) -> tuple[Array, Integers, Integers]:
    """Halve triangles until no side is longer than `longest`; find that of each point again.

    Returns the corners, the triangle of each point, and the number of the triangle of which each
    is a part.
    """
    whole = np.arange(len(corners))
    while True:
        side = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
        long = np.flatnonzero(side.max(axis=1) > longest)
        if not long.size:
            return corners, triangle, whole
        # Roll each triangle until its longest side is from a to b; c is the corner opposite.
        turn = (side[long].argmax(axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(corners[long[:, None], turn], 1, 0)
        middle = 0.5 * (a + b)
        cut = c - middle
        across = (b - a) - ((b - a) * cut).sum(1, keepdims=True) / (cut**2).sum(1)[:, None] * cut
        place = np.full(len(corners), -1)
        place[long] = np.arange(long.size)
        moved = np.flatnonzero(place[triangle] >= 0)
        n = place[triangle[moved]]
        beyond = ((point[moved] - middle[n]) * across[n]).sum(axis=1) > 0.0
        triangle = triangle.copy()
        triangle[moved[beyond]] = len(corners) + n[beyond]
        corners = corners.copy()
        corners[long] = np.stack((a, middle, c), axis=1)
        corners = np.concatenate((corners, np.stack((middle, b, c), axis=1)))
        whole = np.concatenate((whole, whole[long]))


def averaged(corners: NDArray[np.floating], energy: Array, reach: float) -> Array:
    """Energy per area [J/m2] of triangles, averaged over their neighbourhood.

    It is energy over area, both weighted by a Gaussian whose standard deviation is `reach` [m].
    """
    middle = corners.mean(axis=1, dtype=float)
    middle -= middle.min(axis=0)
    width = middle.max(axis=0) / reach + 1.0
    dimensions = max(1, int((width > 2.0).sum()))
    grid = max(_GRID, (float(width.prod()) / _CELLS) ** (1.0 / dimensions))
    cell = (middle // (grid * reach)).astype(int)
    shape = tuple(cell.max(axis=0) + 1)
    far = math.ceil(3.0 / grid)
    window = np.arange(-far, far + 1)
    weight = np.exp(-0.5 * (window * grid) ** 2)

    def spread(values: Array) -> Array:
        found = np.zeros(shape)
        np.add.at(found, tuple(cell.T), values)
        for axis in range(3):
            found = np.apply_along_axis(np.convolve, axis, found, weight)
            found = np.take(found, np.arange(shape[axis]) + window.size // 2, axis=axis)
        return np.asarray(found[tuple(cell.T)])

    return spread(energy) / spread(areas(corners))


def vtk(found: EnergyMap, colours: Array | None = None) -> bytes:
    """Write a map in VTK's legacy text format, which ParaView and OVITO read.

    OVITO shows the colours, red, green and blue from 0 to 1, shape (k, 3).
    """
    n = len(found.corners)
    lines = ["# vtk DataFile Version 3.0", "contactlaw: energy by wall [m, J]", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {3 * n} double", *_rows(found.corners.reshape(-1, 3))]
    lines += [f"CELLS {n} {4 * n}", *_faces(n), f"CELL_TYPES {n}", *["5"] * n, f"CELL_DATA {n}"]
    for name, values in {"impacts": found.impacts, "energy_J": found.energy, "J_per_m2": found.density}.items():
        lines += [f"SCALARS {name} double 1", "LOOKUP_TABLE default", *_rows(values[:, None])]
    if colours is not None:  # last, or some readers lose the others
        lines += ["COLOR_SCALARS color 3", *_rows(colours)]
    return "\n".join([*lines, ""]).encode()


def _rows(values: NDArray[np.generic]) -> list[str]:
    return [" ".join(f"{value:.9g}" for value in row) for row in values.tolist()]


def _faces(count: int) -> list[str]:
    """Triangles that share no corner, so that each may have a colour of its own."""
    return [f"3 {n} {n + 1} {n + 2}" for n in range(0, 3 * count, 3)]
