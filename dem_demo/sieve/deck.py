"""The deck: a tray of sheet metal with round openings, as triangles, and as an STL file."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dem_demo.kit.scene import Floats

FORM = "deck.stl"
_PITCH = 2.0  # [opening], distance of openings: they take 20 % of the area
_SIDES = 16  # corners of the polygon that stands for an opening; a multiple of 8
_WALL = 5.0  # [opening], height of the walls


@dataclass(frozen=True, slots=True)
class Deck:
    """A rectangular tray: square cells with an opening each, a closed margin, four walls.

    Parameters
    ----------
    columns, rows : int
        Cells along x and y, those of the margin included.
    opening : float
        Diameter of an opening [m].

    Examples
    --------
    >>> deck = Deck(columns=40, rows=25, opening=5e-3)
    >>> f"{deck.length * 1e3:.0f} x {deck.width * 1e3:.0f} mm, {len(deck.triangles())} triangles"
    '400 x 250 mm, 31024 triangles'
    """

    columns: int
    rows: int
    opening: float

    @property
    def pitch(self) -> float:
        """Distance of the centres of neighbouring openings [m]."""
        return _PITCH * self.opening

    @property
    def length(self) -> float:
        """Length of the deck along x [m]."""
        return self.columns * self.pitch

    @property
    def width(self) -> float:
        """Width of the deck along y [m]."""
        return self.rows * self.pitch

    @property
    def wall(self) -> float:
        """Height of the walls [m]."""
        return _WALL * self.opening

    @functools.cache  # noqa: B019  a process has few decks
    def triangles(self) -> Floats:
        """Corners of all triangles, shape (n, 3, 3) [m]: the sheet at z = 0, and the walls."""
        column, row = np.meshgrid(np.arange(self.columns), np.arange(self.rows), indexing="ij")
        centre = np.stack((column, row, np.zeros_like(row)), axis=-1) + [0.5, 0.5, 0.0]
        margin = (column % (self.columns - 1) == 0) | (row % (self.rows - 1) == 0)
        parts = [
            (centre[where][:, None, None] + cell).reshape(-1, 3, 3) * self.pitch
            for where, cell in ((margin, _cell(0.0)), (~margin, _cell(0.5 / _PITCH)))
        ]
        return np.concatenate([*parts, *self._walls()])

    def _walls(self) -> list[Floats]:
        """Walls whose lower edges have the corners of the cells above them."""
        found = []
        for along, count, far in ((0, self.columns, self.width), (1, self.rows, self.length)):
            bottom = np.zeros((4 * count + 1, 3))
            bottom[:, along] = np.unique(np.add.outer(np.arange(count), _edge())) * self.pitch
            for across in (0.0, far):
                bottom[:, 1 - along] = across
                top = bottom + [0.0, 0.0, self.wall]
                found += [_strip(bottom, top)]
        return found


def _edge() -> Floats:
    """Where the rays of a cell meet its side, from corner to corner [pitch]."""
    angle = np.linspace(-0.25 * math.pi, 0.25 * math.pi, _SIDES // 4 + 1)
    edge = 0.5 + 0.5 * np.tan(angle)
    edge[[0, -1]] = 0.0, 1.0  # the corners that neighbouring cells share, exactly
    return edge.round(12)


def _cell(radius: float) -> Floats:
    """Triangles of a cell of side 1 around a hole; without a hole they meet in the middle."""
    angle = np.linspace(0.0, 2.0 * math.pi, _SIDES, endpoint=False)
    ray = np.column_stack((np.cos(angle), np.sin(angle), np.zeros(_SIDES)))
    outer = 0.5 * ray / np.abs(ray).max(axis=1, keepdims=True)
    inner, outer = (np.vstack((ring, ring[:1])) for ring in (radius * ray, outer))
    return _strip(inner, outer, closed=not radius)


def _strip(inner: Floats, outer: Floats, *, closed: bool = False) -> Floats:
    """Triangles between two lines of points; the inner one may be a single point."""
    first = np.stack((inner[:-1], outer[:-1], outer[1:]), axis=1)
    if closed:
        return first
    return np.concatenate((first, np.stack((inner[:-1], outer[1:], inner[1:]), axis=1)))


def write_stl(path: Path, triangles: Floats) -> None:
    """Write triangles as a binary STL file, in millimetres as CAD programs do."""
    import trimesh

    corners = 1e3 * triangles.reshape(-1, 3)
    mesh = trimesh.Trimesh(corners, np.arange(len(corners)).reshape(-1, 3), process=False)
    mesh.export(path, file_type="stl")
