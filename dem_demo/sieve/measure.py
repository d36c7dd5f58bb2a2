"""Numbers for the report and the figures of a sieve, computed from its record."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contactlaw import ImpactModel
from contactlaw.reporting.surface import averaged
from dem_demo.kit.beads import Floats
from dem_demo.kit.runs import Run
from dem_demo.sieve.scene import Sieve

_RIM = 1e-6  # [m]; contact points nearer to an opening are on its rim, within rounding


def on_sheet(run: Run[Sieve]) -> NDArray[np.bool_]:
    """Whether each triangle belongs to the sheet, not to a wall."""
    found: NDArray[np.bool_] = np.ptp(run.scene.deck.triangles()[:, :, 2], axis=1) == 0.0
    return found


def density(run: Run[Sieve]) -> Floats:
    """Dissipated energy per area of the sheet [J/m2], one value per triangle of it.

    It is an average over neighbouring triangles: energy over area, both weighted by a Gaussian
    whose standard deviation is the distance of two openings.
    """
    sheet = on_sheet(run)
    corners = run.scene.deck.triangles()[sheet]
    energy = np.zeros(len(run.scene.deck.triangles()))
    np.add.at(energy, run.collisions["triangle"], run.dissipated)
    return averaged(corners, energy[sheet], run.scene.deck.pitch)


def loss_by_openings(run: Run[Sieve]) -> float:
    """Energy that impacts on the flat of the deck lose, over that without openings, less 1.

    The same impacts are compared: their recorded COR, with the law's on a sheet without openings.
    NaN without such impacts.
    """
    rows, scene = run.collisions[on_faces(run) & run.record.impact], run.scene
    speed, bead = rows["approach_speed"], rows["bead"]
    model = ImpactModel(run.pair, run.law, outside="clamp")
    endless = model.restitution(speed, scene.radius[bead], scene.thickness)
    energy = scene.mass[bead] * speed**2
    lost, without = (float((energy * (1.0 - e**2)).sum()) for e in (rows["restitution"], endless))
    return lost / without - 1.0 if without else math.nan


def on_faces(run: Run[Sieve]) -> NDArray[np.bool_]:
    """Mask of impacts on the flat of the deck, not on a rim or a wall.

    At the rim of an opening a bead may have several contacts at once, none of which has a COR of
    its own.
    """
    flat: NDArray[np.bool_] = on_sheet(run)[run.collisions["triangle"]]
    return flat & (_away(run) > _RIM)


def _away(run: Run[Sieve]) -> Floats:
    """Distance of each impact from the nearest opening [m]; inf on a wall."""
    rows, scene = run.collisions, run.scene
    moved = np.sin(2.0 * math.pi * scene.frequency * (rows["time"] + rows["contact_time"]))
    x, y = (rows[name] - scene.vibration[n] * moved for n, name in enumerate("xy"))
    return np.where(on_sheet(run)[rows["triangle"]], scene.deck.nearest_edge(x, y), np.inf)


def passed(run: Run[Sieve]) -> Floats:
    """Share of the undersize beads that are under the deck, for each frame."""
    small = run.scene.small
    under = run.position[:, small, 2] < -run.scene.amplitude - 0.5 * run.scene.deck.opening
    share: Floats = under.sum(axis=1) / max(1, int(small.sum()))
    return share
