"""Figures that every bed has, and helpers for the figures of a scene: titles, and a panel per run.

The caption of a figure is in the scene's file of the same name.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from contactlaw import style
from contactlaw.reporting.limits import label
from dem_demo.kit.measure import account, curve
from dem_demo.kit.runs import Run, Runs

MM = 1e3

_SHOWN = 6000  # most points that are drawn of each kind
_SLOWEST = 0.03  # [m/s], left end of the speed axis
_MARGIN = 0.12  # room on the COR axis below the curves; above them half of it
_PARTS = (
    ("moving", "kinetic energy of the beads", style.PALE),
    ("wave", "bending wave in the plate", style.BLUE),
    ("plastic", "lost at the contact", style.ORANGE),
    ("vibration", "micro-slip and vibration at the contact", style.VERMILION),
    ("friction", "friction on the walls", style.SKY),
    ("others", "bead on bead", style.GREEN),
)


def source(runs: Runs[Any]) -> str:
    """Subtitle: beads, plate material and thickness."""
    scene = runs.law.scene
    return (
        f"{scene.radius.size} beads of {scene.sphere_material.name} on "
        f"{scene.plate_material.name}, {label(scene.thickness)}"
    )


def panels(
    figure: Figure, runs: Runs[Any], *, stacked: bool = False, projection: str | None = None
) -> list[tuple[Axes, Run[Any]]]:
    """Make a panel for each run, titled with the name of the run; all have the same scale."""
    n = len(runs.both)
    shape = (n, 1) if stacked else (1, n)
    kind = {"projection": projection}
    grid = figure.subplots(*shape, sharex=True, sharey=True, squeeze=False, subplot_kw=kind)
    found = list(zip(grid.flat, runs.both, strict=True))
    for axes, run in found:
        cor = run.constant_cor
        name = f"contactlaw, {run.name}" if cor is None else f"constant {run.name}"
        axes.set_title(name)
    return found


def energy(runs: Runs[Any], title: str, wall: str) -> Figure:
    """Draw where the energy is over time, stacked, under the law and with a constant COR."""
    figure = style.figure(12.0, 6.0, title, f"{source(runs)}; energies of all beads since the start")
    shown = panels(figure, runs)
    for axes, run in shown:
        found = account(run)
        parts = [getattr(found, field) * 1e3 for field, _, _ in _PARTS]
        used = [n for n, part in enumerate(parts) if np.abs(part).max(initial=0.0) > 0.0]
        axes.stackplot(
            run.time * 1e3,
            [parts[n] for n in used],
            labels=[_PARTS[n][1] for n in used],
            colors=[_PARTS[n][2] for n in used],
            linewidth=0,
        )
        whole = (found.start + found.gravity + found.walls) * 1e3
        axes.plot(run.time * 1e3, whole, color=style.INK, linewidth=2.0, label="total")
        without = (found.start + found.gravity) * 1e3
        axes.plot(
            run.time * 1e3,
            without,
            color=style.INK,
            linewidth=1.5,
            linestyle=":",
            label=f"without the work of the {wall}",
        )
        axes.set_xlim(0.0, run.time[-1] * 1e3 or 1.0)
        axes.set(xlabel="time [ms]", ylabel="energy [mJ]")
        axes.label_outer()
    handles: dict[str, Artist] = {}
    for axes, _ in shown:
        handles |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    figure.legend(handles.values(), list(handles), loc="outside lower center", ncols=3)
    return figure


def restitution(
    runs: Runs[Any], flat: NDArray[np.bool_], kinds: list[tuple[str, NDArray[np.bool_]]], title: str, others: str
) -> Figure:
    """Draw a point per impact under the law, the law's curves, and the constant."""
    run = runs.law
    figure = style.figure(
        10.5, 6.2, title, f"{source(runs)}; points: impacts as they happened in the engine, lines: the law"
    )
    axes = figure.add_subplot()
    rows, radius = run.collisions, run.scene.radius
    rng = np.random.default_rng(0)
    speeds = np.geomspace(_SLOWEST, max(2.0, float(rows["approach_speed"].max(initial=0.0))), 200)
    flat, cors = flat & run.record.impact, run.impacts["restitution"]
    _scatter(axes, rows[~flat & run.record.impact], rng, style.PALE)
    lowest, highest = 1.0, float(np.quantile(cors, 0.98)) if cors.size else 1.0
    for (name, which), colour in zip(kinds, (style.ORANGE, style.BLUE), strict=True):
        _scatter(axes, rows[flat & which[rows["bead"]]], rng, colour)
        sizes = sorted({radius[which].min(initial=np.inf), radius[which].max(initial=0.0)})
        axes.scatter([], [], s=30, color=colour, label=name)
        for size in sizes if which.any() else ():
            cor = curve(run, speeds, size)
            axes.plot(speeds, cor, color=style.INK, linewidth=1.0, alpha=0.8)
            lowest, highest = min(lowest, float(cor.min())), max(highest, float(cor.max()))
    axes.scatter([], [], s=30, color=style.PALE, label=others)
    if runs.constant.constant_cor is not None:
        axes.axhline(
            runs.constant.constant_cor,
            color=style.VERMILION,
            linestyle="--",
            linewidth=2.0,
            label=f"constant {runs.constant.name}",
        )
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_xlim(speeds[0], speeds[-1])
    axes.set_ylim(max(0.0, lowest - _MARGIN), min(1.0, highest) + 0.5 * _MARGIN)
    axes.set(xlabel="normal approach speed [m/s]", ylabel="coefficient of restitution")
    axes.legend(loc="lower left")
    return figure


def _scatter(axes: Axes, rows: NDArray[np.void], rng: np.random.Generator, colour: str) -> None:
    rows = rows[rng.permutation(rows.size)[:_SHOWN]]
    few = rows.size < 500
    axes.scatter(
        rows["approach_speed"],
        rows["restitution"],
        s=26 if few else 10,
        c=colour,
        alpha=0.7 if few else 0.5,
        linewidths=0,
        rasterized=True,
    )
