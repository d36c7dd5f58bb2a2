"""What the figures share: panels and their axes, and the looks of laws, speeds and remarks.

A figure names its panels by their axes, `sheet` sets them up, and matplotlib's ``plot`` fills them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, SupportsFloat

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from contactlaw import style
from contactlaw.style import BLUE, GREEN, INK, MUTED, ORANGE, PALE, PURPLE, SKY, VERMILION
from validation.accuracy import compare

Colour = str | tuple[float, ...]
Look = dict[str, Any]  # keywords of matplotlib's ``plot``
Drawn = tuple[Figure, Mapping[str, SupportsFloat]]  # a figure and its numbers, named


class Axis(NamedTuple):
    """An axis: its label, its limits, and, where it is logarithmic, all of its ticks."""

    label: str
    limits: tuple[float, float] | None = None  # None: as far as the data
    ticks: tuple[float, ...] = ()
    unit: str = ""  # behind each tick

    def between(self, low: float, high: float) -> Axis:
        """Set the limits."""
        return self._replace(limits=(low, high))

    def log(self, *ticks: float, unit: str = "") -> Axis:
        """Make the axis logarithmic, with these ticks only."""
        return self._replace(ticks=ticks, unit=unit)


class Panel(NamedTuple):
    """A panel: its axes and its title."""

    x: Axis
    y: Axis
    title: str = ""

    def set_up(self, axes: Axes) -> None:
        """Set labels, limits, ticks and title of empty axes."""
        for side, one in (("x", self.x), ("y", self.y)):
            if one.ticks:
                labels = [f"{tick:g}{one.unit}" for tick in one.ticks]
                axes.set(**{f"{side}scale": "log"})
                axes.set(**{f"{side}ticks": one.ticks, f"{side}ticklabels": labels})
                axes.minorticks_off()
            axes.set(**{f"{side}label": one.label})
            if one.limits is not None:
                axes.set(**{f"{side}lim": one.limits})
        axes.set_title(self.title)


SPEED = Axis("impact speed over yield speed  V$_0$ / V$_{Y0}$")
SLENDERNESS = Axis("radius over thickness  R / H")
INELASTICITY = Axis(r"inelasticity  $\lambda$")
RESTITUTION = Axis("coefficient of restitution")
COMPRESSION = Axis("compression  d / d$_Y$")
FORCE = Axis("force  F / F$_Y$")
RATIO = "R/H: radius of the bead over thickness of the plate"  # for subtitles

_LAWS: dict[str, tuple[Colour, str, str]] = {
    "hertz": (MUTED, "--", "Hertz"),
    "fem": (SKY, "-", "law fem"),
    "myc": (BLUE, "-", "MYC"),
    "thornton": (VERMILION, "-", "Thornton"),
    "stronge": (ORANGE, "-", "Stronge"),
    "kogut_etsion": (GREEN, "-.", "Kogut & Etsion"),
    "jackson_green": (PURPLE, "-.", "Jackson & Green"),
}
SPEEDS = {0.6: SKY, 1.0: BLUE, 2.2: GREEN, 3.5: PURPLE, 7.0: VERMILION}  # V0/V_Y0 of `matrix`


def sheet(
    size: tuple[float, float], title: str, subtitle: str, *panels: Panel, rows: int = 1, **grid: Any
) -> tuple[Figure, list[Axes]]:
    """Make a figure of a size in inches and its panels, row by row.

    Examples
    --------
    >>> five = [Panel(SPEED, RESTITUTION)] * 5
    >>> figure, every = sheet((9.0, 6.0), "Five panels", "in two rows", *five, rows=2)
    >>> len(every), len(figure.axes)
    (5, 5)
    """
    figure = style.figure(*size, title, subtitle)
    columns = math.ceil(len(panels) / rows)
    every = list(figure.subplots(rows, columns, squeeze=False, **grid).flat)
    while len(every) > len(panels):
        every.pop().remove()
    for axes, one in zip(every, panels, strict=True):
        one.set_up(axes)
    return figure, every


def by_thickness(
    size: tuple[float, float], title: str, subtitle: str, ratios: Sequence[float], x: Axis, y: Axis
) -> tuple[Figure, list[tuple[float, Axes]]]:
    """Make a figure with a panel for each R/H, and label its axes once."""
    panels = [Panel(x._replace(label=""), y, f"R/H = {ratio:g}") for ratio in ratios]
    figure, every = sheet(size, title, f"{subtitle}; {RATIO}", *panels, sharey=True)
    for axes in every:
        axes.label_outer()
    if len(every) % 2:
        every[len(every) // 2].set_xlabel(x.label)
    else:
        figure.supxlabel(x.label)
    return figure, list(zip(ratios, every, strict=True))


def key(axes: Axes, label: str, line: str, **look: Any) -> None:
    """Give a kind of line or mark its place in the legend; nothing is drawn."""
    axes.plot([], [], line, label=label, **{"color": INK, **look})


def cross(axes: Axes, x: ArrayLike, y: ArrayLike, colour: Colour = PALE, label: str | None = None) -> None:
    """Draw marks that stand out from lines of their colour."""
    axes.plot(
        x,
        y,
        "X",
        color=colour,
        label=label,
        markersize=9,
        markeredgecolor=INK,
        zorder=3,
        clip_on=np.size(x) == 0,  # unclipped, an empty mark takes room in the layout
    )


def law(name: str) -> tuple[Colour, str, str]:
    """Colour, line and title of a law, also of one that `_LAWS` does not list."""
    return _LAWS.get(name, (SKY, ":", name.replace("_", " ").capitalize()))


def of_law(axes: Axes, name: str, x: ArrayLike, y: ArrayLike, *, named: bool = True) -> None:
    """Draw a curve of a law; one without a name in the legend is thin."""
    colour, line, title = law(name)
    label, width = (title, 2.2) if named else (None, 1.2)
    axes.plot(x, y, line, color=colour, label=label, linewidth=width)


def matrix(axes: Axes, field: str, speed_ratio: float, unit: float = 1.0) -> None:
    """Mark a field of the finite elements over the inelasticity, at one of `SPEEDS`."""
    case = compare.comparison("matrix")
    here = np.isclose(case.speed_ratio, speed_ratio)
    cross(axes, case.inelasticity[here], case.fem[field][here] / unit, SPEEDS[speed_ratio])


def shades(count: int) -> list[Colour]:
    """Colours of a quantity that rises: dark to bright, none too pale for a line."""
    return [tuple(colormaps["viridis"](0.82 * n / (count - 1))) for n in range(count)]


def contours(axes: Axes, x: ArrayLike, y: ArrayLike, values: ArrayLike, label: str, **look: Any) -> None:
    """Draw filled contours over two quantities, with a labelled colour bar."""
    drawn = axes.contourf(x, y, values, **{"cmap": "cividis", **look})
    figure = axes.get_figure(root=True)
    assert figure is not None
    figure.colorbar(drawn, ax=axes, label=label, pad=0.03)
    axes.grid(visible=False)


def note(axes: Axes, x: float, y: float, text: str, colour: Colour = INK, **place: Any) -> None:
    """Write a remark into a panel."""
    axes.text(x, y, text, color=colour, fontsize=10.5, **place)


def error_maps(
    size: tuple[float, float], title: str, subtitle: str, maps: Mapping[str, np.ndarray], widest: float
) -> Figure:
    """Make a figure of maps of the matrix, in percent; colours end at `widest`."""
    case = compare.comparison("matrix")
    thick, speeds = np.unique(case.slenderness.round(3)), np.unique(case.speed_ratio.round(3))
    panels = [Panel(SPEED, SLENDERNESS, name) for name in maps]
    figure, every = sheet(size, title, subtitle, *panels, rows=2)
    for axes, values in zip(every, maps.values(), strict=True):
        table = 100.0 * values.reshape(thick.size, speeds.size)
        axes.imshow(table, cmap="RdBu_r", vmin=-widest, vmax=widest, aspect="auto", origin="lower")
        for (i, j), value in np.ndenumerate(table):
            ink = "white" if abs(value) > 0.55 * widest else INK
            text = f"{value:+z.1f}".replace("-", "\N{MINUS SIGN}")
            axes.text(j, i, text, ha="center", va="center", fontsize=10, color=ink)
        axes.set_xticks(range(speeds.size), [f"{v:g}" for v in speeds])
        axes.set_yticks(range(thick.size), [f"{s:g}" for s in thick])
        axes.label_outer()
        axes.grid(visible=False)
    return figure
