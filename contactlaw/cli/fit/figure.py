"""The figure of a fit: data, fitted curve with its band, residuals, and the speed of yield."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from contactlaw import style
from contactlaw._arrays import Array, Places
from contactlaw._readable import drawn
from contactlaw.cli.fit.printed import values_in_words
from contactlaw.cli.parts import wording
from contactlaw.cli.parts.plots import SUFFIXES, colour_of, plate_of, save
from contactlaw.fitting import Fit
from contactlaw.fitting.measurements import KINDS
from contactlaw.physical.validity import Validity, limits_in_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_SAMPLES = 160  # speeds of a curve
_MOST_CURVES = 6  # more could not be distinguished: then only the fitted values are drawn
_WIDER = 1.25  # ratio of a curve's ends to the extreme speeds of the data


# How each quantity is drawn: label, and figure units per SI unit.
_KINDS = {
    "restitution": ("coefficient of restitution [-]", 1.0),
    "contact_time": ("contact time [µs]", 1e6),
    "peak_force": ("peak force [N]", 1.0),
    "tangential_restitution": ("tangential restitution [-]", 1.0),
    "rotational_restitution": ("1 + rotational restitution [-]", 1.0),
    "spin": ("spin after [rad/s]", 1.0),
}


class Group(NamedTuple):
    """Rebounds of one bead on one plate."""

    radius: float
    thickness: float
    rows: Places


class FitCurve(NamedTuple):
    """Fitted quantities over speed, of one bead on one plate."""

    speed: Array
    values: dict[str, Array]
    errors: dict[str, Array]
    yield_speed: float  # NaN if yield does not begin within the curve
    yields: bool  # whether anything yields at some speed of the curve


def save_fit(found: Fit, title: str, path: str | os.PathLike[str]) -> None:
    """Draw a fit into a file: a column for each quantity that was measured."""
    wording.check_suffix("path", path, SUFFIXES)
    groups = list(groups_of(found))
    drawn = len(groups) <= _MOST_CURVES and not found.data.is_oblique  # speed is no abscissa then
    curves = [curve_of(found, group) for group in groups] if drawn else []
    kinds = list(found.residuals)
    with style.applied():
        width = 9.0 if len(kinds) == 1 else 1.5 + 5.6 * len(kinds)
        figure = style.figure(width, 7.4, title, _caption(found, groups, curves))
        grid = figure.subplots(2, len(kinds), sharex=True, squeeze=False, gridspec_kw={"height_ratios": [2.6, 1.0]})
        for (above, below), kind in zip(grid.T, kinds, strict=True):
            for n, group in enumerate(groups):
                colour = colour_of(n, len(groups)) if len(curves) > 1 else style.BLUE
                if curves:
                    _draw_curve(above, below, curves[n], kind, colour)
                _draw_values(above, below, found, group, kind, colour, bool(curves))
            _finish(above, below, found, kind)
        if len(curves) > 1:
            grid[0, 0].legend(loc="best")
        figure.align_ylabels()
        save(figure, path)


def groups_of(found: Fit) -> Iterator[Group]:
    """Group the rebounds by bead and plate."""
    sizes = np.column_stack([found.radius, found.thickness])
    for radius, thickness in np.unique(sizes, axis=0).tolist():
        rows = np.flatnonzero((sizes == (radius, thickness)).all(axis=1))
        yield Group(radius, thickness, rows)


def _speeds(found: Fit) -> Array:
    return np.asarray(found.data.speed)


def _angles(found: Fit) -> Array:
    """Angles of incidence from the normal [deg]."""
    along: Array = np.asarray(found.data.sliding_speed)
    return np.asarray(np.degrees(np.arctan2(along, _speeds(found))))


def curve_of(found: Fit, group: Group) -> FitCurve:
    """Predict rebounds over a range a little wider than the measured speeds, with their errors."""
    speed = _speeds(found)
    v = np.geomspace(speed.min() / _WIDER, speed.max() * _WIDER, _SAMPLES)
    hit, errors = found.curve(v, group.radius, group.thickness)
    overload = np.asarray(hit.overload)
    beyond = np.flatnonzero(overload > 1.0)
    begins = math.nan
    if beyond.size and beyond[0] > 0:
        n = int(beyond[0])
        ends = np.log(overload[n - 1 : n + 1])
        begins = float(np.exp(np.interp(0.0, ends, np.log(v[n - 1 : n + 1]))))
    values = {kind: np.asarray(getattr(hit, kind)) for kind in errors}
    return FitCurve(v, values, errors, begins, bool(beyond.size))


def _draw_curve(above: Axes, below: Axes, curve: FitCurve, kind: str, colour: Any) -> None:
    _, scale = _KINDS[kind]
    values, errors = curve.values[kind], curve.errors[kind]
    low, high = (values + sign * errors for sign in (-1.0, 1.0))
    above.fill_between(curve.speed, low * scale, high * scale, color=colour, alpha=0.22, linewidth=0.0)
    above.plot(curve.speed, values * scale, color=colour, linewidth=2.2)
    share = 100.0 * errors / values
    below.fill_between(curve.speed, -share, share, color=colour, alpha=0.22, linewidth=0.0)
    if math.isfinite(curve.yield_speed):
        at = np.exp(np.interp(math.log(curve.yield_speed), np.log(curve.speed), np.log(values)))
        above.plot(curve.yield_speed, at * scale, "v", color=colour, markersize=11, markeredgecolor="white", zorder=4)
        above.annotate(
            "yield begins",
            (curve.yield_speed, 0.03),
            (6.0, 0.0),
            color=colour,
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
        )
        for axes in (above, below):
            axes.axvline(curve.yield_speed, color=colour, linewidth=1.0, linestyle=(0, (2.0, 2.5)))


def _draw_values(above: Axes, below: Axes, found: Fit, group: Group, kind: str, colour: Any, on_curve: bool) -> None:
    rows, off = found.rows[kind], found.residuals[kind]
    chosen = np.isin(rows, group.rows)
    rows, off = rows[chosen], off[chosen]
    if not rows.size:
        return
    v = (_angles if found.data.is_oblique else _speeds)(found)[rows]
    _, scale = _KINDS[kind]
    measured: Array = np.asarray(getattr(found.data, kind))[rows] + KINDS[kind].shift
    errors: Any = getattr(found.data, f"{kind}_error")
    fitted = measured / (1.0 + off)
    inside = (found.flags[rows] & Validity.ACCURACY) == 0
    name = f"radius {drawn(group.radius)}, {plate_of(group.thickness)}"
    for part, face in ((inside, colour), (~inside, "white")):
        if not part.any():
            continue
        look: dict[str, Any] = {
            "fmt": "o",
            "color": colour,
            "markersize": 6.5,
            "markeredgecolor": colour,
            "markerfacecolor": face,
            "elinewidth": 1.3,
            "zorder": 3,
        }
        bars = None if errors is None else errors[rows][part]
        above.errorbar(v[part], measured[part] * scale, None if bars is None else bars * scale, label=name, **look)
        name = "_"
        below.errorbar(v[part], 100.0 * off[part], None if bars is None else 100.0 * bars / fitted[part], **look)
    if not on_curve:
        above.plot(v, fitted * scale, "_", color=style.INK, markersize=11, markeredgewidth=1.8, zorder=4)


def _finish(above: Axes, below: Axes, found: Fit, kind: str) -> None:
    below.axhline(0.0, color=style.INK, linewidth=1.0)
    largest = 1.15 * max(abs(number) for number in below.get_ylim())
    below.set_ylim(-largest, largest)
    below.set(xlabel="impact speed [m/s]", ylabel="off the fit [%]")
    above.set_ylabel(_KINDS[kind][0])
    if found.data.is_oblique:
        below.set(xlabel="angle of incidence from the normal [°]", xlim=(0.0, 90.0))
        return
    speed = _speeds(found)
    low, high = speed.min() / _WIDER, speed.max() * _WIDER
    above.set_xscale("log")
    above.set_xlim(low, high)
    if kind == "peak_force" and speed.max() > 10.0 * speed.min():
        above.set_yscale("log")
    style.decades(below.xaxis, (1.0, 2.0, 5.0) if high < 300.0 * low else (1.0,))


def _caption(found: Fit, groups: list[Group], curves: list[FitCurve]) -> str:
    parts = [", ".join(values_in_words(found)).replace("+-", "±")]
    parts.append("band: one standard error of the fit")
    if found.data.is_oblique:
        parts[1] = "bars: fitted values"
    elif not curves:
        parts[1] = f"{len(groups)} beads and plates; bars: fitted values"
    elif all(curve.yields and math.isnan(curve.yield_speed) for curve in curves):
        parts.append("yield begins below these speeds")
    elif not any(curve.yields for curve in curves):
        parts.append("nothing yields at these speeds")
    flags = int(np.bitwise_or.reduce(found.flags)) & Validity.ACCURACY
    if flags:
        parts.append(f"hollow: {'; or '.join(limits_in_words(flags))}")
    return ". ".join(part[0].upper() + part[1:] for part in parts)
