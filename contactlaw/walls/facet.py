"""Where a sphere is with respect to a facet: overlap, normal and nearest point.

Legend: r radius, x overlap of the sphere with the facet or position of the sphere's centre, n
normal from the facet to the sphere, s height of the centre over the facet's plane.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._jit import kernel, tuple_of
from contactlaw.walls.profile import RECTANGLE, TRIANGLE, direction_at, in_half_plane, on_profile

Point = tuple[float, float, float]

FACET = np.dtype(
    # a and b: along a rectangle's edges as unit vectors, or a triangle's edges themselves [m]; for
    # what a round facet has there, see `contactlaw.walls.profile`
    [("corner", "f8", 3), ("normal", "f8", 3), ("a", "f8", 3), ("b", "f8", 3)]
    + [("length_a", "f8"), ("length_b", "f8"), ("between", "f8")]  # between: a . b
    + [(name, "i8") for name in ("kind", "plate_row", "frame", "wall", "triangle")]
    # address of the edges that are nearest to the facet's points, none of them within `clear` [m]
    + [("edges", "i8"), ("edge_count", "i8"), ("clear", "f8")],
    align=True,
)


class Touch(NamedTuple):
    """Where a sphere is with respect to a facet."""

    x: float
    s: float
    nx: float
    ny: float
    nz: float
    face: bool  # whether the nearest point is on the face; else it is on an edge


@kernel
def to_frame(frame: Any, x: Point) -> Point:
    """Point of space in a frame's own coordinates."""
    if frame.moves == 0:
        return x
    hub, shift, turn = frame.hub, frame.shift, frame.turn
    px, py, pz = x[0] - hub[0] - shift[0], x[1] - hub[1] - shift[1], x[2] - hub[2] - shift[2]
    return (
        hub[0] + turn[0] * px + turn[3] * py + turn[6] * pz,
        hub[1] + turn[1] * px + turn[4] * py + turn[7] * pz,
        hub[2] + turn[2] * px + turn[5] * py + turn[8] * pz,
    )


@kernel
def turned(frame: Any, t: Touch) -> Touch:
    """Touch with its normal turned from a frame's own coordinates into space."""
    if frame.moves == 0:
        return t
    turn = frame.turn
    return tuple_of(
        Touch,
        t,
        nx=turn[0] * t.nx + turn[1] * t.ny + turn[2] * t.nz,
        ny=turn[3] * t.nx + turn[4] * t.ny + turn[5] * t.nz,
        nz=turn[6] * t.nx + turn[7] * t.ny + turn[8] * t.nz,
    )


@kernel
def velocity(frame: Any, rate: Any, x: Point) -> Point:
    """Velocity of a frame's material at a point of space; `rate` is the velocity of its shift."""
    if frame.moves == 0:
        return 0.0, 0.0, 0.0
    hub, shift, axis, spin = frame.hub, frame.shift, frame.axis, frame.spin
    px, py, pz = x[0] - hub[0] - shift[0], x[1] - hub[1] - shift[1], x[2] - hub[2] - shift[2]
    return (
        rate[0] + spin * (axis[1] * pz - axis[2] * py),
        rate[1] + spin * (axis[2] * px - axis[0] * pz),
        rate[2] + spin * (axis[0] * py - axis[1] * px),
    )


@kernel
def _on_edge(r: float, s: float, dx: float, dy: float, dz: float) -> Touch:
    """Touch on an edge; dx, dy and dz lead from the nearest point to the sphere's centre."""
    distance = math.sqrt(dx * dx + dy * dy + dz * dz)
    return Touch(r - distance, s, dx / distance, dy / distance, dz / distance, False)


@kernel
def _on_face(facet: Any, r: float, s: float) -> Touch:
    """Touch on the face."""
    sign, n = math.copysign(1.0, s), facet.normal
    return Touch(r - abs(s), s, sign * n[0], sign * n[1], sign * n[2], True)


@kernel
def height(facet: Any, p: Point) -> float:
    """Height of a point over a flat facet's plane, in the coordinates of the facet."""
    corner, normal = facet.corner, facet.normal
    px, py, pz = p[0] - corner[0], p[1] - corner[1], p[2] - corner[2]
    return float(px * normal[0] + py * normal[1] + pz * normal[2])


@kernel
def _on_round(facet: Any, p: Point, r: float) -> Touch:
    """Touch with a facet that is a surface of revolution."""
    rho, z, e = in_half_plane(facet, p)
    q, axis = on_profile(facet, rho, z), facet.normal
    return Touch(
        r - q.distance,
        q.s,
        q.out * e[0] + q.up * axis[0],
        q.out * e[1] + q.up * axis[1],
        q.out * e[2] + q.up * axis[2],
        q.face,
    )


@kernel
def normal_at(facet: Any, p: Point) -> Point:
    """Give the normal of a facet at one of its points, in the coordinates of the facet."""
    n = facet.normal
    if facet.kind >= TRIANGLE:
        return n[0], n[1], n[2]
    rho, z, e = in_half_plane(facet, p)
    out, up = direction_at(facet, on_profile(facet, rho, z).t)
    return out * e[0] + up * n[0], out * e[1] + up * n[1], out * e[2] + up * n[2]


@kernel
def on_facet(facet: Any, p: Point, r: float) -> Touch:
    """Overlap and normal at the facet's nearest point, in the coordinates of the facet."""
    if facet.kind < TRIANGLE:
        return _on_round(facet, p, r)
    corner, a, b, normal = facet.corner, facet.a, facet.b, facet.normal
    px, py, pz = p[0] - corner[0], p[1] - corner[1], p[2] - corner[2]
    s = px * normal[0] + py * normal[1] + pz * normal[2]
    along_a = px * a[0] + py * a[1] + pz * a[2]
    along_b = px * b[0] + py * b[1] + pz * b[2]
    if facet.kind == RECTANGLE:
        at_a = min(max(along_a, 0.0), facet.length_a)
        at_b = min(max(along_b, 0.0), facet.length_b)
        if at_a == along_a and at_b == along_b:
            return _on_face(facet, r, s)
        return _on_edge(
            r, s, px - at_a * a[0] - at_b * b[0], py - at_a * a[1] - at_b * b[1], pz - at_a * a[2] - at_b * b[2]
        )
    aa, bb, ab = facet.length_a**2, facet.length_b**2, facet.between
    size = aa * bb - ab * ab
    v, w = (bb * along_a - ab * along_b) / size, (aa * along_b - ab * along_a) / size
    if v >= 0.0 and w >= 0.0 and v + w <= 1.0:
        return _on_face(facet, r, s)
    best, best_v, best_w = math.inf, 0.0, 0.0
    for edge in range(3):
        if edge == 0:
            v, w = min(max(along_a / aa, 0.0), 1.0), 0.0
        elif edge == 1:
            v, w = 0.0, min(max(along_b / bb, 0.0), 1.0)
        else:
            w = min(max((aa - ab + along_b - along_a) / (aa - 2.0 * ab + bb), 0.0), 1.0)
            v = 1.0 - w
        dx, dy, dz = (px - v * a[0] - w * b[0], py - v * a[1] - w * b[1], pz - v * a[2] - w * b[2])
        square = dx * dx + dy * dy + dz * dz
        if square < best:
            best, best_v, best_w = square, v, w
    v, w = best_v, best_w
    return _on_edge(r, s, px - v * a[0] - w * b[0], py - v * a[1] - w * b[1], pz - v * a[2] - w * b[2])


@kernel
def contains(facet: Any, p: Point, margin: float) -> bool:
    """Whether a point is on a facet, in the coordinates of the facet."""
    if facet.kind < TRIANGLE:
        return bool(on_facet(facet, p, margin).x >= 0.0)
    corner, a, b, normal = facet.corner, facet.a, facet.b, facet.normal
    px, py, pz = p[0] - corner[0], p[1] - corner[1], p[2] - corner[2]
    if not abs(px * normal[0] + py * normal[1] + pz * normal[2]) <= margin:
        return False
    if facet.kind == RECTANGLE:
        along_a = px * a[0] + py * a[1] + pz * a[2]
        along_b = px * b[0] + py * b[1] + pz * b[2]
        return bool(-margin <= along_a <= facet.length_a + margin and -margin <= along_b <= facet.length_b + margin)
    return bool(on_facet(facet, p, margin).x >= 0.0)


@kernel
def touch_in_space(frame: Any, facet: Any, x: Point, r: float) -> Touch:
    """Touch of a sphere and a facet of a frame, in space."""
    return turned(frame, on_facet(facet, to_frame(frame, x), r))


@kernel
def nearest(touch: Touch, x: Point, r: float) -> Point:
    """Point of a facet that is nearest to the sphere's centre, in space."""
    reach = r - touch.x
    return x[0] - reach * touch.nx, x[1] - reach * touch.ny, x[2] - reach * touch.nz


@kernel
def cell_of(frame: Any, k: int, coordinate: float) -> int:
    """Index of the cell of a coordinate in direction k."""
    return int(math.floor((coordinate - frame.origin[k]) * frame.per_length))
