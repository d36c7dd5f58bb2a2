"""Impacts that have happened: the record of a run, or any table with a column of speeds."""

import os
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw._content import content_of
from contactlaw._errors import ArgumentError
from contactlaw.cli.parts import columns, wording
from contactlaw.cli.parts.columns import TextColumn
from contactlaw.physical.arguments import check
from contactlaw.physical.kind import Kind, only_impacts
from contactlaw.physical.materials import Material, sphere_mass
from contactlaw.physical.pair import Pair
from contactlaw.quantities import SPEED
from contactlaw.record import hdf5
from contactlaw.record.file import HDF5, Record, read_record, saved


class Recorded(NamedTuple):
    """Impacts on plates in SI units, each column an array of one length; None where unknown."""

    speed: Array  # of approach [m/s]
    radius: Any = None  # of the bead [m]
    thickness: Any = None  # of the plate [m]
    weights: Any = None  # relative frequencies
    plate: Integers | None = None  # number of the plate that is hit
    mass: Array | None = None  # of the bead [kg], in an engine's record
    body: Any = False  # whether the bead is a part of a rigid body; then the mass is that at the contact
    pair: Pair | None = None
    law: str | None = None
    left_out: str = ""  # which rows of a record are no impacts


_SAME = 1e-3  # relative difference of densities; six digits of radius and mass make 2e-5
_OF_ROWS = "radius", "thickness", "mass"
_COLUMNS = {
    "speed": TextColumn(columns.SPEEDS, SPEED),
    **columns.SIZES,
    "weights": TextColumn(("weight", "weights"), None),
    "plate": TextColumn(("plate",), None),
}


def read(*paths: str | os.PathLike[str]) -> list[Recorded]:
    """Read impacts on plates of each pair; bead on bead, and what is no impact, are left out.

    The files are records of one run (``.h5``); or else one file: rows of an engine, as ``np.save``
    writes them (``.npy``), or text with names and units in the first line, as in
    ``speed_m/s,radius_mm``. Columns called radius or diameter, thickness, weight and plate are
    optional.
    """
    first = Path(paths[0])
    if len(paths) > 1 or first.suffix.lower() in HDF5:
        found = _by_pair(read_record(*paths))
    else:
        reader = _npy if first.suffix.lower() == ".npy" else _text
        with wording.reading(first):
            found = [reader(content_of(first, pipe=reader is _text))]
    with wording.reading(first):
        for one in found:
            _check(one)
    return found


def _check(found: Recorded) -> None:
    if found.speed.size == 0:
        why = f": {found.left_out}" if found.left_out else ""
        raise ValueError(f"it has no impact on a plate{why}")
    sizes = {name: getattr(found, name) for name in ("speed", "radius", "thickness", "weights")}
    check(**{name: values for name, values in sizes.items() if values is not None})


def combined(speeds: Sequence[float], radii: Sequence[float] | None, thicknesses: Sequence[float] | None) -> Recorded:
    """Take every combination of some speeds, radii and thicknesses [m/s, m, m] once."""
    sizes = {"radius": radii, "thickness": thicknesses}
    grid = np.meshgrid(*(_given(*size) for size in sizes.items()), speeds, indexing="ij")
    r, h, v = (part.ravel() for part in grid)
    return Recorded(v, r, h, np.ones(v.size))


def completed(found: Recorded, radii: Sequence[float] | None, thicknesses: Sequence[float] | None) -> Recorded:
    """Add what a record does not say: the radius of its beads, and the thickness of its plates [m].

    One value is for all; thicknesses may be one for each plate if the record has their numbers.
    """
    one = np.zeros(found.speed.size, dtype=np.int64)
    plate = one if found.plate is None or len(thicknesses or ()) == 1 else found.plate
    return found._replace(
        radius=_sized("radius", found.radius, radii, one),
        thickness=_sized("thickness", found.thickness, thicknesses, plate),
        mass=found.mass if np.any(found.body) else None,  # else it is that of solid spheres
        weights=np.ones(one.size) if found.weights is None else found.weights,
    )


def check_sphere(found: Recorded, sphere: Material) -> None:
    """Refuse a record with beads of another material, which their density betrays."""
    if found.mass is None or found.radius is None:
        return
    density = found.mass / sphere_mass(1.0, found.radius)
    others = density[~(np.isclose(density, sphere.density, rtol=_SAME) | found.body)]
    if others.size:
        counts = Counter(f"{one:.4g}" for one in others.tolist())
        listed = ", ".join(f"{n} of {one} kg/m3" for one, n in counts.most_common(5))
        raise ValueError(
            f"{len(others)} of {len(density)} impacts are of beads of other material than "
            f"{sphere.name!r} of {sphere.density:g} kg/m3: {listed}: save those of each material "
            "in a file of its own, and name it with --sphere"
        )


def _given(name: str, values: Sequence[float] | None) -> Sequence[float]:
    if values is None:
        raise ArgumentError(name, None, "has to be given, no record says it")
    return values


def _sized(name: str, recorded: Array | None, values: Sequence[float] | None, which: Integers) -> Array:
    """Size of each impact's bead or plate: the record's own, or the given one of number `which`."""
    if recorded is None:
        sizes = np.array(_given(name, values))
        if sizes.size != which.max() + 1:
            raise ArgumentError(
                name,
                None,
                f"got {sizes.size} values for {which.max() + 1} in the record: give one "
                "for all, or thicknesses for the numbers in a column plate",
            )
        return sizes[which]
    if values is not None:
        raise ArgumentError(name, None, "the record has its own: leave this one out")
    return recorded


def _by_pair(record: Record) -> list[Recorded]:
    """Impacts on plates of each pair of materials; of one that is unknown last."""
    on_plates = record.part(record.rows["plate"] >= 0)
    impacts, found = on_plates.part(on_plates.impact), []
    for n in sorted(set(impacts.which.tolist()), key=lambda n: (n < 0, n)) or [-1]:
        rows = impacts.rows[impacts.which == n]
        known = {name: rows[name] for name in _OF_ROWS if name in (rows.dtype.names or ())}
        if "parcel" in (rows.dtype.names or ()):  # a row stands for all beads of a parcel
            known["weights"] = np.maximum(rows["parcel"], 1.0) ** 3
            known["mass"] = rows["mass"] / known["weights"]
        if "kind" in (rows.dtype.names or ()):
            known["body"] = rows["kind"] == Kind.OF_BODY
        pair, law = impacts.bodies[n] if n >= 0 else (None, None)
        found.append(
            Recorded(
                rows["approach_speed"],
                plate=rows["plate"],
                pair=pair,
                law=law or None,
                left_out=on_plates.left_out,
                **known,
            )
        )
    return found


def _npy(content: bytes) -> Recorded:
    rows = saved(content)
    names = rows.dtype.names or ()

    def numbers(wanted: list[int]) -> Array:
        for n in wanted:
            if rows[names[n]].ndim != 1 or rows[names[n]].dtype.kind not in "iuf":
                raise ValueError(f"column {names[n]} holds values of type {rows.dtype[n]}, expected numbers")
        return np.column_stack([rows[names[n]] for n in wanted]).astype(np.float64)

    return _columns(names, numbers)


def _text(content: bytes) -> Recorded:
    try:
        names, rows, delimiter = columns.split_table(content)
    except ValueError as error:
        raise ValueError(f"{error}, nor HDF5 (.h5), nor of np.save (.npy)") from None
    return _columns(names, lambda wanted: columns.numbers(rows, delimiter, names, wanted)[1])


def _columns(heads: Sequence[str], numbers: Callable[[list[int]], Array]) -> Recorded:
    """Pick the columns that are known by their names, and give them SI units."""
    # Only in an engine's record does a column kind say what is an impact, and mass what of.
    more = ("kind", "mass") if "sliding_speed" in heads else ()
    found = columns.locate(heads, _COLUMNS | {one: TextColumn((one,), None) for one in more})
    if "speed" not in found:
        raise ValueError(f"no column of speeds in its first line, {', '.join(heads)[:200]!r}: call one speed_m/s")
    rows = numbers([one.place for one in found.values()])
    picked: dict[str, Any] = {
        field: column / one.per_unit for (field, one), column in zip(found.items(), rows.T, strict=True)
    }
    columns.halve_diameters(picked)
    if "plate" in picked:
        plate = picked["plate"]
        whole = (plate == np.floor(plate)) & (abs(plate) < hdf5.LARGEST)
        if not whole.all():  # NaN, too
            raise ArgumentError("plate", plate[~whole][0], "expected whole numbers")
        on_plates = plate >= 0
        picked = {field: values[on_plates] for field, values in picked.items()}
        picked["plate"] = picked["plate"].astype(np.int64)
    if "kind" not in picked:
        return Recorded(**picked)
    impact, left_out = only_impacts(picked["kind"])
    picked["body"] = picked.pop("kind") == Kind.OF_BODY
    picked = {field: values[impact] for field, values in picked.items()}
    return Recorded(**picked, left_out=left_out)
