"""The scene at one instant: beads as streaks, coloured by their last rebound from a plate."""

from __future__ import annotations

import math

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from numpy.typing import NDArray

from dem_demo import style
from dem_demo.figures._labels import source
from dem_demo.frame import FLYING
from dem_demo.reader import Run
from dem_demo.report import label
from dem_demo.scene import Floats, Scene

_EXPOSURE = 2e-3  # [s]: streaks are as long as the path flown in this time
_MAGNIFIED = 2.5  # times their size, or beads would hardly be seen
_MM = 1e3
_HALF_SPACE = 8e-3  # [m], drawn depth of a plate of infinite thickness


def draw(run: Run) -> Figure:
    """Draw the busiest instant: most beads in sight that have hit a plate."""
    scene = run.scene
    frame = _busiest(run)
    figure = style.figure(
        12.0,
        6.6,
        "Beads rain on plates of different thickness",
        f"{source(run)}; t = {run.time[frame] * 1e3:.0f} ms, beads drawn {_MAGNIFIED:g} "
        f"times their size, streaks: the last {_EXPOSURE * 1e3:g} ms",
    )
    axes = figure.add_subplot()
    _draw_plates(axes, scene)
    colours = _draw_beads(axes, run, frame)
    bar = figure.colorbar(colours, ax=axes, pad=0.01, fraction=0.03)
    bar.set_label("COR of the bead's last impact on a plate")
    left, right, top = _window(scene)
    axes.set(xlim=(left * _MM, right * _MM), ylim=(scene.floor * _MM, top * _MM), aspect="equal")
    axes.set(xlabel="x [mm]", ylabel="height [mm]")
    axes.grid(visible=False)
    return figure


def _window(scene: Scene) -> tuple[float, float, float]:
    left = min(plate.x0 for plate in scene.plates) - 0.01
    right = max(plate.x1 for plate in scene.plates) + 0.01
    return left, right, 1.08 * float(scene.beads.position[:, 1].max())


def _last_restitution(run: Run, until: float) -> Floats:
    """COR of each bead's last impact on a plate [-], NaN before the first."""
    rows = run.collisions[(run.collisions["plate"] >= 0) & (run.collisions["time"] <= until)]
    last = np.full(run.scene.beads.radius.size, math.nan)
    last[rows["bead"]] = rows["restitution"]  # in order of time: the last one stays
    return last


def _in_sight(run: Run, frame: int) -> NDArray[np.bool_]:
    left, right, top = _window(run.scene)
    x, y = run.position[frame].T
    seen: NDArray[np.bool_] = (run.status[frame] == FLYING) & (left < x) & (x < right) & (y < top)
    return seen


def _busiest(run: Run) -> int:
    rows = run.collisions[run.collisions["plate"] >= 0]
    first = np.full(run.scene.beads.radius.size, math.inf)
    np.minimum.at(first, rows["bead"], rows["time"])
    hits = [int((_in_sight(run, n) & (first <= time)).sum()) for n, time in enumerate(run.time)]
    return int(np.argmax(hits))


def _draw_plates(axes: Axes, scene: Scene) -> None:
    for plate in scene.plates:
        depth = min(plate.thickness, _HALF_SPACE)
        corner = plate.x0 * _MM, (plate.y - depth) * _MM
        axes.add_patch(
            Rectangle(
                corner, (plate.x1 - plate.x0) * _MM, depth * _MM, facecolor=style.INK, linewidth=0
            )
        )
        axes.annotate(
            label(plate.thickness),
            (0.5 * (plate.x0 + plate.x1) * _MM, (plate.y - depth) * _MM),
            xytext=(0, -4),
            textcoords="offset points",
            ha="center",
            va="top",
            fontweight="bold",
        )


def _draw_beads(axes: Axes, run: Run, frame: int) -> PatchCollection:
    """Circles and streaks; returns the coloured circles for the colour bar."""
    seen = _in_sight(run, frame)
    radius = run.scene.beads.radius[seen]
    position, velocity = run.position[frame][seen], run.velocity[frame][seen]
    last = _last_restitution(run, float(run.time[frame]))[seen]
    tail = position - velocity * _EXPOSURE
    # A rising bead came from a plate at the earliest, a falling one from its nozzle.
    reach = np.clip(tail[:, 1], radius, run.scene.beads.position[seen, 1])
    below = position[:, 1] < radius  # has missed the plates
    tail[:, 1] = np.where(below, tail[:, 1], reach)
    circles = PatchCollection(
        [
            Circle((x * _MM, y * _MM), _MAGNIFIED * r * _MM)
            for (x, y), r in zip(position, radius, strict=True)
        ],
        cmap=colormaps["viridis"].with_extremes(bad=style.MUTED),
        zorder=3,
    )
    colour = np.ma.masked_invalid(last)
    circles.set_array(colour)
    lowest = np.nanmin(run.collisions["restitution"][run.collisions["plate"] >= 0], initial=1.0)
    circles.set_clim(min(float(lowest), 0.99), 1.0)
    streaks = LineCollection(
        list(np.stack((tail, position), axis=1) * _MM),
        colors=list(circles.to_rgba(colour)),
        linewidths=1.2,
        alpha=0.45,
        zorder=2,
    )
    axes.add_collection(streaks)
    axes.add_collection(circles)
    return circles
