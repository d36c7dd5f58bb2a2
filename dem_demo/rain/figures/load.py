"""What a force sensor under each plate would see.

Left: the load over time. Right: the force in the hardest contact, which lasts microseconds.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactlaw import load_signal, style
from contactlaw.reporting.limits import label
from dem_demo.rain.figures._labels import source
from dem_demo.rain.record import Run

_SAMPLES = 1000  # least number of samples, which keeps single impacts apart


def draw(run: Run) -> Figure:
    """Draw a row per plate: the load over the whole run, and the hardest contact."""
    plates = run.scene.plates
    constant = run.baseline
    rate = 10.0 ** math.ceil(math.log10(_SAMPLES / run.scene.duration))
    figure = style.figure(
        13.0,
        1.9 + 1.25 * len(plates),
        "What a force sensor on each plate would see",
        f"{source(run)}; left: mean force over each {1e3 / rate:g} ms, right: hardest "
        "contact" + ("; forces by contactlaw for the run's impacts" if constant else ""),
    )
    grid = figure.subplots(
        len(plates), 2, sharex="col", sharey="col", squeeze=False, width_ratios=(4.0, 1.0)
    )
    for n, (left, right) in enumerate(grid):
        _plate(left, right, run, n, rate)
    for axes in grid[:, 1]:
        axes.yaxis.set_label_position("right")
        axes.yaxis.tick_right()
    grid[0, 0].set_ylim(0.0, None)
    grid[0, 1].set(xlim=(0.0, None), ylim=(0.0, None))
    grid[0, 0].set_xlim(0.0, run.scene.duration)
    grid[len(plates) // 2, 0].set_ylabel("load [N]")
    grid[len(plates) // 2, 1].set_ylabel("contact force [N]")
    grid[-1, 0].set_xlabel("time [s]")
    grid[-1, 1].set_xlabel("time since touch [µs]")
    return figure


def _plate(left: Axes, right: Axes, run: Run, plate: int, rate: float) -> None:
    here = run.modelled["plate"] == plate
    rows, distance = run.modelled[here], run.edge_distance[here]
    speed, radius = rows["approach_speed"], run.scene.beads.radius[rows["bead"]]
    thickness = run.scene.plates[plate].thickness
    load = load_signal(
        rows["time"], speed, radius, thickness,
        model=run.model, rate=rate, duration=run.scene.duration,
    )  # fmt: skip
    left.fill_between(load.time, load.force, step="mid", color=style.BLUE, linewidth=0.6)
    left.set_title(label(thickness), pad=3.0)
    if rows.size:
        n = int(np.argmax(rows["peak_force"]))
        contact = run.model.force_history(speed[n], radius[n], thickness, edge_distance=distance[n])
        right.plot(contact.time * 1e6, contact.force, color=style.VERMILION, linewidth=2.0)
