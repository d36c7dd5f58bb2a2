"""Which of the facets that a bead overlaps it is in contact with: one, where they are one surface.

A bead feels one surface where facets meet. Of facets whose nearest points are one, or of which one
has the other's nearest point, the contact is with that which has it on its face, else with the
nearest, else with the first. Of faces that meet at a small angle, as those of a tessellated
cylinder, it is with the deepest: the overlap, and with it the force, so has no jump where the bead
goes on from one to the next.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlaw._jit import kernel
from contactlaw.engines.lammps.geometry import (
    Bead,
    Point,
    Touch,
    cell_of,
    entries_of,
    has,
    height,
    nearest,
    on_facet,
    to_frame,
    turned,
)
from contactlaw.engines.lammps.memory import array_at

_SEAM = 1e-4  # [r] between facets that are one surface to a bead
_TIE = 1e-9  # [r] of overlap: rounding
_SMOOTH = math.cos(math.radians(20.0))  # faces of one surface
# Facets that a bead may overlap before shallow ones are left out, and room for one more. Where
# facets are that small, a deeper one is beside each of these, and in contact in its place.
_MOST = 64
ROOM = _MOST + 1

# A facet that a bead overlaps. `surface` is the place in the list of what it is the surface of
# together with: its own, if it is in contact.
OVERLAP = np.dtype(
    [(name, "i8") for name in ("facet", "face", "surface")]
    + [(name, "f8") for name in ("x", "s", "nx", "ny", "nz")],
    align=True,
)


@kernel
def touch_of(row: Any) -> Touch:
    """Read a row of the list."""
    return Touch(row.x, row.s, row.nx, row.ny, row.nz, row.face != 0)


@kernel
def _has_deeper(found: Any, count: int, one: Any) -> bool:
    """Whether a deeper facet of the list lies in nearly the same direction."""
    for n in range(count):
        row = found[n]
        along = row.nx * one.nx + row.ny * one.ny + row.nz * one.nz
        if row.x > one.x and along > _SMOOTH:
            return True
    return False


@kernel
def _spare(found: Any, count: int) -> int:
    """Shallowest facet that a deeper one beside it stands for; without any, the shallowest.

    So the many facets of a floor leave room for the wall that the bead just begins to touch.
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
    """Put a facet into the list, once; the list is in the order of the facets' numbers."""
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
    for n in range(_spare(found, count + 1), count):
        found[n] = found[n + 1]
    return count


@kernel
def near(frames: Any, x: Point, r: float) -> bool:
    """Whether any facet may be near a bead: a quick look, for most are near none."""
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
def overlaps(frames: Any, facets: Any, bead: Bead, found: Any) -> int:
    """List the facets that a bead overlaps, and count them."""
    count = 0
    for f in range(len(frames)):
        frame = frames[f]
        p, cells = to_frame(frame, bead.x), frame.cells
        more = max(bead.r - frame.reach, 0.0)  # of a bead too large for one cell
        i0, i1 = cell_of(frame, 0, p[0] - more), cell_of(frame, 0, p[0] + more)
        j0, j1 = cell_of(frame, 1, p[1] - more), cell_of(frame, 1, p[1] + more)
        k0, k1 = cell_of(frame, 2, p[2] - more), cell_of(frame, 2, p[2] + more)
        starts, entries = entries_of(frame)
        for i in range(max(i0, 0), min(i1 + 1, cells[0])):
            for j in range(max(j0, 0), min(j1 + 1, cells[1])):
                row = (i * cells[1] + j) * cells[2]
                for k in range(max(k0, 0), min(k1 + 1, cells[2])):
                    for e in range(starts[row + k], starts[row + k + 1]):
                        facet = facets[entries[e]]
                        if not abs(height(facet, p)) < bead.r:
                            continue
                        touch = on_facet(facet, p, bead.r)
                        if touch.x > 0.0:
                            count = _insert(found, count, entries[e], turned(frame, touch))
    return count


@kernel
def _rank(row: Any, r: float) -> tuple[int, int]:
    """Sort facets that share a point: face before edge, then the nearest."""
    return 1 - row.face, math.floor(-row.x / (_TIE * r))


@kernel
def _one_face(a: Any, b: Any, r: float) -> bool:
    """Whether a face belongs to a deeper one, which it meets at a small angle."""
    if a.face == 0 or b.face == 0:
        return False
    return bool(a.nx * b.nx + a.ny * b.ny + a.nz * b.nz > _SMOOTH)


@kernel
def on_it(frames: Any, facets: Any, row: Any, point: Point, r: float) -> bool:
    """Whether a point of space is on a facet of the list."""
    facet = facets[row.facet]
    return has(facet, to_frame(frames[facet.frame], point), _SEAM * r)


@kernel
def join(frames: Any, facets: Any, bead: Bead, found: Any, count: int) -> None:
    """Tell for each facet of the list which one it is the surface of together with."""
    r = bead.r
    for n in range(count):
        found[n].surface = n
    if count < 2:
        return
    for n in range(count):
        point, best = nearest(touch_of(found[n]), bead), n
        for m in range(count):
            # the list is in the order of the facets: of two of one rank the first is before
            mine, its = _rank(found[best], r), _rank(found[m], r)
            if its < mine or (its == mine and m < best):
                if _one_face(found[n], found[m], r) or on_it(frames, facets, found[m], point, r):
                    best = m
        found[n].surface = best
    for n in range(count):
        home = found[n].surface
        for _ in range(count):
            if found[home].surface == home:
                break
            home = found[home].surface
        found[n].surface = home
