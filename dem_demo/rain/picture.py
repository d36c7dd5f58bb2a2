"""Drawings of the rain: window, plates, beads coloured by COR; and rain.gif, its busiest part."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from contactlaw import style
from contactlaw.reporting.limits import label
from dem_demo.kit import film
from dem_demo.kit.drawing import MM, restitution_range
from dem_demo.kit.run import Run, Runs
from dem_demo.rain import paths
from dem_demo.rain.scene import Shower

# Beads are drawn this many times as large, to be visible, and with friction to show that they turn.
_MAGNIFIED, _TURNING_MAGNIFIED = 3.0, 5.0
PLATES_MAGNIFIED = 4.0  # plates are drawn this many times as thick, to look different
TURNING = 20.0  # spins, of a thousand turns a second, are drawn this many times slower than paths
HAND = 1.6  # [drawn radius], length of the hand that turns with a bead
EXPOSURE = 2e-3  # [s]; a streak is the path of a bead in this time
_HALF_SPACE = 3e-3  # [m], drawn depth of a plate of infinite thickness
_SIDES, _BELOW = 0.01, 0.016  # [m] beside and below the plates
_ABOVE = 1.08  # top of the picture over the height of the nozzles
_SLOWER = 20  # the film is so many times slower than the rain
_FRAMES, _RATE = 100, 20.0  # frames of the film, and frames per second [1/s]
_SIZE = 7.2, 4.3  # [inches]


def window(scene: Shower) -> tuple[float, float, float, float]:
    """Left, right, bottom and top [m] of what is shown."""
    bottom = min(scene.floor, -max(map(drawn_depth, scene.plates)) - _BELOW)
    return -_SIDES, float(scene.ends.max()) + _SIDES, bottom, _ABOVE * float(scene.position[:, 1].max())


def magnified(run: Run[Shower]) -> float:
    """How many times their size beads are drawn."""
    return _TURNING_MAGNIFIED if run.scene.friction else _MAGNIFIED


def drawn_depth(thickness: float) -> float:
    """Depth [m] with which a plate is drawn."""
    return PLATES_MAGNIFIED * min(thickness, _HALF_SPACE)


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

    def __init__(self, axes: Axes, run: Run[Shower], made: NDArray[np.void]) -> None:
        self.axes, self.run, self.made = axes, run, made
        _draw_plates(axes, run.scene)
        self.streaks = LineCollection([], linewidths=1.2, alpha=0.45, zorder=2)
        axes.add_collection(self.streaks)
        self.circles = style.circles(axes, style.MUTED)
        self.circles.set_clim(*restitution_range(run))
        self.hands = LineCollection([], linewidths=1.0, colors=style.INK, zorder=4)
        axes.add_collection(self.hands)

    def show(self, time: float) -> None:
        """Show the beads at a time [s]."""
        now = paths.at(self.made, time)
        place = paths.places(now, time)
        size = 2.0 * magnified(self.run) * self.run.scene.radius[now["bead"]] * MM
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


def _draw_plates(axes: Axes, scene: Shower) -> None:
    left, right, bottom, top = window(scene)
    axes.set(xlim=(left * MM, right * MM), ylim=(bottom * MM, top * MM), aspect="equal")
    axes.set(xlabel="x [mm]", ylabel="height [mm]")
    axes.grid(visible=False)
    for (x, end), thickness in zip((scene.ends * MM).tolist(), scene.plates, strict=True):
        depth = drawn_depth(thickness) * MM
        axes.add_patch(Rectangle((x, -depth), end - x, depth, facecolor=style.INK, linewidth=0))
        look: dict[str, Any] = {"ha": "center", "va": "top", "fontsize": 12, "fontweight": "bold"}
        axes.annotate(label(thickness), (0.5 * (x + end), -depth), (0, -4), textcoords="offset points", **look)


def gif(runs: Runs[Shower]) -> bytes:
    """Film the busiest time of a run in slow motion."""
    run = runs[0]
    made = paths.pieces(run)

    def lay_out(figure: Figure) -> film.Moving:
        axes = figure.add_subplot()
        hands = f"\nhands: spin, {_SLOWER * TURNING:g} times slower" if run.scene.friction else ""
        beads, *_, plates = run.scene.title()[0].split(", ")
        axes.set_title(f"{beads} {plates}, {_SLOWER} times slower{hands}")
        picture = Picture(axes, run, made)
        bar = figure.colorbar(picture.circles, ax=axes, pad=0.01, fraction=0.03)
        bar.set_label("COR of the last impact (grey: none yet)")
        return picture.show, (picture.streaks, picture.circles, picture.hands)

    return film.film(_SIZE, lay_out, _times(run, made), _RATE)


def _times(run: Run[Shower], made: NDArray[np.void]) -> list[float]:
    """Choose the times [s] of the frames: around that with most rebounding beads in the window."""
    left, right, _, top = window(run.scene)
    counts = []
    for time in run.time.tolist():
        now = paths.at(made, time)
        x, y = paths.places(now, time).T
        shown = (left < x) & (x < right) & (0.0 < y) & (y < top)
        counts.append(int((np.isfinite(now["restitution"]) & shown).sum()))
    length, end = _FRAMES / (_RATE * _SLOWER), run.time[-1]
    within = np.ones(max(1, round(length * run.scene.FRAME_RATE)))
    middle = run.time[np.argmax(np.convolve(counts, within, "same"))]
    begin = min(max(0.0, middle - 0.5 * length), max(0.0, end - length))
    return list(map(float, np.linspace(begin, min(begin + length, end), _FRAMES, endpoint=False)))
