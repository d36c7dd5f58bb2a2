"""Contacts of a bead that overlaps several facets: one contact for each surface that they form.

The force on an elastic bead must have a potential, whatever facets come within its reach, meet and
leave it again. Let a ball around the bead's centre grow to the size of the bead: it cuts the walls
in patches, which appear one after the other and merge. A patch i first appears at the overlap x_i,
and merges with an older patch at the *pass*, whose overlap is x_pass,i. It counts with the energy
of a contact of overlap x_i, less that of overlap x_pass,i. The potential is the sum over the
patches,

    E = sum E(x_i) - E(x_pass,i),

continuous in the bead's position, because patches begin, end and replace each other where x_i is 0
or x_pass,i (in topology: persistent homology of order 0, and its stability). On a plane, an edge, a
corner and all that bends away from the bead, one patch is left, however it is tessellated. In a
groove there are two, which share nothing if the bottom of the groove is out of reach.

The pass lies where the tangent planes of the ball at the two nearest points meet. Its distance is
reduced so far that there is no pass between facets that lean towards each other by less than 20
degrees: a tessellated cylinder is one surface from the inside, too, and the contact is with its
deepest facet.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlaw._jit import kernel, tuple_of
from contactlaw.walls.edges import SMOOTH
from contactlaw.walls.facet import Point, Touch, cell_of, contains, height, normal_at, on_facet, to_frame, turned
from contactlaw.walls.memory import array_at
from contactlaw.walls.profile import TRIANGLE

_SEAM = 1e-4  # [r] distance from a facet within which a point counts as on it
_TIE = 1e-10  # [r] difference of overlaps that is rounding
# Factor on the distance of a pass from the bead's centre, so that there is no pass between faces
# that lean towards each other by 20 degrees.
_PASS_FACTOR = math.cos(math.radians(10.0))
_NUDGE = 1e-6  # [r] step of the finite differences in `pass_gradient`
# A bead's list holds so many facets, and one more while the one to drop is sought. Facets of a bead
# that overlaps more are so small that a deeper one beside the dropped one takes its place.
_MOST = 64
ROOM = _MOST + 1

# A facet that a bead overlaps. `representative` is the list position of the facet with which the
# bead is in contact on this surface. If that is the facet itself, `shared` is the overlap of its
# pass, 0 if it has none, and the pass lies between list positions `one` and `other`. The search
# uses the rest.
OVERLAP = np.dtype(
    [(name, "i8") for name in ("facet", "face", "representative", "one", "other", "done", "near", "far")]
    + [(name, "f8") for name in ("x", "s", "nx", "ny", "nz", "shared", "level")],
    align=True,
)


@kernel
def touch_of(row: Any) -> Touch:
    """Touch of a row of the list."""
    return tuple_of(Touch, row, face=row.face != 0)


@kernel
def _has_deeper(found: Any, count: int, one: Any) -> bool:
    """Whether a deeper facet of the list lies in nearly the same direction."""
    for n in range(count):
        row = found[n]
        along = row.nx * one.nx + row.ny * one.ny + row.nz * one.nz
        if row.x > one.x and along > SMOOTH:
            return True
    return False


@kernel
def _facet_to_drop(found: Any, count: int) -> int:
    """Find the facet to drop when the list is full.

    It is the shallowest one that lies beside a deeper one in nearly the same direction, else the
    shallowest of all. So the many facets of a floor leave room for the wall that the bead just
    begins to touch.
    """
    spare = least = -1
    for n in range(count):
        if least < 0 or found[n].x < found[least].x:
            least = n
        if (spare < 0 or found[n].x < found[spare].x) and _has_deeper(found, count, found[n]):
            spare = n
    return least if spare < 0 else spare


@kernel
def _insert(found: Any, count: int, facet: int, touch: Touch) -> int:
    """Put a facet into the list, which has each facet once and is sorted by their numbers."""
    at = count
    while at > 0 and found[at - 1].facet >= facet:
        at -= 1
    if at < count and found[at].facet == facet:
        return count
    for n in range(count, at, -1):
        found[n] = found[n - 1]
    row = found[at]
    row.facet, row.face = facet, int(touch.face)
    row.x, row.s, row.nx, row.ny, row.nz = touch.x, touch.s, touch.nx, touch.ny, touch.nz
    if count < _MOST:
        return count + 1
    for n in range(_facet_to_drop(found, count + 1), count):
        found[n] = found[n + 1]
    return count


@kernel
def box(frames: Any) -> tuple[float, float, float, float, float, float]:
    """Box around all walls at their present positions: three lowest coordinates, three highest."""
    low, high = np.empty(3), np.empty(3)
    low[:], high[:] = math.inf, -math.inf
    for f in range(len(frames)):
        frame = frames[f]
        small, large, turn = frame.low, frame.high, frame.turn
        for k in range(3):
            if frame.moves == 0:
                a, b = small[k], large[k]
            else:
                a = b = frame.hub[k] + frame.shift[k]
                for m in range(3):
                    one = turn[3 * k + m] * (small[m] - frame.hub[m])
                    other = turn[3 * k + m] * (large[m] - frame.hub[m])
                    a, b = a + min(one, other), b + max(one, other)
            low[k], high[k] = min(low[k], a), max(high[k], b)
    return low[0], low[1], low[2], high[0], high[1], high[2]


@kernel
def near(frames: Any, x: Point, r: float) -> bool:
    """Whether a bead may be near any facet: a quick test, because most beads are not."""
    for f in range(len(frames)):
        frame = frames[f]
        p = to_frame(frame, x)
        if r > frame.reach:
            return True
        i, j, k = cell_of(frame, 0, p[0]), cell_of(frame, 1, p[1]), cell_of(frame, 2, p[2])
        cells = frame.cells
        if 0 <= i < cells[0] and 0 <= j < cells[1] and 0 <= k < cells[2]:
            at = (i * cells[1] + j) * cells[2] + k
            busy = array_at(frame.busy, (frame.cell_count + 7) >> 3, np.uint8)
            if busy[at >> 3] >> (at & 7) & 1:
                return True
    return False


@kernel
def overlaps(frames: Any, facets: Any, x: Point, r: float, found: Any, rows: Any = None) -> int:
    """List the facets that a sphere overlaps, and count them; not those that it passes by `rows`."""
    count = 0
    for f in range(len(frames)):
        frame = frames[f]
        p, cells = to_frame(frame, x), frame.cells
        more = max(r - frame.reach, 0.0)  # a bead too large for one cell reads those around too
        i0, i1 = cell_of(frame, 0, p[0] - more), cell_of(frame, 0, p[0] + more)
        j0, j1 = cell_of(frame, 1, p[1] - more), cell_of(frame, 1, p[1] + more)
        k0, k1 = cell_of(frame, 2, p[2] - more), cell_of(frame, 2, p[2] + more)
        starts = array_at(frame.starts, frame.cell_count + 1, np.int64)
        entries = array_at(frame.entries, frame.entry_count, np.int32)
        for i in range(max(i0, 0), min(i1 + 1, cells[0])):
            for j in range(max(j0, 0), min(j1 + 1, cells[1])):
                row = (i * cells[1] + j) * cells[2]
                for k in range(max(k0, 0), min(k1 + 1, cells[2])):
                    for e in range(starts[row + k], starts[row + k + 1]):
                        facet = facets[entries[e]]
                        if facet.kind >= TRIANGLE and not abs(height(facet, p)) < r:
                            continue
                        if rows is not None and rows[facet.plate_row].passes != 0:
                            continue
                        touch = on_facet(facet, p, r)
                        if touch.x > 0.0:
                            count = _insert(found, count, entries[e], turned(frame, touch))
    return count


@kernel
def _before(one: Any, other: Any, r: float) -> bool:
    """Order of facets: the deepest first, and at equal overlap a face before an edge."""
    here, there = math.floor(-one.x / (_TIE * r)), math.floor(-other.x / (_TIE * r))
    if here != there:
        return bool(here < there)
    return one.face > other.face if one.face != other.face else bool(one.facet < other.facet)


@kernel
def _path_distance(a: Touch, b: Touch, r: float) -> float:
    """Largest distance from the centre on the path from one nearest point to the other [m].

    The path follows the tangent planes of the ball at the two points to the line where they meet,
    and is straight where that comes nearer to the centre all the time. Each point sees the centre
    and the line at a right angle, so all four are on one circle (Thales).
    """
    far, near = r - min(a.x, b.x), r - max(a.x, b.x)
    square = (a.nx - b.nx) ** 2 + (a.ny - b.ny) ** 2 + (a.nz - b.nz) ** 2
    if near <= far * (1.0 - 0.5 * square):
        return far
    sine = square * (1.0 - 0.25 * square)  # its square
    if not sine > 0.0:  # opposite each other
        return math.inf
    return math.sqrt(((far - near) ** 2 + near * far * square) / sine)


@kernel
def _pass(a: Touch, b: Touch, r: float) -> float:
    """Overlap of the pass between two facets' nearest points, at most that of the shallower one."""
    return min(a.x, b.x, r - _PASS_FACTOR * _path_distance(a, b, r))


@kernel
def pass_gradient(frames: Any, facets: Any, x: Point, r: float, one: Any, other: Any) -> Point:
    """Negative gradient of the overlap at a pass between two facets with the bead's position."""
    a, b = touch_of(one), touch_of(other)
    low = a if a.x < b.x else b
    if _pass(a, b, r) == low.x:
        return low.nx, low.ny, low.nz
    first, second = facets[one.facet], facets[other.facet]
    here, there = frames[first.frame], frames[second.frame]
    step = _NUDGE * r
    dx, dy, dz = 0.0, 0.0, 0.0
    for k in range(3):
        change = 0.0
        for side in range(2):
            sign = 2.0 * side - 1.0
            p = (
                x[0] + (sign * step if k == 0 else 0.0),
                x[1] + (sign * step if k == 1 else 0.0),
                x[2] + (sign * step if k == 2 else 0.0),
            )
            a = turned(here, on_facet(first, to_frame(here, p), r))
            b = turned(there, on_facet(second, to_frame(there, p), r))
            change += sign * _path_distance(a, b, r)
        change *= 0.5 * _PASS_FACTOR / step
        if k == 0:
            dx = change
        elif k == 1:
            dy = change
        else:
            dz = change
    return dx, dy, dz


@kernel
def on_listed_facet(frames: Any, facets: Any, row: Any, point: Point, r: float) -> bool:
    """Whether a point of space is on a facet of the list."""
    facet = facets[row.facet]
    return contains(facet, to_frame(frames[facet.frame], point), _SEAM * r)


@kernel
def wall_ends(frames: Any, facets: Any, number: int, point: Point, r: float) -> bool:
    """Whether a wall ends at a point on the rim of a facet: no other facet goes on smoothly."""
    facet = facets[number]
    frame = frames[facet.frame]
    p, cells = to_frame(frame, point), frame.cells
    n = normal_at(facet, p)
    i, j, k = cell_of(frame, 0, p[0]), cell_of(frame, 1, p[1]), cell_of(frame, 2, p[2])
    if not (0 <= i < cells[0] and 0 <= j < cells[1] and 0 <= k < cells[2]):
        return True
    starts = array_at(frame.starts, frame.cell_count + 1, np.int64)
    entries = array_at(frame.entries, frame.entry_count, np.int32)
    at = (i * cells[1] + j) * cells[2] + k
    for e in range(starts[at], starts[at + 1]):
        other = facets[entries[e]]
        m = normal_at(other, p)
        smooth = abs(n[0] * m[0] + n[1] * m[1] + n[2] * m[2]) > SMOOTH
        if smooth and entries[e] != number and contains(other, p, _SEAM * r):
            return False
    return True


@kernel
def _search(found: Any, count: int, start: int, r: float) -> None:
    """Find the pass of largest overlap to a deeper facet: the widest path, by Dijkstra's search."""
    for n in range(count):
        found[n].level, found[n].done = 0.0, 0
    row, at = found[start], start
    row.level, row.representative, row.shared, row.near, row.far = row.x, start, 0.0, start, start
    while True:
        here, touch = found[at], touch_of(found[at])
        if _before(here, row, r):
            if here.level >= row.x - _TIE * r:
                row.representative = at
            else:
                row.shared, row.one, row.other = here.level, here.near, here.far
            return
        here.done, best = 1, -1
        for n in range(count):
            that = found[n]
            if that.done != 0:
                continue
            between = _pass(touch, touch_of(that), r)
            if min(between, here.level) > that.level:
                that.level = min(between, here.level)
                that.near, that.far = here.near, here.far
                if between < here.level:
                    that.near, that.far = at, n
            if that.level > 0.0 and (best < 0 or that.level > found[best].level):
                best = n
        if best < 0:
            return
        at = best


@kernel
def group_surfaces(r: float, found: Any, count: int) -> bool:
    """Give facets of one surface the same `representative`; return whether contacts share force."""
    first, single, sharing = 0, True, False
    if count == 1:
        found[0].representative, found[0].shared = 0, 0.0
        return False
    for n in range(1, count):
        if _before(found[n], found[first], r):
            first = n
    deepest = touch_of(found[first])
    for n in range(count):
        row = found[n]
        row.representative, row.shared = first, 0.0
        if n != first and _pass(deepest, touch_of(row), r) < row.x - _TIE * r:
            row.representative, single = -1, False
    if single:
        return False
    for n in range(count):
        if found[n].representative < 0:
            _search(found, count, n, r)
    for n in range(count):
        representative = found[n].representative
        while found[representative].representative != representative:
            representative = found[representative].representative
        found[n].representative = representative
        sharing = sharing or (representative == n and found[n].shared > 0.0)
    return sharing
