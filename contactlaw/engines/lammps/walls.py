"""Walls as the adapter's kernel reads them: sheets, facets, and frames that move as one.

A *sheet* is what the law needs of a thickness and of the bead's material. A *facet* is a rectangle
or a triangle of a sheet. A *frame* holds the facets of all walls of one motion, in coordinates that
do not change, and a grid by which those near a bead are found.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw.engines.lammps.grid import GRID, Grid
from contactlaw.engines.lammps.mesh import Mesh
from contactlaw.engines.lammps.motion import MOTION, POSE
from contactlaw.engines.lammps.plate import Models, Plate, check_models
from contactlaw.equation.numbers import PlateConstants
from contactlaw.equation.waves import Waves
from contactlaw.model import ImpactModel
from contactlaw.physical.validity import Limits
from contactlaw.softsphere import Spring, unit_spring

Rows = NDArray[np.void]
Wall = Plate | Mesh

SHEET = np.dtype(
    [
        (name, "f8")
        for name in (
            "tangential",
            *Spring._fields[:-1],
            *PlateConstants._fields[:-1],
            *Waves._fields,
        )
    ]
    # of the flags of an impact, beside what a Limits has
    + [("thickness", "f8")]
    + [
        (name, "i8" if "int" in str(kind) else "f8")
        for name, kind in Limits.__annotations__.items()
    ]
    # largest inelasticity that the model answers; first atom type with the same row on all sheets
    + [("largest", "f8"), ("alike", "i8")]
    # address and size of the law; 0: there is no model for beads of this type
    + [("law", "i8"), ("law_size", "i8")],
    align=True,
)
RECTANGLE, TRIANGLE = 4, 3
FACET = np.dtype(
    # of a rectangle unit vectors, of a triangle its edges
    [("corner", "f8", 3), ("normal", "f8", 3), ("a", "f8", 3), ("b", "f8", 3)]
    + [("length_a", "f8"), ("length_b", "f8"), ("between", "f8")]  # between: a . b
    + [(name, "i8") for name in ("kind", "sheet", "frame", "wall", "triangle")],
    align=True,
)
FRAME = np.dtype(
    [*MOTION, *POSE, *GRID, ("fastest", "f8")],  # of any point of it [m/s]
    align=True,
)


class Compiled(NamedTuple):
    """Walls in the kernel's words; the arrays that its addresses point to, too."""

    sheets: Rows  # (atom types, sheets)
    facets: Rows
    frames: Rows
    held: list[Any]


def checked(walls: Any, models: Any, types: int) -> tuple[list[Wall], dict[int, ImpactModel]]:
    """Refuse walls that the models of the beads cannot serve; models by atom type."""
    if models is None:
        raise TypeError("model: expected a contactlaw.ImpactModel, got None")
    check_models(models)
    own = _by_type(models, types)
    if not own:
        raise ValueError("model: has none for any atom type")
    for kind in own:
        if kind > types:
            raise ValueError(f"model: there is no atom type {kind}, the box has {types}")
    if not isinstance(walls, Sequence):
        raise TypeError(f"plates: expected a list of plates and meshes, got {walls!r}")
    found = list(walls)
    if not found:
        raise ValueError("plates: at least one contactlaw.engines.lammps.Plate or Mesh is needed")
    for wall in found:
        if not isinstance(wall, Wall):
            raise TypeError(
                f"plates: expected Plate or Mesh of contactlaw.engines.lammps, got {wall!r}"
            )
        for kind, model in _by_type(wall.model, types).items():
            beads = own.get(kind)
            if beads is None:
                raise ValueError(
                    f"plates: have a model for atom type {kind}, for which attach() got none; give "
                    f"them a dict of models for the atom types {sorted(own)}"
                )
            if (model.force_law.family, model.pair.sphere) != (
                beads.force_law.family,
                beads.pair.sphere,
            ):
                raise ValueError(
                    f"plates: {model!r} is for another law or other beads than {beads!r}; plates "
                    "may differ in their own material only"
                )
    return found, own


def _by_type(models: Models | None, types: int) -> dict[int, ImpactModel]:
    if models is None:
        return {}
    if isinstance(models, Mapping):
        return {int(kind): model for kind, model in models.items()}
    return dict.fromkeys(range(1, types + 1), models)


def compiled(
    walls: Sequence[Wall], models: Mapping[int, ImpactModel], types: int, largest: float
) -> Compiled:
    """Walls as the kernel reads them, with grids for beads of up to a largest radius [m]."""
    sheets: dict[Any, int] = {}
    groups: dict[Any, list[Rows]] = {}
    for number, wall in enumerate(walls):
        rows = _rectangle(wall) if isinstance(wall, Plate) else _triangles(wall)
        thickness = np.broadcast_to(np.asarray(wall.thickness, dtype=float), rows.shape)
        values, which = np.unique(thickness, return_inverse=True)
        own = {kind: id(model) for kind, model in {**models, **_by_type(wall.model, types)}.items()}
        keys = [(tuple(own.items()), float(value)) for value in values]
        numbers = [sheets.setdefault(key, len(sheets)) for key in keys]
        rows["sheet"], rows["wall"] = np.array(numbers)[which.ravel()], number
        groups.setdefault(wall.motion, []).append(rows)
    by_id = {id(model): model for model in _all_models(walls, models, types)}
    table = np.zeros((types, len(sheets)), SHEET)
    laws = [[""] * len(sheets) for _ in range(types)]
    for (kinds, thickness), number in sheets.items():
        for kind, model in kinds:
            _fill_sheet(table[kind - 1, number], by_id[model], thickness)
            laws[kind - 1][number] = by_id[model].force_law.key
    table["alike"] = _first_alike(table, laws)[:, None]
    facets = np.concatenate([rows for parts in groups.values() for rows in parts])
    frames, held, first = np.zeros(len(groups), FRAME), [], 0
    for number, (motion, parts) in enumerate(groups.items()):
        frame, count = frames[number], sum(map(len, parts))
        facets["frame"][first : first + count] = number
        corners = _corners(facets[first : first + count])
        if motion is not None:
            motion.fill(frame)
        grid = Grid(corners, first, largest)
        grid.fill(frame)
        frame["fastest"] = 0.0 if motion is None else _fastest(motion, corners)
        held += [motion, grid]
        first += count
    return Compiled(table, facets, frames, [*held, *by_id.values()])


def _all_models(
    walls: Sequence[Wall], models: Mapping[int, ImpactModel], types: int
) -> list[ImpactModel]:
    return [*models.values(), *(m for wall in walls for m in _by_type(wall.model, types).values())]


def _first_alike(table: Any, laws: list[list[str]]) -> NDArray[np.intp]:
    """First atom type, from 0, with the same numbers and laws on all sheets, for each type.

    Laws are compared by their keys: equal models have the data at addresses of their own.
    """
    numbers = [name for name in SHEET.names or () if name != "law"]
    said = [(row[numbers].tolist(), keys) for row, keys in zip(table, laws, strict=True)]
    return np.array([said.index(one) for one in said])


def _fill_sheet(row: Any, model: ImpactModel, thickness: float) -> None:
    row["tangential"] = 8.0 * model.pair.effective_shear_modulus
    spring = unit_spring(model, thickness)
    parts: dict[str, Any] = spring._asdict() | model.limits._asdict()
    parts |= parts.pop("plate")._asdict()
    parts |= parts.pop("waves")._asdict()
    for name, value in parts.items():
        row[name] = value
    law = model.force_law.data
    row["law"], row["law_size"] = law.ctypes.data, law.size
    row["thickness"] = thickness
    row["largest"] = math.inf
    if model.outside == "raise":  # other models are asked for what is beyond their table
        row["largest"] = model.largest_inelasticity


def _rectangle(plate: Plate) -> Rows:
    row = np.zeros(1, FACET)
    a, b = np.asarray(plate.edge_a, dtype=float), np.asarray(plate.edge_b, dtype=float)
    row["kind"], row["triangle"] = RECTANGLE, -1
    row["corner"] = plate.corner
    row["length_a"], row["length_b"] = np.linalg.norm(a), np.linalg.norm(b)
    row["a"], row["b"] = a / row["length_a"], b / row["length_b"]
    row["normal"] = np.cross(row["a"], row["b"])
    return row


def _triangles(mesh: Mesh) -> Rows:
    rows = np.zeros(len(mesh.triangles), FACET)
    first, second, third = (mesh.vertices[mesh.triangles[:, n]] for n in range(3))
    rows["kind"], rows["triangle"] = TRIANGLE, mesh.kept
    rows["corner"], rows["a"], rows["b"] = first, second - first, third - first
    rows["length_a"] = np.linalg.norm(rows["a"], axis=1)
    rows["length_b"] = np.linalg.norm(rows["b"], axis=1)
    rows["between"] = (rows["a"] * rows["b"]).sum(axis=1)
    normal = np.cross(rows["a"], rows["b"])
    rows["normal"] = normal / np.linalg.norm(normal, axis=1)[:, None]
    return rows


def _corners(facets: Rows) -> NDArray[np.float64]:
    """Corners of facets, shape (n, 4, 3) [m]; a triangle has one of them twice."""
    box = facets["kind"] == RECTANGLE
    a = facets["a"] * np.where(box, facets["length_a"], 1.0)[:, None]
    b = facets["b"] * np.where(box, facets["length_b"], 1.0)[:, None]
    here = facets["corner"]
    return np.stack((here, here + a, here + a * box[:, None] + b, here + b), axis=1)


def _fastest(motion: Any, corners: NDArray[np.float64]) -> float:
    """Bound of the speed of any point of a frame [m/s]."""
    row = np.zeros(1, FRAME)[0]
    motion.fill(row)
    arm = np.linalg.norm(corners - row["hub"], axis=2).max()
    table = 0.0
    if row["count"]:
        steps = np.diff(motion.displacements, axis=0) / np.diff(motion.times)[:, None]
        table = float(np.linalg.norm(steps, axis=1).max())
    return float(
        np.linalg.norm(row["velocity"])
        + abs(row["spin"]) * arm
        + row["frequency"] * np.linalg.norm(row["amplitude"])
        + table
    )
