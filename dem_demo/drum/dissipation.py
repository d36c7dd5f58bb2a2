"""Where round the drum its shell takes energy from the beads: where it wears, rings and warms.

Bars show energy that impacts dissipate, in bending waves and at the contact, without sliding
friction. The drum turns clockwise; the directions do not turn with it.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from contactlaw import style
from dem_demo.drum.scene import Drum
from dem_demo.kit.drawing import panels, source
from dem_demo.kit.run import Runs

_BINS = 36


def draw(runs: Runs[Drum]) -> Figure:
    """Draw the shell as a clock, under the law and with a constant COR."""
    figure = style.figure(
        style.COLUMN,
        10.6,
        "Where round the drum its shell dissipates energy",
        f"{source(runs)}; seen along the axis, {360 // _BINS} degrees per bar, "
        f"energy dissipated in {runs[0].time[-1] * 1e3:.0f} ms",
    )
    width = math.tau / _BINS
    for axes, run in panels(figure, runs, projection="polar"):
        rows, bottom = run.contacts[run.contacts["plate"] == 0], np.zeros(_BINS)
        angle = np.arctan2(rows["x"], rows["z"]) % math.tau  # clockwise from the top
        for name in ("wave", "plastic"):
            share = 1e6 * np.histogram(angle, _BINS, (0.0, math.tau), weights=rows[f"{name}_energy"])[0]
            text, colour = style.ENERGIES[name]
            middle = width * (np.arange(_BINS) + 0.5)
            axes.bar(middle, share, width, bottom, color=colour, label=text, edgecolor="white", linewidth=0.6)
            bottom += share
        axes.set(theta_zero_location="N", theta_direction=-1)
        axes.set_xticks(np.arange(4) * 0.5 * math.pi, ["", "right", "bottom", "left"])
        axes.yaxis.set_major_locator(MaxNLocator(3))
        axes.yaxis.set_major_formatter("{x:g} µJ")
        axes.set(rlabel_position=20.0, ymargin=0.15)  # room for the outermost number inside the circle
        axes.tick_params(axis="x", pad=8.0)
        axes.set_title(axes.get_title("left"), loc="center", pad=10.0)
        axes.set_title("", loc="left")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure
