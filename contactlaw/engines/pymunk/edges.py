"""Edges of plates, and plates that share ends: the distance of an impact from an edge, and which plate it hits."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from contactlaw._errors import ArgumentError
from contactlaw.engines.needs import knows
from contactlaw.engines.pymunk.models import ModelsByBead
from contactlaw.engines.pymunk.record import FAR, KnownEdge
from contactlaw.engines.pymunk.registry import Edges, PlateShape, Side, Vector, ends, may_meet
from contactlaw.physical.impacts import check_kind
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
    u, v = plate.mount.local(*at)
    least, nearest = math.inf, FAR
    for (u0, v0), (du, dv), length, (before, after) in plate.sides:
        s = min(max((u - u0) * du + (v - v0) * dv, 0.0), length)
        off = math.hypot(u - u0 - s * du, v - v0 - s * dv)
        if off < least:
            least, start, end = off, before[1] + s, after[1] + length - s
            nearest = (before[0], start) if start <= end else (after[0], end)
    return nearest


def edges_of(edge: Any, models: ModelsByBead, corners: int, thickness: float) -> Edges | None:
    """Kinds of the edges of a new plate, at its start and its end; None for an endless one."""
    kinds = tuple(edge) if isinstance(edge, tuple | list) else (edge, edge)
    if len(kinds) != 2 or (corners > 2 and kinds[0] != kinds[1]):
        raise ArgumentError("edge", edge, "expected one kind, or for a segment two")
    named = [kind for kind in kinds if kind is not None]
    for kind in named:
        check_kind(kind)
    for model in models.values() if named else ():
        if not knows(model, "edge_kernel"):
            raise TypeError(
                f"edge: {model!r} knows none, it has no edge_kernel(); leave edge=None, a plate "
                "without edges, or give an ImpactModel"
            )
    return kinds if named and thickness < math.inf else None  # no wave returns in a half-space


def _sides(plate: PlateShape) -> list[Side]:
    shape: Any = plate.shape()
    corners, found = ends(shape), []
    for i in range(len(corners) if len(corners) > 2 else 1):
        last = (i + 1) % len(corners)
        beyond = _beyond(plate, last, i), _beyond(plate, i, last)
        found.append(Side(corners[i], *_direction(corners[i], corners[last]), beyond))
    return found


def _beyond(plate: PlateShape, came: int, corner: int) -> KnownEdge:
    """Kind of the edge where the plates end, and how far from a corner it is [m].

    The way to it comes to the corner from another one, and goes on where plates turn least.
    """
    distance, seen, limit = 0.0, set(), FARTHEST * plate.wall
    while (plate.index, came, corner) not in seen and distance <= limit:
        seen.add((plate.index, came, corner))
        corners = _corners(plate)
        here, (du, dv) = corners[corner], _direction(corners[came], corners[corner])[0]
        joined = {other.index: other for _, _, other in plate.joints}
        straightest, step, held = SMOOTH, None, False
        for other in (plate, *joined.values()):
            its = _corners(other)
            for i in (n for n, at in enumerate(its) if math.dist(at, here) <= SAME_END):
                held |= other is not plate
                for j in (i - 1) % len(its), (i + 1) % len(its):
                    (eu, ev), length = _direction(its[i], its[j])
                    if du * eu + dv * ev > straightest:
                        straightest, step = du * eu + dv * ev, (other, i, j, length)
        if step is None:
            kind = plate.edge and plate.edge[min(corner, 1)]
            # What is joined at a fold keeps the end where it is.
            return ("supported" if held else kind, distance) if kind else ("", math.inf)
        plate, came, corner, length = step
        distance += length
    return "", math.inf  # the plates are closed, or end too far away


def _corners(plate: PlateShape) -> list[Vector]:
    """Corners in coordinates that joined plates have in common."""
    shape: Any = plate.shape()
    return [] if shape is None else [place(end, shape.body)[1] for end in ends(shape)]


def _direction(one: Vector, other: Vector) -> tuple[Vector, float]:
    """Vector of length 1 from one point to another, and their distance."""
    length = math.dist(one, other)
    return ((other[0] - one[0]) / length, (other[1] - one[1]) / length), length


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
