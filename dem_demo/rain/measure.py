"""Numbers for the figures of a rain, computed from its run."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dem_demo.kit.run import Run
from dem_demo.kit.scene import FLYING, GRAVITY, Floats
from dem_demo.rain.scene import Shower


def one_for_all(run: Run[Shower]) -> float:
    """Mean COR over all impacts on plates, which is not known beforehand; NaN without any."""
    return float(run.impacts["restitution"].mean()) if run.impacts.size else math.nan


class Hits(NamedTuple):
    """Collisions as beads have them, by bead and time: two entries for that of two beads."""

    bead: NDArray[np.int64]
    time: Floats
    row: NDArray[np.int64]  # of the record


def hits(run: Run[Shower]) -> Hits:
    """List the collisions of each bead, also those that are no impacts."""
    rows = run.record.rows
    bead, time = np.r_[rows["bead"], rows["other"]], np.tile(rows["time"], 2)
    order = np.lexsort((time, bead))
    order = order[bead[order] >= 0]
    return Hits(bead[order], time[order], order % max(1, rows.size))


class Rebounds(NamedTuple):
    """Rows of impacts, and rebound height over impact height."""

    rows: NDArray[np.void]
    ratio: Floats


def first_rebounds(run: Run[Shower]) -> Rebounds:
    """Measure how high beads rebound from their first impact.

    A bead counts if its first collision is on a plate and its second one after the next frame.
    Height and vertical speed in that frame give the apex, y + v^2/2g: a measure of what the engine
    did that does not rely on the COR in the record.
    """
    bead, time, row = hits(run)
    n, first = np.unique(bead, return_index=True)
    after = np.r_[np.where(bead[1:] == bead[:-1], time[1:], math.inf), math.inf][first]
    rows, last = run.record.rows[row[first]], run.time.size - 1
    frame = np.searchsorted(run.time, time[first], side="right").clip(max=last)
    ok = (rows["plate"] >= 0) & run.record.impact[row[first]] & (run.status[frame, n] == FLYING)
    ok &= (time[first] < run.time[frame]) & (run.time[frame] < after)
    n, frame, rows = n[ok], frame[ok], rows[ok]
    upwards = run.velocity[frame, n, 1].astype(float)
    apex = run.position[frame, n, 1] - run.scene.radius[n] + upwards * np.abs(upwards) / (2.0 * GRAVITY)
    return Rebounds(rows, apex * 2.0 * GRAVITY / rows["approach_speed"] ** 2)
