"""The sieve as it is drawn: a slice of the bed, seen from the side."""

from __future__ import annotations

import numpy as np
from matplotlib.lines import Line2D

from contactlaw import style
from dem_demo.kit.drawing import Drawing
from dem_demo.kit.graphs import MM
from dem_demo.sieve.scene import Sieve

_SLICE = 4.0  # [largest radius], half width of the slice that is drawn
_ABOVE, _BELOW = 1.05, 4.0  # [feed's height], [opening]: room above and below the deck


class Sheet(Drawing[Sieve]):
    """Section of the deck through a row of openings, with its walls."""

    STACKED, RATE = True, 8.0

    @staticmethod
    def window(scene: Sieve) -> tuple[float, float, float, float]:
        """Left, right, bottom and top [m] of what is shown."""
        deck, top = scene.deck, float(scene.position[:, 2].max())
        return -0.03 * deck.length, 1.03 * deck.length, -_BELOW * deck.opening, _ABOVE * top

    @staticmethod
    def slice(scene: Sieve) -> tuple[float, float]:
        """Middle and half of the width [m] along y of what is shown."""
        return 0.5 * scene.deck.width, _SLICE * float(scene.radius.max())

    def draw_walls(self) -> None:
        """Draw the walls at rest."""
        self._lines = [self.axes.add_line(line) for line in self._sheet()]
        self._rest = [np.array(line.get_xydata()) for line in self._lines]

    def move_walls(self, time: float) -> None:
        """Show the walls at a time [s]."""
        moved = self.run.scene.deck_place(time)[[0, 2]] * MM
        for line, rest in zip(self._lines, self._rest, strict=True):
            line.set_data(*(rest + moved).T)

    def _sheet(self) -> list[Line2D]:
        """Lines of the deck between its openings, and of its walls."""
        deck = self.run.scene.deck
        half = 0.5 * deck.opening
        holes = (np.arange(1, deck.columns - 1) + 0.5) * deck.pitch
        ends = np.r_[0.0, np.column_stack((holes - half, holes + half)).ravel(), deck.length]
        found = [([a, b], [0.0, 0.0]) for a, b in ends.reshape(-1, 2)]
        found += [([x, x], [0.0, deck.wall]) for x in (0.0, deck.length)]
        return [Line2D(np.multiply(x, MM), np.multiply(z, MM), color=style.INK, linewidth=2.2) for x, z in found]
