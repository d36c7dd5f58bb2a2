"""Impacts as rows: every combination of some speeds, radii and thicknesses.

A sheet is printed for people, for spreadsheets (CSV) or for programs (JSON); which columns there
are, and in which units, is listed once.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import NamedTuple, TextIO

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import switched_off
from contactlaw.answers.backend import SphereOnPlate
from contactlaw.answers.solver import Solver
from contactlaw.answers.tabulated import extent
from contactlaw.cli.parts import wording
from contactlaw.equation.losses import Losses
from contactlaw.model import ImpactModel
from contactlaw.physical.rebound import Impacts
from contactlaw.physical.validity import Validity, count_flags, explain
from contactlaw.table import file

Array = NDArray[np.float64]

_MOST = 1_000_000  # impacts: half a minute of text, 100 MB of it


class _Column(NamedTuple):
    name: str
    unit: str  # of the SI, as in CSV
    title: str = ""  # on a terminal; those without one are not shown there
    shown: str = "-"  # unit on a terminal
    scale: float = 1.0  # of that unit


_COLUMNS = (
    _Column("speed", "m/s", "speed", "m/s"),
    _Column("radius", "m", "radius", "mm", 1e3),
    _Column("thickness", "m", "thickness", "mm", 1e3),
    _Column("restitution", "", "COR"),
    _Column("contact_time", "s", "time", "us", 1e6),
    _Column("peak_force", "N", "force", "N"),
    _Column("peak_compression", "m"),
    _Column("residual_compression", "m"),
    *(_Column(f"{channel}_fraction", "", channel) for channel in Losses._fields),
    _Column("inelasticity", ""),
    _Column("overload", ""),
    _Column("yield_speed", "m/s", "yield at", "m/s"),
)


@dataclass(frozen=True, eq=False)
class Sheet:
    """Impacts and what comes of them, in SI units, each column an array of one length.

    Attributes
    ----------
    columns : dict of str to ndarray
        Speed, radius, thickness, the fields of a `Rebound` but for its flags, and the yield speed:
        inf where nothing yields, or so thin a plate is hit that it is beyond the table.
    flags : ndarray of int64
        `Validity` limits that an impact exceeds.
    """

    columns: dict[str, Array]
    flags: NDArray[np.int64]

    def __len__(self) -> int:
        """Count the impacts."""
        return len(self.flags)


def impacts(
    model: ImpactModel,
    speeds: Sequence[float],
    radii: Sequence[float],
    thicknesses: Sequence[float],
    solve: bool = False,
) -> Sheet:
    """Look up every combination, or integrate it.

    Parameters
    ----------
    model : ImpactModel
        Of the pair of materials.
    speeds, radii, thicknesses : sequence of float
        Of impacts [m/s], beads and plates [m]; speeds change fastest along the sheet.
    solve : bool, optional
        Whether to integrate the equation.

    Raises
    ------
    ValueError
        More than a million impacts, or what the model refuses.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    >>> sheet = impacts(model, [1.0, 5.0], [0.9e-3], [0.5e-3, math.inf])
    >>> sheet.columns["restitution"].round(4)
    array([0.7592, 0.6854, 1.    , 1.    ])
    """
    count = len(speeds) * len(radii) * len(thicknesses)
    if count > _MOST:
        raise ValueError(
            f"speed, radius, thickness: every combination of them is {count} impacts, and "
            f"{_MOST} is the most: give fewer values"
        )
    r, h, v = (part.ravel() for part in np.meshgrid(radii, thicknesses, speeds, indexing="ij"))
    with wording.impacts(v, r, h):
        if not solve and _tableless(model):
            limited = model.outside == "raise"
            rebound = _solver(model, limited).rebounds(Impacts.on_plates(v, r, h))
        else:
            rebound = model.solve(v, r, h) if solve else model.lookup(v, r, h)
    first = slice(None, None, len(speeds))  # of each bead on each plate
    yields = np.repeat(yield_speeds(model, r[first], h[first]), len(speeds))
    found = asdict(rebound) | {"speed": v, "radius": r, "thickness": h, "yield_speed": yields}
    return Sheet({column.name: found[column.name] for column in _COLUMNS}, found["flags"])


def _tableless(model: ImpactModel) -> bool:
    """Whether to do without a table: Python would take minutes to build it."""
    law = model.force_law
    ships = (law.is_hertz and not law.yields) or file.packaged(law) is not None
    return switched_off() and model.outside != "clamp" and not ships


def _solver(model: ImpactModel, limited: bool) -> Solver:
    """Solver of a model, within the limits of its table or without."""
    law = model.force_law
    bodies = SphereOnPlate(model.pair, law)
    return Solver(bodies, extent=extent(law)) if limited else Solver(bodies)


def yield_speeds(model: ImpactModel, radius: Array, thickness: Array) -> Array:
    """Yield speeds [m/s]; inf for so thin a plate that it is beyond the table.

    An impact on that plate need not be beyond it.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    >>> yield_speeds(model, np.array([1e-3, 1e-3]), np.array([1e-3, 0.05e-3])).round(2)
    array([7.92,  inf])
    """
    try:
        if _tableless(model):
            return _solver(model, True).yield_speeds(radius, thickness)
        return np.asarray(model.yield_speed(radius, thickness))
    except ValueError:
        if radius.size == 1:
            return np.array([math.inf])
        parts = zip(np.split(radius, radius.size), np.split(thickness, radius.size), strict=True)
        return np.concatenate([yield_speeds(model, r, h) for r, h in parts])


def text(sheet: Sheet) -> Iterator[str]:
    """Lines for a terminal: names, units, a row per impact, and what the flags say.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    >>> for line in text(impacts(model, [1.0, 5.0], [0.9e-3], [1e-3])):
    ...     print(line[:46])
    speed  radius  thickness     COR   time  force
    [m/s]    [mm]       [mm]     [-]   [us]    [N]
        1     0.9          1  0.9324  6.692  1.426
        5     0.9          1  0.9081  4.864  9.688
    """
    shown = [column for column in _COLUMNS if column.title]
    cells = [
        [column.title, f"[{column.shown}]"]
        + [f"{value:.4g}" for value in sheet.columns[column.name] * column.scale]
        for column in shown
    ]
    cells.append(["flags", "", *map(", ".join, map(flag_names, sheet.flags))])
    yield from aligned(cells)
    yield from explained(count_flags(sheet.flags), len(sheet))


def aligned(columns: Sequence[Sequence[str]]) -> Iterator[str]:
    """Lines of columns that end at one place; the last one begins at one.

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
    """Lines that say what flags mean, and of how many impacts; none where there is no flag.

    Examples
    --------
    >>> [line[:24] for line in explained({Validity.FAST_IMPACT: 3}, 7)]
    ['', 'FAST_IMPACT, 3 of 7: fas']
    """
    if flags:
        yield ""
    for flag, count in sorted(flags.items()):
        (words,) = explain(flag)
        yield f"{flag.name}, {count} of {total}: {words}"


def write_csv(sheet: Sheet, out: TextIO) -> None:
    """Write rows with every digit; the header has names and units of the SI.

    Examples
    --------
    >>> import io
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    >>> out = io.StringIO()
    >>> write_csv(impacts(model, [60.0], [0.9e-3], [1e-3]), out)
    >>> for line in out.getvalue().splitlines():
    ...     print(*line.split(",")[:3], line.split(",")[-1])
    speed_m/s radius_m thickness_m flags
    60.0 0.0009 0.001 FAST_IMPACT
    """
    writer = csv.writer(out, lineterminator="\n")
    units = (f"_{column.unit}" * bool(column.unit) for column in _COLUMNS)
    names = [column.name + unit for column, unit in zip(_COLUMNS, units, strict=True)]
    writer.writerow([*names, "flags"])
    values = (column.tolist() for column in sheet.columns.values())
    flags = ("|".join(flag_names(value)) for value in sheet.flags)
    writer.writerows([*row, last] for *row, last in zip(*values, flags, strict=True))


def records(sheet: Sheet) -> list[dict[str, object]]:
    """Rows for JSON, which has no inf: no yield speed, and a half-space's thickness, are None.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")
    >>> (row,) = records(impacts(model, [1.0], [1e-3], [math.inf]))
    >>> row["thickness"], row["yield_speed"], row["flags"]
    (None, None, [])
    """
    values = zip(*(column.tolist() for column in sheet.columns.values()), strict=True)
    return [
        {
            name: value if value < math.inf else None
            for name, value in zip(sheet.columns, row, strict=True)
        }
        | {"flags": flag_names(flags)}
        for row, flags in zip(values, sheet.flags, strict=True)
    ]


def units() -> dict[str, str]:
    """Units of the columns; an empty one for those that have none.

    Examples
    --------
    >>> units()["peak_force"], units()["restitution"]
    ('N', '')
    """
    return {column.name: column.unit for column in _COLUMNS}


def flag_names(flags: int) -> list[str]:
    """Names of the limits that some flags stand for.

    Examples
    --------
    >>> flag_names(Validity.THIN_PLATE | Validity.DAMAGE)
    ['THIN_PLATE', 'DAMAGE']
    """
    return [str(flag.name) for flag in Validity(int(flags))]
