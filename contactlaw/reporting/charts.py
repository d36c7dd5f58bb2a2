"""Energy on a sheet, as the figures of several kinds of runs draw it."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from contactlaw import style
from contactlaw._arrays import Array

_BAR, _AROUND = 0.15, 2.0  # [inches] height of a bar of colours, and of all that is around the drawings
DENSITY, _SPAN = "inferno", 100.0  # colours of energies per area, and largest over least


def density_scale(values: Sequence[Array]) -> LogNorm:
    """Scale of the colours for energies per area [J/m2]; all of the least energies are dark."""
    most = max(float(np.quantile(value, 0.999)) for value in values) or 1.0
    return LogNorm(most / _SPAN, most, clip=True)


def sheet(axes: Axes, corners: NDArray[np.floating], value: Array, scale: LogNorm) -> PolyCollection:
    """Draw triangles (n, 3, 2) in the colours of their energies per area [J/m2]."""
    drawn = PolyCollection(
        list(corners), array=value, cmap=DENSITY, norm=scale, edgecolors="none", antialiased=False
    )  # smoothed edges would show the triangles, and more than double the file
    drawn.set_rasterized(True)
    axes.add_collection(drawn)
    axes.set_aspect("equal")
    axes.grid(visible=False)
    return drawn


def density_bar(figure: Figure, drawn: Any, axes: Sequence[Axes]) -> None:
    """Explain the colours of a `sheet` below some axes."""
    part = _BAR / max(figure.get_figheight() - _AROUND, 4.0 * _BAR)
    bar = figure.colorbar(drawn, ax=axes, location="bottom", fraction=part, pad=0.4 * part, aspect=40)
    bar.set_label("energy taken per area [J/m²]")
    style.decades(bar.ax.xaxis, (1.0, 2.0, 5.0))
