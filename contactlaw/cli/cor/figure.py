"""The figure of ``contactlaw cor``: COR over speed, a curve per plate or bead."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contactlaw import style
from contactlaw.cli.cor import bands
from contactlaw.cli.cor.curves import CorCurve, is_logarithmic
from contactlaw.cli.parts import plots, wording
from contactlaw.cli.parts.plots import SUFFIXES, colour_of, length_of, plate_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

_SEEN = 0.015  # width of a band of the COR that its curve does not hide


def save_restitution(curves: Sequence[CorCurve], title: str, path: str | os.PathLike[str]) -> None:
    """Draw the COR over speed into a file: a curve per plate or bead, first yield marked.

    A curve has its band, shaded, and is dashed where impacts have a flag of `Validity.ACCURACY`.
    Several beads on several plates have a panel per bead.

    Parameters
    ----------
    curves : sequence of CorCurve
        Result of `contactlaw.cli.cor.curves.restitution_curves`.
    title : str
        Title of the figure.
    path : path-like
        File to write: PNG, SVG or PDF, by its suffix.

    Raises
    ------
    ImportError
        If matplotlib is missing; the message says how to install it.
    ValueError
        If the suffix names no format.
    """
    wording.check_suffix("path", path, SUFFIXES)
    radii = dict.fromkeys(curve.radius for curve in curves)
    by_radius = len(radii) == len(curves) > 1
    panels = [list(curves)] if by_radius else [[c for c in curves if c.radius == r] for r in radii]
    with style.applied():
        figure = _restitution_figure(panels, title, by_radius)
        figure.savefig(path)


def _restitution_figure(panels: list[list[CorCurve]], title: str, by_radius: bool) -> Figure:
    columns = len(panels) if len(panels) < 4 else -(-len(panels) // 2)
    rows = -(-len(panels) // columns)
    width = 9.0 if columns == 1 else 2.0 + 4.4 * columns
    figure = style.figure(width, 1.2 + 4.4 * rows, title, _caption(panels, by_radius))
    grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axes, curves in zip(grid.flat, panels, strict=False):
        for n, curve in enumerate(curves):
            _draw(axes, curve, colour_of(n, len(curves)))
        if len(panels) > 1:
            axes.set_title(f"bead radius {length_of(curves[0].radius)}")
    for axes in grid.flat[len(panels) :]:
        axes.set_visible(False)
    _axes(grid, panels)
    figure.draw_without_rendering()  # so that the positions of the curves' ends are known
    for axes, curves in zip(grid.flat, panels, strict=False):
        names = _names(curves, by_radius, short=len(panels) > 1)
        _label(axes, curves, names)
    return figure


def _caption(panels: list[list[CorCurve]], by_radius: bool) -> str:
    curves = [curve for panel in panels for curve in panel]
    least, largest = curves[0].speed[[0, -1]]
    parts = [f"bead radius {length_of(curves[0].radius)}"]
    if by_radius:
        parts = [plate_of(curves[0].thickness)]
    elif len(panels) > 1:
        parts = ["a curve per thickness of the plate"]
    yields = [curve.yield_speed for curve in curves]
    if min(yields) < least:
        parts.append(f"first yield {'' if max(yields) < least else 'of some '}below {least:g} m/s")
    if any(least <= speed <= largest for speed in yields):
        parts.append("triangle: first yield")
    known = [curve.band for curve in curves if curve.band]
    if known and max(np.max(np.subtract(band.high, band.low)) for band in known) > _SEEN:
        parts.append(f"shaded: {bands.meaning(known[0])}")
        if len(known[0].causes) > 1:
            parts[-1] += f", mostly by the {bands.main_cause(known)}"
    reasons = plots.limits_of(np.concatenate([curve.flags for curve in curves]))
    if reasons:
        parts.append(f"dashed: {reasons}")
    return ". ".join(part[0].upper() + part[1:] for part in parts)


def _names(curves: list[CorCurve], by_radius: bool, short: bool) -> list[str]:
    if by_radius:
        return [f"radius {length_of(curve.radius)}" for curve in curves]
    return [(length_of if short else plate_of)(curve.thickness) for curve in curves]


def _draw(axes: Axes, curve: CorCurve, colour: Any) -> None:
    if curve.band:
        ends = curve.band.low, curve.band.high
        axes.fill_between(curve.speed, *ends, color=colour, alpha=0.2, linewidth=0.0)
    plots.curve(axes, curve.speed, curve.restitution, curve.flags, colour)
    if curve.at_yield == curve.at_yield:  # not NaN
        axes.plot(
            curve.yield_speed, curve.at_yield, "v", color=colour, markersize=10,
            markeredgecolor="white", zorder=3,
        )  # fmt: skip


def _axes(grid: NDArray[Any], panels: list[list[CorCurve]]) -> None:
    curves = [curve for panel in panels for curve in panel]
    least, largest = curves[0].speed[[0, -1]]
    first = grid[0, 0]
    if is_logarithmic(least, largest):
        first.set_xscale("log")
        few = largest > (1e4 if len(panels) == 1 else 1e2) * least
        steps = (1.0,) if few else (1.0, 2.0, 5.0)
        decades = range(math.floor(math.log10(least)), math.ceil(math.log10(largest)) + 1)
        ticks = [step * 10.0**n for n in decades for step in steps]
        shown = [tick for tick in ticks if 0.999 * least <= tick <= 1.001 * largest]
        shown = shown[:: 1 + len(shown) // 16]  # at most 16 ticks, also over thirty decades
        first.set_xticks(shown, [f"{tick:g}" for tick in shown])
        first.minorticks_off()
    first.set_xlim(least, largest)
    ends = (curve.band.low if curve.band else curve.restitution for curve in curves)
    lowest = min(float(np.min(low)) for low in ends)
    span = max(1.0 - lowest, 0.05)  # the COR of elastic beads on a half-space is 1 throughout
    first.set_ylim(max(0.0, 1.0 - 1.06 * span), 1.0 + 0.03 * span)
    for axes in grid.flat[max(0, len(panels) - grid.shape[1]) :]:  # the lowest of each column
        axes.set_xlabel("impact speed [m/s]")
        axes.tick_params(labelbottom=True)
    for axes in grid[:, 0]:
        axes.set_ylabel("coefficient of restitution [-]")


def _label(axes: Axes, curves: list[CorCurve], names: list[str]) -> None:
    """Write the name of each curve at its end, without overlap."""
    ends = [axes.transData.transform((curve.speed[-1], curve.restitution[-1])) for curve in curves]
    heights = axes.transAxes.inverted().transform(ends)[:, 1]
    line = 1.3 * 12.0 / 72.0 / (axes.bbox.height / axes.figure.dpi)
    for n, (at, to) in enumerate(zip(heights, _spread(heights, line), strict=True)):
        colour = colour_of(n, len(curves))
        axes.plot([1.0, 1.02], [at, to], transform=axes.transAxes, color=colour, linewidth=2.0,
                  clip_on=False)  # fmt: skip
        axes.text(1.03, to, names[n], transform=axes.transAxes, color=style.INK, va="center",
                  fontweight="bold")  # fmt: skip


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
