"""Measured rebounds from a table of named columns with units, and the conditions in its head."""

import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from contactlaw import _escaped, quantities
from contactlaw._arrays import Array, Integers
from contactlaw._content import LARGEST_TEXT, content_of
from contactlaw._errors import ArgumentError
from contactlaw.cli.parts import columns, own, wording
from contactlaw.cli.parts.columns import DIAMETER
from contactlaw.fitting import Measurements
from contactlaw.fitting.drops import is_height_or_time, rebounds_of
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.quantities import ANGLE, FORCE, FRICTION, LENGTH, SHARE, SPEED, SPIN, TIME

_KINDS = {
    "restitution": (SHARE, "restitution cor coefficient_of_restitution e e_n"),
    "contact_time": (TIME, "contact_time time duration contact_duration"),
    "peak_force": (FORCE, "peak_force force max_force maximum_force"),
    "tangential_restitution": (SHARE, "tangential_restitution tangential_cor e_t"),
    "rotational_restitution": (SHARE, "rotational_restitution beta"),
    "spin": (SPIN, "spin rebound_spin angular_velocity"),
}
# Heights and times of a drop, which `contactlaw.fitting.drops` turns into speeds and CORs.
_DROP = {
    "drop": (LENGTH, "drop drop_height fall_height height h0 h_0"),
    "bounce": (LENGTH, "bounce bounce1 bounce_1 bounce_height rebound_height h1 h_1"),
}
_LATER = {f"t{n}": (TIME, f"t{n} t_{n} time{n} time_{n}") for n in range(1, 21)} | {
    f"bounce{n}": (LENGTH, f"bounce{n} bounce_{n} h{n} h_{n} bounce_height_{n}") for n in range(2, 21)
}
_MEASURED = {*_KINDS, "bounce", *_LATER}
_COLUMNS = {
    **_KINDS,
    **_DROP,
    **_LATER,
    **{f"{kind}_error": (si, f"{names} ".replace(" ", "_error ")) for kind, (si, names) in (_KINDS | _DROP).items()},
    "time_error": (TIME, "time_error t_error"),
    "angle": (ANGLE, "angle impact_angle angle_of_incidence"),
    "sliding_speed": (SPEED, "sliding_speed tangential_speed"),
    "friction": (FRICTION, "friction coefficient_of_friction mu"),
}
# Instants at which phyphox heard a bead: in a row, or below each other.
_HEARD = {name.format(n): (f"heard{n}", 1.0) for n in range(10) for name in ("bounce_{}_s", "stop_{}_s")}
_HEARD |= {"start_s": ("heard0", 1.0), "stop_s": ("heard1", 1.0), "event_time_s": ("heard0", 1.0)}
_FIELDS = columns.IMPACT | _HEARD
for _field, (_quantity, _names) in _COLUMNS.items():
    _FIELDS |= columns.heads(_field, _quantity, _names)
# What a head may say of all rows.
OF_ALL = {"radius": LENGTH, "diameter": DIAMETER, "thickness": LENGTH} | {
    name: _COLUMNS[name][0] for name in ("friction", "drop", "time_error", "drop_error", "bounce_error")
}
_TEXTS = "title", "reference", "provenance", "reading", "missing"
_ERRORS = dict.fromkeys(("speed_error", "radius_error", "thickness_error"), SHARE)


class Source(NamedTuple):
    """Rebounds of a file, and where they come from."""

    title: str
    reference: str
    pair: Pair
    rebounds: Measurements
    errors: dict[str, float]  # relative standard errors of speed and sizes, by argument


def read(
    path: str | Path, materials: Mapping[str, Material], pair: Callable[[Mapping[str, Material]], Pair], **sizes: float
) -> Source:
    """Read a table of rebounds, a row for each, and the TOML behind # above it.

    Columns are between commas, semicolons or tabs, with names and units in the first line, as in
    ``speed_m/s,COR,COR_error`` or ``Speed [m/s];Contact time [us]``. Rows in which nothing was
    measured are left out with a warning, and so are wrong rows among more good ones. Instants that
    phyphox exports become the times between them. Sizes [m], and whatever else all rows have, come
    before those of the head; `pair` chooses the materials, and gets those that the head names.
    """
    with wording.reading(path):
        table = columns.read(content_of(Path(path), LARGEST_TEXT, pipe=True), _FIELDS)
        values, lines = _times_between(table.values, table.lines)
        _check_heads(values, table)
        head = _head(table.comments, materials)
    bodies = pair({role: head[role] for role in ("sphere", "plate") if role in head})
    sizes = {name: head[name] for name in OF_ALL if name in head} | sizes
    if twice := sizes.keys() & values.keys():
        raise ArgumentError(min(twice), None, "the table has its own: leave this one out")
    values |= {"line": lines} | {name: np.full(lines.size, size) for name, size in sizes.items()}
    measured = np.any([~np.isnan(values[kind]) for kind in _MEASURED if kind in values], axis=0)
    values = {name: column[measured] for name, column in values.items()}
    with wording.reading(path):
        data = _measurements(values, table.wrong, bodies.sphere.density)
    warnings = [f"left out: {sentence}" for sentence in table.wrong]
    if not measured.all():
        warnings.append(f"lines without a rebound are left out: {', '.join(map(str, lines[~measured]))}")
    if ":" in table.comments and not head:
        warnings.append("the lines with # above its table are not used, as they have no =")
    if table.unused and "heard0" not in table.values:
        warnings.append(f"columns that are not used: {', '.join(table.unused)}")
    for warning in warnings:
        wording.print_warning(f"{path}: {warning}")
    title, reference = (_escaped.line(str(head.get(name, ""))) for name in _TEXTS[:2])
    return Source(title, reference, bodies, data, {name: head[name] for name in _ERRORS if name in head})


def _times_between(values: dict[str, Array], lines: Integers) -> tuple[dict[str, Array], Integers]:
    """Replace the instants of phyphox by the times between them."""
    heard = np.array([values[name] for name in values if name.startswith("heard")])
    if not heard.size:
        return values, lines
    if len(heard) == 1:
        heard, lines = heard.T, lines[:1]
    times = np.diff(np.where(heard > 0.0, heard, np.nan), axis=0).round(9)  # 0: not heard
    return {f"t{n}": row for n, row in enumerate(times, 1)}, lines


def _check_heads(values: Mapping[str, Array], table: columns.Columns) -> None:
    """Refuse a table without speeds or anything measured, or with speeds of another kind than its angles."""
    listed = f"in its first line, {', '.join(table.names)[:200]!r}"
    if "speed" not in values and not any(map(is_height_or_time, values)):
        raise ValueError(f"no column of speeds {listed}: call one speed_m/s, or drop_cm")
    if not values.keys() & _MEASURED:
        raise ValueError(
            f"nothing measured {listed}: call a column COR, contact_time_us, peak_force_N, tangential_restitution, "
            "rotational_restitution, spin_rad/s, bounce_cm or t1_ms"
        )
    if "angle" in values and any("normal" in name.lower() for name in {*table.names} - {*table.unused}):
        raise ValueError(
            "with angles the speed is that of the bead: call it speed_m/s if it is, else give sliding_speed_m/s in "
            "place of the angle"
        )


def _head(comments: str, materials: Mapping[str, Material]) -> dict[str, Any]:
    """Numbers in SI units, materials and texts of a head; one without = is a remark."""
    try:
        head = tomllib.loads(comments if "=" in comments else "")
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f'the lines with # above its table are no TOML, as title = "...": {error}') from None
    units = OF_ALL | _ERRORS
    own.check_keys(head, [*_TEXTS, *units, "sphere", "plate"])
    for name in head.keys() - {*_TEXTS}:
        with wording.reading(f"{name} in its head"):
            value = head.pop(name)
            head["radius" if name == "diameter" else name] = (
                quantities.value(str(value), units[name]) if name in units else own.material_of(name, value, materials)
            )
    return head


def _measurements(values: dict[str, Array], wrong: list[str], density: float) -> Measurements:
    """Measurements of good rows, in which beads of a density [kg/m3] fell; sentences about others join `wrong`."""
    while True:
        good = values["line"].size
        if wrong and len(wrong) >= good:
            raise ValueError(f"{wrong[0]} (half of all rows or more are wrong)")
        rebounds = values
        try:
            rebounds = rebounds_of(values, density)
            return Measurements(**rebounds)
        except ArgumentError as error:
            line = rebounds["line"]
            if error.element is None and (error.value is None or line.size > 1):
                raise
            n = int(line[error.element or 0])
            wrong.append(f"line {n}: {ArgumentError(error.name, error.value, error.reason)}")
            values = {name: column[values["line"] != n] for name, column in values.items()}
