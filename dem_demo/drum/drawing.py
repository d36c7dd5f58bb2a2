"""The drum as it is drawn: seen along its axis, with marks on the shell that turn with it."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Annulus

from contactlaw import style
from dem_demo.drum.scene import Drum
from dem_demo.kit.drawing import Drawing
from dem_demo.kit.graphs import MM

_MARKS = 12  # number of marks on the shell
_ROOM = 1.12  # half width of the picture over the drum's radius
_THICK = 2.0  # the shell is drawn this many times as thick, to be visible


class Section(Drawing[Drum]):
    """Cross-section of the drum: the shell, and all beads."""

    STACKED, RATE = False, 12.0

    @staticmethod
    def window(scene: Drum) -> tuple[float, float, float, float]:
        """Left, right, bottom and top [m] of what is shown."""
        side = _ROOM * scene.drum
        return -side, side, -side, side

    @staticmethod
    def slice(scene: Drum) -> tuple[float, float]:
        """Middle and half of the width [m] along y of what is shown."""
        return 0.5 * scene.length, 0.5 * scene.length

    def draw_walls(self) -> None:
        """Draw the walls at rest."""
        scene = self.run.scene
        width = _THICK * scene.thickness
        self._ring = np.array([scene.drum, scene.drum + width]) * MM
        shell = Annulus((0.0, 0.0), self._ring[1], width * MM, color=style.INK, linewidth=0)
        self.axes.add_patch(shell)
        self._marks = LineCollection([], colors="white", linewidths=1.6, zorder=4)
        self.axes.add_collection(self._marks)

    def move_walls(self, time: float) -> None:
        """Show the walls at a time [s]: about y, z turns towards x."""
        angle = np.arange(_MARKS) * math.tau / _MARKS + self.run.scene.spin * time
        ray = np.stack((np.sin(angle), np.cos(angle)), axis=-1)
        self._marks.set_segments(list(ray[:, None, :] * self._ring[None, :, None]))
