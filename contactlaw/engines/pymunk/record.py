"""The adapter's record of impacts; the columns that the run does not give are filled on demand."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.lib.recfunctions import repack_fields
from numpy.typing import NDArray

from contactlaw.engines.needs import knows_rebounds
from contactlaw.engines.pymunk.models import Models, name_of
from contactlaw.engines.record import IMPACT, OBSERVED, fill
from contactlaw.equation.edge import KINDS
from contactlaw.physical.materials import sphere_mass
from contactlaw.physical.pair import Pair
from contactlaw.physical.plates import SHEETS, sheet_of
from contactlaw.record.file import Bodies, bodies_of

Rows = NDArray[np.void]
KnownEdge = tuple[str, float]  # kind of an edge, and the distance from it [m]
FAR: KnownEdge = "", math.inf
# What a run gives of each impact; of friction_energy that over the mass [m2/s2]
SEEN = (*OBSERVED, "sliding_speed_after", "spin_z", "friction_energy")
WIDTH = len(SEEN) + 2  # and the kind of the nearest edge, and the distance from it [m]
EDGES = ("", *KINDS)


class Record:
    """Beads, plates and impacts, added one by one and read as arrays; it outlives the shapes."""

    def __init__(self, models: Models) -> None:
        self._models = models
        self._whole = all(map(knows_rebounds, models.by_pair.values()))  # whether all models complete the record
        self._radii, self._materials = array("d"), array("l")  # of beads
        self._plates: list[tuple[int, Any]] = []  # material, and the argument thickness
        self._seen = array("d")  # 128 bytes per impact; a list of tuples takes five times that
        self._rows = np.empty(0, IMPACT)  # rows of the impacts that have been read

    def add_bead(self, radius: float, material: int) -> int:
        """Add a bead and return its index."""
        self._radii.append(radius)
        self._materials.append(material)
        return len(self._radii) - 1

    def add_plate(self, material: int, wall: Any) -> int:
        """Add a plate and return its index."""
        self._plates.append((material, wall))
        return len(self._plates) - 1

    def add(self, seen: tuple[Any, ...], edge: KnownEdge) -> None:
        """Add an impact, its columns in the order of SEEN, and the edge that counted."""
        self._seen.extend((*seen, EDGES.index(edge[0]), edge[1]))

    def beads(self) -> Rows:
        """Radius [m] and material by index."""
        return _table("radius", self._radii, self._models.spheres, self._materials)

    def plates(self) -> Rows:
        """Thickness [m] and material by index."""
        thickness = [float(sheet_of(wall)) for _, wall in self._plates]
        return _table("thickness", thickness, self._models.plates, [number for number, _ in self._plates])

    def read(self) -> Rows:
        """Structured array of all impacts; each is looked up when it is first read, and not again.

        Unless every model can complete the record, there are only the columns of OBSERVED.
        """
        seen = np.array(self._seen[len(self._rows) * WIDTH :]).reshape(-1, WIDTH)
        if len(seen):
            rows = np.zeros(len(seen), IMPACT)
            for name, column in zip(SEEN, seen.T, strict=False):
                rows[name] = column
            if self._whole:
                self._complete(rows, seen[:, -2].astype(np.int64), seen[:, -1])
            self._rows = np.concatenate((self._rows, rows))
        return self._rows.copy() if self._whole else repack_fields(self._rows[list(OBSERVED)])

    def bodies(self, rows: Rows) -> tuple[list[Bodies], NDArray[np.int64]]:
        """Materials and laws of impacts, and the number of these for each row; -1: no pair."""
        found: list[Bodies] = []
        which, spheres = np.full(len(rows), -1), self._models.spheres
        for model, _, own, bead, other, plate, _ in self._alike(rows, np.zeros(len(rows), np.int64)):
            if hasattr(model, "pair"):
                bodies = bodies_of(model)
                if plate < 0:
                    bodies = bodies._replace(pair=Pair(spheres[bead], spheres[other]))
                if bodies not in found:
                    found.append(bodies)
                which[own] = found.index(bodies)
        return found, which

    def _alike(self, rows: Rows, edge: NDArray[np.int64]) -> Iterator[Any]:
        """Sort impacts by what one call of a model answers; `edge` numbers their edges in EDGES.

        Give the model, the rows, the materials of the beads, the plate or -1, and the edge.
        """
        material = np.append(self._materials, -1)
        keys = np.stack([material[rows["bead"]], material[rows["other"]], rows["plate"], edge], axis=1)
        kinds, which = np.unique(keys, axis=0, return_inverse=True)
        for n, (bead, other, plate, near) in enumerate(kinds.tolist()):
            models = self._models
            if plate < 0:
                model, more = models.of_beads(bead, other)
            else:
                model, more = models.of_pair(bead, self._plates[plate][0]), ()
            yield model, more, which.ravel() == n, bead, other, plate, EDGES[near]

    def _complete(self, rows: Rows, edge: NDArray[np.int64], distance: NDArray[np.float64]) -> None:
        """Look impacts up, each with the model of its materials; every model can complete the record."""
        models, radius, material = self._models, np.array(self._radii), np.array(self._materials)
        mass = sphere_mass(np.array([sphere.density for sphere in models.spheres])[material], radius)
        bead = rows["bead"]
        rows["mass"], rows["radius"], rows["material"] = mass[bead], radius[bead], material[bead]
        rows["friction_energy"] *= rows["mass"]
        rows["thickness"] = np.append(self.plates()["thickness"], 0.0)[rows["plate"]]
        # m1 m2/(m1 + m2); a plate has an infinite mass
        reduced = rows["mass"] / (1.0 + rows["mass"] / np.append(mass, math.inf)[rows["other"]])
        energy = 0.5 * reduced * rows["approach_speed"] ** 2
        for model, more, own, _, _, plate, kind in self._alike(rows, edge):
            part = rows[own]
            speed, size = part["approach_speed"], part["radius"]
            if plate < 0:
                found = model.lookup_sphere_sphere(speed, size, radius[part["other"]], *more)
            else:
                wall = self._plates[plate][1]
                on = part["thickness"] if type(wall) in SHEETS else wall
                found = model.lookup(speed, size, on, *((kind, distance[own]) if kind else ()))
            fill(part, found, energy[own])
            rows[own] = part


def _table(size: str, sizes: Any, known: list[Any], materials: Any) -> Rows:
    material = np.array([name_of(one) for one in known])[np.array(materials, np.int64)]
    table = np.empty(len(material), [(size, np.float64), ("material", material.dtype)])
    table[size], table["material"] = sizes, material
    return table
