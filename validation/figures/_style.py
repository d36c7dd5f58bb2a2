"""The look that all figures share, with more colours and the marks of the paper's regions."""

from __future__ import annotations

from matplotlib import colormaps
from matplotlib.axes import Axes

from dem_demo.style import BLUE as BLUE
from dem_demo.style import GREEN as GREEN
from dem_demo.style import INK as INK
from dem_demo.style import MUTED as MUTED
from dem_demo.style import ORANGE as ORANGE
from dem_demo.style import PALE as PALE
from dem_demo.style import VERMILION as VERMILION
from dem_demo.style import applied as applied
from dem_demo.style import figure as figure

SKY, PURPLE = "#56B4E9", "#CC79A7"  # Okabe and Ito (2008), as the others
_LAWS = {
    "hertz": (MUTED, "--", "Hertz"),
    "myc": (BLUE, "-", "MYC"),
    "thornton": (VERMILION, "-", "Thornton"),
    "stronge": (ORANGE, "-", "Stronge"),
    "kogut_etsion": (GREEN, "-.", "Kogut & Etsion"),
    "jackson_green": (PURPLE, "-.", "Jackson & Green"),
}


def law(name: str) -> tuple[str, str, str]:
    """Colour, line and title of a law; one that is new here is drawn too."""
    return _LAWS.get(name, (SKY, ":", name.replace("_", " ").capitalize()))


def shades(count: int) -> list[tuple[float, ...]]:
    """Colours of a quantity that rises: dark to bright, none too pale for a line."""
    return [tuple(colormaps["viridis"](0.82 * n / (count - 1))) for n in range(count)]


def speed_axis(axes: Axes, ticks: tuple[float, ...]) -> None:
    """Give speeds a logarithmic axis with these ticks only."""
    axes.set_xscale("log")
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_xlabel("impact speed  V$_0$ / V$_{Y0}$")
