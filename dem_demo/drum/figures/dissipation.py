"""Where round the drum its shell takes energy from the beads: where it wears, rings and warms.

Bars show energy that impacts dissipate, in bending waves and at the contact, without sliding
friction. The drum turns clockwise; the directions do not turn with it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from contactlaw import style
from dem_demo.drum.scene import Drum
from dem_demo.kit import graphs
from dem_demo.kit.beads import Floats
from dem_demo.kit.runs import Run, Runs

_BINS = 36
_LOSSES = ("wave", "bending wave in the plate"), ("plastic", "lost at the contact")


def draw(runs: Runs[Drum]) -> Figure:
    """Draw the shell as a clock, under the law and with a constant COR."""
    figure = style.figure(
        12.0,
        7.5,
        "Where round the drum its shell dissipates energy",
        f"{graphs.source(runs)}; seen along the axis, {360 // _BINS} degrees per bar, "
        f"energy dissipated in {runs.law.time[-1] * 1e3:.0f} ms",
    )
    shown: list[tuple[Any, Run[Any]]] = graphs.panels(figure, runs, projection="polar")
    for axes, run in shown:
        bottom = np.zeros(_BINS)
        width = math.tau / _BINS
        middle = width * (np.arange(_BINS) + 0.5)
        for (name, text), colour in zip(_LOSSES, (style.BLUE, style.ORANGE), strict=True):
            share = _round(run, f"{name}_energy") * 1e6
            axes.bar(middle, share, width, bottom, color=colour, label=text, edgecolor="white", linewidth=0.6)
            bottom += share
        axes.set(theta_zero_location="N", theta_direction=-1)
        axes.set_xticks(np.arange(4) * 0.5 * math.pi, ["", "right", "bottom", "left"])
        axes.yaxis.set_major_locator(MaxNLocator(3))
        axes.yaxis.set_major_formatter("{x:g} µJ")
        axes.set_rlabel_position(20.0)
        axes.set_ymargin(0.15)  # room for the outermost number inside the circle
        axes.tick_params(axis="x", pad=8.0)
        axes.set_title(axes.get_title("left"), loc="center", pad=10.0)
        axes.set_title("", loc="left")
    figure.legend(*shown[0][0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _round(run: Run[Drum], column: str) -> Floats:
    """Sum a column of the impacts on the shell by direction, clockwise from the top."""
    rows = run.collisions[run.collisions["plate"] == 0]
    angle = np.arctan2(rows["x"], rows["z"]) % math.tau
    return np.asarray(np.histogram(angle, _BINS, (0.0, math.tau), weights=rows[column])[0])
