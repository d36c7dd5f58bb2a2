"""Impacts that have happened: the record of a run, or any table with a column of speeds."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._content import content_of
from contactlaw._errors import ArgumentError
from contactlaw.cli.parts import chosen, columns, wording
from contactlaw.physical.arguments import check
from contactlaw.physical.pair import Pair
from contactlaw.record.file import Record, read_record

Impacts = dict[str, Array]  # speed, and what is known of radius, thickness, mass, weights; in SI units


class Recorded(NamedTuple):
    """Impacts on plates of one pair of materials."""

    impacts: Impacts
    pair: Pair | None = None
    law: str | None = None


_OF_ENGINE = {"speed": "approach_speed"} | {name: name for name in ("radius", "thickness", "mass")}
_OF_TEXT = columns.IMPACT | {"weight": ("weights", 1.0), "weights": ("weights", 1.0)}


def read(*paths: str) -> list[Recorded]:
    """Read impacts on plates of each pair; bead on bead, and what is no impact, are left out.

    The files are records of one run (``.h5``), or rows of an engine as ``np.save`` writes them
    (``.npy``); or else one text with names and units in the first line, as in
    ``speed_m/s,radius_mm``. Columns called radius or diameter, thickness and weight are optional.
    """
    first = Path(paths[0])
    record = read_record(*paths) if chosen.is_record(paths) else None
    with wording.reading(first):
        found = [*_by_pair(record)] if record else [Recorded(_text(content_of(first, pipe=True)))]
        left_out = record.left_out if record else ""
        if not any(one.impacts["speed"].size for one in found):
            raise ValueError(f"it has no impact on a plate{': ' * bool(left_out)}{left_out}")
        for one in found:
            check(**one.impacts)
    if left_out:
        wording.print_warning(f"{first}: {left_out}")
    return found


def completed(impacts: Impacts, **sizes: Sequence[float] | None) -> Impacts:
    """Combine impacts with each of the sizes [m] that they lack."""
    for name, values in sizes.items():
        if values is None and name not in impacts:
            raise ArgumentError(name, None, "has to be given, no record says it")
        if values is not None and name in impacts:
            raise ArgumentError(name, None, "the record has its own: leave this one out")
        if values is not None:
            every = np.repeat(values, impacts["speed"].size)
            impacts = {field: np.tile(column, len(values)) for field, column in impacts.items()} | {name: every}
    return impacts


def _by_pair(record: Record) -> Iterator[Recorded]:
    """Impacts on plates of each pair of materials."""
    on_plate = record.impact & (record.rows["plate"] >= 0)
    for n in np.unique(record.which[on_plate]).tolist():
        rows = record.rows[on_plate & (record.which == n)]
        names = rows.dtype.names or ()
        known = {field: rows[name] for field, name in _OF_ENGINE.items() if name in names}
        if "parcel" in names:  # a row stands for all beads of a parcel
            known["weights"] = np.maximum(rows["parcel"], 1.0) ** 3
            known["mass"] = rows["mass"] / known["weights"]
        if n < 0 and "material" in names and np.ptp(rows["material"]):
            raise ValueError("it has beads of several materials: save the record as .h5, which has a result for each")
        yield Recorded(known, *record.bodies[n]) if n >= 0 else Recorded(known)


def _text(content: bytes) -> Impacts:
    """Pick the columns of a text that are known by their names, and give them SI units."""
    table = columns.read(content, _OF_TEXT)
    if table.wrong:
        raise ValueError(table.wrong[0])
    if "speed" not in table.values:
        listed = ", ".join(table.names)[:200]
        raise ValueError(f"no column of speeds in its first line, {listed!r}: call one speed_m/s")
    if "plate" in table.names:
        raise ValueError("a column plate: remove it and rows of bead on bead; give an engine's record as .h5 or .npy")
    return table.values
