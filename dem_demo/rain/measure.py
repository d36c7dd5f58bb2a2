"""Numbers for the report and the figures of a rain, computed from its record."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw import edge_distance
from contactlaw.reporting.limits import Limit, exceeded
from contactlaw.reporting.run import Shares, shares
from dem_demo.kit.beads import FLYING, GRAVITY, Floats
from dem_demo.rain.record import Run

_NOTHING = math.nan, math.nan, math.nan, math.nan


@dataclass(frozen=True)
class PlateRow:
    """What happened on one plate.

    Attributes
    ----------
    thickness : float
        Thickness [m].
    impacts : int
        Number of impacts; the other numbers are NaN if it is 0.
    speed, restitution, lowest, highest : float
        Mean normal speed [m/s]; mean, smallest and largest COR.
    shares : Shares
        Shares of the total energy of the impacts. In the baseline all but ``kept`` are NaN: a
        constant COR does not say where the energy went.
    outside : int
        Number of impacts that exceed a limit of the model.
    """

    thickness: float
    impacts: int
    speed: float
    restitution: float
    lowest: float
    highest: float
    shares: Shares
    outside: int


def on_plate(run: Run, plate: int) -> NDArray[np.void]:
    """Impacts on one plate."""
    rows: NDArray[np.void] = run.impacts[run.impacts["plate"] == plate]
    return rows


def bead_on_bead(run: Run) -> NDArray[np.void]:
    """Impacts of two beads."""
    rows: NDArray[np.void] = run.impacts[run.impacts["other"] >= 0]
    return rows


def plate_rows(run: Run) -> list[PlateRow]:
    """Measure every plate of a run."""
    return [_plate_row(run, n) for n in range(len(run.scene.plates))]


def _plate_row(run: Run, plate: int) -> PlateRow:
    rows = on_plate(run, plate)
    thickness = run.scene.plates[plate].thickness
    if not rows.size:
        return PlateRow(thickness, 0, *_NOTHING, Shares(*[math.nan] * 5), 0)
    energy, cor = run.energy(rows), rows["restitution"]
    kept = float((cor**2 * energy).sum() / energy.sum())
    return PlateRow(
        thickness=thickness,
        impacts=rows.size,
        speed=float(rows["approach_speed"].mean()),
        restitution=float(cor.mean()),
        lowest=float(cor.min()),
        highest=float(cor.max()),
        shares=Shares(kept, *[math.nan] * 4) if run.baseline else model_shares(run, plate),
        outside=int(outside(run)[run.modelled["plate"] == plate].sum()),
    )


def model_shares(run: Run, plate: int) -> Shares:
    """Shares of the energy by the model, also for the impacts of the baseline."""
    rows = run.modelled[run.modelled["plate"] == plate]
    return shares(rows, _masses(run)[rows["bead"]], run.scene.friction > 0.0)


class Balance(NamedTuple):
    """Energy of all beads from their nozzles to the last frame that shows them [J]."""

    given: float
    """Kinetic energy at the nozzles, and work of gravity."""
    moving: float
    """Kinetic energy of translation at the end."""
    spinning: float
    """Kinetic energy of rotation at the end."""
    wave: float
    plastic: float
    other: float
    friction: float
    beads: float
    """Lost where beads hit each other, if that is recorded."""

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


def constant_beside_model(run: Run) -> tuple[Floats, Floats]:
    """Two CORs for each impact in `Run.modelled`: the constant one, and the model's.

    The constant is that of the baseline; without one it is the mean over all impacts of the run,
    which is not known beforehand.
    """
    rows = run.modelled
    own = rows["restitution"].astype(float)
    if run.constant_cor is None:
        return np.full(own.size, own.mean() if own.size else math.nan), own
    return own, np.asarray(run.by_model.restitution)


def restitution_range(run: Run) -> tuple[float, float]:
    """Range of the colour scale: from the lowest COR on a plate, at most 0.99, to 1."""
    on = run.impacts["plate"] >= 0
    return float(run.impacts["restitution"][on].min(initial=0.99)), 1.0


def limits(run: Run) -> list[Limit]:
    """List the limits of the model that impacts on plates exceed."""
    return exceeded(run.modelled["flags"])


def outside(run: Run) -> NDArray[np.bool_]:
    """Mask of the impacts in `Run.modelled` that exceed a limit of the model."""
    found: NDArray[np.bool_] = run.modelled["flags"] != 0
    return found


def near_edge(run: Run) -> NDArray[np.bool_]:
    """Mask of `Run.modelled`: the bending wave comes back from an edge during the contact."""
    rows, near = run.modelled, np.zeros(run.modelled.size, dtype=bool)
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
    first = first[((rows["plate"] == plate) & run.impact)[index[first]]]
    after = np.r_[np.where(bead[1:] == bead[:-1], time[1:], math.inf), math.inf][first]
    frame = np.searchsorted(run.time, time[first], side="right")
    ok = (frame < run.time.size) & (run.time[np.minimum(frame, run.time.size - 1)] < after)
    n, frame, row = bead[first][ok], frame[ok], index[first][ok]
    flying = run.status[frame, n] == FLYING
    n, frame, row = n[flying], frame[flying], row[flying]
    far = np.zeros(rows.size, dtype=bool)
    far[(rows["plate"] >= 0) & run.impact] = outside(run)
    speed = rows["approach_speed"][row]
    surface = run.scene.plates[plate].y + run.scene.beads.radius[n]
    upwards = run.velocity[frame, n, 1].astype(float)
    apex = run.position[frame, n, 1] - surface + upwards * np.abs(upwards) / (2.0 * GRAVITY)
    return Rebounds(speed, apex * 2.0 * GRAVITY / speed**2, far[row])
