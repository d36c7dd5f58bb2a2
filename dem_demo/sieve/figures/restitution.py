"""The COR of the impacts on the deck, over their approach speed.

A thin sheet gives heavy beads less back than light ones, and fast ones less than slow ones. Points
off the lines are beads that were hit by others while they touched the sheet. At the rim of an
opening a bead has several contacts at once, which share its rebound.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from contactlaw import style
from dem_demo.sieve.figures._labels import source
from dem_demo.sieve.measure import curve, on_faces
from dem_demo.sieve.record import Runs

_SHOWN = 6000  # points of each kind
_SLOWEST = 0.03  # [m/s]
_MARGIN = 0.12  # of the COR above and below the curves
_SIZES = (style.ORANGE, "smaller beads"), (style.BLUE, "larger beads")


def draw(runs: Runs) -> Figure:
    """Draw a point per impact under the law, the law's curves, and the constant."""
    run = runs.law
    figure = style.figure(
        10.5,
        6.2,
        "One sheet has many coefficients of restitution",
        f"{source(runs)}; points: impacts as they happened in the engine, lines: the law",
    )
    axes = figure.add_subplot()
    rows, radius, flat = run.collisions, run.scene.radius, on_faces(run)
    rng = np.random.default_rng(0)
    speeds = np.geomspace(_SLOWEST, max(2.0, float(rows["approach_speed"].max(initial=0.0))), 200)
    _scatter(axes, rows[~flat], rng, style.PALE)
    lowest = 1.0
    for size, (colour, name) in zip((radius.min(), radius.max()), _SIZES, strict=True):
        _scatter(axes, rows[flat & (radius[rows["bead"]] == size)], rng, colour)
        cor = curve(run, speeds, size)
        axes.plot(speeds, cor, color=style.INK, linewidth=1.0, alpha=0.8)
        axes.scatter([], [], s=30, color=colour, label=f"{name}, radius {size * 1e3:g} mm")
        lowest = min(lowest, float(cor.min()))
    axes.scatter([], [], s=30, color=style.PALE, label="at a rim or a wall")
    if runs.constant is not None and runs.constant.constant_cor is not None:
        axes.axhline(
            runs.constant.constant_cor, color=style.VERMILION, linestyle="--", linewidth=2.0,
            label=f"constant {runs.constant.name}",
        )  # fmt: skip
    axes.set_xscale("log")
    axes.set_xlim(speeds[0], speeds[-1])
    axes.set_ylim(max(0.0, lowest - _MARGIN), 1.0 + _MARGIN)
    axes.set(xlabel="normal approach speed [m/s]", ylabel="coefficient of restitution")
    axes.legend(loc="lower left")
    return figure


def _scatter(axes: Axes, rows: NDArray[np.void], rng: np.random.Generator, colour: str) -> None:
    rows = rows[rng.permutation(rows.size)[:_SHOWN]]
    axes.scatter(
        rows["approach_speed"], rows["restitution"], s=10, c=colour, alpha=0.5, linewidths=0,
        rasterized=True,
    )  # fmt: skip
