"""Columns of impacts, and what was asked about them."""

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TextIO

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw._escaped import cell, line
from contactlaw.cli.parts.table import Column
from contactlaw.equation.losses import Losses
from contactlaw.equation.outcome import FIELDS
from contactlaw.model import ImpactModel
from contactlaw.physical.validity import Validity, count_flags, explain

_SHOWN: dict[str, Any] = {  # title, unit and number of these in one SI unit on a terminal
    "restitution": ("COR", "-", 1.0, "", ".4f"),
    "contact_time": ("time", "us", 1e6),
    "peak_force": ("force", "N"),
    **{f"{channel}_fraction": (channel, "%", 100.0, "", ".1f") for channel in Losses._fields},
}
COLUMNS = (
    Column("speed", "m/s", "speed", "m/s", is_input=True),
    Column("radius", "m", "radius", "mm", 1e3, is_input=True),
    Column("thickness", "m", "thickness", "mm", 1e3, is_input=True),
    *(Column(name, field.unit.strip("1"), *_SHOWN.get(name, ())) for name, field in FIELDS.items()),
    Column("yield_speed", "m/s"),
)
UNITS = {column.name: column.unit for column in COLUMNS}  # in SI, "" without one


def asked(model: ImpactModel, **sizes: float | None) -> dict[str, Any]:
    """Repeat what the user asked: names of the materials and of the law, and sizes in SI units."""
    law, (sphere, plate) = model.force_law, model.pair.given
    name = law.family if law.from_pair else law.name
    units = UNITS | {"mass": "kg"}
    numbers = {f"{n}_{units[n]}": float(size) for n, size in sizes.items() if size is not None}
    return {"sphere": sphere.name, "plate": plate.name, "law": name, **numbers}


# Old pieces, until fit, compare and constant use `Table`.


@dataclass(frozen=True, eq=False)
class ImpactTable:
    """Impacts and their results in SI units; all columns have the same length.

    The yield speed is inf if nothing yields or an impact at yield is outside the table. What is not
    known, as an end of a range, is NaN: "-", an empty cell or null.
    """

    columns: dict[str, Array]
    flags: Integers
    asked: dict[str, Any]

    def __len__(self) -> int:
        """Count the impacts."""
        return len(self.flags)


def in_words(asked: dict[str, Any]) -> str:
    """Write what was asked as a title.

    Examples
    --------
    >>> in_words({"sphere": "glass", "plate": "pom", "law": "fem", "radius_m": 0.001})
    'glass on pom, law fem, radius 0.001 m'
    """
    sphere, plate, law, *_ = asked.values()
    sizes = [(*name.split("_"), value) for name, value in [*asked.items()][3:]]
    words = (f"{name} {one} {unit}" for name, unit, one in sizes)
    return line(", ".join([f"{sphere} on {plate}, law {law}", *words]))


def text(table: ImpactTable, columns: Sequence[Column] = COLUMNS) -> Iterator[str]:
    """Lines for a terminal: what was asked, names, units, impacts, and the meaning of the flags."""
    shown = [column for column in columns if column.title]
    cells = [[column.title, f"[{column.shown}]", *_cells(table, column)] for column in shown]
    cells.append(["flags", "", *map(", ".join, map(flag_names, table.flags))])
    yield in_words(table.asked)
    yield from aligned(cells)
    yield from explained(count_flags(table.flags), len(table))


def _cells(table: ImpactTable, column: Column) -> Iterator[str]:
    values = table.columns[column.name] * column.scale
    if not column.to:
        return ("-" if math.isnan(value) else f"{value:.4g}" for value in values)
    ends = zip(values, table.columns[column.to] * column.scale, strict=True)
    return (_range(low, high) for low, high in ends)


def _range(low: float, high: float) -> str:
    """Write a range, one end of which may be NaN: not known."""
    if math.isnan(low):
        return "-" if math.isnan(high) else f"<{high:.3g}"
    return f">{low:.3g}" if math.isnan(high) else f"{low:.3g}-{high:.3g}"


def aligned(columns: Sequence[Sequence[str]]) -> Iterator[str]:
    """Pad columns to equal width, aligned on the right; the last column is left-aligned.

    Examples
    --------
    >>> for line in aligned([["COR", "[-]", "0.9"], ["flags", "", "FAST_IMPACT"]]):
    ...     print(line)
    COR  flags
    [-]
    0.9  FAST_IMPACT
    """
    *numbers, words = columns
    widths = [max(map(len, column)) for column in numbers]
    for *row, last in zip(*numbers, words, strict=True):
        padded = (cell.rjust(width) for cell, width in zip(row, widths, strict=True))
        yield f"{'  '.join(padded)}  {last}".rstrip()


def explained(flags: dict[Validity, int], total: int) -> Iterator[str]:
    """Lines with the meaning of each flag and its number of impacts; none without flags."""
    if flags:
        yield ""
    for flag, count in sorted(flags.items()):
        (words,) = explain(flag)
        yield f"{flag.name}, {count} of {total}: {words}"


def write_csv(table: ImpactTable, out: TextIO, columns: Sequence[Column] = COLUMNS) -> None:
    """Write rows with every digit; the header has names and SI units."""
    writer = csv.writer(out, lineterminator="\n")
    names = [f"{column.name}_{column.unit}" if column.unit else column.name for column in columns]
    writer.writerow([*names, *table.asked, "flags"])
    shown = (np.where(np.isnan(one), "", one.astype(object)) for one in table.columns.values())
    values = (column.tolist() for column in shown)
    flags = ("|".join(flag_names(value)) for value in table.flags)
    said = [cell(value) for value in table.asked.values()]
    writer.writerows([*row, *said, last] for *row, last in zip(*values, flags, strict=True))


def records(table: ImpactTable) -> list[dict[str, object]]:
    """Rows for JSON, which has no inf: an infinite yield speed or thickness is None."""
    values = zip(*(column.tolist() for column in table.columns.values()), strict=True)
    return [
        {name: value if value < math.inf else None for name, value in zip(table.columns, row, strict=True)}
        | {**table.asked, "flags": flag_names(flags)}
        for row, flags in zip(values, table.flags, strict=True)
    ]


def units() -> dict[str, str]:
    """SI units of the columns, "" for a column without one."""
    return {column.name: column.unit for column in COLUMNS}


def flag_names(flags: int) -> list[str]:
    """Names of the limits in a sum of flags."""
    return [str(flag.name) for flag in Validity(int(flags))]
