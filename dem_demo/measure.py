"""What the report and the figures say about a run, computed from its record."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactlaw import Validity, edge_distance
from dem_demo.frame import FLYING
from dem_demo.reader import Run
from dem_demo.recorder import CONSTANT
from dem_demo.scene import GRAVITY, Floats


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
    kept, wave, plastic : float
        Shares of the impacts' total kinetic energy (normal part). In the baseline wave is NaN, and
        so is plastic: a constant COR does not say where the energy went.
    """

    thickness: float
    impacts: int
    speed: float
    restitution: float
    lowest: float
    highest: float
    kept: float
    wave: float
    plastic: float


def on_plate(run: Run, plate: int) -> NDArray[np.void]:
    """Collisions on one plate."""
    rows: NDArray[np.void] = run.collisions[run.collisions["plate"] == plate]
    return rows


def bead_on_bead(run: Run) -> NDArray[np.void]:
    """Collisions of two beads."""
    rows: NDArray[np.void] = run.collisions[run.collisions["other"] >= 0]
    return rows


def plate_rows(run: Run) -> list[PlateRow]:
    """Measure every plate of a run."""
    return [_plate_row(run, n) for n in range(len(run.scene.plates))]


def _plate_row(run: Run, plate: int) -> PlateRow:
    rows = on_plate(run, plate)
    thickness = run.scene.plates[plate].thickness
    if not rows.size:
        return PlateRow(thickness, 0, *[math.nan] * 7)
    energy, cor = run.energy(rows), rows["restitution"]
    total = energy.sum()
    constant = run.law == CONSTANT
    return PlateRow(
        thickness=thickness,
        impacts=rows.size,
        speed=float(rows["approach_speed"].mean()),
        restitution=float(cor.mean()),
        lowest=float(cor.min()),
        highest=float(cor.max()),
        kept=float((cor**2 * energy).sum() / total),
        wave=math.nan if constant else float(rows["wave_energy"].sum() / total),
        plastic=math.nan if constant else float(rows["plastic_energy"].sum() / total),
    )


def model_shares(run: Run, plate: int) -> tuple[float, float, float]:
    """Shares kept, lost to waves and lost to plastic flow, had the model ruled the same impacts."""
    rows = run.modelled[run.modelled["plate"] == plate]
    total = run.energy(rows).sum()
    wave, plastic = (float(rows[name].sum() / total) for name in ("wave_energy", "plastic_energy"))
    return 1.0 - wave - plastic, wave, plastic


def flag_counts(run: Run) -> Counter[str]:
    """Count the impacts on plates that exceed a limit of the model, by the limit's name.

    "near an edge" is an impact so close to the plate's edge that the bending wave comes back while
    the contact lasts.
    """
    counts: Counter[str] = Counter()
    for flag in Validity:
        number = int(((run.modelled["flags"] & flag) != 0).sum())
        if number:
            counts[str(flag.name).lower().replace("_", " ")] = number
    near = _near_edge(run)
    if near:
        counts["near an edge"] = near
    return counts


def first_rebounds(run: Run, plate: int) -> tuple[Floats, Floats]:
    """Impact speed [m/s] and measured rebound height over impact height, of first impacts.

    A bead counts if its first collision is on this plate and it meets nothing until the next frame.
    There its height and vertical speed give the apex it is going to reach, y + v^2/2g, from what
    the engine did rather than from the COR it was told.
    """
    rows = run.collisions
    bead, time = np.r_[rows["bead"], rows["other"]], np.r_[rows["time"], rows["time"]]
    order = np.lexsort((time, bead))
    index = np.tile(np.arange(rows.size), 2)[order]
    bead, time = bead[order], time[order]
    first = np.flatnonzero(np.r_[True, bead[1:] != bead[:-1]] & (bead >= 0))
    first = first[rows["plate"][index[first]] == plate]
    after = np.r_[np.where(bead[1:] == bead[:-1], time[1:], math.inf), math.inf][first]
    frame = np.searchsorted(run.time, time[first], side="right")
    ok = (frame < run.time.size) & (run.time[np.minimum(frame, run.time.size - 1)] < after)
    n, frame, speed = bead[first][ok], frame[ok], rows["approach_speed"][index[first]][ok]
    flying = run.status[frame, n] == FLYING
    n, frame, speed = n[flying], frame[flying], speed[flying]
    surface = run.scene.plates[plate].y + run.scene.beads.radius[n]
    upwards = run.velocity[frame, n, 1].astype(float)
    apex = run.position[frame, n, 1] - surface + upwards * np.abs(upwards) / (2.0 * GRAVITY)
    return speed, apex * 2.0 * GRAVITY / speed**2


def _near_edge(run: Run) -> int:
    count = 0
    for n, plate in enumerate(run.scene.plates):
        here = run.modelled[run.modelled["plate"] == n]
        if not here.size or plate.thickness == math.inf:
            continue
        edge = np.minimum(here["x"] - plate.x0, plate.x1 - here["x"])
        # It grows with the square root of contact time, so one call serves for all.
        unit = edge_distance(run.scene.plate_material, plate.thickness, 1.0)
        count += int((edge < unit * np.sqrt(here["contact_time"])).sum())
    return count
