"""A fit as lines of text and as JSON."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw._readable import percent, rounded, scale_of, with_error
from contactlaw.cli.parts.impacts import COLUMNS
from contactlaw.cli.parts.table import Column, Table, flag_names
from contactlaw.fitting import Fit
from contactlaw.fitting.measurements import KINDS
from contactlaw.fitting.unknowns import UNKNOWNS
from contactlaw.parser import wrapped

_IN_JSON = (
    "values",
    "errors",
    "statistical_errors",
    "correlation",
    "alternatives",
    "residuals",
    "rows",
    "scatter",
    "notes",
    "law",
)


def text(found: Fit) -> Iterator[str]:
    """Lines for a terminal: each value with its error and the error's parts, residuals, notes."""
    cells = {
        "unknown": [UNKNOWNS[name].title for name in found.unknown],
        "value": [_number(found, name) for name in found.unknown],
        "error from data": [_size(found.statistical_errors[name], name) for name in found.unknown],
        "error from law": [_size(found.model_errors[name], name) for name in found.unknown],
    }
    yield from Table([Column(name, title=name, shown="") for name in cells], cells).text()
    for kind, off in found.residuals.items():
        values = f"{off.size} value{'s' * (off.size > 1)}"
        yield f"{KINDS[kind].title}: {values}, rms difference from the fit {percent(found.scatter[kind])}"
    for note in found.notes:
        yield from wrapped(f"- {note}", "  ")


def values_in_words(found: Fit) -> list[str]:
    """Title, value and error of each unknown."""
    return [f"{UNKNOWNS[name].title} {_number(found, name)}" for name in found.unknown]


def _number(found: Fit, name: str) -> str:
    return with_error(found.values[name], found.errors[name], UNKNOWNS[name].unit).rstrip()


def _size(error: float, name: str) -> str:
    unit, size = scale_of(error, UNKNOWNS[name].unit)
    return f"{rounded(error / size)} {unit}".rstrip() if np.isfinite(error) else "not known"


def impacts_of(found: Fit) -> dict[str, Array]:
    """Speed of the bead, sizes, and the angle [deg] of oblique rebounds."""
    data, sizes = found.data, {"thickness": found.thickness, "radius": found.radius}
    normal, sliding = np.asarray(data.speed), np.asarray(data.sliding_speed if data.is_oblique else 0.0)
    angle = {"angle": np.degrees(np.arctan2(sliding, normal))} if data.is_oblique else {}
    return {"speed": np.hypot(normal, sliding)} | sizes | angle


def rows(found: Fit) -> Table:
    """Table of the rebounds: sizes, and by how much each measured value differs from the fit."""
    count, values = len(found.data), {"line": np.asarray(found.data.line)} | impacts_of(found)
    columns = [Column("line", title="line", digits=".0f"), *COLUMNS[:3], Column("angle", "deg", "angle", "deg")]
    columns = [column for column in columns if column.name in values.keys() - {*found.unknown}]
    for kind, off in found.residuals.items():
        values[kind] = np.full(count, np.nan)
        values[kind][found.rows[kind]] = off
        title = KINDS[kind].title.removesuffix(" restitution").split()[-1]
        columns.append(Column(kind, "", title, "%", 100.0, digits="+z.2f"))
    return Table(columns, values, flags=found.flags)


def record(found: Fit) -> dict[str, Any]:
    """All of a fit for JSON, in SI units; arrays become lists."""
    return {name: getattr(found, name) for name in _IN_JSON} | {
        "model_errors": {name: error if error < np.inf else None for name, error in found.model_errors.items()},
        "units": {name: UNKNOWNS[name].unit for name in found.unknown},
        "flags": [flag_names(flags) for flags in found.flags],
    }
