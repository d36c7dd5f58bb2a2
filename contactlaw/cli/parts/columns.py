"""Text tables of named columns with units, as people and spreadsheets write them."""

import csv
import math
import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw.quantities import LENGTH, SPEED, Quantity

Fields = Mapping[str, tuple[str, float]]  # field of each head, and the number of its units in one SI unit

_MICRO = str.maketrans("µμ", "uu")  # the micro sign and the Greek letter
_NUMBER = re.compile(r"\s*([-+.]?\d|nan|inf)")
_MISSING = "", "n/a", "n.a.", "na", "none", "-"  # cells without a measurement


def heads(field: str, quantity: Quantity, names: str) -> dict[str, tuple[str, float]]:
    """Heads of a column for `Fields`: each of its names alone, in SI units, and with each unit."""
    sizes = {"": 1.0} | {f"_{unit}".lower(): float(1 / size) for unit, size in quantity.units.items()}
    return {name + unit: (field, per_si) for name in names.split() for unit, per_si in sizes.items()}


# A column of diameters is one of radii, in units that are half as long.
DIAMETER = Quantity("diameter", {unit: size / 2 for unit, size in LENGTH.units.items()})
_SPEEDS = "speed approach_speed normal_speed impact_speed"
IMPACT = {
    **heads("speed", SPEED, f"{_SPEEDS} {_SPEEDS.replace('speed', 'velocity')} v"),
    **heads("radius", LENGTH, "radius bead_radius ball_radius sphere_radius particle_radius"),
    **heads("radius", DIAMETER, "diameter bead_diameter ball_diameter sphere_diameter particle_diameter"),
    **heads("thickness", LENGTH, "thickness plate_thickness"),
}


class Columns(NamedTuple):
    """Columns of a table in SI units, by their fields."""

    values: dict[str, Array]  # NaN where a cell says that nothing was measured
    lines: Integers  # line of the file of each row
    names: list[str]  # of all columns, as the file has them
    unused: list[str]  # those of other columns
    wrong: list[str]  # a sentence about each row that is left out
    comments: str  # above the table


def read(content: bytes, fields: Fields) -> Columns:
    r"""Read the columns with a known name; a unit follows it in brackets, or after an underscore.

    Names are in the first line that is no comment, or in the comment above the first number, as
    `np.savetxt` writes them. Between tabs or semicolons, numbers may have decimal commas.

    Raises
    ------
    ValueError
        Two columns of one field, or a row with more cells than there are names: a decimal comma
        may have moved its numbers into other columns.

    Examples
    --------
    >>> table = read(b"No;Speed [cm/s]\n1;2,5\n;;\n3;n/a\n4;much", IMPACT)
    >>> table.values, table.lines, table.unused
    ({'speed': array([0.025,   nan])}, array([2, 4]), ['No'])
    >>> table.wrong
    ["line 5, column 'Speed [cm/s]': 'much' is no number such as 1.5"]
    """
    lines = _lines(content)
    top = next((n for n, text in enumerate(lines) if not text.startswith("#")), len(lines))
    if top and (top == len(lines) or _NUMBER.match(lines[top])):
        top -= 1
    delimiter = next((mark for mark in "\t;" if mark in lines[top]), ",")
    without_comments = (text.partition("#")[0] for text in [lines[top].lstrip("#"), *lines[top + 1 :]])
    rows = csv.reader(without_comments, delimiter=delimiter, strict=True)
    names = [name.strip() for name in next(rows, [])]
    places = _located(names, fields)
    table, numbers, wrong = list[list[float]](), list[int](), list[str]()
    for row in rows:
        cells, line = [cell.strip() for cell in row], top + rows.line_num
        count = f"line {line} fills {len(cells)} of {len(names)} columns, {delimiter.join(row)[:80]!r}"
        if any(cells[len(names) :]):
            raise ValueError(
                f"{count}: a decimal comma? Write numbers with a point, or semicolons between the columns; else delete "
                "what is beyond the columns, or name it in the first line"
            )
        if not any(cells):
            continue
        try:
            table.append([_number(cells[n], delimiter, names[n]) for n in places.values()])
            numbers.append(line)
        except IndexError:
            wrong.append(f"{count}: leave the cell of what was not measured empty, but keep what separates the cells")
        except ValueError as error:
            wrong.append(f"line {line}, {error}")
    columns = np.array(table, dtype=np.float64).reshape(len(table), len(places)).T
    return Columns(
        {
            field: values / fields[_head(names[n])][1]
            for (field, n), values in zip(places.items(), columns, strict=True)
        },
        np.array(numbers, dtype=np.int64),
        names,
        [name for n, name in enumerate(names) if name and n not in places.values()],
        wrong,
        "\n".join(text[1:] for text in lines[:top]),
    )


def _lines(content: bytes) -> list[str]:
    """Lines of a text in UTF-8, or in the characters of Windows, for µ."""
    if b"\0" in content:
        raise ValueError("a binary file, expected a table of text")
    try:
        return content.decode("utf-8-sig").splitlines() or [""]
    except UnicodeDecodeError:
        return content.decode("cp1252", "replace").splitlines()


def _located(names: list[str], fields: Fields) -> dict[str, int]:
    """Place of the column of each field; other columns have none."""
    places: dict[str, int] = {}
    for n, name in enumerate(names):
        field, _ = fields.get(_head(name), ("", 1.0))
        if field in places:
            raise ValueError(f"two columns of {field}, {names[places[field]]!r} and {name!r}")
        if field:
            places[field] = n
    return places


def _head(name: str) -> str:
    """Head of `Fields` for the name of a column, in which the unit may be in brackets."""
    return re.sub(r"[\s_()[\]]+", "_", name.lower().translate(_MICRO)).strip("_")


def _number(cell: str, delimiter: str, name: str) -> float:
    if cell.lower() in _MISSING:
        return math.nan
    decimal_comma = delimiter != "," and "." not in cell
    try:
        return float(cell.replace(",", ".") if decimal_comma else cell)
    except ValueError:
        raise ValueError(f"column {name!r}: {cell!r} is no number such as 1.5") from None
