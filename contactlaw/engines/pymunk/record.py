"""The adapter's record of impacts; the columns that the run does not give are filled on demand."""

from __future__ import annotations

import math
from array import array
from itertools import product
from typing import Any

import numpy as np
from numpy.lib.recfunctions import repack_fields
from numpy.typing import NDArray

from contactlaw.engines.needs import RestitutionModel, knows_rebounds
from contactlaw.engines.pymunk.models import KnownEdge, Models, ModelsByBead
from contactlaw.engines.record import IMPACT, OBSERVED, fill
from contactlaw.physical.materials import sphere_mass
from contactlaw.physical.pair import Pair
from contactlaw.physical.plates import SHEETS, sheet_of
from contactlaw.record.file import Bodies, bodies_of

# What a run gives of each impact; of friction_energy that over the mass [m2/s2]
SEEN = (*OBSERVED, "sliding_speed_after", "spin_z", "friction_energy")
WIDTH = len(SEEN)


class Register:
    """All beads and plates ever registered, by index, because the record outlives the shapes."""

    def __init__(self, models: Models) -> None:
        self.models = models
        self._radii = array("d")
        self._materials = array("l")
        self.walls: list[Any] = []  # what was given for the thicknesses
        self._plates: list[ModelsByBead] = []

    def bead(self, material: int, radius: float) -> int:
        """Add a bead and return its index."""
        self._radii.append(radius)
        self._materials.append(material)
        return len(self._radii) - 1

    def plate(self, models: ModelsByBead, wall: Any) -> int:
        """Add a plate and return its index."""
        self.walls.append(wall)
        self._plates.append(models)
        return len(self._plates) - 1

    def beads(self) -> NDArray[np.void]:
        """Radius [m] and material by index."""
        names = np.array(self.models.names())
        return _table(("radius", np.array(self._radii)), ("material", names[self.materials]))

    def plates(self) -> NDArray[np.void]:
        """Thickness [m] and material by index."""
        names = np.array([models.plate for models in self._plates], dtype="U")
        return _table(("thickness", np.array([float(sheet_of(wall)) for wall in self.walls])), ("material", names))

    @property
    def materials(self) -> NDArray[np.int64]:
        """Number of the material by bead."""
        return np.array(self._materials, dtype=np.int64)

    def every_model(self) -> list[RestitutionModel]:
        """All models of beads and plates, each once."""
        found = {id(model): model for model in self.models.all}
        for models in {id(models): models for models in self._plates}.values():
            found |= {id(model): model for model in models.values()}
        return list(found.values())

    def bodies(self, rows: NDArray[np.void]) -> tuple[list[Bodies], NDArray[np.int64]]:
        """Materials and laws of impacts, and the number of these for each row; -1: no pair."""
        found: list[Bodies] = []
        which = np.full(len(rows), -1)
        material = np.append(self.materials, -1)
        on_beads = np.stack([material[rows["bead"]], material[rows["other"]]], axis=1)
        for one, other in np.unique(on_beads[rows["other"] >= 0], axis=0).tolist():
            model: Any = self.models.of_bead(one)
            if hasattr(model, "pair"):
                pair = Pair(self.models.spheres[one], self.models.spheres[other])
                found.append(bodies_of(model)._replace(pair=pair))
                which[(on_beads == (one, other)).all(axis=1)] = len(found) - 1
        for model, own in self.by_model(rows):
            if hasattr(model, "pair"):
                found.append(bodies_of(model))
                which[own] = len(found) - 1
        return found, which

    def by_model(self, rows: NDArray[np.void]) -> list[tuple[Any, NDArray[np.bool_]]]:
        """Models, each with a mask of the impacts on plates that it answers."""
        kinds = len(self.models.spheres)
        pairs = rows["plate"] * kinds + self.materials[rows["bead"]]
        pairs, place = np.unique(pairs, return_inverse=True)
        asked = [self._plates[n // kinds][n % kinds] for n in pairs.tolist() if n >= 0]
        own = np.array([-1] * (len(pairs) - len(asked)) + [id(model) for model in asked])[place]
        return [(model, own == n) for n, model in {id(model): model for model in asked}.items()]


class Record:
    """Impacts, added one by one and read as one array."""

    def __init__(self) -> None:
        self._seen = array("d")  # 112 bytes per impact; a list of tuples takes five times that
        self.add = self._seen.extend  # takes one tuple in the order of SEEN
        self.near: dict[int, KnownEdge] = {}  # of impacts near edges, by row
        self._rows = np.empty(0, IMPACT)  # rows of the impacts that have been read

    def __len__(self) -> int:
        return len(self._seen) // WIDTH

    def read(self, register: Register) -> NDArray[np.void]:
        """Structured array of all impacts; each is looked up when it is first read, and not again.

        Unless every model is a `ReboundModel`, there are only the columns of OBSERVED.
        """
        whole = all(knows_rebounds(model) for model in register.every_model())
        seen = np.array(self._seen[len(self._rows) * WIDTH :]).reshape(-1, WIDTH)
        if len(seen):
            rows = np.zeros(len(seen), IMPACT)
            for name, column in zip(SEEN, seen.T, strict=True):
                rows[name] = column
            if whole:
                first = len(self._rows)
                near = {n - first: one for n, one in self.near.items() if n >= first}
                _complete(rows, register, near)
            self._rows = np.concatenate((self._rows, rows))
        # Once a model gives a COR alone, the rest of the run has the columns of OBSERVED only.
        return self._rows.copy() if whole else repack_fields(self._rows[list(OBSERVED)])


def _complete(rows: NDArray[np.void], register: Register, near: dict[int, KnownEdge]) -> None:
    """Look impacts up, each with the model of its materials; every model is a `ReboundModel`."""
    beads, plates, material = register.beads(), register.plates(), register.materials
    density = np.array([register.models.density(n) for n in range(len(register.models.spheres))])
    mass = sphere_mass(density[material], beads["radius"])
    on_bead = rows["other"] >= 0
    bead, other = rows["bead"], rows["other"]
    radius, rows["mass"] = beads["radius"], mass[bead]
    rows["friction_energy"] *= rows["mass"]
    rows["radius"], rows["material"] = radius[bead], material[bead]
    thickness = np.append(plates["thickness"], math.nan)[rows["plate"]]
    target = np.where(on_bead, radius[other], thickness)
    rows["thickness"] = np.where(on_bead, 0.0, target)
    # m1 m2/(m1 + m2); a plate has an infinite mass
    reduced = rows["mass"] / (1.0 + np.where(on_bead, mass[bead] / mass[other], 0.0))
    energy = 0.5 * reduced * rows["approach_speed"] ** 2
    edge, distance = np.full(len(rows), "", dtype="U9"), np.full(len(rows), math.inf)
    for n, one in near.items():
        edge[n], distance[n] = one
    bare = np.array([type(wall) in SHEETS for wall in register.walls] + [True])
    wall = np.where(bare[rows["plate"]], -1, rows["plate"])  # sheets are looked up together
    questions: list[tuple[Any, NDArray[np.bool_], Any, tuple[Any, ...]]] = []
    for model, own in register.by_model(rows):
        for kind, plate in product(np.unique(edge[own]).tolist(), np.unique(wall[own]).tolist()):
            some = own & (edge == kind) & (wall == plate)
            on = target[some] if plate < 0 else register.walls[plate]
            questions += [(model.lookup, some, on, (kind, distance[some]) if kind else ())] if some.any() else []
    met = np.stack((material[bead], material[other]), axis=1)
    for pair in np.unique(met[on_bead], axis=0).tolist():
        own = on_bead & (met == pair).all(axis=1)
        by: Any = register.models.of_bead(pair[0])
        questions.append((by.lookup_sphere_sphere, own, target[own], register.models.extra_arguments(*pair)))
    for lookup, own, on, more in questions:
        part = rows[own]
        found = lookup(part["approach_speed"], radius[bead[own]], on, *more)
        fill(part, found, energy[own])
        rows[own] = part


def _table(*columns: tuple[str, NDArray[Any]]) -> NDArray[np.void]:
    table = np.empty(len(columns[0][1]), [(name, column.dtype) for name, column in columns])
    for name, column in columns:
        table[name] = column
    return table
