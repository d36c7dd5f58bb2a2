"""The figure of ``--plot``: curves over an axis, in panels if need be, or a map with contours."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from contactlaw import style
from contactlaw._arrays import Array
from contactlaw._readable import drawn, scale_of
from contactlaw.cli.parts import plots
from contactlaw.cli.parts.layout import AXES, Answers, Ask, Layout, is_logarithmic, layout
from contactlaw.cli.parts.plots import FlagLook, colour_of, curve, dashes_of, kinds_of
from contactlaw.physical.validity import Validity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_FLAT = 0.005  # range of a map that has no contours
_SEEN = 0.015  # width of a band that its curve does not hide


class Subject(NamedTuple):
    """What a figure is about."""

    title: str  # of the quantity that is drawn
    label: str  # of its axis
    about: str  # bodies and law


def save(
    path: str | os.PathLike[str],
    subject: Subject,
    given: Mapping[str, Sequence[float]],
    ask: Ask,
    along: int = 400,
    across: int = 81,  # steps of half a millimetre on a slide
) -> None:
    """Draw what `ask` answers into a file: PNG, SVG or PDF, by its suffix.

    The other arguments, and what is refused, are those of `layout`. Bands are shaded, first yield
    is marked, and parts that exceed limits of `Validity.ACCURACY` are dashed, in maps hatched, each
    kind in its own way.
    """
    plan = layout(given, along, across)
    found = ask(plan.grid())
    with style.applied():
        plots.save((_map if plan.is_map else _curves)(plan, found, subject), path)


def named(name: str, value: float) -> str:
    """Write the value of a quantity with its name, as short as it is understood.

    Examples
    --------
    >>> named("thickness", 1e-3), named("radius", 5e-5), named("speed", 2.0), named("angle", 30.0)
    ('plate 1 mm', 'radius 50 µm', '2 m/s', '30°')
    """
    match name:
        case "thickness":
            return plots.plate_of(value)
        case "radius":
            return f"radius {drawn(value)}"
        case "friction":
            return f"friction {value:g}"
    return f"{value:g}{'°' if name == 'angle' else ' m/s'}"


def _curves(plan: Layout, found: Answers, subject: Subject) -> Figure:
    panels, curves = found.value.shape[:2]
    columns = panels if panels < 4 else -(-panels // 2)
    rows = -(-panels // columns)
    width = 9.0 if columns == 1 else 2.0 + 4.4 * columns
    figure = _figure(width, 1.6 + 4.4 * rows, plan, found, subject)
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    kinds, x = kinds_of(found.flags), plan.values[plan.axis]
    label, scale = _unit(plan.axis, x)
    shown = _finite(x) * scale
    for p, axes in enumerate(grid.flat[:panels]):
        for c in range(curves):
            part = Answers(*(numbers[p, c] for numbers in found[:5]))
            _draw(axes, shown, part, kinds, colour_of(c, curves))
        if panels > 1:
            axes.set_title(named(plan.panel, plan.values[plan.panel][p]))
    for axes in grid.flat[panels:]:
        axes.set_visible(False)
    _scale(grid[0, 0], "x", plan.axis, x, few=panels > 1)
    grid[0, 0].set_xlabel("")
    for axes in grid.flat[max(0, panels - columns) : panels]:  # the lowest of each column
        axes.set_xlabel(label)
        axes.tick_params(labelbottom=True)
    for axes in grid[:, 0]:
        axes.set_ylabel(subject.label)
    lowest, highest = float(np.min(found.low)), float(np.max(found.high))
    margin = 0.04 * max(highest - lowest, 0.05)  # elastic beads on a half-space have 1 throughout
    grid[0, 0].set_ylim(lowest - margin, highest + margin)
    if curves > 1:
        figure.draw_without_rendering()  # so that the positions of the curves' ends are known
        names = [named(plan.curve, value) for value in plan.values[plan.curve]]
        for p, axes in enumerate(grid.flat[:panels]):
            _label(axes, found.value[p, :, shown.size - 1], names)
    return figure


def _finite(values: Array) -> Array:
    return values[values < math.inf]


def _draw(axes: Axes, x: Array, found: Answers, kinds: dict[Validity, FlagLook], colour: Any) -> None:
    """Draw a curve with its band and first yield; what follows the finite x is a thin line."""
    parts: list[Any] = [part[: x.size] for part in found[:5]]
    value, flags, overload, low, high = parts
    axes.fill_between(x, low, high, color=colour, alpha=0.2, linewidth=0.0)
    curve(axes, x, value, flags, kinds, color=colour, linewidth=2.4)
    if found.value.size > x.size:
        last = found.value[[-1, -1]], found.flags[[-1, -1]]
        curve(axes, x[[0, -1]], *last, kinds, color=colour, linewidth=1.0)
    for n in np.flatnonzero(np.diff(overload > 1.0)):
        share = (1.0 - overload[n]) / (overload[n + 1] - overload[n])
        at: list[Any] = [part[n] + share * (part[n + 1] - part[n]) for part in (x, value)]
        axes.plot(*at, "v", color=colour, markersize=10, markeredgecolor="white", zorder=3)


def _map(plan: Layout, found: Answers, subject: Subject) -> Figure:
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap
    from matplotlib.patheffects import withStroke
    from matplotlib.ticker import MaxNLocator

    figure = _figure(9.0, 7.0, plan, found, subject)
    axes, kinds = figure.add_subplot(), kinds_of(found.flags)
    x, y = (plan.values[name] * _unit(name, plan.values[name])[1] for name in (plan.axis, plan.curve))
    for which, name in (("x", plan.axis), ("y", plan.curve)):
        _scale(axes, which, name, plan.values[name])
    value, flags, overload = (part[0] for part in found[:3])
    least, most = float(value.min()), float(value.max())
    nice = np.array(MaxNLocator(10, steps=[1, 2, 5, 10]).tick_values(least, most))
    inner = nice[(nice > least) & (nice < most) & (most - least > _FLAT)]
    colours = ListedColormap(colormaps["viridis"](np.linspace(0.25, 1.0, 256)))  # hatches are dark
    levels = [min(least, most - 0.01), *inner, most]
    filled = axes.contourf(x, y, value, levels, cmap=colours)
    ticks = inner if inner.size else [most]
    figure.colorbar(filled, label=subject.label, ticks=ticks, spacing="proportional", format="%g")
    for flag, kind in kinds.items():
        axes.contourf(x, y, (flags & flag) != 0, [0.5, 1.5], colors="none", hatches=[kind.hatch])
    if overload.min() < 1.0 < overload.max():
        line = axes.contour(x, y, overload, [1.0], colors=style.INK, linewidths=3.0)
        line.set_path_effects([withStroke(linewidth=6.0, foreground="white")])
    axes.grid(visible=False)
    if inner.size:
        lines = axes.contour(x, y, value, inner, colors="white", linewidths=1.0)
        figure.draw_without_rendering()  # so that the slopes of the lines are known
        for text in axes.clabel(lines, fmt="%g", fontsize=12, inline=False):
            text.set(color=style.INK, fontweight="bold", path_effects=[withStroke(linewidth=3.0, foreground="white")])
            corners = text.get_window_extent().corners()
            text.set_visible(axes.bbox.count_contains(corners) == 4)  # none that is cut off
    return figure


def _figure(width: float, height: float, plan: Layout, found: Answers, subject: Subject) -> Figure:
    """Make an empty figure that says what it is about and what its marks mean."""
    over = [AXES[name].label for name in (plan.axis, plan.curve)[: 1 + plan.is_map]]
    varied = plan.axis, plan.curve, plan.panel
    fixed = [named(name, at[0]) for name, at in plan.values.items() if name not in varied]
    about, parts = ", ".join([subject.about, *fixed]), list[str]()
    yields = (found.overload > 1.0)[..., plan.values[plan.axis] < math.inf]
    lasting = yields.all(axis=-1)
    if (yields.any(axis=-1) & ~lasting).any():
        parts.append(f"{'thick line' if plan.is_map else 'triangle'}: yield point")
    if lasting.all():
        parts.append("a body yields everywhere")
    elif lasting.any() and not plan.is_map:
        parts.append("some curves lie beyond the yield point")
    elif not yields.any():
        parts.append("nothing yields")
    half = 0.5 * (found.high - found.low)
    if plan.is_map and found.said:
        ends = dict.fromkeys(f"{end:.2g}" for end in (half.min(), half.max()))
        parts.append(f"±{' to '.join(ends)}: {found.said}")
    elif half.max() > 0.5 * _SEEN:
        parts.append(f"shaded: {found.said}")
    if not plan.is_map and math.inf in plan.values[plan.axis]:
        parts.append("thin line: half-space")
    kinds = kinds_of(found.flags)
    exceeded = (sum(bool(one & flag) for flag in kinds) for one in np.unique(found.flags).tolist())
    if not plan.is_map and max(exceeded) > 1:
        parts.append("beyond several limits dashes have a stroke of each")
    title = f"{subject.title} over {' and '.join(over)}"
    caption = ". ".join([about, *(part[0].upper() + part[1:] for part in parts)])
    keys = _keys(kinds, width, plan.is_map)
    height += 0.3 * sum(1 + key.get_label().count("\n") for key in keys)
    figure = style.figure(width, height, title, caption)
    if keys:
        figure.legend(handles=keys, loc="outside lower left", handlelength=4.0)
    return figure


def _keys(kinds: dict[Validity, FlagLook], width: float, hatched: bool) -> list[Any]:
    """Show a sample of each kind of dashes or hatches with the limit that it stands for."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    keys: list[Any] = []
    for flag, kind in kinds.items():
        words = "\n".join(style.balanced(kind.words, 9.5 * width))
        if hatched:
            keys.append(Patch(facecolor="none", edgecolor=style.INK, hatch=kind.hatch, label=words))
        else:
            dashes = dashes_of(flag, kinds)
            keys.append(Line2D([], [], color=style.INK, linewidth=2.4, linestyle=dashes, label=words))
    return keys


def _unit(name: str, values: Array) -> tuple[str, float]:
    """Name an axis with its unit, for lengths that of the largest; and units per SI unit."""
    label, quantity, _ = AXES[name]
    unit, _ = scale_of(_finite(values)[-1], quantity.si)
    shown = unit.translate({ord("u"): "µ"}).replace("deg", "° from the normal")
    return f"{label} [{shown}]", 1.0 / float(quantity.units[unit])


def _scale(axes: Axes, which: str, name: str, values: Array, few: bool = False) -> None:
    """Set range, spacing and ticks of an axis ("x" or "y")."""
    label, scale = _unit(name, values)
    least, largest = _finite(values)[[0, -1]] * scale
    if is_logarithmic(name, least, largest):
        axes.set(**{f"{which}scale": "log"})
        width = math.log10(largest / least) * (2.0 if few else 1.0)
        steps = (1.0,) if width > 4.0 else (1.0, 2.0, 5.0) if width > 2.0 else (1.0, 2.0, 3.0, 5.0)
        style.decades(getattr(axes, f"{which}axis"), steps)
    axes.set(**{f"{which}lim": (least, largest), f"{which}label": label})


def _label(axes: Axes, at: Array, names: list[str]) -> None:
    """Write the name of each curve beside its end, without overlap."""
    ends = axes.transData.transform(np.column_stack([np.full_like(at, axes.get_xlim()[1]), at]))
    heights = axes.transAxes.inverted().transform(ends)[:, 1]
    line = 1.3 * 12.0 / 72.0 / (axes.bbox.height / axes.figure.dpi)
    for n, (at, to) in enumerate(zip(heights, _spread(heights, line), strict=True)):
        colour = colour_of(n, len(names))
        axes.plot([1.0, 1.02], [at, to], transform=axes.transAxes, color=colour, linewidth=2.0, clip_on=False)
        axes.text(1.03, to, names[n], transform=axes.transAxes, color=style.INK, va="center", fontweight="bold")


def _spread(heights: Array, least: float) -> Array:
    """Move heights apart to a least distance, with the least sum of squared displacements."""
    order = np.argsort(heights)
    shifts = least * np.arange(heights.size)
    # This is an isotonic regression: neighbours that are too near are pooled about their mean.
    blocks: list[list[float]] = []
    for height in heights[order] - shifts:
        blocks.append([float(height)])
        while len(blocks) > 1 and np.mean(blocks[-2]) >= np.mean(blocks[-1]):
            blocks[-2:] = [blocks[-2] + blocks[-1]]
    level = np.concatenate([[np.mean(block)] * len(block) for block in blocks])
    spread = np.empty_like(heights)
    spread[order] = np.clip(level, 0.0, 1.0 - shifts[-1]) + shifts
    return spread
