"""What figures of scenes share: subtitles, panels; and drawings and films of beds, from the side."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.kit import film
from dem_demo.kit.run import B, Run, Runs, S
from dem_demo.kit.scene import FLYING

MM = 1e3
_DRAWN, _ROOM = 0.78 * style.COLUMN, 0.75  # [inches]: width of a drawing, and height of its title and labels


def source(runs: Runs[S]) -> str:
    """Subtitle: beads and walls."""
    scene = runs[0].scene
    return f"{scene.radius.size} beads of {scene.sphere_material.name} on {scene.sheet}"


def panels(figure: Figure, runs: Runs[B], *, projection: str | None = None) -> list[tuple[Axes, Run[B]]]:
    """Make a panel for each run, one above the other, titled with its name; all have the same scale."""
    kind = {"projection": projection}
    grid = figure.subplots(len(runs), 1, sharex=True, sharey=True, squeeze=False, subplot_kw=kind)
    found = list(zip(grid.flat, runs, strict=True))
    for axes, run in found:
        kind_of_run = "contactlaw," if run.making.constant_cor is None else "constant"
        axes.set_title(f"{kind_of_run} {run.name}")
    return found


def restitution_range(run: Run[Any]) -> tuple[float, float]:
    """Range of the colour scale: from the 2 % quantile of the COR, at most 0.9, to 1."""
    found = run.impacts["restitution"]
    low = float(np.quantile(found, 0.02)) if found.size else 0.9
    return max(0.0, min(low, 0.9)), 1.0


class Drawing:
    """Walls and beads of one run, coloured by the COR of their last impact; `show` moves them."""

    def __init__(self, axes: Axes, run: Run[Any], colours: tuple[float, float]) -> None:
        self.run, scene = run, run.scene
        left, right, bottom, top = np.multiply(scene.window, MM)
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        axes.set(xlabel="x [mm]", ylabel="height [mm]")
        axes.label_outer()
        axes.grid(visible=False)
        rows = run.impacts
        end = rows["time"] + rows["contact_time"]
        order = np.argsort(end, kind="stable")  # the last impact of a bead comes last
        self._end, self._last = end[order], rows[["bead", "restitution"]][order]
        self.walls = LineCollection([], colors=style.INK, linewidths=3.0, capstyle="butt", zorder=2)
        axes.add_collection(self.walls)
        self.beads = style.circles(axes, style.PALE, linewidths=0.25, edgecolors="white")
        self.beads.set_clim(*colours)

    def show(self, time: float) -> None:
        """Show the frame of a time [s]."""
        run, scene = self.run, self.run.scene
        frame, (middle, reach) = round(time * scene.FRAME_RATE), scene.slice
        place = run.position[frame].astype(float)
        near = np.flatnonzero((np.abs(place[:, 1] - middle) < reach) & (run.status[frame] == FLYING))
        near = near[np.argsort(-place[near, 1])]  # from back to front
        colour = np.full(len(place), np.nan)
        past = self._last[: int(np.searchsorted(self._end, time, side="right"))]
        colour[past["bead"]] = past["restitution"]  # later impacts replace earlier ones
        size = 2.0 * scene.radius[near] * MM
        self.beads.set(offsets=place[near][:, [0, 2]] * MM, widths=size, heights=size, angles=0.0 * size)
        self.beads.set_array(np.ma.masked_invalid(colour[near]))
        self.walls.set_segments([line * MM for line in scene.outline(time)])


def drawings(figure: Figure, runs: Runs[B]) -> list[Drawing]:
    """Draw both runs, with a scale of the colours."""
    shown, colours = panels(figure, runs), restitution_range(runs[0])
    found = [Drawing(axes, run, colours) for axes, run in shown]
    bar = figure.colorbar(found[0].beads, ax=[axes for axes, _ in shown], pad=0.02, fraction=0.03)
    bar.set_label("COR of the last impact")
    figure.draw_without_rendering()  # once more, or panels of a fixed shape leave no room for labels
    return found


def gif(runs: Runs[B]) -> bytes:
    """Film both runs in slow motion, as a GIF that repeats itself."""

    def lay_out(figure: Figure) -> film.Moving:
        drawn = drawings(figure, runs)
        clock = figure.text(0.01, 0.01, "", ha="left", va="bottom", color=style.MUTED)

        def show(time: float) -> None:
            clock.set_text(f"{time * 1e3:.0f} ms")
            for drawing in drawn:
                drawing.show(time)

        return show, [clock, *(artist for drawing in drawn for artist in (drawing.walls, drawing.beads))]

    return film.film((style.COLUMN, height(runs)), lay_out, runs[0].time.tolist(), runs[0].scene.FILM_RATE)


def height(runs: Runs[B]) -> float:
    """Height of all drawings, with room for the title of each [inches]."""
    left, right, bottom, top = runs[0].scene.window
    return len(runs) * (_ROOM + _DRAWN * (top - bottom) / (right - left))
