"""A column for each plate, in which impacts are sorted from slow to fast; rings around some."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from contactlaw import style
from contactlaw.reporting.limits import label
from dem_demo.kit.drawing import source
from dem_demo.kit.run import Runs
from dem_demo.kit.scene import Floats
from dem_demo.rain.scene import Shower


def figure(runs: Runs[Shower], title: str, points: str, rows: NDArray[np.void]) -> tuple[Figure, Axes]:
    """Make a figure with a column per plate; `points` says what each of these impacts is."""
    about = f"{source(runs)}; {points}, in each column from slow (left) to fast (right){ringed(rows)}"
    made = style.figure(style.COLUMN, 6.4, title, about)
    axes = made.add_subplot()
    labels = [label(thickness) for thickness in runs[0].scene.plates]
    axes.set_xticks(range(len(labels)), labels, rotation=60 if len(labels) > 5 else 0)
    axes.set(xlim=(-0.55, len(labels) - 0.45), xlabel="plate thickness")
    axes.grid(visible=False, axis="x")
    return made, axes


def place(runs: Runs[Shower], plate: int | NDArray[np.int64], speed: Floats) -> Floats:
    """Place of a speed [m/s] within the column of a plate."""
    fastest = float(runs[0].impacts["approach_speed"].max(initial=1e-9))
    return np.asarray(plate + 0.8 * (speed / fastest - 0.5))


def ring(axes: Axes, x: Floats, y: Floats, rows: NDArray[np.void]) -> None:
    """Mark the points of impacts that are outside a limit of the model."""
    far = rows["flags"] != 0
    axes.scatter(x[far], y[far], s=46, facecolors="none", edgecolors=style.VERMILION, linewidths=1.1)


def ringed(rows: NDArray[np.void]) -> str:
    """Legend of the rings; empty if there are none."""
    return "; ringed: outside a limit of the model" if rows["flags"].any() else ""
