"""Walls in their places at the start, and where on them impacts have happened."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.walls.facet import to_frame
from contactlaw.walls.frame import corners_of, profile_of
from contactlaw.walls.motion import move_one
from contactlaw.walls.profile import ARC, RECTANGLE, SEGMENT, TRIANGLE
from contactlaw.walls.round import places

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Rows = NDArray[np.void]

_AROUND = 72  # triangles of a round wall around its axis, in pictures


def at_rest(facets: Rows, frames: Rows, hits: Rows) -> tuple[Floats, Integers, Integers, Floats]:
    """Triangles of all walls in their places at time 0, and where on them impacts have happened.

    Hits have the columns of `contactlaw.engines.record.IMPACT`. Returned are the corners of m
    triangles (m, 3, 3) [m], of which a rectangle is two and a round wall many; the number of the
    wall of each; the triangle that each impact was on; and where on it (n, 3) [m].
    """
    four, box = corners_of(facets), facets["kind"] == RECTANGLE
    corners = np.concatenate((four[:, :3], four[box][:, [0, 2, 3]]))
    second = len(facets) + np.cumsum(box) - 1
    keys = facets["wall"] * (facets["triangle"].max() + 2) + facets["triangle"] + 1
    order = np.argsort(keys)
    wanted = hits["plate"] * (facets["triangle"].max() + 2) + hits["triangle"] + 1
    facet = order[np.searchsorted(keys, wanted, sorter=order)]
    point = np.stack([hits[name] for name in "xyz"], axis=1)
    _to_rest(frames.copy(), facets["frame"][facet], hits["time"] + hits["contact_time"] - hits["wall_start"], point)
    # A rectangle's second triangle is beyond its diagonal, on the side of edge b.
    one = facets[facet]
    along = point - one["corner"]
    a, b = ((along * one[edge]).sum(axis=1) for edge in "ab")
    wall = np.concatenate((facets["wall"], facets["wall"][box]))
    number = np.where(box[facet] & (b * one["length_a"] > a * one["length_b"]), second[facet], facet)
    for n in np.flatnonzero(facets["kind"] < TRIANGLE):
        parts, which = _tessellated(facets[n], point[facet == n])
        # The first of its triangles has the facet's own number.
        number[facet == n] = np.where(which > 0, len(corners) + which - 1, n)
        corners[n] = parts[0]
        corners = np.concatenate((corners, parts[1:]))
        wall = np.concatenate((wall, np.full(len(parts) - 1, facets["wall"][n])))
    return corners, wall, number, point


def _tessellated(row: Any, point: Floats) -> tuple[Floats, Integers]:
    """Triangles of a round wall, for pictures, and in which of them points are."""
    profile = profile_of(row)
    bands = math.ceil(_AROUND * profile.length / (2.0 * math.pi * profile.shape[0])) if profile.kind == ARC else 1
    rho, height = places(profile, bands + 1)
    angle = 2.0 * math.pi * np.arange(_AROUND + 1) / _AROUND
    e, f, axis = row["a"], np.cross(row["normal"], row["a"]), row["normal"]
    circle = np.outer(np.cos(angle), e) + np.outer(np.sin(angle), f)
    grid = row["corner"] + rho[:, None, None] * circle + height[:, None, None] * axis
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    pairs = np.stack((a, b, c, a, c, d), axis=2).reshape(-1, 3, 3)
    at = point - row["corner"]
    turned = np.arctan2(at @ f, at @ e) % (2.0 * math.pi) * _AROUND / (2.0 * math.pi)
    out, up, (one, two, three) = np.hypot(at @ f, at @ e), at @ axis, profile.shape
    t = (out - one) * two + up * three if profile.kind == SEGMENT else one * (np.arctan2(out, up) - two)
    share = np.clip(t / profile.length, 0.0, 1.0) * bands
    band, column = np.minimum(share.astype(int), bands - 1), np.minimum(turned.astype(int), _AROUND - 1)
    share, inner, outer = share - band, rho[band], rho[band + 1]
    beyond = (turned - column) * (inner + share * (outer - inner)) > share * outer  # the diagonal
    which = 2 * (band * _AROUND + column) + beyond
    # At the axis one of two triangles has no area.
    area = np.linalg.norm(np.cross(pairs[:, 1] - pairs[:, 0], pairs[:, 2] - pairs[:, 0]), axis=1)
    good = area > 1e-9 * area.max()
    return pairs[good], (np.cumsum(good) - 1)[np.where(good[which], which, which ^ 1)]


@kernel(cache=True)
def _to_rest(frames: Any, number: Any, time: Any, point: Any) -> None:
    """Carry points on walls that move back to where the wall was at time 0."""
    for n in range(len(number)):
        frame = frames[number[n]]
        if frame.moves != 0:
            move_one(frame, time[n], 1.0)
            point[n] = to_frame(frame, (point[n, 0], point[n, 1], point[n, 2]))
