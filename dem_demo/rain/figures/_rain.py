"""Drawings of the rain for figure, film and page: window, plates, beads coloured by COR."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from contactlaw import style
from contactlaw.reporting.limits import label
from dem_demo.kit.beads import Floats
from dem_demo.rain import paths
from dem_demo.rain.measure import restitution_range
from dem_demo.rain.record import Run
from dem_demo.rain.scene import Scene

MM = 1e3
# Beads are drawn this many times as large, to be visible, and with friction to show that they turn.
_MAGNIFIED, _TURNING_MAGNIFIED = 3.0, 5.0
PLATES_MAGNIFIED = 4.0  # plates are drawn this many times as thick, to look different
TURNING = 20.0  # spins, of a thousand turns a second, are drawn this many times slower than paths
HAND = 1.6  # [drawn radius], length of the hand that turns with a bead
EXPOSURE = 2e-3  # [s]; a streak is the path of a bead in this time
_HALF_SPACE = 3e-3  # [m], drawn depth of a plate of infinite thickness
_SIDES, _BELOW = 0.01, 0.016  # [m] beside and below the plates
_ABOVE = 1.08  # top of the picture over the height of the nozzles


def window(scene: Scene) -> tuple[float, float, float, float]:
    """Left, right, bottom and top [m] of what is shown."""
    left = min(plate.x0 for plate in scene.plates) - _SIDES
    right = max(plate.x1 for plate in scene.plates) + _SIDES
    deepest = max(drawn_depth(plate.thickness) - plate.y for plate in scene.plates)
    bottom = min(scene.floor, -deepest - _BELOW)
    return left, right, bottom, _ABOVE * float(scene.beads.position[:, 1].max())


def magnified(run: Run) -> float:
    """How many times their size beads are drawn."""
    return _TURNING_MAGNIFIED if run.scene.friction else _MAGNIFIED


def drawn_depth(thickness: float) -> float:
    """Depth [m] with which a plate is drawn."""
    return PLATES_MAGNIFIED * min(thickness, _HALF_SPACE)


def instants(run: Run, made: NDArray[np.void]) -> tuple[Floats, NDArray[np.int64]]:
    """Count, for the time of each frame, the beads in the window that have hit a plate."""
    left, right, _, top = window(run.scene)
    counts = []
    for time in run.time.tolist():
        now = paths.at(made, time)
        x, y = paths.places(now, time).T
        hit = np.isfinite(now["restitution"])
        counts.append(int((hit & (left < x) & (x < right) & (0.0 < y) & (y < top)).sum()))
    return run.time, np.array(counts)


class Picture:
    """Plates, and beads with streaks; `show` moves them.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    run : Run
        The run.
    made : ndarray
        Flight of its beads, from `paths.pieces`.
    """

    def __init__(self, axes: Axes, run: Run, made: NDArray[np.void]) -> None:
        self.axes, self.run, self.made = axes, run, made
        _draw_plates(axes, run.scene)
        self.streaks = LineCollection([], linewidths=1.2, alpha=0.45, zorder=2)
        axes.add_collection(self.streaks)
        self.circles = style.circles(axes, style.MUTED)
        self.circles.set_clim(*restitution_range(run))
        self.hands = LineCollection([], linewidths=1.0, colors=style.INK, zorder=4)
        axes.add_collection(self.hands)

    @property
    def moving(self) -> tuple[LineCollection, EllipseCollection, LineCollection]:
        """The parts of the picture that move."""
        return self.streaks, self.circles, self.hands

    def show(self, time: float) -> None:
        """Show the beads at a time [s]."""
        now = paths.at(self.made, time)
        place = paths.places(now, time)
        size = 2.0 * magnified(self.run) * self.run.scene.beads.radius[now["bead"]] * MM
        colour = np.ma.masked_invalid(now["restitution"])
        self.circles.set(offsets=place * MM, widths=size, heights=size, angles=0.0 * size)
        self.circles.set_array(colour)
        rings = np.where(now["outside"], style.VERMILION, "none")
        self.circles.set(edgecolors=list(rings), linewidths=1.2)
        tail = paths.places(now, np.maximum(time - EXPOSURE, now["start"]))
        self.streaks.set_segments(list(np.stack((tail, place), axis=1) * MM))
        self.streaks.set_color(list(self.circles.to_rgba(colour)))
        if self.run.scene.friction:
            angle = (now["angle"] + now["spin"] * (time - now["start"])) / TURNING
            hand = np.column_stack((np.cos(angle), np.sin(angle))) * (0.5 * HAND * size)[:, None]
            self.hands.set_segments(list(np.stack((place * MM, place * MM + hand), axis=1)))


def _draw_plates(axes: Axes, scene: Scene) -> None:
    left, right, bottom, top = window(scene)
    axes.set(xlim=(left * MM, right * MM), ylim=(bottom * MM, top * MM), aspect="equal")
    axes.set(xlabel="x [mm]", ylabel="height [mm]")
    axes.grid(visible=False)
    for plate in scene.plates:
        depth, width = drawn_depth(plate.thickness), plate.x1 - plate.x0
        corner = plate.x0 * MM, (plate.y - depth) * MM
        axes.add_patch(Rectangle(corner, width * MM, depth * MM, facecolor=style.INK, linewidth=0))
        axes.annotate(
            label(plate.thickness),
            (0.5 * (plate.x0 + plate.x1) * MM, (plate.y - depth) * MM),
            xytext=(0, -4),
            textcoords="offset points",
            ha="center",
            va="top",
            fontsize=12,
            fontweight="bold",
        )
