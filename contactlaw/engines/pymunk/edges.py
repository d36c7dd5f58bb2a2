"""Edges of plates, and plates that share ends: the distance of an impact from an edge, and which plate it hits."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from contactlaw.engines.pymunk.record import FAR, KnownEdge
from contactlaw.engines.pymunk.registry import PlateShape, Vector, ends, is_static
from contactlaw.walls.edges import SMOOTH

if TYPE_CHECKING:
    import pymunk

# Ends closer than this are one end [m]: far below any bead's size, far above a drawing's rounding.
SAME_END = 1e-7
# A bead touches a plate's end if the end is farther than the plate's nearest point by at most this
# share of the bead's radius; the distances have rounding errors of 1e-13 of the radius.
AT_END = 1e-9
# No wave comes back from more than this many thicknesses within a contact.
FARTHEST = 1000.0


def near(plate: PlateShape, at: Vector) -> KnownEdge:
    """Kind of the nearest edge and its distance [m]."""
    plate.sides = plate.sides or _sides(plate)
    point = plate.shape.body.world_to_local(at)
    least, nearest = math.inf, FAR
    for first, along, length, (before, after) in plate.sides:
        s = min(max((point - first).dot(along), 0.0), length)
        off = (point - first - s * along).length
        if off < least:
            least, start, end = off, before[1] + s, after[1] + length - s
            nearest = (before[0], start) if start <= end else (after[0], end)
    return nearest


def _sides(plate: PlateShape) -> list[Any]:
    corners, found = ends(plate.shape), []
    for i in range(len(corners) if len(corners) > 2 else 1):
        last = (i + 1) % len(corners)
        along, beyond = corners[last] - corners[i], (_beyond(plate, last, i), _beyond(plate, i, last))
        found.append((corners[i], along.normalized(), along.length, beyond))
    return found


def _beyond(plate: PlateShape, came: int, corner: int) -> KnownEdge:
    """Kind of the edge where the plates end, and how far from a corner it is [m].

    The way to it comes to the corner from another one, and goes on where plates turn least.
    """
    distance, limit = 0.0, FARTHEST * plate.wall
    while distance <= limit:
        corners = _corners(plate)
        here, along = corners[corner], (corners[corner] - corners[came]).normalized()
        joined = {other.index: other for _, other in plate.joints}
        straightest, step, held = SMOOTH, None, False
        for other in (plate, *joined.values()):
            its = _corners(other)
            for i in (n for n, at in enumerate(its) if math.dist(at, here) <= SAME_END):
                held |= other is not plate
                for j in (i - 1) % len(its), (i + 1) % len(its):
                    onward = its[j] - its[i]
                    if (turn := along.dot(onward.normalized())) > straightest:
                        straightest, step = turn, (other, i, j, onward.length)
        if step is None:
            # What is joined at a fold keeps the end where it is.
            return ("supported" if held else plate.edge, distance) if plate.edge else FAR
        plate, came, corner, length = step
        distance += length
    return FAR  # the plates are closed, or end too far away


def _corners(plate: PlateShape) -> list[Any]:
    """Corners in coordinates that joined plates have in common."""
    return [place(end, plate.shape.body)[1] for end in ends(plate.shape)]


def join(plates: Iterable[PlateShape]) -> None:
    """Find the ends that plates on the same rigid body share, after plates have come or gone."""
    from scipy.spatial import KDTree

    places, owners = [], []
    for plate in plates:
        plate.joints, plate.sides = [], []
        for end in ends(plate.shape):
            rigid, at = place(end, plate.shape.body)
            places.append((rigid, *at))
            owners.append((plate, end))
    for i, j in KDTree(places).query_pairs(SAME_END) if places else ():
        (one, end), (two, its_end) = owners[i], owners[j]
        if one is not two:
            one.joints.append((end, two))
            two.joints.append((its_end, one))


def belongs_to_neighbour(radius: float, plate: PlateShape, x: float, y: float) -> bool:
    """Whether a contact of a bead at x, y belongs to another plate that shares the touched end.

    It belongs to the nearest plate, and of equally near plates to the one registered first.
    """
    shape = plate.shape
    centre = shape.body.world_to_local((x, y))
    mine = math.inf
    for end, other in plate.joints:
        away = math.dist(centre, end) - shape.radius
        if away <= radius:
            if mine == math.inf:
                mine = shape.point_query((x, y)).distance
            there = other.shape
            # Else the bead touches the side of this plate, not the end; or it may pass the neighbour.
            met = away <= mine + AT_END * radius and there.space is shape.space and not there.sensor
            if met and there.filter == shape.filter:
                if (there.point_query((x, y)).distance, other.index) < (mine, plate.index):
                    return True
    return False


def place(end: pymunk.Vec2d, body: pymunk.Body) -> tuple[int, pymunk.Vec2d]:
    """Rigid body of an end, and its coordinates there; all static bodies count as one."""
    if is_static(body):
        return -1, body.local_to_world(end)
    return body.id, end
