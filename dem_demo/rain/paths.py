"""The flight of every bead in pieces, from impact to impact: compact data for animations."""

from __future__ import annotations

import functools
import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dem_demo.kit.beads import FLYING, GRAVITY, Floats
from dem_demo.rain.measure import one_for_all, outside
from dem_demo.rain.record import Run

# One piece: from `start` to `end` [s] at x + u t, y + v t - fall t^2/2 with t since its start.
PIECE = np.dtype(
    [
        ("bead", "i4"),
        *[(name, "f8") for name in ("start", "end", "x", "y", "u", "v", "fall")],
        ("spin", "f8"),  # 0 without friction
        ("angle", "f8"),  # at the start, counterclockwise [rad]
        ("restitution", "f8"),  # of the last impact on a plate so far, NaN before the first
        ("other_v", "f8"),  # v with the other COR; NaN if no impact on a plate began it
        ("outside", "i4"),  # 1: the last impact exceeds a limit of the model
    ]
)

_MOST = 3000  # most beads on a page; a thousand take some 0.2 MB
_PLACE = 5e-5  # [m], invisible difference of two positions
# A bead at rest is slower than this many times the speed that gravity adds in a frame.
_STILL = 2.0
_UNMARKED = 0.0, math.nan, math.nan, 0


@functools.lru_cache(maxsize=1)  # shared by snapshot, film and page
def pieces(run: Run) -> NDArray[np.void]:
    """Cut the paths of beads into parabolas, and into pieces at rest."""
    found: list[tuple[float, ...]] = []
    hits = _hits(run)
    for bead in drawn(run).tolist():
        found += _flight(run, bead, hits[bead])
    made = np.array(found, dtype=PIECE) if found else np.empty(0, PIECE)
    turned = np.r_[0.0, np.cumsum(made["spin"] * (made["end"] - made["start"]))]
    made["angle"] = turned[:-1] - turned[np.searchsorted(made["bead"], made["bead"])]
    _mark(made, run)
    return made


def drawn(run: Run) -> NDArray[np.int64]:
    """Choose the beads that are drawn, by index: all, or `_MOST` of them evenly."""
    every = run.scene.beads.radius.size
    return np.unique(np.linspace(0, every - 1, min(every, _MOST)).round().astype(int))


def at(made: NDArray[np.void], time: float) -> NDArray[np.void]:
    """Pieces that cover a time [s], one for each bead that flies."""
    now: NDArray[np.void] = made[(made["start"] <= time) & (time < made["end"])]
    return now


def places(made: NDArray[np.void], time: float | Floats) -> Floats:
    """Positions (N, 2) [m] of the beads on pieces at a time [s], one for all or one for each."""
    t = time - made["start"]
    height = made["y"] + made["v"] * t - 0.5 * made["fall"] * t**2
    return np.column_stack((made["x"] + made["u"] * t, height))


def _hits(run: Run) -> list[Floats]:
    """Find the times of the recorded collisions of each bead, ascending."""
    rows = run.collisions
    bead = np.r_[rows["bead"], rows["other"]]
    time = np.r_[rows["time"], rows["time"]]
    order = np.lexsort((time, bead))
    bead, time = bead[order], time[order]
    ends = np.searchsorted(bead, np.arange(run.scene.beads.radius.size + 1))
    return [time[a:b] for a, b in zip(ends[:-1], ends[1:], strict=True)]


class _Free(NamedTuple):
    """State of a bead in free flight, or at rest, at one instant."""

    time: float
    x: float
    y: float
    u: float
    v: float
    fall: float
    spin: float

    def later(self, time: float) -> _Free:
        """State at another time of the same flight."""
        t = time - self.time
        y = self.y + self.v * t - 0.5 * self.fall * t * t
        v = self.v - self.fall * t
        return self._replace(time=time, x=self.x + self.u * t, y=y, v=v)

    def meets(self, other: _Free, slow: float) -> bool:
        """Whether another state at the same time is part of the same flight."""
        return (
            math.hypot(self.x - other.x, self.y - other.y) < _PLACE
            and math.hypot(self.u - other.u, self.v - other.v) < slow
        )


def _flight(run: Run, bead: int, hits: Floats) -> list[tuple[float, ...]]:
    states = _states(run, bead)
    if not states:
        return []
    begin, now, found = float(run.scene.beads.emission_time[bead]), states[0], []
    slow = _STILL * GRAVITY / run.scene.frame_rate
    for before, new in itertools.pairwise(states):
        if now.later(new.time).meets(new, slow):
            continue
        between = hits[(hits > before.time) & (hits <= new.time)].tolist()
        between = between or [0.5 * (before.time + new.time)]
        found.append((begin, between[0], now))
        if len(between) > 1:  # between unknown impacts: a straight line
            found.append((between[0], between[-1], _straight(now, new, between)))
        lies = math.hypot(new.u, new.v) < slow
        begin, now = between[-1], new._replace(fall=0.0) if lies else new
    found.append((begin, states[-1].time + 1.0 / run.scene.frame_rate, now))
    return [(bead, a, b, *free.later(a)[1:], *_UNMARKED) for a, b, free in found]


def _states(run: Run, bead: int) -> list[_Free]:
    frames = np.flatnonzero(run.status[:, bead] == FLYING)
    spin = np.zeros(frames.size) if run.spin is None else run.spin[frames, bead]
    columns = run.time[frames], run.position[frames, bead], run.velocity[frames, bead], spin
    return [
        _Free(time, x, y, u, v, GRAVITY, turn)
        for time, (x, y), (u, v), turn in zip(*(one.tolist() for one in columns), strict=True)
    ]


def _straight(old: _Free, new: _Free, between: list[float]) -> _Free:
    a, b = old.later(between[0]), new.later(between[-1])
    t = max(b.time - a.time, 1e-9)
    return _Free(a.time, a.x, a.y, (b.x - a.x) / t, (b.y - a.y) / t, 0.0, b.spin)


def _mark(made: NDArray[np.void], run: Run) -> None:
    """Write the last impact on a plate, and the rebound with the other COR, into the pieces."""
    rows = run.on_plates
    constant = one_for_all(run)
    far = outside(run)
    order = np.lexsort((rows["time"], rows["bead"]))
    key = rows["bead"][order], rows["time"][order]
    for piece in made:
        first, last = np.searchsorted(key[0], [piece["bead"], piece["bead"] + 1])
        n = first + int(np.searchsorted(key[1][first:last], piece["start"], side="right")) - 1
        if n < first:
            continue
        hit = order[n]
        piece["restitution"] = rows["restitution"][hit]
        piece["outside"] = far[hit]
        if rows["time"][hit] == piece["start"]:
            piece["other_v"] = constant * rows["approach_speed"][hit]
