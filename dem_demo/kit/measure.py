"""Numbers for the reports and figures of any bed, computed from its record."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw import ImpactModel
from dem_demo.kit.beads import Floats
from dem_demo.kit.runs import Run


class Account(NamedTuple):
    """Energy balance of all beads at each frame [J]: input since the start, and where it went."""

    start: Floats  # kinetic energy at the start
    gravity: Floats
    walls: Floats  # work of the moving walls
    moving: Floats  # translational and rotational kinetic energy at the frame
    wave: Floats
    plastic: Floats
    vibration: Floats  # lost to friction within the contact and to vibration of the bodies
    friction: Floats  # lost to friction on the walls
    others: Floats  # the rest: bead on bead, and energy stored in open contacts


def account(run: Run[Any]) -> Account:
    """Sum up the energy balance until each frame."""
    rows = run.collisions
    end = rows["time"] + rows["contact_time"]
    order = np.argsort(end, kind="stable")
    until = np.searchsorted(end[order], run.time, side="right")

    def so_far(column: str) -> Floats:
        if column not in (rows.dtype.names or ()):  # a record of an older version
            return np.zeros_like(run.time)
        sums: Floats = np.r_[0.0, np.cumsum(rows[column][order])][until]
        return sums

    moving = run.kinetic + run.rotational
    start, gravity = np.full_like(moving, moving[0]), run.potential[0] - run.potential
    walls, wave, plastic = (so_far(name) for name in ("wall_work", "wave_energy", "plastic_energy"))
    vibration, friction = so_far("other_energy") + so_far("scheme_energy"), so_far("friction_energy")
    rest = start + gravity + walls - moving - wave - plastic - vibration - friction
    return Account(start, gravity, walls, moving, wave, plastic, vibration, friction, rest)


def kept(run: Run[Any], rows: NDArray[np.void]) -> float:
    """Constant COR with which these impacts would lose the same energy; NaN without impacts.

    e^2 is the mean of the impacts' own e^2, weighted by their energies.
    """
    weight = run.scene.mass[rows["bead"]] * rows["approach_speed"] ** 2
    if not weight.sum() > 0.0:
        return math.nan
    return math.sqrt(float((weight * rows["restitution"] ** 2).sum() / weight.sum()))


def curve(run: Run[Any], speed: Floats, radius: float) -> Floats:
    """COR of the law over speed [m/s], for a radius [m]."""
    model = ImpactModel(run.pair, run.law, outside="clamp")
    return np.asarray(model.restitution(speed, radius, run.scene.thickness))


def restitution_range(run: Run[Any]) -> tuple[float, float]:
    """Range of the colour scale: from the 2 % quantile of the COR, at most 0.9, to 1."""
    found = run.impacts["restitution"]
    low = float(np.quantile(found, 0.02)) if found.size else 0.9
    return max(0.0, min(low, 0.9)), 1.0
