"""Drawings and films of a bed from the side, beads coloured by the COR of their last impact."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar, Generic

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from contactlaw import style
from dem_demo.kit.beads import FLYING, Floats
from dem_demo.kit.film import encoded
from dem_demo.kit.graphs import MM, panels, source
from dem_demo.kit.measure import restitution_range
from dem_demo.kit.runs import Run, Runs, S

_WIDTH, _ROOM = 9.0, 0.75  # [inches]: width of a film, and height of a panel's title and labels


class Drawing(ABC, Generic[S]):
    """Walls and beads of one run; `show` moves them. Each scene draws its walls in a subclass.

    `range` has the lowest and highest COR of the colour scale.
    """

    STACKED: ClassVar[bool]  # whether the runs stand one above the other; else side by side
    RATE: ClassVar[float]  # frames per second of the film [1/s]

    def __init__(self, axes: Axes, run: Run[S], range: tuple[float, float]) -> None:
        self.axes, self.run = axes, run
        left, right, bottom, top = np.multiply(self.window(run.scene), MM)
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        axes.set_anchor("W" if self.STACKED else "C")
        axes.set(xlabel="x [mm]", ylabel="height [mm]")
        axes.label_outer()
        axes.grid(visible=False)
        rows = run.impacts
        end = rows["time"] + rows["contact_time"]
        order = np.argsort(end, kind="stable")  # the last impact of a bead comes last
        self._end, self._last = end[order], rows[["bead", "restitution"]][order]
        self.beads = style.circles(axes, style.PALE, linewidths=0.25, edgecolors="white")
        self.beads.set_clim(*range)
        self.draw_walls()

    @staticmethod
    @abstractmethod
    def window(scene: S) -> tuple[float, float, float, float]:
        """Left, right, bottom and top [m] of what is shown."""

    @staticmethod
    @abstractmethod
    def slice(scene: S) -> tuple[float, float]:
        """Middle and half of the width [m] along y of what is shown."""

    @abstractmethod
    def draw_walls(self) -> None:
        """Draw the walls at rest."""

    @abstractmethod
    def move_walls(self, time: float) -> None:
        """Show the walls at a time [s]."""

    def show(self, frame: int) -> None:
        """Show a frame."""
        run, (middle, reach) = self.run, self.slice(self.run.scene)
        place, time = run.position[frame].astype(float), float(run.time[frame])
        near = np.flatnonzero((np.abs(place[:, 1] - middle) < reach) & (run.status[frame] == FLYING))
        near = near[np.argsort(-place[near, 1])]  # from back to front
        colour = np.full(len(place), np.nan)
        past = self._last[: int(np.searchsorted(self._end, time, side="right"))]
        colour[past["bead"]] = past["restitution"]  # later impacts replace earlier ones
        size: Floats = 2.0 * run.scene.radius[near] * MM
        self.beads.set(offsets=place[near][:, [0, 2]] * MM, widths=size, heights=size)
        self.beads.set(angles=0.0 * size)
        self.beads.set_array(np.ma.masked_invalid(colour[near]))
        self.move_walls(time)


def snapshot(drawn: type[Drawing[Any]], runs: Runs[Any], title: str) -> Figure:
    """Draw the last frame of both runs."""
    frame = runs.law.time.size - 1
    scene = runs.law.scene
    figure = style.figure(
        12.0,
        1.4 + _height(drawn, runs, 10.0, 0.4),
        title,
        f"{source(runs)}; t = {runs.law.time[frame] * 1e3:.0f} ms, a slice of "
        f"{2.0 * drawn.slice(scene)[1] * MM:.0f} mm along the middle",
    )
    shown = panels(figure, runs, stacked=drawn.STACKED)
    for axes, run in shown:
        drawing = drawn(axes, run, restitution_range(runs.law))
        drawing.show(frame)
    bar = figure.colorbar(drawing.beads, ax=[axes for axes, _ in shown], location="right", pad=0.02, fraction=0.03)
    bar.set_label("COR of the last impact")
    return figure


def gif(drawn: type[Drawing[Any]], runs: Runs[Any]) -> bytes:
    """Film both runs in slow motion, as a GIF that repeats itself."""
    with style.applied():
        size = _WIDTH, _height(drawn, runs, 0.85 * _WIDTH, _ROOM)
        figure = Figure(figsize=size, dpi=100, layout="constrained")
        canvas: Any = FigureCanvasAgg(figure)  # its methods are untyped
        shown = panels(figure, runs, stacked=drawn.STACKED)
        colours = restitution_range(runs.law)
        drawings = [drawn(axes, run, colours) for axes, run in shown]
        bar = figure.colorbar(drawings[0].beads, ax=[axes for axes, _ in shown], fraction=0.03)
        bar.set_label("COR of the last impact")
        clock = figure.text(0.01, 0.01, "", ha="left", va="bottom", color=style.MUTED)
        images = []
        for frame in range(runs.law.time.size):
            clock.set_text(f"{runs.law.time[frame] * 1e3:.0f} ms")
            for drawing in drawings:
                drawing.show(frame)
            canvas.draw()
            images.append(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB"))
    return encoded(images, drawn.RATE)


def _height(drawn: type[Drawing[Any]], runs: Runs[Any], width: float, room: float) -> float:
    """Height of all panels for their width, with room for the title of each [inches]."""
    left, right, bottom, top = drawn.window(runs.law.scene)
    count = len(runs.both)
    rows = count if drawn.STACKED else 1
    wide = width if drawn.STACKED else width * rows / count
    return rows * (room + wide * (top - bottom) / (right - left))
