"""The one table of all subcommands: for a terminal of 80 columns, as CSV and as JSON."""

import csv
import json
import math
import string
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TextIO

import numpy as np

from contactlaw._arrays import Integers
from contactlaw._escaped import cell, line
from contactlaw._readable import in_unit
from contactlaw.physical.validity import Validity, count_flags, explain

WIDTH = 80  # of a line on a terminal


class Column(NamedTuple):
    """A column of a table."""

    name: str
    unit: str = ""  # SI unit, as in CSV
    title: str = ""  # name on a terminal; a column without one is not shown there
    shown: str = "-"  # unit on a terminal, without brackets
    scale: float = 1.0  # number of these units in one SI unit
    to: str = ""  # another column, up to which this one is the lower end of a range on a terminal
    digits: str = ""  # format of the numbers on a terminal; ".4g", of a range ".3g"
    is_input: bool = False  # on a terminal the title has an input that is the same in all rows

    @property
    def head(self) -> str:
        """Name and unit in the first line of CSV."""
        return f"{self.name}_{self.unit}" if self.unit else self.name


@dataclass(frozen=True, eq=False)
class Table:
    """Rows of numbers in SI units, or of texts, and what was asked.

    A number that is not known is NaN: "-" on a terminal, an empty cell in CSV, null in JSON. An
    infinite number is null in JSON, which has none.
    """

    columns: Sequence[Column]
    values: Mapping[str, Any]  # by the names of the columns, all of one length
    asked: Mapping[str, Any] = field(default_factory=dict)  # repeated in each row of CSV and JSON
    flags: Integers | None = None  # limits of the model that each row exceeds
    counts: Mapping[Validity, int] | None = None  # impacts that exceed each, if a row has several
    total: int = 0  # impacts of these counts
    width: int = WIDTH  # of its sentences; less in comments of another program

    def __len__(self) -> int:
        """Count the rows."""
        return len(self.values[self.columns[0].name])

    def text(self) -> Iterator[str]:
        """Lines for a terminal: what was asked, names, units, rows, and the meaning of the flags.

        The last columns are left out if they do not fit into the width of a terminal.
        """
        shown = [column for column in self.columns if column.title]
        alike = [column for column in shown if column.is_input and len({*self._cells(column)}) == 1]
        named = (f"{column.title} {self._alike(column)}" for column in alike)
        title = ", ".join([*([in_words(self.asked)] if self.asked else []), *named])
        if title:
            yield from wrapped(title, "", self.width)
        cells = {c.title: [c.title, f"[{c.shown}]" * bool(c.shown), *self._cells(c)] for c in shown if c not in alike}
        letters = self._letters()
        marks = ["".join(mark for flag, (mark, _) in letters.items() if row & flag) for row in self._row_flags()]
        last = [["flags", "", *marks]] * any(marks)
        left_out = list[str]()
        while max(map(len, aligned([*cells.values(), *last]))) > WIDTH and len(cells) > 1:
            left_out.insert(0, cells.popitem()[0])
        yield from aligned([*cells.values(), *last])
        remarks = [*self.remarks()]
        if left_out:
            remarks += wrapped(f"CSV has more columns than fit here: {', '.join(left_out)}.")
        yield from [""] * bool(remarks) + remarks

    def remarks(self) -> Iterator[str]:
        """Lines with the meaning of each flag, its letter, and the number of impacts that have it."""
        for flag, (mark, count) in self._letters().items():
            (words,) = explain(flag)
            yield from wrapped(f"{mark}: {flag.name}, {count} of {self.total or len(self)}: {words}", "   ", self.width)

    def _letters(self) -> dict[Validity, tuple[str, int]]:
        """Letter of each flag, and its number of impacts."""
        counts = self.counts or count_flags(np.array(self._row_flags(), dtype=int))
        return {flag: (mark, counts[flag]) for mark, flag in zip(string.ascii_lowercase, counts, strict=False)}

    def _row_flags(self) -> list[int]:
        flags: list[int] = [0] * len(self) if self.flags is None else self.flags.tolist()
        return flags

    def write_csv(self, out: TextIO, head: bool = True) -> None:
        """Write rows with every digit, below a line of names with SI units."""
        writer = csv.writer(out, lineterminator="\n")
        last = [] if self.flags is None else ["flags"]
        if head:
            writer.writerow([*(column.head for column in self.columns), *self.asked, *last])
        repeated = [cell(value) for value in self.asked.values()]
        for row, flags in self._rows():
            texts = (cell("" if value is None else value) for value in row.values())
            writer.writerow([*texts, *repeated, *["|".join(flags)] * len(last)])

    def records(self) -> list[dict[str, Any]]:
        """Rows for JSON, which has no inf."""
        last = [] if self.flags is None else ["flags"]
        return [
            {name: None if value in (math.inf, -math.inf) else value for name, value in row.items()}
            | {**self.asked}
            | dict.fromkeys(last, flags)
            for row, flags in self._rows()
        ]

    def write(self, out: TextIO, form: str = "text") -> None:
        """Write the table as ``text``, ``csv`` or ``json``; JSON is a list, or the only row."""
        if form == "csv":
            self.write_csv(out)
        elif form == "json":
            rows = self.records()
            print(json.dumps(rows if len(rows) != 1 else rows[0], indent=2), file=out)
        else:
            print(*self.text(), sep="\n", file=out)

    def _rows(self) -> Iterator[tuple[dict[str, Any], list[str]]]:
        """Values of each row by name, None for one that is not known, and the names of its flags."""
        names = [column.name for column in self.columns]
        values = zip(*(np.asarray(self.values[name]).tolist() for name in names), strict=True)
        for row, flag in zip(values, self._row_flags(), strict=True):
            known = (None if isinstance(value, float) and math.isnan(value) else value for value in row)
            yield dict(zip(names, known, strict=True)), flag_names(flag)

    def _alike(self, column: Column) -> str:
        value = next(self._cells(column._replace(digits="")))
        return value if value == "inf" or column.shown == "-" else f"{value} {column.shown}"

    def _cells(self, column: Column) -> Iterator[str]:
        values = np.asarray(self.values[column.name])
        if values.dtype.kind not in "iuf":
            return map(str, values.tolist())
        if not column.to:
            return (
                "-" if math.isnan(value) else f"{value:{column.digits or '.4g'}}" for value in values * column.scale
            )
        ends = zip(values * column.scale, self.values[column.to] * column.scale, strict=True)
        return (_range(low, high, column.digits or ".3g") for low, high in ends)


def _range(low: float, high: float, digits: str) -> str:
    """Write a range, one end of which may be NaN: not known."""
    if math.isnan(low):
        return "-" if math.isnan(high) else f"<{high:{digits}}"
    return f">{low:{digits}}" if math.isnan(high) else f"{low:{digits}}-{high:{digits}}"


def aligned(columns: Sequence[Sequence[str]]) -> Iterator[str]:
    """Pad columns to equal width; numbers and their heads end, and texts begin, at one place.

    Examples
    --------
    >>> for line in aligned([["wall", "", "chute"], ["COR", "[-]", "0.9"], ["flags", "", "ab"]]):
    ...     print(line)
    wall   COR  flags
           [-]
    chute  0.9  ab
    """
    padded = []
    for column in columns:
        width, is_text = max(map(len, column)), column[1] == ""  # a column of texts has no unit
        padded.append([text.ljust(width) if is_text else text.rjust(width) for text in column])
    yield from filter(None, ("  ".join(row).rstrip() for row in zip(*padded, strict=True)))  # units may be missing


def wrapped(text: str, indent: str = "", width: int = WIDTH) -> list[str]:
    """Break a text into lines for a terminal; lines after the first are indented."""
    return textwrap.wrap(text, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def in_words(asked: Mapping[str, Any]) -> str:
    """Write what was asked as a title.

    Examples
    --------
    >>> in_words({"sphere": "glass", "plate": "pom", "law": "fem", "radius_m": 0.001})
    'glass on pom, law fem, radius 1 mm'
    """
    sphere, plate, law, *sizes = asked.items()
    words = (f"{name.replace('_', ' ')} {size}" for name, size in (_sized(*size) for size in sizes))
    return line(", ".join([f"{sphere[1]} on {plate[1]}, law {law[1]}", *words]))


def _sized(name: str, size: float) -> tuple[str, str]:
    """Name and size of an argument; its SI unit follows an underscore in its key."""
    bare, _, unit = name.rpartition("_")
    return bare, in_unit(size, unit)


def flag_names(flags: int) -> list[str]:
    """Names of the limits in a sum of flags."""
    return [str(flag.name) for flag in Validity(int(flags))]
