"""One look for all figures, the demo's and the report's: readable in a talk, colours told apart."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

# Okabe and Ito (2008), Color Universal Design.
BLUE, ORANGE, GREEN, VERMILION = "#0072B2", "#E69F00", "#009E73", "#D55E00"
INK, MUTED, PALE = "#222222", "#6E6E6E", "#D9D9D9"

_SETTINGS: dict[Any, Any] = {
    "figure.dpi": 150,
    "savefig.dpi": 150,
    "figure.facecolor": "white",
    "font.size": 12,
    "axes.titlesize": 12,
    "axes.labelsize": 13,
    "axes.labelcolor": INK,
    "axes.edgecolor": MUTED,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#EBEBEB",
    "xtick.color": INK,
    "ytick.color": INK,
    "legend.frameon": False,
    "legend.fontsize": 11,
}


@contextmanager
def applied() -> Iterator[None]:
    """Within this block figures have the common style, and no screen is needed."""
    with mpl.rc_context(_SETTINGS):
        yield


def figure(width: float, height: float, title: str, subtitle: str) -> Figure:
    """Make an empty figure of a size in inches, with a message and what it shows."""
    lines = textwrap.wrap(subtitle, int(10.6 * width))  # letters of 11.5 points to an inch
    # The axes leave room for the lines above them.
    room = 0.24 + 0.2 * len(lines)
    layout = ConstrainedLayoutEngine(rect=(0.0, 0.0, 1.0, 1.0 - room / height))
    made = Figure(figsize=(width, height), layout=layout)
    made.suptitle(title, x=0.012, ha="left", fontsize=16, fontweight="bold", color=INK)
    text = "\n".join(lines)
    made.text(0.012, 1.0 - 0.5 / height, text, fontsize=11.5, color=MUTED, va="top")
    return made
