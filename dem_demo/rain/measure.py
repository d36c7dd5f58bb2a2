"""Numbers for the report and the figures of a rain, computed from its record."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw import edge_distance
from contactlaw.reporting.run import Shares, shares
from dem_demo.kit.beads import FLYING, GRAVITY, Floats
from dem_demo.rain.record import Run


def bead_on_bead(run: Run) -> NDArray[np.void]:
    """Impacts of two beads."""
    rows: NDArray[np.void] = run.impacts[run.impacts["other"] >= 0]
    return rows


def plate_shares(run: Run, plate: int) -> Shares | None:
    """Shares of the energy of the impacts on a plate; None without any."""
    rows = run.on_plates[run.on_plates["plate"] == plate]
    if not rows.size:
        return None
    return shares(rows, _masses(run)[rows["bead"]], run.scene.friction > 0.0)


class Balance(NamedTuple):
    """Energy of all beads from their nozzles to the last frame that shows them [J]."""

    given: float  # kinetic energy at the nozzles, and work of gravity
    moving: float  # kinetic energy of translation at the end
    spinning: float  # kinetic energy of rotation at the end
    wave: float
    plastic: float
    other: float
    friction: float
    beads: float  # lost where beads hit each other

    @property
    def rest(self) -> float:
        """Energy that nothing here accounts for."""
        return self.given - sum(self[1:])


def balance(run: Run) -> Balance:
    """Sum up the energies of a rain with friction."""
    assert run.spin is not None
    beads, mass, rows = run.scene.beads, _masses(run), run.collisions
    seen = np.flatnonzero((run.status == FLYING).any(axis=0))
    last = run.time.size - 1 - np.argmax(run.status[::-1, seen] == FLYING, axis=0)
    mass, began = mass[seen], (beads.velocity[seen] ** 2).sum(axis=1)
    fallen = beads.position[seen, 1] - run.position[last, seen, 1]
    ended = (run.velocity[last, seen].astype(float) ** 2).sum(axis=1)
    turning = 0.4 * (beads.radius[seen] * run.spin[last, seen]) ** 2  # of solid spheres
    until = np.full(beads.radius.size, -1.0)
    until[seen] = run.time[last]
    rows = rows[rows["time"] <= until[rows["bead"]]]
    on, pairs = rows[rows["plate"] >= 0], rows[rows["other"] >= 0]
    one, two = (_masses(run)[pairs[name]] for name in ("bead", "other"))
    normal = 0.5 * one * two / (one + two) * pairs["approach_speed"] ** 2
    return Balance(
        float(mass @ (0.5 * began + GRAVITY * fallen)),
        float(0.5 * mass @ ended),
        float(0.5 * mass @ turning),
        **{name: float(on[f"{name}_energy"].sum()) for name in Shares._fields[1:]},
        beads=float(normal @ (1.0 - pairs["restitution"] ** 2)),
    )


def _masses(run: Run) -> Floats:
    return run.scene.beads.mass(run.scene.sphere_material.density)


def one_for_all(run: Run) -> float:
    """Mean COR over all impacts on plates, which is not known beforehand; NaN without any."""
    rows = run.on_plates
    return float(rows["restitution"].mean()) if rows.size else math.nan


def restitution_range(run: Run) -> tuple[float, float]:
    """Range of the colour scale: from the lowest COR on a plate, at most 0.99, to 1."""
    return float(run.on_plates["restitution"].min(initial=0.99)), 1.0


def outside(run: Run) -> NDArray[np.bool_]:
    """Mask of the impacts in `Run.on_plates` that exceed a limit of the model."""
    found: NDArray[np.bool_] = run.on_plates["flags"] != 0
    return found


def near_edge(run: Run) -> NDArray[np.bool_]:
    """Mask of `Run.on_plates`: the bending wave comes back from an edge during the contact."""
    rows, near = run.on_plates, np.zeros(run.on_plates.size, dtype=bool)
    for n, plate in enumerate(run.scene.plates):
        here = rows["plate"] == n
        if plate.thickness == math.inf or not here.any():
            continue
        # The distance grows with the square root of contact time: one call serves all impacts.
        unit = edge_distance(run.scene.plate_material, plate.thickness, 1.0)
        near |= here & (run.edge_distance < unit * np.sqrt(rows["contact_time"]))
    return near


class Rebounds(NamedTuple):
    """Speed [m/s], rebound height over impact height, and mask of impacts outside a limit."""

    speed: Floats
    ratio: Floats
    outside: NDArray[np.bool_]


def first_rebounds(run: Run, plate: int) -> Rebounds:
    """Measure how high beads rebound from their first impact.

    A bead counts if its first collision is on this plate and its second one after the next frame.
    Height and vertical speed in that frame give the apex, y + v^2/2g: a measure of what the engine
    did that does not rely on the COR in the record.
    """
    rows = run.collisions
    bead, time = np.r_[rows["bead"], rows["other"]], np.r_[rows["time"], rows["time"]]
    order = np.lexsort((time, bead))
    index = np.tile(np.arange(rows.size), 2)[order]
    bead, time = bead[order], time[order]
    first = np.flatnonzero(np.r_[True, bead[1:] != bead[:-1]] & (bead >= 0))
    first = first[((rows["plate"] == plate) & run.record.impact)[index[first]]]
    after = np.r_[np.where(bead[1:] == bead[:-1], time[1:], math.inf), math.inf][first]
    frame = np.searchsorted(run.time, time[first], side="right")
    ok = (frame < run.time.size) & (run.time[np.minimum(frame, run.time.size - 1)] < after)
    n, frame, row = bead[first][ok], frame[ok], index[first][ok]
    flying = run.status[frame, n] == FLYING
    n, frame, row = n[flying], frame[flying], row[flying]
    far = np.zeros(rows.size, dtype=bool)
    far[(rows["plate"] >= 0) & run.record.impact] = outside(run)
    speed = rows["approach_speed"][row]
    surface = run.scene.plates[plate].y + run.scene.beads.radius[n]
    upwards = run.velocity[frame, n, 1].astype(float)
    apex = run.position[frame, n, 1] - surface + upwards * np.abs(upwards) / (2.0 * GRAVITY)
    return Rebounds(speed, apex * 2.0 * GRAVITY / speed**2, far[row])
