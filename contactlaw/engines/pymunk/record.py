"""The record of impacts that an adapter keeps: raw numbers during the run, the rest on demand."""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

RAW = np.dtype(
    [("time", "f8"), ("bead", "i8"), ("plate", "i8"), ("other", "i8"), ("x", "f8"), ("y", "f8")]
    + [("approach_speed", "f8"), ("restitution", "f8")]
)
DERIVED = np.dtype(
    [("contact_time", "f8"), ("peak_force", "f8"), ("plastic_energy", "f8"), ("wave_energy", "f8")]
)


class Record:
    """Impacts, added one by one and read as one array."""

    def __init__(self) -> None:
        self._numbers = array("d")  # 64 bytes per impact; a list of tuples takes five times that
        self.add = self._numbers.extend  # takes one tuple in the order of RAW

    def read(
        self, model: Any, radii: Sequence[float], plates: Sequence[tuple[Any, float]]
    ) -> NDArray[np.void]:
        """Structured array of all impacts.

        Parameters
        ----------
        model : ImpactModel
            That of the beads. Without ``lookup`` and ``lookup_sphere_sphere``, here and in every
            plate's model, the columns of DERIVED are left out.
        radii : sequence of float
            Of the beads, by index [m].
        plates : sequence of (model, thickness [m])
            By index.
        """
        raw = np.array(self._numbers).reshape(-1, len(RAW.descr))
        models = {id(m): m for m in (model, *(m for m, _ in plates))}
        derived = hasattr(model, "lookup_sphere_sphere")
        derived = derived and all(hasattr(m, "lookup") for m in models.values())
        rows = np.zeros(len(raw), RAW.descr + (DERIVED.descr if derived else []))
        for name, column in zip(RAW.names or (), raw.T, strict=True):
            rows[name] = column
        if derived:
            radius = np.array(radii)
            for each in models.values():
                _fill_on_plates(rows, each, radius, plates)
            _fill_bead_on_bead(rows, model, radius)
        return rows


def _fill_on_plates(
    rows: NDArray[np.void], model: Any, radius: Array, plates: Sequence[tuple[Any, float]]
) -> None:
    """Complete the rows of the plates that answer to this model."""
    own = np.array([m is model for m, _ in plates] + [False])  # last: plate -1, bead on bead
    chosen = own[rows["plate"]]
    if chosen.any():
        thickness = np.array([h for _, h in plates])[rows["plate"][chosen]]
        bead = radius[rows["bead"][chosen]]
        rebound = model.lookup(rows["approach_speed"][chosen], bead, thickness)
        _fill(rows, chosen, rebound, _mass(model, bead))


def _fill_bead_on_bead(rows: NDArray[np.void], model: Any, radius: Array) -> None:
    chosen = rows["other"] >= 0
    if chosen.any():
        bead, other = radius[rows["bead"][chosen]], radius[rows["other"][chosen]]
        rebound = model.lookup_sphere_sphere(rows["approach_speed"][chosen], bead, other)
        mass, other_mass = _mass(model, bead), _mass(model, other)
        _fill(rows, chosen, rebound, mass * other_mass / (mass + other_mass))


def _mass(model: Any, radius: Array) -> Array:
    mass: Array = 4.0 / 3.0 * math.pi * radius**3 * model.pair.sphere.density
    return mass


def _fill(rows: NDArray[np.void], chosen: NDArray[np.bool_], rebound: Any, mass: Array) -> None:
    energy = 0.5 * mass * rows["approach_speed"][chosen] ** 2
    rows["contact_time"][chosen] = rebound.contact_time
    rows["peak_force"][chosen] = rebound.peak_force
    rows["plastic_energy"][chosen] = rebound.plastic_fraction * energy
    rows["wave_energy"][chosen] = rebound.wave_fraction * energy
