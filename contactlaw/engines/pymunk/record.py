"""The adapter's record of impacts; the columns that the run does not give are filled on demand."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.lib.recfunctions import repack_fields
from numpy.typing import NDArray

from contactlaw.engines.needs import knows_rebounds
from contactlaw.engines.pymunk.models import Models, ModelsByBead
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


class Question(NamedTuple):
    """Impacts that one call of a model answers."""

    model: Any
    rows: NDArray[np.bool_]
    bead: int  # number of the bead's material
    other: int  # of the other bead's; -1: a plate
    wall: Any  # what was given for the plate's thickness; None for bare sheets, which may differ
    edge: str


class Register:
    """All beads and plates ever registered, by index, because the record outlives the shapes."""

    def __init__(self, models: Models) -> None:
        self.models = models
        self.whole = all(map(knows_rebounds, models.all))  # whether all models complete the record
        self._radii, self._materials = array("d"), array("l")
        self._walls: list[Any] = []  # what was given for the thicknesses
        self._plates: list[ModelsByBead] = []
        self._alike = array("l")  # the first plate of which a model is asked together with this one
        self._sheets: dict[int, int] = {}  # first bare sheet, by the id of its models

    def bead(self, material: int, radius: float) -> int:
        """Add a bead and return its index."""
        self._radii.append(radius)
        self._materials.append(material)
        return len(self._radii) - 1

    def plate(self, models: ModelsByBead, wall: Any) -> int:
        """Add a plate and return its index."""
        self.whole = self.whole and all(map(knows_rebounds, models.values()))
        index = len(self._plates)
        self._walls.append(wall)
        self._plates.append(models)
        self._alike.append(self._sheets.setdefault(id(models), index) if type(wall) in SHEETS else index)
        return index

    def beads(self) -> Rows:
        """Radius [m] and material by index."""
        names = np.array(self.models.names())
        return _table(radius=np.array(self._radii), material=names[self.materials])

    def plates(self) -> Rows:
        """Thickness [m] and material by index."""
        thickness = np.array([float(sheet_of(wall)) for wall in self._walls])
        return _table(thickness=thickness, material=np.array([models.plate for models in self._plates], dtype="U"))

    @property
    def materials(self) -> NDArray[np.int64]:
        """Number of the material by bead."""
        return np.array(self._materials, dtype=np.int64)

    def questions(self, rows: Rows, edge: NDArray[np.int64]) -> Iterator[Question]:
        """Sort impacts by the model that answers, with the numbers of their edges in EDGES."""
        material, alike = np.append(self.materials, -1), np.array([*self._alike, -1])
        keys = np.stack([material[rows["bead"]], material[rows["other"]], alike[rows["plate"]], edge], axis=1)
        kinds, which = np.unique(keys, axis=0, return_inverse=True)
        for n, (bead, other, plate, near) in enumerate(kinds.tolist()):
            model = self._plates[plate][bead] if other < 0 else self.models.of_bead(bead)
            wall = self._walls[plate] if other < 0 and type(self._walls[plate]) not in SHEETS else None
            yield Question(model, which.ravel() == n, bead, other, wall, EDGES[near])

    def bodies(self, rows: Rows) -> tuple[list[Bodies], NDArray[np.int64]]:
        """Materials and laws of impacts, and the number of these for each row; -1: no pair."""
        known: dict[tuple[int, int, int], int] = {}
        found: list[Bodies] = []
        which = np.full(len(rows), -1)
        for model, own, bead, other, *_ in self.questions(rows, np.zeros(len(rows), np.int64)):
            if hasattr(model, "pair"):
                key = id(model), bead if other >= 0 else -1, other
                if key not in known:
                    known[key], bodies = len(found), bodies_of(model)
                    spheres = self.models.spheres
                    found.append(bodies if other < 0 else bodies._replace(pair=Pair(spheres[bead], spheres[other])))
                which[own] = known[key]
        return found, which


class Record:
    """Impacts, added one by one and read as one array."""

    def __init__(self) -> None:
        self._seen = array("d")  # 128 bytes per impact; a list of tuples takes five times that
        self._rows = np.empty(0, IMPACT)  # rows of the impacts that have been read

    def add(self, seen: tuple[float, ...], edge: KnownEdge = FAR) -> None:
        """Add an impact, its columns in the order of SEEN, and the edge that counted."""
        self._seen.extend((*seen, EDGES.index(edge[0]), edge[1]))

    def read(self, register: Register) -> Rows:
        """Structured array of all impacts; each is looked up when it is first read, and not again.

        Unless every model is a `ReboundModel`, there are only the columns of OBSERVED.
        """
        seen = np.array(self._seen[len(self._rows) * WIDTH :]).reshape(-1, WIDTH)
        if len(seen):
            rows = np.zeros(len(seen), IMPACT)
            for name, column in zip(SEEN, seen.T, strict=False):
                rows[name] = column
            if register.whole:
                _complete(rows, register, seen[:, -2].astype(np.int64), seen[:, -1])
            self._rows = np.concatenate((self._rows, rows))
        # Once a model gives a COR alone, the rest of the run has the columns of OBSERVED only.
        return self._rows.copy() if register.whole else repack_fields(self._rows[list(OBSERVED)])


def _complete(rows: Rows, register: Register, edge: NDArray[np.int64], distance: NDArray[np.float64]) -> None:
    """Look impacts up, each with the model of its materials; every model is a `ReboundModel`."""
    radius, material, models = register.beads()["radius"], register.materials, register.models
    mass = sphere_mass(np.array([models.density(n) for n in range(len(models.spheres))])[material], radius)
    bead, other, on_bead = rows["bead"], rows["other"], rows["other"] >= 0
    rows["mass"], rows["radius"], rows["material"] = mass[bead], radius[bead], material[bead]
    rows["friction_energy"] *= rows["mass"]
    rows["thickness"] = np.where(on_bead, 0.0, np.append(register.plates()["thickness"], 0.0)[rows["plate"]])
    # m1 m2/(m1 + m2); a plate has an infinite mass
    reduced = rows["mass"] / (1.0 + np.where(on_bead, mass[bead] / mass[other], 0.0))
    energy = 0.5 * reduced * rows["approach_speed"] ** 2
    for model, own, one, two, wall, kind in register.questions(rows, edge):
        part = rows[own]
        speed, size, on = part["approach_speed"], part["radius"], part["thickness"] if wall is None else wall
        if two < 0:
            found = model.lookup(speed, size, on, *((kind, distance[own]) if kind else ()))
        else:
            found = model.lookup_sphere_sphere(speed, size, radius[part["other"]], *models.extra_arguments(one, two))
        fill(part, found, energy[own])
        rows[own] = part


def _table(**columns: NDArray[Any]) -> Rows:
    table = np.empty(len(next(iter(columns.values()))), [(name, column.dtype) for name, column in columns.items()])
    for name, column in columns.items():
        table[name] = column
    return table
