"""Constants of the contacts between bead types and walls, as rows that kernels read.

A *sheet* is a plate of one thickness and material under beads of one type. Its row holds the spring
of a bead of radius 1 m, the limits of the model's validity, and the contact law.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation.numbers import PlateConstants
from contactlaw.equation.waves import Waves
from contactlaw.model import ImpactModel
from contactlaw.physical.validity import Limits
from contactlaw.stepping.spring import Spring, resized, unit_spring
from contactlaw.walls.frame import Wall
from contactlaw.walls.plate import by_type

Rows = NDArray[np.void]

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
    # the flags of an impact need the thickness and the fields of Limits
    + [("thickness", "f8")]
    + [
        (name, "i8" if "int" in str(kind) else "f8")
        for name, kind in Limits.__annotations__.items()
    ]
    # largest inelasticity that the model accepts; first bead type with equal rows on all sheets
    + [("largest", "f8"), ("alike", "i8")]
    # address and size of the law; 0: there is no model for beads of this type
    + [("law", "i8"), ("law_size", "i8")],
    align=True,
)


def sheets(
    walls: Sequence[Wall], models: Mapping[int, ImpactModel], types: int
) -> tuple[Rows, list[NDArray[np.intp]], list[ImpactModel]]:
    """Sheets by bead type and number, the sheet numbers of each wall's facets, and the models."""
    table: dict[Any, int] = {}
    numbers = []
    by_id = {id(model): model for model in models.values()}
    for wall in walls:
        values, which = np.unique(np.asarray(wall.thickness, dtype=float), return_inverse=True)
        own = {**models, **by_type(wall.model, types)}
        by_id |= {id(model): model for model in own.values()}
        keys = tuple((kind, id(model)) for kind, model in own.items())
        found = [table.setdefault((keys, float(value)), len(table)) for value in values]
        numbers.append(np.array(found)[which.ravel()])
    rows = np.zeros((types, len(table)), SHEET)
    laws = [[""] * len(table) for _ in range(types)]
    for (kinds, thickness), number in table.items():
        for kind, model in kinds:
            _fill(rows[kind - 1, number], by_id[model], thickness)
            laws[kind - 1][number] = by_id[model].force_law.key
    rows["alike"] = _first_alike(rows, laws)[:, None]
    return rows, numbers, list(by_id.values())


def _first_alike(rows: Any, laws: list[list[str]]) -> NDArray[np.intp]:
    """First bead type, from 0, with equal rows and laws on all sheets, for each bead type.

    Laws are compared by their keys, because equal models hold their data at different addresses.
    """
    numbers = [name for name in SHEET.names or () if name != "law"]
    said = [(row[numbers].tolist(), keys) for row, keys in zip(rows, laws, strict=True)]
    return np.array([said.index(one) for one in said])


def _fill(row: Any, model: ImpactModel, thickness: float) -> None:
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
    if model.outside == "raise":  # other models answer beyond their table too
        row["largest"] = model.largest_inelasticity


@kernel
def spring_of(sheet: Any, r: float) -> Spring:
    """Spring of a bead of this radius [m] on a sheet."""
    waves = Waves(
        sheet.eta, sheet.eta_h, sheet.eta4, sheet.beyond, sheet.steepest, sheet.bulk_factor,
        sheet.p1, sheet.p2, sheet.p3, sheet.p4, sheet.p5,
    )  # fmt: skip
    plate = PlateConstants(
        sheet.inelasticity, sheet.transit, sheet.reach, sheet.saturated, waves
    )  # fmt: skip
    unit = Spring(
        sheet.mass, sheet.stiffness, sheet.mobility, sheet.scale, sheet.relaxation, sheet.ratio,
        plate,
    )  # fmt: skip
    return resized(unit, r)


@kernel
def limits_of(sheet: Any) -> Limits:
    """Limits of the model behind a sheet."""
    return Limits(
        sheet.slender, sheet.slowness, sheet.always, sheet.yielded, sheet.trusted, sheet.fastest,
        sheet.swiftest, sheet.share, sheet.deepest, sheet.bending, sheet.damage, sheet.untried,
    )  # fmt: skip
