"""Walls in their places at the start, and where on them impacts have happened."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.walls.facet import to_frame
from contactlaw.walls.frame import RECTANGLE, corners_of
from contactlaw.walls.motion import move_one

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Rows = NDArray[np.void]


def at_rest(facets: Rows, frames: Rows, hits: Rows) -> tuple[Floats, Integers, Integers, Floats]:
    """Triangles of all walls in their places at time 0, and where on them impacts have happened.

    Hits have the columns of `contactlaw.engines.record.IMPACT`. Returned are the corners of m
    triangles (m, 3, 3) [m], of which a rectangle is two; the number of the wall of each; the
    triangle that each impact was on; and where on it (n, 3) [m].
    """
    four, box = corners_of(facets), facets["kind"] == RECTANGLE
    corners = np.concatenate((four[:, :3], four[box][:, [0, 2, 3]]))
    second = len(facets) + np.cumsum(box) - 1
    keys = facets["wall"] * (facets["triangle"].max() + 2) + facets["triangle"] + 1
    order = np.argsort(keys)
    wanted = hits["plate"] * (facets["triangle"].max() + 2) + hits["triangle"] + 1
    facet = order[np.searchsorted(keys, wanted, sorter=order)]
    point = np.stack([hits[name] for name in "xyz"], axis=1)
    _to_rest(frames.copy(), facets["frame"][facet], hits["time"] + hits["contact_time"], point)
    # A rectangle's second triangle is beyond its diagonal, on the side of edge b.
    one = facets[facet]
    along = point - one["corner"]
    a, b = ((along * one[edge]).sum(axis=1) / one[f"length_{edge}"] for edge in "ab")
    wall = np.concatenate((facets["wall"], facets["wall"][box]))
    return corners, wall, np.where(box[facet] & (b > a), second[facet], facet), point


@kernel(cache=True)
def _to_rest(frames: Any, number: Any, time: Any, point: Any) -> None:
    """Carry points on walls that move back to where the wall was at time 0."""
    for n in range(len(number)):
        frame = frames[number[n]]
        if frame.moves != 0:
            move_one(frame, time[n], 1.0)
            point[n] = to_frame(frame, (point[n, 0], point[n, 1], point[n, 2]))
