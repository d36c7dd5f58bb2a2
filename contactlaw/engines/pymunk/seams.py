"""Plates that share ends or corners: a bead there hits one of them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from contactlaw.engines.pymunk.registry import PlateShape, Vector, ends, may_meet

if TYPE_CHECKING:
    import pymunk

# Ends closer than this are one end [m]: far below any bead's size, far above a drawing's rounding.
SAME_END = 1e-7
# A bead touches a plate's end if the end is farther than the plate's nearest point by at most this
# share of the bead's radius; the distances have rounding errors of 1e-13 of the radius.
AT_END = 1e-9


def join(plates: Iterable[PlateShape]) -> None:
    """Find the ends that plates on the same rigid body share, after plates have come or gone."""
    from scipy.spatial import KDTree

    places, owners = [], []
    for plate in plates:
        plate.joints, plate.sides = [], []
        shape: Any = plate.shape()
        for end in ends(shape) if shape is not None and shape.body is not None else ():
            rigid, (x, y) = place(end, shape.body)
            if math.isfinite(x) and math.isfinite(y):
                places.append((rigid, x, y))
                owners.append((plate, end))
    for i, j in KDTree(places).query_pairs(SAME_END) if places else ():
        (one, end), (two, its_end) = owners[i], owners[j]
        if one is not two:
            one.joints.append((*end, two))
            two.joints.append((*its_end, one))


def belongs_to_neighbour(radius: float, plate: PlateShape, circle: Any, shape: Any, x: float, y: float) -> bool:
    """Whether a contact of a bead at x, y belongs to another plate that shares the touched end.

    It belongs to the nearest plate, and of equally near plates to the one registered first.
    """
    u, v = plate.mount.local(x, y)
    reach = radius + shape.radius
    mine = math.inf
    for end_u, end_v, other in plate.joints:
        away = math.hypot(u - end_u, v - end_v)
        if away > reach:
            continue
        if mine == math.inf:
            mine = shape.point_query((x, y)).distance
        if away - shape.radius > mine + AT_END * radius:
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
