"""Plates that share ends or corners: a bead there hits one of them."""

from __future__ import annotations

import math
from itertools import product
from typing import TYPE_CHECKING, Any

from contactlaw.engines.pymunk.registry import BeadShape, PlateShape, Vector, ends, may_meet

if TYPE_CHECKING:
    import pymunk

    from contactlaw.engines.pymunk.registry import Face

# Ends closer than this are one end [m]: far below any bead's size, far above a drawing's rounding.
SAME_END = 1e-7
# A bead touches a plate's end if the end is farther than the plate's nearest point by at most this
# share of the bead's radius; the distances have rounding errors of 1e-13 of the radius.
AT_END = 1e-9

Cell = tuple[int, int, int]


class Seams:
    """Ends of all plates, found by their position."""

    def __init__(self) -> None:
        self._ends: dict[Cell, list[tuple[Vector, PlateShape, Vector]]] = {}
        self._cells: dict[int, list[Cell]] = {}  # by index of the plate

    def join(self, plate: PlateShape, shape: Face, body: pymunk.Body) -> None:
        """Make joints of the ends that a new plate shares with others on the same rigid body."""
        cells = self._cells[plate.index] = []
        for end in ends(shape):
            rigid, (x, y) = place(end, body)
            if not (math.isfinite(x) and math.isfinite(y)):
                continue
            column, row = round(x / SAME_END), round(y / SAME_END)
            for i, j in product((-1, 0, 1), repeat=2):
                for (u, v), other, its_end in self._ends.get((rigid, column + i, row + j), ()):
                    if other is not plate and math.hypot(x - u, y - v) <= SAME_END:
                        plate.joints.append((*end, other))
                        other.joints.append((*its_end, plate))
            cells.append((rigid, column, row))
            self._ends.setdefault(cells[-1], []).append(((x, y), plate, end))

    def part(self, plate: PlateShape) -> None:
        """Forget a plate."""
        for _, _, other in plate.joints:
            other.joints[:] = [joint for joint in other.joints if joint[2] is not plate]
        for cell in self._cells.pop(plate.index):
            left = [entry for entry in self._ends.pop(cell, []) if entry[1] is not plate]
            if left:
                self._ends[cell] = left


def belongs_to_neighbour(bead: BeadShape, plate: PlateShape, circle: Any, shape: Any, x: float, y: float) -> bool:
    """Whether a contact of a bead at x, y belongs to another plate that shares the touched end.

    It belongs to the nearest plate, and of equally near plates to the one registered first.
    """
    u, v = plate.mount.local(x, y)
    reach = bead.radius + shape.radius
    mine = math.inf
    for end_u, end_v, other in plate.joints:
        away = math.hypot(u - end_u, v - end_v)
        if away > reach:
            continue
        if mine == math.inf:
            mine = shape.point_query((x, y)).distance
        if away - shape.radius > mine + AT_END * bead.radius:
            continue  # the bead touches the side of this plate, not the end
        there = other.shape()
        if there is not None and may_meet(circle, there):
            its = there.point_query((x, y)).distance
            if (its, other.index) < (mine, plate.index):
                return True
    return False


def place(end: pymunk.Vec2d, body: pymunk.Body) -> tuple[int, Vector]:
    """Rigid body of an end, and its coordinates there; all static bodies count as one."""
    import pymunk

    if body.body_type == pymunk.Body.STATIC:
        return -1, body.local_to_world(end)
    return body.id, end
