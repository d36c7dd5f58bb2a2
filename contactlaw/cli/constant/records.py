"""Impacts that have happened: the record of a run, or any table with a column of speeds."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw._content import content_of
from contactlaw._errors import ArgumentError
from contactlaw.cli.parts import columns, wording
from contactlaw.physical.arguments import check
from contactlaw.physical.kind import Kind, only_impacts
from contactlaw.physical.materials import Material, sphere_mass
from contactlaw.physical.pair import Pair
from contactlaw.record import hdf5
from contactlaw.record.file import HDF5, Record, read_record


class Recorded(NamedTuple):
    """Impacts on plates in SI units, each column an array of one length; None where unknown."""

    speed: Array  # of approach [m/s]
    radius: Any = None  # of the bead [m]
    thickness: Any = None  # of the plate [m]
    weights: Any = None  # relative frequencies
    plate: Any = None  # number of the plate that is hit
    mass: Any = None  # of the bead [kg], in an engine's record
    body: Any = False  # whether the bead is a part of a rigid body; then the mass is that at the contact
    pair: Pair | None = None
    law: str | None = None
    left_out: str = ""  # which rows of a record are no impacts


_SAME = 1e-3  # relative difference of densities; six digits of radius and mass make 2e-5
_OF_ENGINE = {"speed": "approach_speed"} | {name: name for name in ("plate", "kind", "radius", "thickness", "mass")}
_FIELDS = columns.IMPACT | {"weight": ("weights", 1.0), "weights": ("weights", 1.0), "plate": ("plate", 1.0)}


def read(*paths: str | os.PathLike[str]) -> list[Recorded]:
    """Read impacts on plates of each pair; bead on bead, and what is no impact, are left out.

    The files are records of one run (``.h5``), or rows of an engine as ``np.save`` writes them
    (``.npy``); or else one text with names and units in the first line, as in
    ``speed_m/s,radius_mm``. Columns called radius or diameter, thickness, weight and plate are
    optional.
    """
    first = Path(paths[0])
    is_text = len(paths) == 1 and first.suffix.lower() not in (*HDF5, ".npy")
    record = None if is_text else read_record(*paths)
    with wording.reading(first):
        found = [_text(content_of(first, pipe=True))] if record is None else _by_pair(record)
        for one in found:
            if one.speed.size == 0:
                raise ValueError(f"it has no impact on a plate{': ' * bool(one.left_out)}{one.left_out}")
            sizes = {name: getattr(one, name) for name in ("speed", "radius", "thickness", "weights")}
            check(**{name: values for name, values in sizes.items() if values is not None})
    return found


def combined(speeds: Sequence[float], radii: Sequence[float] | None, thicknesses: Sequence[float] | None) -> Recorded:
    """Take every combination of some speeds, radii and thicknesses [m/s, m, m] once."""
    sizes = _known("radius", radii), _known("thickness", thicknesses)
    r, h, v = (part.ravel() for part in np.meshgrid(*sizes, speeds, indexing="ij"))
    return Recorded(v, r, h, np.ones(v.size))


def completed(found: Recorded, radii: Sequence[float] | None, thicknesses: Sequence[float] | None) -> Recorded:
    """Add what a record does not say: the radius of its beads, and the thickness of its plates [m].

    One value is for all; thicknesses may be one for each plate if the record has their numbers.
    """
    zeros = np.zeros(found.speed.size, dtype=np.int64)
    plate = zeros if found.plate is None or len(thicknesses or ()) == 1 else found.plate
    return found._replace(
        radius=_sized("radius", found.radius, radii, zeros),
        thickness=_sized("thickness", found.thickness, thicknesses, plate),
        mass=found.mass if np.any(found.body) else None,  # else it is that of solid spheres
        weights=zeros + 1.0 if found.weights is None else found.weights,
    )


def check_sphere(found: Recorded, sphere: Material) -> None:
    """Refuse a record with beads of another material, which their density betrays."""
    if found.mass is None or found.radius is None:
        return
    density = found.mass / sphere_mass(1.0, found.radius)
    others = density[~(np.isclose(density, sphere.density, rtol=_SAME) | found.body)]
    if others.size:
        raise ValueError(
            f"{others.size} of {density.size} impacts are of beads of other material than {sphere.name!r} of "
            f"{sphere.density:g} kg/m3, with densities from {others.min():.4g} to {others.max():.4g} kg/m3: save "
            "those of each material in a file of its own, and name it with --sphere"
        )


def _known(name: str, values: Sequence[float] | None) -> Sequence[float]:
    if values is None:
        raise ArgumentError(name, None, "has to be given, no record says it")
    return values


def _sized(name: str, recorded: Array | None, values: Sequence[float] | None, which: Integers) -> Array:
    """Size of each impact's bead or plate: the record's own, or the given one of number `which`."""
    if recorded is None:
        sizes = np.array(_known(name, values))
        if sizes.size != which.max() + 1:
            reason = (
                f"got {sizes.size} values for {which.max() + 1} in the record: give one for all, or thicknesses "
                "for the numbers in a column plate"
            )
            raise ArgumentError(name, None, reason)
        return sizes[which]
    if values is not None:
        raise ArgumentError(name, None, "the record has its own: leave this one out")
    return recorded


def _by_pair(record: Record) -> list[Recorded]:
    """Impacts on plates of each pair of materials; of one that is unknown last."""
    found = []
    for n in sorted({*record.which.tolist()}, key=lambda n: (n < 0, n)):
        rows = record.rows[record.which == n]
        names = rows.dtype.names or ()
        known = {field: rows[name] for field, name in _OF_ENGINE.items() if name in names}
        if "parcel" in names:  # a row stands for all beads of a parcel
            known["weights"] = np.maximum(rows["parcel"], 1.0) ** 3
            known["mass"] = rows["mass"] / known["weights"]
        pair, law = record.bodies[n] if n >= 0 else (None, "")
        found.append(_on_plates(known)._replace(pair=pair, law=law or None))
    return [one for one in found if one.speed.size] or found[:1] or [Recorded(np.empty(0))]


def _on_plates(rows: dict[str, Array]) -> Recorded:
    """Impacts among some rows; without a column plate all are on plates."""
    zeros = np.zeros(rows["speed"].size)
    on_plate = rows.get("plate", zeros) >= 0
    known: dict[str, Any] = {name: values[on_plate] for name, values in ({"kind": zeros} | rows).items()}
    kind = known.pop("kind")
    impact, left_out = only_impacts(kind)
    known["body"] = kind == Kind.OF_BODY
    return Recorded(**{name: values[impact] for name, values in known.items()}, left_out=left_out)


def _text(content: bytes) -> Recorded:
    """Pick the columns of a text that are known by their names, and give them SI units."""
    # Only in an engine's record does a column kind say what is an impact, and mass what of.
    more = ("kind", "mass") if b"sliding_speed" in content.partition(b"\n")[0] else ()
    table = columns.read(content, _FIELDS | {name: (name, 1.0) for name in more})
    picked: dict[str, Any] = {**table.values}
    if table.wrong:
        raise ValueError(table.wrong[0])
    if "speed" not in picked:
        listed = ", ".join(table.names)[:200]
        raise ValueError(f"no column of speeds in its first line, {listed!r}: call one speed_m/s")
    if "plate" in picked:
        plate = picked["plate"]
        whole = (plate == np.floor(plate)) & (abs(plate) < hdf5.LARGEST)
        if not whole.all():  # NaN, too
            raise ArgumentError("plate", plate[~whole][0], "expected whole numbers")
        picked["plate"] = plate.astype(np.int64)
    return _on_plates(picked)
