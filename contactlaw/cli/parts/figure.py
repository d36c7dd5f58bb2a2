"""The one figure of all subcommands: curves with their bands, and measured points, over one axis."""

from __future__ import annotations

import io
import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from contactlaw import _atomic, style
from contactlaw._arrays import Array
from contactlaw._readable import drawn, scale_of
from contactlaw.physical.validity import Validity, limits_in_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes


SUFFIXES = ".png", ".svg", ".pdf"
MOST_CURVES = 8  # more could not be distinguished
_MOST_INSIDE = 5  # names of curves that have room among these
WIDE = 20.0  # ratio of the ends of an axis from which on it is logarithmic


class Axis(NamedTuple):
    """A quantity that an axis shows."""

    label: str
    unit: str  # SI unit
    may_be_logarithmic: bool = False  # if its range is wide

    def scaled(self, largest: float) -> tuple[str, float]:
        """Label with the unit that suits the largest value, and that unit's size in SI units."""
        unit, size = scale_of(largest, self.unit)
        return f"{self.label} [{unit.replace('u', 'µ')}]", size


AXES = {
    "speed": Axis("impact speed", "m/s", may_be_logarithmic=True),
    "thickness": Axis("plate thickness", "m", may_be_logarithmic=True),
    "radius": Axis("bead radius", "m", may_be_logarithmic=True),
    "angle": Axis("angle of incidence from the normal", "°"),
    "friction": Axis("coefficient of friction", "-"),
    "time": Axis("time since touch", "s"),
    "force": Axis("contact force", "N"),
    "restitution": Axis("coefficient of restitution", "-"),
    "contact_time": Axis("contact time", "s"),
    "peak_force": Axis("peak force", "N"),
    "tangential_restitution": Axis("tangential restitution", "-"),
    "rotational_restitution": Axis("1 + rotational restitution", "-"),
    "spin": Axis("spin after the impact", "rad/s"),
}


def named(name: str, size: float) -> str:
    """Write the value of a quantity of `AXES` with its name."""
    return drawn(size) if size == math.inf else f"{name} {drawn(size, AXES[name].unit, 4)}".rstrip(" -")


class Curve(NamedTuple):
    """A curve in SI units, and what is known along it."""

    x: Array  # rising; a last value of inf is drawn as a thin line across
    y: Array
    label: str = ""
    low: Array | None = None  # ends of the band
    high: Array | None = None
    flags: Any = 0  # the curve is dashed where it exceeds a limit of the model


class Points(NamedTuple):
    """Measured values in SI units."""

    x: Array
    y: Array
    label: str = ""
    error: Array | None = None  # standard errors
    flags: Any = 0  # points that exceed a limit of the model are hollow
    curve: int | None = None  # number of the curve whose colour they have


@dataclass(frozen=True)
class Figure:
    """Curves and points of one quantity over another."""

    title: str
    about: str  # bodies, law and what else is the same for all curves
    x: str  # a key of AXES
    y: str
    curves: Sequence[Curve]  # of one abscissa
    points: Sequence[Points] = ()
    remarks: Sequence[str] = ()  # meaning of the band, and what else the figure does not show

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a whole file, in the format that its suffix names; matplotlib is loaded here."""
        parts: list[Curve | Points] = [*self.curves, *self.points]
        x = self.curves[0].x[np.isfinite(self.curves[0].x)]
        y = np.concatenate([part.y for part in parts])
        labels = [part.label for part in parts if part.label]
        with style.applied():
            figure = style.figure(9.0, 6.0, self.title, ". ".join([self.about, *self._remarks(parts)]))
            axes = figure.subplots()
            (x_label, x_size), (y_label, y_size) = AXES[self.x].scaled(x.max()), AXES[self.y].scaled(np.nanmax(y))
            axes.set(xlabel=x_label, ylabel=y_label)
            for n, curve in enumerate(self.curves):
                draw_curve(axes, curve, self._colour(n), x_size, y_size)
            for points in self.points:
                colour = style.ORANGE if points.curve is None else self._colour(points.curve)
                draw_points(axes, points, colour, x_size, y_size)
            least, largest = x.min() / x_size, x.max() / x_size
            if AXES[self.x].may_be_logarithmic and largest >= WIDE * least:
                axes.set(xscale="log")
                width = math.log10(largest / least)
                style.decades(axes.xaxis, (1.0,) if width > 4.0 else (1.0, 2.0, 5.0))
            axes.set_xlim(least, largest)
            if len(labels) > _MOST_INSIDE:
                figure.legend(loc="outside right center")
            elif len(labels) > 1:
                axes.legend()
            content = io.BytesIO()
            figure.savefig(content, format=PurePath(path).suffix[1:].lower())
        _atomic.write(path, content.getvalue())

    def _colour(self, n: int) -> Any:
        """Colour of a curve, from dark to bright, none too pale for a line."""
        from matplotlib import colormaps

        count = len(self.curves)
        return style.BLUE if count == 1 else colormaps["viridis"](0.82 * n / (count - 1))

    def _remarks(self, parts: list[Curve | Points]) -> list[str]:
        """Sentences that say what the marks of the figure mean."""
        remarks = list(self.remarks)
        if any(curve.x[-1] == math.inf for curve in self.curves):
            remarks.append("Thin line: half-space")
        flags = np.concatenate([np.ravel(part.flags) for part in parts])
        if words := limits_in_words(int(np.bitwise_or.reduce(flags)) & Validity.ACCURACY):
            remarks.append(f"{'Dashed or hollow' if self.points else 'Dashed'}: {'; or '.join(words)}")
        return remarks


def draw_curve(axes: Axes, curve: Curve, colour: Any, x_size: float, y_size: float) -> None:
    """Draw a curve with its band, dashed beyond limits of the model."""
    finite = np.isfinite(curve.x)
    x, y = curve.x[finite] / x_size, curve.y[finite] / y_size
    look = {"color": colour, "linewidth": 2.4}
    if curve.low is not None and curve.high is not None:
        low, high = curve.low[finite] / y_size, curve.high[finite] / y_size
        axes.fill_between(x, low, high, color=colour, alpha=0.22, linewidth=0.0)
    inside = np.where(curve.flags & Validity.ACCURACY, np.nan, curve.y)[finite] / y_size
    axes.plot(x, y, "--", **look)
    # This line lies over the dashes. The legend shows its look, so it is dashed if no part of it is seen.
    axes.plot(x, inside, "--" if np.isnan(inside).all() else "-", label=curve.label, **look)
    if not finite.all():
        axes.axhline(curve.y[-1] / y_size, color=colour, linewidth=1.0)


def draw_points(axes: Axes, points: Points, colour: Any, x_size: float, y_size: float) -> None:
    """Draw points with their standard errors; those beyond a limit of the model are hollow."""
    x, y = points.x / x_size, points.y / y_size
    inside = np.where(points.flags & Validity.ACCURACY, np.nan, y)
    error = None if points.error is None else points.error / y_size
    look = {"color": colour, "markersize": 7}
    axes.errorbar(x, y, error, fmt="o", markerfacecolor="white", capsize=3, **look)
    # These lie over the hollow ones. The legend shows their look, so they are hollow if none of them is seen.
    face = "white" if np.isnan(inside).all() else colour
    axes.plot(x, inside, "o", label=points.label, markerfacecolor=face, zorder=3.0, **look)
