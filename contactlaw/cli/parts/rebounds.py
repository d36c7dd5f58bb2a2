"""Measured rebounds from a table of named columns with units, and the conditions in its head."""

import dataclasses
import itertools
import os
import re
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array, Integers
from contactlaw._content import LARGEST_TEXT, content_of
from contactlaw._errors import ArgumentError
from contactlaw._escaped import line
from contactlaw.cli.parts import columns, own, wording
from contactlaw.cli.parts.columns import Located, TextColumn
from contactlaw.fitting import Measurements
from contactlaw.fitting.drops import is_height_or_time, rebounds_of
from contactlaw.fitting.measurements import INPUTS
from contactlaw.physical.arguments import unlikely
from contactlaw.physical.materials import Material, find, spelled_out
from contactlaw.quantities import FORCE, LENGTH, SHARE, SPEED, TIME, Quantity


def _column(names: str, quantity: Quantity) -> TextColumn:
    return TextColumn(tuple(names.split()), quantity)


_KINDS = {
    "restitution": _column("restitution cor coefficient_of_restitution e e_n", SHARE),
    "contact_time": _column("contact_time time duration contact_duration", TIME),
    "peak_force": _column("peak_force force max_force maximum_force", FORCE),
    "tangential_restitution": _column("tangential_restitution tangential_cor e_t", SHARE),
    "rotational_restitution": _column("rotational_restitution beta", SHARE),
    "spin": _column("spin rebound_spin angular_velocity", quantities.SPIN),
}
# Heights and times of a drop, which `contactlaw.fitting.drops` turns into speeds and CORs.
_MOST = 20  # bounces in a row of a table
_NOTED = {f"t{n}": _column(f"t{n} t_{n} time{n} time_{n}", TIME) for n in range(1, _MOST + 1)}
_NOTED |= {
    f"bounce{n}": _column(f"bounce{n} bounce_{n} h{n} h_{n} bounce_height_{n}", LENGTH) for n in range(2, _MOST + 1)
}
_NOTED["bounce"] = _column("bounce bounce1 bounce_1 bounce_height rebound_height h1 h_1", LENGTH)
_MEASURED = _KINDS | _NOTED
_ERRORS = "error", "standard_error", "std", "sd", "sigma", "uncertainty"
_COLUMNS = {
    "speed": TextColumn(columns.SPEEDS, SPEED),
    "angle": _column("angle impact_angle angle_of_incidence", quantities.ANGLE),
    "sliding_speed": _column("sliding_speed tangential_speed", SPEED),
    "friction": _column("friction coefficient_of_friction mu", quantities.FRICTION),
    **columns.SIZES,
    "drop": _column("drop drop_height fall_height height h0 h_0", LENGTH),
    "time_error": _column("time_error t_error", TIME),
    "drop_error": _column("drop_error drop_height_error", LENGTH),
    "bounce_error": _column("bounce_error bounce_height_error", LENGTH),
    **_MEASURED,
    **{
        f"{field}_error": TextColumn(tuple(f"{name}_{word}" for name in names for word in _ERRORS), quantity)
        for field, (names, quantity) in _KINDS.items()
    },
}
# Columns of the experiments "(In)elastic collision" and "Acoustic stopwatch" of phyphox, in all languages:
# instants at which a bead was heard, and what phyphox derives from them without the drag of the air.
_HEARD = re.compile(r"(start|(stop|bounce)( [0-9])?|event time) \(s\)", re.IGNORECASE)
_DERIVED = "Height ", "Energy ", "Difference ", "Interval "


class Read(NamedTuple):
    """Columns of a file in SI units, by the names of `Measurements`."""

    columns: dict[str, Array]
    lines: Integers  # line of the file of each rebound
    head: str  # comments above the table
    warnings: list[str]  # about what is left out or likely wrong


def read(path: str | os.PathLike[str]) -> Read:
    """Read a table of rebounds, a row for each, and warn about what is left out or likely wrong.

    Columns are between commas, semicolons or tabs, with names and units in the first line, as in
    ``speed_m/s,COR,COR_error`` or ``Speed [m/s];Contact time [us]``. Rows in which nothing was
    measured are left out, and so are wrong rows among more good ones. Instants that phyphox exports
    become the times between them.
    """
    with wording.reading(path):
        found = _read(content_of(Path(path), LARGEST_TEXT, pipe=True))
    for warning in found.warnings:
        wording.print_warning(f"{path}: {warning}")
    return found


def _read(content: bytes) -> Read:
    try:
        names, rows, delimiter = columns.split_table(content)
    except ValueError:
        raise ValueError(
            "no text in UTF-8, as spreadsheets save it; take columns with names in the first line"
        ) from None
    heard = [n for n, name in enumerate(names) if _HEARD.fullmatch(name)]
    found = columns.locate(["" if n in heard else name for n, name in enumerate(names)], _COLUMNS)
    found |= {f"t{n}": Located(place, 1.0) for n, place in enumerate(heard, 1)}
    if found.get("time_error") == found.get("contact_time_error"):  # a column of this name is of what else is there
        found.pop("contact_time_error" if any(re.fullmatch("t[0-9]+", name) for name in found) else "time_error", None)
    _check_heads(names, found)
    if not rows:
        raise ValueError("it has no row after the first line")
    wanted, wrong = [one.place for one in found.values()], list[str]()
    found_lines, table = columns.numbers(rows, delimiter, names, wanted, wrong)
    lines, warnings = np.array(found_lines), _left_out(wrong, len(table))
    picked = {name: values / one.per_unit for (name, one), values in zip(found.items(), table.T, strict=True)}
    columns.halve_diameters(picked)
    if heard:
        instants = np.array([picked.pop(f"t{n + 1}") for n in range(len(heard))])
        if len(heard) == 1:  # the set "All" has one below the other
            instants, lines = instants.T, lines[:1]
        intervals = np.diff(np.where(instants > 0.0, instants, np.nan), axis=0)  # 0: not heard
        picked |= {f"t{n}": times for n, times in enumerate(intervals, 1)}
    measured = np.any([~np.isnan(picked[kind]) for kind in _MEASURED if kind in picked], axis=0)
    if not measured.any():
        raise ValueError("none of its rows has a number in a column of what is measured")
    if not measured.all():
        warnings.append(f"lines without a rebound are left out: {', '.join(map(str, lines[~measured]))}")
    known, missing = _DERIVED if heard else (), _COLUMNS.keys() - found.keys()
    unused = [name for n, name in enumerate(names) if name and n not in wanted and not name.startswith(known)]
    if unused:
        heads = ", ".join(name + _nearest([name], missing) for name in unused)
        warnings.append(f"columns that are not used: {heads}")
    for name in ("radius", "thickness"):
        if (size := unlikely(picked.get(name, 0.0))) is not None:
            warnings.append(f"{name} {size:g} is {size:g} m; call the column {name}_mm for millimetres?")
    comments = itertools.takewhile(lambda line: line.startswith("#"), columns.lines_of(content))
    return Read(
        {name: values[measured] for name, values in picked.items()},
        lines[measured],
        "\n".join(line[1:] for line in comments),
        warnings,
    )


def _check_heads(names: list[str], found: Mapping[str, Located]) -> None:
    """Refuse a table without speeds or anything measured, or with speeds of another kind than its angles."""
    listed = f"in its first line, {', '.join(names)[:200]!r}"
    if "speed" not in found and not any(map(is_height_or_time, found)):
        near = _nearest(names, ("speed",))
        raise ValueError(f"no column of speeds {listed}: call one speed_m/s, or drop_cm{near}")
    if not found.keys() & _MEASURED.keys():
        raise ValueError(
            f"nothing measured {listed}: call a column COR, contact_time_us, peak_force_N, tangential_restitution, "
            f"rotational_restitution, spin_rad/s, bounce_cm or t1_ms{_nearest(names, _MEASURED)}"
        )
    if "speed" in found and "angle" in found and "normal" in names[found["speed"].place].lower():
        raise ValueError(
            f"{names[found['speed'].place]!r}: with angles the speed is that of the bead: call it "
            "speed_m/s if it is, else give sliding_speed_m/s in place of the angle"
        )


def _left_out(wrong: list[str], good: int) -> list[str]:
    """Sentences about wrong rows, of which there have to be fewer than good ones."""
    if wrong and len(wrong) >= good:
        others = " (half of all rows or more are wrong)" * (len(wrong) + good > 1)
        raise ValueError(wrong[0] + others)
    return [f"left out: {sentence}" for sentence in wrong]


def _nearest(heads: list[str], fields: Iterable[str]) -> str:
    """Ask for each head whether it is meant for one of some fields."""
    of = {field: _COLUMNS[field] for field in sorted(fields)}
    return "".join(columns.nearest(head, of) for head in heads)


def completed(table: Read, path: str | os.PathLike[str], density: float, **sizes: Any) -> Measurements:
    """Add the sizes [m] that a table does not have; None for those that are unknown.

    Heights and times are those of beads of a density [kg/m3]. Rows with a value out of its range
    are left out with a warning, if there are more good ones.
    """
    sizes = {name: size for name, size in sizes.items() if size is not None}
    if twice := sizes.keys() & table.columns.keys():
        raise ArgumentError(min(twice), None, "the table has its own: leave this one out")
    values, wrong = table.columns | {"line": table.lines}, list[str]()
    values |= {name: np.full(table.lines.size, size) for name, size in sizes.items()}
    for name in table.columns.keys() & {*INPUTS, "angle"}:
        if name != "speed" or "drop" not in values:  # else each row has one of these
            missing = np.isnan(values[name])
            wrong += [f"line {n} has no {name}" for n in values["line"][missing]]
            values = {name: column[~missing] for name, column in values.items()}
    with wording.reading(path):
        while True:
            warnings, rebounds = _left_out(wrong, values["line"].size), values
            try:
                rebounds = rebounds_of(values, density)
                data = Measurements(**rebounds)
                break
            except ArgumentError as error:
                line = rebounds["line"]
                if error.element is None and (error.value is None or line.size > 1):
                    raise
                n = int(line[error.element or 0])
                wrong.append(f"line {n}: {ArgumentError(error.name, error.value, error.reason)}")
                values = {name: column[values["line"] != n] for name, column in values.items()}
    for warning in warnings:
        wording.print_warning(f"{path}: {warning}")
    return data


class Conditions(NamedTuple):
    """What the head of a file of measurements says: TOML behind # above the table."""

    title: str
    reference: str
    bodies: dict[str, Material]  # those of sphere and plate that it names
    errors: dict[str, float]  # relative standard errors of speed and sizes, by argument
    values: dict[str, float]  # what all rows have, by the names of columns


_TEXTS = "title", "reference", "provenance", "reading", "missing"
_SIZES = "speed_error", "radius_error", "thickness_error"
OF_ALL = "radius", "diameter", "thickness", "friction", "drop", "time_error", "drop_error", "bounce_error"


def conditions(table: Read, materials: Mapping[str, Material]) -> Conditions:
    """Read the conditions in the head of a file; a head without = is a remark."""
    try:
        head = tomllib.loads(table.head if "=" in table.head else "")
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f'the lines with # above its table are no TOML, as title = "...": {error}') from None
    _check_keys(head, (*_TEXTS, *_SIZES, *OF_ALL, "sphere", "plate"))
    bodies: dict[str, Material] = {
        role: _body(role, head[role], materials) for role in ("sphere", "plate") if role in head
    }
    errors = {name: _quantity(name, head[name], SHARE) for name in _SIZES if name in head}
    values = {name: _quantity(name, head[name], _COLUMNS[name].quantity or SHARE) for name in OF_ALL if name in head}
    columns.halve_diameters(values)
    title, reference = (line(str(head.get(name, ""))) for name in _TEXTS[:2])
    return Conditions(title, reference, bodies, errors, values)


def _quantity(name: str, text: Any, quantity: Quantity) -> float:
    with wording.reading(f"{name} in its head"):
        return quantities.value(str(text), quantity)


def _check_keys(head: Mapping[str, Any], known: tuple[str, ...]) -> None:
    for key in head.keys() - {*known}:
        raise ValueError(f"its head has an {own.unknown(key, known)}")


def _body(role: str, numbers: Any, materials: Mapping[str, Material]) -> Material:
    """Material of a head: a name, numbers in one text, or a table of numbers `like` another."""
    if isinstance(numbers, str):
        return own.material_of(role, numbers, materials)
    if not isinstance(numbers, dict):
        raise ValueError(f"{role} = {numbers!r}: write the name of a material, or a table [{role}] of numbers")
    numbers = spelled_out(numbers)
    like = numbers.pop("like", None)
    _check_keys(numbers, tuple(one.name for one in dataclasses.fields(Material)))
    if like is not None:
        return own.changed(find(like, materials), numbers)
    return Material(**{"name": role} | numbers)
