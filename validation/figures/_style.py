"""The look that all figures share, with more colours and the marks of the paper's regions."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D

from contactlaw import style
from contactlaw.style import BLUE as BLUE
from contactlaw.style import GREEN as GREEN
from contactlaw.style import INK as INK
from contactlaw.style import MUTED as MUTED
from contactlaw.style import ORANGE as ORANGE
from contactlaw.style import PALE as PALE
from contactlaw.style import VERMILION as VERMILION

SKY, PURPLE = "#56B4E9", "#CC79A7"  # Okabe and Ito (2008), as the others
SPEED = "impact speed over yield speed  V$_0$ / V$_{Y0}$"
SLENDERNESS = "radius over thickness  R / H"
INELASTICITY = r"inelasticity  $\lambda$"
RESTITUTION = "coefficient of restitution"
RATIO = "R/H: radius of the bead over thickness of the plate"  # for subtitles
_MARGIN = 0.1  # [inch] on either side of the axes
_LAWS = {
    "hertz": (MUTED, "--", "Hertz"),
    "fem": (SKY, "-", "law fem"),
    "myc": (BLUE, "-", "MYC"),
    "thornton": (VERMILION, "-", "Thornton"),
    "stronge": (ORANGE, "-", "Stronge"),
    "kogut_etsion": (GREEN, "-.", "Kogut & Etsion"),
    "jackson_green": (PURPLE, "-.", "Jackson & Green"),
}


@contextmanager
def applied() -> Iterator[None]:
    """Within this block figures have the style of the report."""
    titles: dict[Any, Any] = {
        "axes.titlelocation": "left",
        "axes.titleweight": "bold",
        "figure.labelsize": 13,
    }
    with style.applied(), mpl.rc_context(titles):
        yield


def figure(width: float, height: float, title: str, subtitle: str) -> Figure:
    """Make an empty figure of a size in inches, as the demo's, with margins."""
    made = style.figure(width, height, title, subtitle)
    engine = made.get_layout_engine()
    assert isinstance(engine, ConstrainedLayoutEngine)
    *_, top = engine.get()["rect"]
    side, below = _MARGIN / width, _MARGIN / height
    engine.set(rect=(side, below, 1.0 - 2.0 * side, top - below))
    return made


def key(axes: Axes, label: str, line: str, width: float = 2.0, **look: Any) -> Line2D:
    """Give a kind of line or mark its place in the legend; nothing is drawn."""
    (made,) = axes.plot([], [], line, label=label, linewidth=width, **{"color": INK, **look})
    return made


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
    axes.set_xlabel(SPEED)
