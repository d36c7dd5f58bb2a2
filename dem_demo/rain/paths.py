"""The flight of every bead in pieces, from impact to impact: compact data for animations."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from dem_demo.kit.run import Run
from dem_demo.kit.scene import FLYING, GRAVITY, Floats
from dem_demo.rain.scene import Shower

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


def pieces(run: Run[Shower]) -> NDArray[np.void]:
    """Cut the paths of beads into parabolas, and into pieces at rest.

    A piece is what fits consecutive frames; the collisions between two frames say when it ends.
    """
    rows, found = run.record.rows, []
    for bead in drawn(run).tolist():
        times = np.sort(rows["time"][(rows["bead"] == bead) | (rows["other"] == bead)])
        found += _flight(run, bead, times)
    made = np.zeros(len(found), PIECE)
    made[list(PIECE.names or ())[:9]] = np.array(found, PIECE.descr[:9])
    turned = np.r_[0.0, np.cumsum(made["spin"] * (made["end"] - made["start"]))]
    made["angle"] = turned[:-1] - turned[np.searchsorted(made["bead"], made["bead"])]
    _mark(made, run)
    return made


def drawn(run: Run[Shower]) -> NDArray[np.int64]:
    """Beads that are drawn: all, or an even sample of very many."""
    count = run.scene.radius.size
    return np.unique(np.linspace(0, count - 1, min(count, _MOST)).astype(int))


def _flight(run: Run[Shower], bead: int, times: Floats) -> list[tuple[float, ...]]:
    """Cut the path of a bead into pieces; its collisions have these times."""
    frames = np.flatnonzero(run.status[:, bead] == FLYING)
    if not frames.size:
        return []
    dt = 1.0 / run.scene.FRAME_RATE
    slow = _STILL * GRAVITY * dt
    time, spin = run.time[frames], run.spin[frames, bead, 0]
    place, speed = (one[frames, bead].astype(float) for one in (run.position, run.velocity))
    # A bead lies if it is slow and gravity does not change that until the next frame.
    change = np.diff(speed, axis=0, append=speed[-1:])
    still = (np.hypot(*speed.T) < slow) & (np.abs(change[:, 1]) < 0.5 * GRAVITY * dt)
    fall = np.where(still, 0.0, GRAVITY)

    def moved(n: int, at: float) -> tuple[float, float, float, float]:
        """Place and velocity at a time of the flight that the bead has in a frame."""
        (x, y), (u, v), t = place[n], speed[n], at - time[n]
        return x + u * t, y + v * t - 0.5 * fall[n] * t**2, u, v - fall[n] * t

    down = np.array([0.0, 1.0])
    missed = np.diff(place, axis=0) - speed[:-1] * dt + 0.5 * np.outer(fall[:-1], down) * dt**2
    turned = change[:-1] + np.outer(fall[:-1], down) * dt
    other = (np.hypot(*missed.T) > _PLACE) | (np.hypot(*turned.T) > slow) | (np.diff(fall) != 0.0)
    begin, n, found = float(run.scene.emission_time[bead]), 0, []
    for new in (np.flatnonzero(other) + 1).tolist():
        before, after = time[new - 1], time[new]
        between = times[(times > before) & (times <= after)].tolist() or [0.5 * (before + after)]
        found.append((bead, begin, between[0], *moved(n, begin), fall[n], spin[n]))
        begin = between[-1]
        if len(between) > 1:  # between unknown impacts: a straight line
            (x, y, *_), (to_x, to_y, *_) = moved(n, between[0]), moved(new, begin)
            t = max(begin - between[0], 1e-9)
            found.append((bead, between[0], begin, x, y, (to_x - x) / t, (to_y - y) / t, 0.0, spin[new]))
        n = new
    return [*found, (bead, begin, time[-1] + dt, *moved(n, begin), fall[n], spin[n])]


def _mark(made: NDArray[np.void], run: Run[Shower]) -> None:
    """Write the last impact on a plate, and the rebound with the other COR, into the pieces."""
    made["restitution"] = made["other_v"] = math.nan
    if not run.impacts.size:
        return
    order = np.lexsort((run.impacts["time"], run.impacts["bead"]))
    rows, span = run.impacts[order], 2.0 * run.time[-1]  # longer than the run: sorts by bead first
    keys = rows["bead"] * span + rows["time"]
    n = np.searchsorted(keys, made["bead"] * span + made["start"], side="right") - 1
    last = rows[n]
    hit = (n >= 0) & (last["bead"] == made["bead"])
    began = hit & (last["time"] == made["start"])
    made["restitution"][hit], made["outside"][hit] = last["restitution"][hit], last["flags"][hit] != 0
    made["other_v"][began] = run.mean_cor * last["approach_speed"][began]
