"""The file of a run: where beads, plates, materials and impacts are in HDF5.

All writers and readers of such a file use this module. Each dataset has a unit and a description.
The columns of ``/collisions`` are those of `contactlaw.engines.record`.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict, fields
from typing import Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw.engines import hdf5
from contactlaw.engines.record import COLUMNS, IMPACT, only_impacts, typed
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair

FORMAT = "contactlaw-"  # the attribute "format" is this and the name of the scene that has run
_BODIES = "sphere", "plate"
# Fields of a material that are texts, and lists of numbers; the others are numbers.
_TEXTS = "name", "source", "kind", "uncertainty"
_LISTS = "hardening", "rate", "loss_factor"
_REQUIRED = "name", "source", "youngs_modulus", "poissons_ratio", "density"


class Hits(NamedTuple):
    """Impacts on plates in SI units, and the materials and the law of the run."""

    speed: NDArray[np.float64]
    radius: NDArray[np.float64]
    thickness: NDArray[np.float64]
    pair: Pair
    law: str
    left_out: str  # which rows are no impacts


def write(group: h5py.Group, name: str, values: object, units: str, description: str) -> None:
    """Write an array with its unit and description."""
    data = np.asarray(values)
    dataset = group.create_dataset(name, data=data, compression="gzip" if data.size else None)
    dataset.attrs.update({"units": units, "description": description})


def write_beads(file: h5py.File, radius: object, mass: object) -> h5py.Group:
    """Write the radii [m] and the masses [kg] of the beads; returns their group."""
    beads = file.create_group("beads")
    write(beads, "radius", radius, "m", "radius")
    write(beads, "mass", mass, "kg", "mass of the sphere")
    return beads


def write_plates(file: h5py.File, thickness: Iterable[float]) -> h5py.Group:
    """Write the thickness of each plate [m]; returns their group.

    A file whose plates are all alike may have an attribute ``thickness`` instead.
    """
    plates = file.create_group("plates")
    write(plates, "thickness", list(thickness), "m", "thickness, inf: half-space")
    return plates


def write_materials(file: h5py.File, sphere: Material, plate: Material) -> None:
    """Write all that is known of the two materials."""
    for body, material in zip(_BODIES, (sphere, plate), strict=True):
        values = asdict(material) | {"uncertainty": json.dumps(dict(material.uncertainty))}
        values |= {"units": "Pa (moduli, strength, hardness), kg/m3"}
        group = file.create_group(f"materials/{body}")
        group.attrs.update({name: value for name, value in values.items() if value is not None})


def write_impacts(file: h5py.File, rows: NDArray[np.void], description: str) -> None:
    """Write the table of impacts; the description defines axes, and bead and plate numbers."""
    table = file.create_group("collisions")
    table.attrs["description"] = description
    for name, _, unit, text in COLUMNS:
        if name in (rows.dtype.names or ()):
            write(table, name, rows[name], unit, text)


def impacts(file: h5py.File) -> NDArray[np.void]:
    """Read all impacts by time, with the columns of the record that the file has."""
    group = hdf5.group(file, "collisions")
    size = hdf5.numbers(group, "time").size
    columns = {n: hdf5.numbers(group, n, size) for n in IMPACT.names or () if n in group}
    table = np.empty(size, [(name, column.dtype) for name, column in columns.items()])
    for name, column in columns.items():
        table[name] = column
    return typed(table)[np.argsort(table["time"], kind="stable")]


def materials(file: h5py.File) -> tuple[Material, Material]:
    """Read the materials of the beads and of the plates."""
    group = hdf5.group(file, "materials")
    sphere, plate = (_material(hdf5.group(group, body)) for body in _BODIES)
    return sphere, plate


def hits(file: h5py.File) -> Hits:
    """Read impacts on plates with the sizes of bead and plate.

    Left out are those of bead on bead, and rows that are no impacts.
    """
    form = str(file.attrs.get("format", ""))
    if not form.startswith(FORMAT):
        raise ValueError(
            f"no record of dem-demo, whose format is {FORMAT!r} and the name of a scene, got "
            f"{form!r}"
        )
    if "thickness" in file.attrs:
        thickness = np.array([hdf5.attribute(file, "thickness", float)])
    else:
        thickness = hdf5.numbers(hdf5.group(file, "plates"), "thickness")
    radius = hdf5.numbers(hdf5.group(file, "beads"), "radius")
    table = hdf5.group(file, "collisions")
    speed = hdf5.numbers(table, "approach_speed")
    plate = hdf5.indices(table, "plate", thickness.size, speed.size)
    bead = hdf5.indices(table, "bead", radius.size, speed.size)
    on_plates = plate >= 0
    kind = hdf5.numbers(table, "kind", speed.size) if "kind" in table else np.zeros(speed.size)
    impact, left_out = only_impacts(kind[on_plates])
    if (bead[on_plates] < 0).any():  # numpy would take the last bead
        raise ValueError(
            "dataset collisions/bead has -1, no bead, in a row that hits a plate; expected a "
            f"number from 0 to {radius.size - 1}"
        )
    on_plates[on_plates] = impact
    return Hits(
        speed[on_plates],
        radius[bead[on_plates]],
        thickness[plate[on_plates]],
        Pair(*materials(file)),
        hdf5.attribute(file, "law", str),
        left_out,
    )


def _material(group: h5py.Group) -> Material:
    names = [one.name for one in fields(Material)]
    stored: dict[str, Any] = {
        name: hdf5.number_or_list(group, name)
        if name in _LISTS
        else hdf5.attribute(group, name, str if name in _TEXTS else float)
        for name in names
        if name in _REQUIRED or name in group.attrs
    }
    stored["uncertainty"] = json.loads(stored.get("uncertainty", "{}"))
    return Material(**stored)
