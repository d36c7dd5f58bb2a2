"""Text tables of named columns with units, as people and spreadsheets write them."""

import csv
import difflib
import math
import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw.quantities import LENGTH, Quantity

_BRACKET = re.compile(r"(?P<name>.*?)[_ ]*[\[(](?P<unit>[^])]*)[\])]")
_UNIT = re.compile(r"\d\s*([^\W\d]|%)")
_MICRO = str.maketrans("µμ", "uu")  # the micro sign and the Greek letter
_SPEED = "speed", "approach_speed", "normal_speed", "impact_speed"
SPEEDS = (*_SPEED, *(name.replace("speed", "velocity") for name in _SPEED), "v")
_TOO_MANY = "delete what is beyond the columns, or name it in the first line"
_DECIMAL_COMMA = "a decimal comma? Write numbers with a point, 1.5, or semicolons between the columns"
_TOO_FEW = "leave the cell of what was not measured empty, but keep what separates the cells"
_MISSING = ("", "n/a", "n.a.", "na", "nan", "none", "-")  # cells of what was not measured


class TextColumn(NamedTuple):
    """Possible names of a column, in lower case with underscores, and its quantity."""

    names: tuple[str, ...]
    quantity: Quantity | None  # None for bare numbers


_BEADS = ("", "bead_", "ball_", "sphere_", "particle_")
SIZES = {
    "radius": TextColumn(tuple(f"{of}radius" for of in _BEADS), LENGTH),
    "diameter": TextColumn(tuple(f"{of}diameter" for of in _BEADS), LENGTH),
    "thickness": TextColumn(("thickness", "plate_thickness"), LENGTH),
}


class Located(NamedTuple):
    """Index of a column, and the number of its units in one SI unit."""

    place: int
    per_unit: float  # values are divided by this, which rounds only once


def lines_of(content: bytes) -> list[str]:
    """Lines of a text in UTF-8, or in the characters of Windows, for µ."""
    try:
        return content.decode("utf-8-sig").splitlines() or [""]
    except UnicodeDecodeError:
        if b"\0" in content:
            raise ValueError("no text in UTF-8") from None
        return content.decode("cp1252", "replace").splitlines()


def split_table(content: bytes) -> tuple[list[str], list[str], str]:
    r"""Split a table into the names of its columns, its rows, and the delimiter of columns.

    The names are in the first line, or below comments in the first that is none. Rows are the lines
    after the first; those that hold no data are empty.

    Examples
    --------
    >>> split_table(b"# in May\nspeed,COR\n0.5,0.9\n")
    (['speed', 'COR'], ['', '0.5,0.9'], ',')
    """
    lines = lines_of(content)
    below = next((n for n, line in enumerate(lines) if not line.startswith("#")), 0)
    words = re.sub(r"\d[eE][-+]?\d|nan|inf", "", lines[below])
    head = below if re.search(r"[^\W\d]", words) else 0  # numpy's names are a comment
    delimiter = next((mark for mark in "\t;" if mark in lines[head]), ",")
    names = [name.strip() for name in _fields(lines[head].lstrip("#"), delimiter)]
    rows = ["" if line.isspace() or line.startswith("#") else line for line in lines[1:]]
    rows[:head] = [""] * head
    while rows and not rows[-1]:
        rows.pop()
    return names, rows, delimiter


def locate(names: Sequence[str], columns: dict[str, TextColumn]) -> dict[str, Located]:
    """Find columns by their names; others are ignored.

    A unit follows in brackets, or after a space or an underscore; a column without a unit is in SI
    units.

    Examples
    --------
    >>> from contactlaw.quantities import SPEED
    >>> locate(["No", "Speed [cm/s]"], {"speed": TextColumn(("speed",), SPEED)})
    {'speed': Located(place=1, per_unit=100.0)}
    """
    found: dict[str, Located] = {}
    for n, head in enumerate(names):
        for field, column in columns.items():
            per_unit = _per_unit(head, column)
            if per_unit is None:
                continue
            if field in found:
                raise ValueError(f"two columns of {field}, {names[found[field].place]!r} and {head!r}")
            found[field] = Located(n, per_unit)
    return found


def halve_diameters(picked: dict[str, Any]) -> None:
    """Put radii in the place of a column of diameters."""
    if "diameter" in picked:
        if "radius" in picked:
            raise ValueError("columns of radius and of diameter: leave one out")
        picked["radius"] = picked.pop("diameter") / 2.0


def nearest(head: str, columns: Mapping[str, TextColumn]) -> str:
    """Find the name of a column that a head may be meant for, with a question, or "".

    Examples
    --------
    >>> nearest("Velocty [mm/s]", {"speed": TextColumn(("speed", "velocity"), None)})
    ", did you mean velocity for 'Velocty [mm/s]'?"
    """
    names = [name for column in columns.values() for name in column.names if len(name) > 2]
    name, _ = _name_and_unit(head)
    for trial in (name, name.rpartition("_")[0]):  # a unit may follow an underscore
        for near in difflib.get_close_matches(trial, names, n=1, cutoff=0.7):
            return f", did you mean {near} for {head!r}?"
    return ""


def _name_and_unit(head: str) -> tuple[str, str]:
    """Name in lower case with underscores, and the unit that follows it in brackets, or ""."""
    bare = re.sub(r"\s+", "_", head.strip().lower().translate(_MICRO))
    match = _BRACKET.fullmatch(bare)
    return (match["name"], match["unit"].strip("_")) if match else (bare, "")


def _per_unit(head: str, column: TextColumn) -> float | None:
    """Count a column's units in one SI unit; None for the head of another column."""
    quantity, (name, unit) = column.quantity, _name_and_unit(head)
    units = {text.lower(): size for text, size in quantity.units.items()} if quantity else {}
    if name not in column.names:
        name, _, unit = name.rpartition("_")
        if name not in column.names or unit not in units:
            return None
    if quantity is None or not unit:
        return 1.0
    if unit not in units:
        raise ValueError(f"column {head!r}: {unit!r} is no unit of {quantity.name}; take {', '.join(quantity.units)}")
    return float(1 / units[unit])


def numbers(
    rows: Sequence[str], delimiter: str, names: Sequence[str], wanted: Sequence[int], wrong: list[str] | None = None
) -> tuple[list[int], Array]:
    """Read some columns of a table's rows: the line of the file of each row with data, its numbers.

    If the delimiter is no comma, numbers may have decimal commas. With a list `wrong`, cells may be
    empty or ``n/a``, which is NaN. Rows with too few cells, or with a cell that is no number, are
    then left out, and the list gets a sentence about each.

    Raises
    ------
    ValueError
        Of a row with more cells than there are names: a decimal comma may have moved its numbers
        into other columns. Without the list, of the other wrong rows, too.

    Examples
    --------
    >>> wrong = []
    >>> numbers(["1;2,5", ";;", "3;n/a", "4;much"], ";", ["a", "b"], [1], wrong)
    ([2, 4], array([[2.5],
           [nan]]))
    >>> wrong
    ["line 5, column 'b': 'much' is no number such as 1.5"]
    """
    lines, table = [], list[list[float]]()
    for line, row in enumerate(rows, start=2):
        fields = _fields(row, delimiter)
        count = f"line {line} fills {len(fields)} of {len(names)} columns, {row[:80]!r}"
        if len(fields) > len(names):
            comma = delimiter == "," and "." not in row and re.search(r"\d,\d", row)
            raise ValueError(f"{count}: {_DECIMAL_COMMA if comma else _TOO_MANY}")
        if not fields:
            continue
        try:
            if len(fields) < max(wanted, default=-1) + 1 > row.count(delimiter) + 1:
                raise ValueError(f"{count}: {_TOO_FEW}")
            fields += [""] * (len(names) - len(fields))
            table.append([_number(fields[n].strip(), delimiter, wrong is not None, names[n], line) for n in wanted])
            lines.append(line)
        except ValueError as error:
            if wrong is None:
                raise
            wrong.append(str(error))
    return lines, np.array(table, dtype=np.float64).reshape(len(lines), len(wanted))


def _number(text: str, delimiter: str, gaps: bool, name: str, line: int) -> float:
    if gaps and text.lower() in _MISSING:
        return math.nan
    decimal_comma = delimiter != "," and "." not in text
    try:
        return float(text.replace(",", ".") if decimal_comma else text)
    except ValueError:
        hint = "; units belong into the name of the column" * bool(_UNIT.search(text))
        raise ValueError(f"line {line}, column {name!r}: {text!r} is no number such as 1.5{hint}") from None


def _fields(row: str, delimiter: str) -> list[str]:
    """Split a row, without a comment or the delimiters that spreadsheets leave at its end."""
    try:
        found = next(csv.reader([row.partition("#")[0]], delimiter=delimiter), [])
    except csv.Error as error:
        raise ValueError(f"{error}, in {row[:80]!r}") from None
    while found and not found[-1].strip():
        found.pop()
    return found
