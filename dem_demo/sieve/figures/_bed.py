"""The bed as it is drawn, still or moving: a slice seen from the side, by the last COR."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactlaw import style
from dem_demo.scene import Floats
from dem_demo.sieve.figures._labels import MM
from dem_demo.sieve.record import Run

SLICE = 4.0  # [largest radius], to either side of the middle
_ABOVE, _BELOW = 1.05, 4.0  # of the feed's height; openings, below the deck


def window(run: Run) -> tuple[float, float, float, float]:
    """Left, right, bottom and top [m] of what is shown."""
    deck, top = run.scene.deck, float(run.scene.position[:, 2].max())
    return -0.03 * deck.length, 1.03 * deck.length, -_BELOW * deck.opening, _ABOVE * top


def restitution_range(run: Run) -> tuple[float, float]:
    """Range of COR that colours span: from a low one under the law to 1."""
    found = run.collisions["restitution"]
    low = float(np.quantile(found, 0.02)) if found.size else 0.9
    return max(0.0, min(low, 0.9)), 1.0


class Last(NamedTuple):
    """Impacts in the order in which they ended, to tell the last one of each bead."""

    end: Floats
    bead: np.ndarray
    restitution: Floats


def last_impacts(run: Run) -> Last:
    """Sort the impacts by their ends."""
    rows = run.collisions
    end = rows["time"] + rows["contact_time"]
    order = np.argsort(end, kind="stable")
    return Last(end[order], rows["bead"][order], rows["restitution"][order])


class Bed:
    """Deck and beads of one run; `show` moves them.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    run : Run
        The run.
    range : tuple of float
        Of the COR that colours span.
    """

    def __init__(self, axes: Axes, run: Run, range: tuple[float, float]) -> None:
        self.run, self._last = run, last_impacts(run)
        self._reach = SLICE * float(run.scene.radius.max())
        left, right, bottom, top = window(run)
        axes.set(xlim=(left * MM, right * MM), ylim=(bottom * MM, top * MM), aspect="equal")
        axes.set_anchor("W")
        axes.set(xlabel="x [mm]", ylabel="height [mm]")
        axes.label_outer()
        axes.grid(visible=False)
        self.sheet = [axes.add_line(line) for line in self._sheet()]
        self._rest = [np.array(line.get_xydata()) for line in self.sheet]
        self.beads = style.circles(axes, style.PALE, linewidths=0.25, edgecolors="white")
        self.beads.set_clim(*range)

    def _sheet(self) -> list[Line2D]:
        """Make lines of the sheet between the openings of a row, and of the walls."""
        deck = self.run.scene.deck
        half = 0.5 * deck.opening
        holes = (np.arange(1, deck.columns - 1) + 0.5) * deck.pitch
        ends = np.r_[0.0, np.column_stack((holes - half, holes + half)).ravel(), deck.length]
        found = [([a, b], [0.0, 0.0]) for a, b in ends.reshape(-1, 2)]
        found += [([x, x], [0.0, deck.wall]) for x in (0.0, deck.length)]
        return [
            Line2D(np.multiply(x, MM), np.multiply(z, MM), color=style.INK, linewidth=2.2)
            for x, z in found
        ]

    def show(self, frame: int) -> None:
        """Show a frame."""
        run, scene = self.run, self.run.scene
        place, time = run.position[frame].astype(float), float(run.time[frame])
        middle = 0.5 * scene.deck.width
        near = np.flatnonzero(
            (np.abs(place[:, 1] - middle) < self._reach) & (run.status[frame] == 1)
        )
        near = near[np.argsort(-place[near, 1])]  # those behind first
        colour = np.full(len(place), np.nan)
        past = slice(0, int(np.searchsorted(self._last.end, time, side="right")))
        colour[self._last.bead[past]] = self._last.restitution[past]  # the last one stays
        size = 2.0 * scene.radius[near] * MM
        self.beads.set(offsets=place[near][:, [0, 2]] * MM, widths=size, heights=size)
        self.beads.set(angles=0.0 * size)
        self.beads.set_array(np.ma.masked_invalid(colour[near]))
        moved = scene.deck_place(time)[[0, 2]] * MM
        for line, rest in zip(self.sheet, self._rest, strict=True):
            line.set_data(*(rest + moved).T)
