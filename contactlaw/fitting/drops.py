"""Speeds and CORs from what people note down: heights, and times between bounces."""

import re
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.physical import flight
from contactlaw.physical.arguments import broadcast, check, number, within

_BOUNCE = re.compile(r"(bounce|t)([0-9]*)")
METRES, _SECONDS = (1e-5, 10.0, "metres; in cm or mm?"), (1e-3, 5.0, "seconds; in ms?")
_ERRORS = {"drop_error": "drop", "bounce_error": "bounce", "time_error": "t"}  # and what they are of
NAMES = f"drop, bounce, bounce2, ..., t1, t2, ..., {', '.join(_ERRORS)}"


def is_height_or_time(name: str) -> bool:
    """Whether a column is one of those that `rebounds_of` replaces."""
    return name in ("drop", *_ERRORS) or _BOUNCE.fullmatch(name) is not None


def rebounds_of(data: Mapping[str, Any], density: float) -> dict[str, Any]:
    """Replace heights and times of drops by speeds and CORs of their bounces, in SI units.

    Each row is a drop. `drop` is the height from which a bead falls from rest; ``bounce``,
    ``bounce2``, ... are the heights of its bounces in their order, or ``t1``, ``t2``, ... the times
    from each bounce to the next. Without `drop` or `speed` the first of these only gives the speed
    of the second bounce. What else was measured belongs to the first bounce. The air is taken off,
    for spheres of that `density`. Errors are standard errors; `time_error` is that of an instant.

    Examples
    --------
    >>> found = rebounds_of({"drop": 0.3, "t1": 0.4, "t2": 0.32, "radius": 0.01}, 8000.0)
    >>> found["speed"].round(3), found["restitution"].round(3)
    (array([2.425, 1.96 ]), array([0.809, 0.8  ]))
    """
    columns = dict(data)
    if not any(map(is_height_or_time, columns)):
        return columns
    if columns.get("radius") is None:
        raise ArgumentError("radius", None, "has to be given with heights or times: the air slows small beads")
    *arrays, _ = broadcast(**columns)
    flat: dict[str, Array] = dict(zip(columns, arrays, strict=True))
    given = {name: flat.pop(name) for name in columns if is_height_or_time(name)}
    order = sorted((int(match[2] or 1), name) for name in given if (match := _BOUNCE.fullmatch(name)))
    if [n for n, _ in order] != [*range(1, len(order) + 1)]:
        raise ArgumentError("data", ", ".join(name for _, name in order), "number bounces 1, 2, 3, ..., each once")
    known = [name for name in _ERRORS if name in given]
    for clash in ("restitution", "angle", "sliding_speed", *["restitution_error"] * bool(known)):
        if order and clash in flat:
            raise ArgumentError(clash, None, f"leave it out beside {order[0][1]}, from which the COR follows")
    kinds = {name.rstrip("0123456789") for _, name in order} | ({"drop"} & given.keys() if order else set())
    for name in known:
        if _ERRORS[name] not in kinds:
            raise ArgumentError(name, None, "there is no bounce whose COR it enters: leave it out")
    for name, values in given.items():
        least, most, hint = _SECONDS if name[0] == "t" else METRES
        within(name, np.where(np.isnan(values), most, values), 0.0 if name in _ERRORS else least, most, hint)
    check(radius=flat["radius"])
    within("density", np.array([number("density", density)]), 5.0, flight.NO_AIR, "kg/m3; in g/cm3?")
    radius = flat["radius"]
    none = np.full(radius.size, np.nan)
    drop_error, height_error, time_error = (given.get(name, 0.0 * radius) for name in _ERRORS)
    height = given.get("drop", none)
    fallen = flight.of_height(height, radius, density).down
    air = [fallen / np.sqrt(2.0 * flight.GRAVITY * height)]
    arrives, error, before = flat.pop("speed", none), 0.0 * radius, none
    if (np.isfinite(arrives) & np.isfinite(height)).any():
        raise ArgumentError("drop", None, "give speeds or drops, not both of a rebound")
    if "drop" in given:
        arrives, error = np.where(np.isnan(height), arrives, fallen), 0.5 * drop_error / height
    rows = [(arrives, none, none)] if not order else []
    for _, name in order:
        timed, size = name[0] == "t", given[name]
        fly = flight.of_time if timed else flight.of_height
        found = fly(size, radius, density)
        air.append(found.up / (0.5 * flight.GRAVITY * size if timed else np.sqrt(2.0 * flight.GRAVITY * size)))
        if (wrong := found.up > arrives).any():
            row = int(np.argmax(wrong))
            reason = (
                f"a bead that arrives at {arrives[row]:.4g} m/s does not leave at {found.up[row]:.4g} m/s, air "
                "taken off: check the unit; times and heights have to fall from bounce to bounce, and "
                "another drop has a row of its own"
            )
            raise ArgumentError(name, size[row], reason, row)
        cor, leaves = found.up / arrives, np.sqrt(2.0) * time_error / size if timed else 0.5 * height_error / size
        # An error of the instant between two times shortens the one and lengthens the other.
        shared = np.nan_to_num(2.0 * time_error**2 / (size * before)) if timed else 0.0
        rows.append((arrives, cor, cor * np.sqrt(leaves**2 + error**2 + shared)))
        arrives, error, before = found.down, leaves, size if timed else none
    flight.say_air(np.array(air))
    speed, cor, errors = (np.ravel(part, "F") for part in zip(*rows, strict=True))
    first = np.tile([True] + [False] * (len(rows) - 1), radius.size)
    keep = np.isfinite(speed) & (first | np.isfinite(cor)) if order else first
    lost = ~keep.reshape(-1, len(rows)).any(axis=1)
    if lost.any():
        reason = "a bounce alone has no COR: add the drop (in a head: # drop = '30cm'), its speed, or the next time, t2"
        if lost.all():
            raise ArgumentError("drop", None, reason)
        rows_lost = flat.get("line", np.arange(lost.size))[lost].astype(int)
        warnings.warn(f"drop: {reason}; rows {rows_lost} are left out", stacklevel=4)
    flat = {name: np.repeat(values, len(rows)) for name, values in flat.items()}
    for name in flat.keys() - {"radius", "thickness", "friction", "line"}:
        flat[name] = np.where(first, flat[name], np.nan)
    new = {"speed": speed} | ({"restitution": cor} if order else {})
    new |= {"restitution_error": errors} if known and order else {}
    return {name: values[keep] for name, values in (new | flat).items()}
