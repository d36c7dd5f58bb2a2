"""Constants of the contacts between bead types and walls, as rows that kernels read.

A *plate row* is for a plate of one thickness and material under beads of one type. It holds the
spring of a bead of radius 1 m, the limits of the model's validity, and the contact law.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from contactlaw._arrays import Places, Rows
from contactlaw._jit import kernel, tuple_of
from contactlaw.equation.corrections import PlateCorrections
from contactlaw.equation.edge import SIZE
from contactlaw.equation.numbers import ModulusGrowth, PlateConstants, RateOfStrain, solid_mass
from contactlaw.model import ImpactModel
from contactlaw.physical.materials import Material
from contactlaw.physical.plates import (
    ATTRIBUTES,
    EquivalentThickness,
    Foundation,
    Shell,
    check_wall,
    described,
    sheet_of,
)
from contactlaw.physical.responses import CYLINDER, RESPONSES, SPHERE, responses_of
from contactlaw.physical.scaling import swing_of, wave_path
from contactlaw.physical.strengths import COARSE, by_strength
from contactlaw.physical.validity import Limits
from contactlaw.stepping.spring import Spring, curved, resized, unit_spring
from contactlaw.walls.frame import Wall
from contactlaw.walls.plate import by_type

SOLID = 1e-6  # largest relative difference of a bead's mass from that of the model's solid sphere

PLATE_ROW = np.dtype(
    [
        (name, "f8")
        for name in (
            "tangential",
            *Spring._fields[:-1],
            *PlateConstants._fields[:-3],
            *PlateCorrections._fields,
            *ModulusGrowth._fields,
            *RateOfStrain._fields,
        )
    ]
    # the flags of an impact need the thickness and the fields of Limits
    + [("thickness", "f8")]
    + [(name, "i8" if "int" in str(kind) else "f8") for name, kind in Limits.__annotations__.items()]
    # how a plate's edges act, see `responses_of`, and by what its bending waves scale [m/s]
    + [("responses", "f8", (RESPONSES, 2 * SIZE)), ("wave_path", "f8"), ("shell_speed", "f8")]
    # frequency [1/s] and response of what swings on flat facets; what flags of layers need
    + [("swing", "f8"), ("swing_place", "i8"), *((name, "f8") for name in ("top", "softest", "pitch", "wave_of_all"))]
    # largest inelasticity that the model accepts; first bead type with equal rows on all plates
    + [("largest", "f8"), ("alike", "i8")]
    # address of the law at any strength (0: there is no model for beads of this type), and its size
    + [("law", "i8"), ("law_size", "i8"), ("passes", "i8")],  # passes: beads fly through the wall
    align=True,
)


def plate_rows(
    walls: Sequence[Wall], models: Mapping[int, ImpactModel | None], types: int
) -> tuple[Rows, list[Places], list[Any]]:
    """Plate rows by bead type and number, their numbers for each wall's facets, what they need."""
    table: dict[Any, int] = {}
    plates: dict[int, Any] = {}
    numbers = []
    for wall in walls:
        values, which = np.unique(np.asarray(sheet_of(wall.thickness), dtype=float), return_inverse=True)
        own = {**models, **by_type(wall.model, types)}
        given = getattr(wall, "given", wall.thickness)
        sheet = sheet_of(given)
        for known in filter(None, own.values()):  # where a shell has edges, the nearest one counts
            check_wall(sheet if isinstance(given, Shell) else given, known, wall.edges)
        keys = tuple((kind, id(model)) for kind, model in own.items())
        swings = tuple(getattr(given, name, None) for name in ("stiffness", "radius", "kind"))
        named, found = {float(one): one for one in described(sheet)}, []
        for value in values.tolist():
            one = named.get(value, value)
            key = keys, value, swings, *(getattr(one, name, None) for name in ATTRIBUTES)
            found.append(table.setdefault(key, len(table)))
            one = replace(given, thickness=one) if isinstance(given, Foundation | Shell) else one
            plates[found[-1]] = own, one
        numbers.append(np.array(found)[which.ravel()])
    rows = np.zeros((types, len(table)), PLATE_ROW)
    laws: list[list[Any]] = [[""] * len(table) for _ in range(types)]
    held: list[Any] = [plates]
    for number, (own, plate) in plates.items():
        for kind, model in own.items():
            row = rows[kind - 1, number]
            row["passes"] = model is None
            model = model or models.get(kind)  # which has the mass of the beads
            if model is None:
                continue
            _fill(row, model, float(sheet_of(plate)))
            _fill_wall(row, model.pair.plate, plate)
            law = by_strength(model.pair, model.force_law, COARSE)
            row["law"], row["law_size"] = law.ctypes.data, law.size
            laws[kind - 1][number], held = law.tobytes(), [*held, law]
    rows["alike"] = _first_alike(rows, laws)[:, None]
    return rows, numbers, held


def _first_alike(rows: Any, laws: list[list[Any]]) -> Places:
    """First bead type, from 0, with equal rows and laws on all plates, for each bead type.

    Laws are compared by what they are, because equal models hold their data at different addresses.
    """
    rows = rows.copy()
    rows["law"] = 0
    contents = [(row.tobytes(), keys) for row, keys in zip(rows, laws, strict=True)]
    return np.array([contents.index(one) for one in contents])


def _fill(row: Any, model: ImpactModel, thickness: float) -> None:
    row["tangential"] = model.pair.tangential_ratio
    spring = unit_spring(model, thickness)
    parts: Any = spring, spring.plate, *spring.plate[-3:], model.limits
    for part in parts:
        for name in {*part._fields}.intersection(PLATE_ROW.names or ()):
            row[name] = getattr(part, name)
    row["thickness"], plate = thickness, model.pair.plate
    row["responses"] = responses_of(plate.poissons_ratio)
    row["wave_path"] = wave_path(plate)
    row["largest"] = math.inf
    if model.outside == "raise":  # other models answer beyond their table too
        row["largest"] = model.largest_inelasticity


def _fill_wall(row: Any, plate: Material, given: Any) -> None:
    """Write what comes back from a wall, and the attributes of its layers."""
    kind, row["swing"] = swing_of(plate, given)
    row["swing_place"] = CYLINDER if kind == "cylinder" else SPHERE
    sheet, row["top"], row["softest"] = sheet_of(given), math.inf, 1.0
    square = plate.youngs_modulus / plate.density  # of the speed by which a curved wall swings
    if isinstance(sheet, EquivalentThickness):
        square = np.nan_to_num(sheet.membrane) / sheet.areal
        row["top"], row["softest"], row["pitch"] = sheet.top, sheet.alike, sheet.pitch
        row["wave_of_all"] = math.sqrt(sheet.bending / sheet.areal)
    row["shell_speed"] = math.sqrt(square)


@kernel
def spring_of(row: Any, r: float, parcel: float, bending: float, mass: float) -> Spring:
    """Spring of a bead of this radius [m] and mass [kg] on the plate of a row, which is bent: R*/R.

    A parcel stands for so many beads that are smaller by the factor `parcel`: at the same overlap
    it has their mass, their force, and a plate that gives way as under one of them.
    """
    plate = tuple_of(
        PlateConstants,
        row,
        corrections=tuple_of(PlateCorrections, row),
        growth=tuple_of(ModulusGrowth, row),
        rate=tuple_of(RateOfStrain, row),
    )
    unit = tuple_of(Spring, row, plate=plate)
    one, many = curved(resized(unit, r / parcel), bending), parcel * parcel * parcel
    solid, stiffness, mobility = one.solid * many, one.stiffness * many, one.mobility / many
    return tuple_of(Spring, one, mass=mass, solid=solid, stiffness=stiffness, mobility=mobility)


@kernel
def modelled_mass(row: Any, r: float) -> Any:
    """Mass of a solid sphere of the row's material [kg]; NaN where there is no model."""
    return solid_mass(row, r) if row.law != 0 else math.nan


@kernel
def limits_of(row: Any) -> Limits:
    """Limits of the model behind a plate row."""
    return tuple_of(Limits, row)
