"""Walls in their places at the start, and where on them impacts have happened."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.walls.facet import to_frame
from contactlaw.walls.frame import boxes_of, corners_of, profile_of
from contactlaw.walls.motion import move_one
from contactlaw.walls.profile import ARC, RECTANGLE, SEGMENT, TRIANGLE
from contactlaw.walls.round import places

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Rows = NDArray[np.void]

_AROUND = 72  # triangles of a round wall around its axis, in pictures
# Walls cross that go on behind each other by more than these shares of their size; triangles of a
# round wall are within the second one of it. Their number is such that no plane halves them all.
_COARSE, _BEHIND, _SAG = 21, 0.05, 0.012


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


def _tessellated(row: Any, point: Floats, around: int = _AROUND) -> tuple[Floats, Integers]:
    """Triangles of a round wall, for pictures, and in which of them points are."""
    profile = profile_of(row)
    bands = math.ceil(around * profile.length / (2.0 * math.pi * profile.shape[0])) if profile.kind == ARC else 1
    rho, height = places(profile, bands + 1)
    angle = 2.0 * math.pi * np.arange(around + 1) / around
    e, f, axis = row["a"], np.cross(row["normal"], row["a"]), row["normal"]
    circle = np.outer(np.cos(angle), e) + np.outer(np.sin(angle), f)
    grid = row["corner"] + rho[:, None, None] * circle + height[:, None, None] * axis
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    pairs = np.stack((a, b, c, a, c, d), axis=2).reshape(-1, 3, 3)
    at = point - row["corner"]
    turned = np.arctan2(at @ f, at @ e) % (2.0 * math.pi) * around / (2.0 * math.pi)
    out, up, (one, two, three) = np.hypot(at @ f, at @ e), at @ axis, profile.shape
    t = (out - one) * two + up * three if profile.kind == SEGMENT else one * (np.arctan2(out, up) - two)
    share = np.clip(t / profile.length, 0.0, 1.0) * bands
    band, column = np.minimum(share.astype(int), bands - 1), np.minimum(turned.astype(int), around - 1)
    share, inner, outer = share - band, rho[band], rho[band + 1]
    beyond = (turned - column) * (inner + share * (outer - inner)) > share * outer  # the diagonal
    which = 2 * (band * around + column) + beyond
    # At the axis one of two triangles has no area.
    area = np.linalg.norm(np.cross(pairs[:, 1] - pairs[:, 0], pairs[:, 2] - pairs[:, 0]), axis=1)
    good = area > 1e-9 * area.max()
    return pairs[good], (np.cumsum(good) - 1)[np.where(good[which], which, which ^ 1)]


def crossing(facets: Rows) -> tuple[int, int] | None:
    """Numbers of two walls that cross as they were given, neither of them a mesh; None if no two do."""
    facets, parts = facets[facets["kind"] != TRIANGLE], list[Floats]()
    for row, four in zip(facets, corners_of(facets), strict=True):
        flat = row["kind"] == RECTANGLE
        parts.append(four[[[0, 1, 2], [0, 2, 3]]] if flat else _tessellated(row, np.empty((0, 3)), _COARSE)[0])
    corners = np.concatenate([np.empty((0, 3, 3)), *parts])
    order = np.argsort(corners[:, :, 0].min(axis=1))
    corners, which = corners[order], np.repeat(np.arange(len(parts)), [len(part) for part in parts])[order]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    low, high, wall = corners.min(axis=1), corners.max(axis=1), facets["wall"][which]
    least = _SAG * ((facets["kind"] < RECTANGLE) * np.ptp(boxes_of(facets), axis=1).max(axis=1))[which]
    last = np.searchsorted(low[:, 0], high[:, 0], side="right")
    near = [n + np.flatnonzero(((low[n:m] <= high[n]) & (high[n:m] >= low[n])).all(axis=1)) for n, m in enumerate(last)]
    i, j = np.repeat(np.arange(len(near)), [len(one) for one in near]), np.concatenate([[], *near]).astype(int)
    along, deep = np.cross(normal[i], normal[j]), np.maximum(least[i], least[j])
    (a, b), (c, d) = (_cut(corners[k], corners[m], normal[m], along, deep) for k, m in ((i, j), (j, i)))
    crossed = (wall[i] != wall[j]) & (np.minimum(b, d) - np.maximum(a, c) > _BEHIND * np.minimum(b - a, d - c))
    pairs = zip(wall[i[crossed]].tolist(), wall[j[crossed]].tolist(), strict=True)
    return min(((min(pair), max(pair)) for pair in pairs), default=None)


def _cut(one: Floats, two: Floats, normal: Floats, along: Floats, least: Floats) -> tuple[Floats, Floats]:
    """Where the planes of triangles cut others: from, to along a direction; inf, -inf if not."""
    h = ((one - two[:, :1]) * normal[:, None]).sum(axis=2)
    after, deep = np.roll(h, -1, axis=1), np.minimum(h.max(axis=1), -h.min(axis=1))
    cut = (h * after <= 0.0) & (h != after) & (deep > np.maximum(_BEHIND * np.ptp(h, axis=1), least))[:, None]
    share = h / np.where(cut, h - after, 1.0)
    at = ((one + share[..., None] * (np.roll(one, -1, axis=1) - one)) * along[:, None]).sum(axis=2)
    return np.where(cut, at, math.inf).min(axis=1), np.where(cut, at, -math.inf).max(axis=1)


@kernel(cache=True)
def _to_rest(frames: Any, number: Any, time: Any, point: Any) -> None:
    """Carry points on walls that move back to where the wall was at time 0."""
    for n in range(len(number)):
        frame = frames[number[n]]
        if frame.moves != 0:
            move_one(frame, time[n], 1.0)
            point[n] = to_frame(frame, (point[n, 0], point[n, 1], point[n, 2]))
