"""The one table of all subcommands: for a terminal of 80 columns, as CSV and as JSON."""

import csv
import json
import math
import string
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TextIO

import numpy as np

from contactlaw._arrays import Integers
from contactlaw._escaped import cell, line
from contactlaw._readable import in_unit
from contactlaw.parser import WIDTH, wrapped
from contactlaw.physical.validity import Validity, count_flags, explain


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


@dataclass(frozen=True, eq=False)
class Table:
    """Rows of numbers in SI units, or of texts, and what was asked.

    A number that is not known is NaN: "-" on a terminal, an empty cell in CSV, null in JSON. An
    infinite number, of a half-space, is the text "inf" in JSON, which has no such number.
    """

    columns: Sequence[Column]
    values: Mapping[str, Any]  # by the names of the columns, all of one length
    asked: Mapping[str, Any] = field(default_factory=dict)  # repeated in each row of CSV and JSON
    flags: Integers | None = None  # limits of the model that each row exceeds
    counts: Mapping[Validity, int] | None = None  # impacts that exceed each, if a row has several
    total: int = 0  # impacts of these counts

    def __len__(self) -> int:
        """Count the rows."""
        return len(self.values[self.columns[0].name])

    def text(self) -> Iterator[str]:
        """Lines for a terminal: what was asked, names, units, rows, and the meaning of the flags.

        The last columns are left out if they do not fit into the width of a terminal.
        """
        shown = [column for column in self.columns if column.title]
        alike = [column for column in shown if column.is_input and np.unique(self.values[column.name]).size == 1]
        named = (f"{c.title} {in_unit(self.values[c.name][0], c.unit)}".rstrip() for c in alike)
        yield from wrapped(", ".join([*filter(None, [in_words(self.asked)]), *named]))
        cells = {c.title: [c.title, f"[{c.shown}]" * bool(c.shown), *self._cells(c)] for c in shown if c not in alike}
        letters = self._letters()
        marks = ["".join(mark for mark, flag, _ in letters if row & flag) for row in self._row_flags()]
        last = [["flags", "", *marks]] * any(marks)
        left_out = list[str]()
        while max(map(len, lines := aligned([*cells.values(), *last]))) > WIDTH and len(cells) > 1:
            left_out.insert(0, cells.popitem()[0])
        yield from lines
        remarks = [*self.remarks()]
        if left_out:
            remarks += wrapped(f"CSV has more columns than fit here: {', '.join(left_out)}.")
        yield from [""] * bool(remarks) + remarks

    def remarks(self) -> Iterator[str]:
        """Lines with the meaning of each flag, its letter, and the number of impacts that have it."""
        for mark, flag, count in self._letters():
            (words,) = explain(flag)
            yield from wrapped(f"{mark}: {flag.name}, {count} of {self.total or len(self)}: {words}", "   ")

    def _letters(self) -> list[tuple[str, Validity, int]]:
        """Letter of each flag, and its number of impacts."""
        counts = self.counts or count_flags(np.array(self._row_flags(), dtype=int))
        return [(mark, *flag) for mark, flag in zip(string.ascii_lowercase, counts.items(), strict=False)]

    def _row_flags(self) -> list[int]:
        flags: list[int] = [0] * len(self) if self.flags is None else self.flags.tolist()
        return flags

    def write_csv(self, out: TextIO, head: bool = True) -> None:
        """Write rows with every digit, below a line of names with SI units."""
        writer = csv.writer(out, lineterminator="\n")
        if head:
            last = [] if self.flags is None else ["flags"]
            heads = (f"{column.name}_{column.unit}".removesuffix("_") for column in self.columns)
            writer.writerow([*heads, *self.asked, *last])
        for row in self._rows():
            writer.writerow(cell("|".join(value) if isinstance(value, list) else value) for value in row.values())

    def records(self) -> list[dict[str, Any]]:
        """Rows for JSON."""
        return [{name: for_json(value) for name, value in row.items()} for row in self._rows()]

    def write(self, out: TextIO, form: str = "text") -> None:
        """Write the table as ``text``, ``csv`` or ``json``; JSON is a list, or the only row."""
        if form == "csv":
            self.write_csv(out)
        elif form == "json":
            rows = self.records()
            print(json.dumps(rows if len(rows) != 1 else rows[0], indent=2), file=out)
        else:
            print(*self.text(), sep="\n", file=out)

    def _rows(self) -> Iterator[dict[str, Any]]:
        """Values of each row by name, None for one that is not known, what was asked, and the names of flags."""
        names = [column.name for column in self.columns]
        values = zip(*(np.asarray(self.values[name]).tolist() for name in names), strict=True)
        for row, flag in zip(values, self._row_flags(), strict=True):
            known = (None if isinstance(value, float) and math.isnan(value) else value for value in row)
            flags = {} if self.flags is None else {"flags": flag_names(flag)}
            yield dict(zip(names, known, strict=True)) | {**self.asked} | flags

    def _cells(self, column: Column) -> Iterator[str]:
        ends = [np.asarray(self.values[name]) for name in (column.name, column.to) if name]
        if ends[0].dtype.kind not in "iuf":
            return map(str, ends[0].tolist())
        digits = column.digits or (".3g" if column.to else ".4g")
        rows = zip(*(end * column.scale for end in ends), strict=True)
        return (_joined(["" if math.isnan(number) else f"{number:{digits}}" for number in row]) for row in rows)


def for_json(value: Any) -> Any:
    """Write the thickness of a half-space as a text, since JSON has no infinite number."""
    return "inf" if value == math.inf else value


def _joined(texts: list[str]) -> str:
    """Write a number, or both ends of a range; one that is not known is empty."""
    if any(texts) and not all(texts):
        return f">{texts[0]}" if texts[0] else f"<{texts[1]}"
    return "-".join(texts) or "-"


def aligned(columns: Sequence[Sequence[str]]) -> list[str]:
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
        width, pad = max(map(len, column)), str.rjust if column[1] else str.ljust  # a column of texts has no unit
        padded.append([pad(text, width) for text in column])
    lines = ("  ".join(row).rstrip() for row in zip(*padded, strict=True))
    return [*filter(None, lines)]  # units may be missing


def in_words(asked: Mapping[str, Any]) -> str:
    """Write what was asked as a title.

    Examples
    --------
    >>> in_words({"sphere": "glass", "plate": "pom", "law": "fem", "radius_m": 0.001})
    'glass on pom, law fem, radius 1 mm'
    """
    if not asked:
        return ""
    sphere, plate, law, *sizes = asked.values()
    parts = zip((key.split("_") for key in [*asked][3:]), sizes, strict=True)  # the unit follows the name
    words = [f"{name} {in_unit(size, unit)}" for (name, unit), size in parts]
    return line(", ".join([f"{sphere} on {plate}, law {law}", *words]))


def flag_names(flags: int) -> list[str]:
    """Names of the limits in a sum of flags."""
    return [str(flag.name) for flag in Validity(int(flags))]
