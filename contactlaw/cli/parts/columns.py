"""Text tables of named columns with units, as people and spreadsheets write them."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw.cli.parts.quantities import Quantity

Array = NDArray[np.float64]

_BRACKET = re.compile(r"(?P<name>.*?)[_ ]*[\[(](?P<unit>[^])]*)[\])]")
_MICRO = str.maketrans("µμ", "uu")  # the micro sign and the Greek letter


class Column(NamedTuple):
    """What a column may be called, in lower case with underscores, and what is in it."""

    names: tuple[str, ...]
    quantity: Quantity | None  # None for bare numbers


class Found(NamedTuple):
    """Where a column is, and how many of its units are one of the SI."""

    place: int
    per_unit: float  # to divide by, which rounds but once


def heads(content: bytes) -> tuple[list[str], list[str], str]:
    r"""Split a table into the names in its first line, its rows, and what stands between columns.

    Rows are the lines after the first; those that hold no data are empty.

    Raises
    ------
    ValueError
        What is no text.

    Examples
    --------
    >>> heads(b"Speed [m/s];COR\n0.5;0.9\n")
    (['Speed [m/s]', 'COR'], ['0.5;0.9'], ';')
    """
    try:
        first, *lines = content.decode("utf-8-sig").splitlines() or [""]
    except UnicodeDecodeError:
        raise ValueError("neither text") from None
    delimiter = next((mark for mark in "\t;" if mark in first), ",")
    names = [head.strip() for head in _fields(first.lstrip("#"), delimiter)]
    rows = ["" if line.isspace() or line.startswith("#") else line for line in lines]
    while rows and not rows[-1]:
        rows.pop()
    return names, rows, delimiter


def locate(names: Sequence[str], columns: dict[str, Column]) -> dict[str, Found]:
    """Find columns by their names; others are left alone.

    A unit follows in brackets, or after a space or an underscore; a column without one is in that
    of the SI.

    Raises
    ------
    ValueError
        Two columns of one kind, or a unit of something else.

    Examples
    --------
    >>> from contactlaw.cli.parts.quantities import SPEED
    >>> locate(["No", "Speed [cm/s]"], {"speed": Column(("speed",), SPEED)})
    {'speed': Found(place=1, per_unit=100.0)}
    """
    found: dict[str, Found] = {}
    for n, head in enumerate(names):
        for field, column in columns.items():
            unit = _unit(head, column)
            if unit is None:
                continue
            if field in found:
                raise ValueError(
                    f"two columns of {field}, {names[found[field].place]!r} and {head!r}"
                )
            found[field] = Found(n, _per_unit(head, unit, column.quantity))
    return found


def _unit(head: str, column: Column) -> str | None:
    """Take the unit of a head that is a column's name, empty without one; None: it is not."""
    bare = head.strip().lower().translate(_MICRO)
    match = _BRACKET.fullmatch(bare)
    name, unit = (match["name"], match["unit"].strip()) if match else (bare, "")
    if re.sub(r"\s+", "_", name.strip()) in column.names:
        return unit
    name, _, unit = re.sub(r"\s+", "_", bare).rpartition("_")
    units = column.quantity.units if column.quantity else {}
    return unit if name in column.names and unit in map(str.lower, units) else None


def _per_unit(head: str, unit: str, quantity: Quantity | None) -> float:
    if quantity is None or not unit:
        return 1.0
    sizes = {name.lower(): size for name, size in quantity.units.items()}
    if unit not in sizes:
        raise ValueError(
            f"column {head!r}: {unit!r} is no unit of {quantity.name}; take "
            f"{', '.join(quantity.units)}"
        )
    return float(1 / sizes[unit])


def numbers(
    rows: Sequence[str],
    delimiter: str,
    count: int,
    wanted: list[int],
    read: Callable[[str], float] = float,
) -> Array:
    """Read some columns of a table's rows.

    Parameters
    ----------
    rows : sequence of str
        As `heads` gives them.
    delimiter : str
        What stands between columns.
    count : int
        How many columns the first line names.
    wanted : list of int
        Which to read.
    read : callable, optional
        From the text of a cell to its number.

    Raises
    ------
    ValueError
        What is no number, with its row; a row with more fields than the first line, or with too
        few for the columns that are wanted.

    Examples
    --------
    >>> numbers(["1;2", "3;4"], ";", 2, [1])
    array([[2.],
           [4.]])
    """
    _check_fields(rows, delimiter, count, max(wanted, default=-1) + 1)
    rows = [row for row in rows if row]
    if not rows:  # of which loadtxt would warn
        return np.empty((0, len(wanted)))
    return np.loadtxt(
        rows, delimiter=delimiter, usecols=wanted, ndmin=2, quotechar='"', converters=read
    )


def _fields(row: str, delimiter: str) -> list[str]:
    """Split a row, less a comment at its end and the separators that spreadsheets leave there."""
    try:
        found = next(csv.reader([row.partition("#")[0]], delimiter=delimiter), [])
    except csv.Error as error:
        raise ValueError(f"{error}, in {row[:80]!r}") from None
    while found and not found[-1].strip():
        found.pop()
    return found


def _check_fields(rows: Sequence[str], delimiter: str, count: int, least: int) -> None:
    """Refuse rows with more fields than the first line: numbers would shift in silence.

    Those that end before the last wanted column, which is the `least` number of fields, are refused
    too, unless they have the separators up to there.
    """
    for line, row in enumerate(rows, start=2):
        fields = _fields(row, delimiter)
        more, fewer = len(fields) > count, len(fields) < least > row.count(delimiter) + 1
        if fields and (more or fewer):
            why = _why(row, delimiter, more)
            raise ValueError(
                f"line {line} has {_counted(len(fields), 'field')}, {row[:80]!r}, where the first "
                f"line names {_counted(count, 'column')}: {why}"
            )


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"


def _why(row: str, delimiter: str, more: bool) -> str:
    """Say what has most likely happened to a row with too many or too few fields."""
    if more and delimiter == "," and "." not in row and re.search(r"\d,\d", row):
        return (
            "a decimal comma? Write numbers with a point, 1.5, or semicolons between the columns "
            "and points in the numbers"
        )
    if more:
        return "delete what is beyond the columns, or name it in the first line"
    return "leave the cell of what was not measured empty, but keep what separates the cells"


def number_or_nan(text: str) -> float:
    """Read a number; an empty cell is NaN.

    Examples
    --------
    >>> number_or_nan(" "), number_or_nan("1e-3")
    (nan, 0.001)
    """
    return float(text) if text.strip() else math.nan
