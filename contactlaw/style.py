"""The style of all figures: those of the command line, of the demo and of the validation.

Readable in a talk, in colours that colour-blind people can tell apart. Matplotlib is loaded when a
figure is made.
"""

from __future__ import annotations

import io
import textwrap
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

# Okabe and Ito (2008), Color Universal Design.
BLUE, ORANGE, GREEN, VERMILION = "#0072B2", "#E69F00", "#009E73", "#D55E00"
SKY, PURPLE = "#56B4E9", "#CC79A7"
INK, MUTED, PALE = "#222222", "#6E6E6E", "#D9D9D9"
# Words and colour of each place where the energy of a bead goes, for all figures and pages.
ENERGIES = {
    "kept": ("kept by the bead", PALE),
    "wave": ("bending wave in the plate", BLUE),
    "plastic": ("lost at the contact", ORANGE),
    "other": ("micro-slip and vibration", PURPLE),
    "friction": ("friction along the plate", SKY),
    "beads": ("bead on bead", GREEN),
}
COLUMN = 6.0  # [inches] width of figures on pages: their letters are readable on a phone

_SETTINGS: dict[Any, Any] = {
    "figure.dpi": 150,
    "savefig.dpi": 150,
    "figure.facecolor": "white",
    "font.size": 12,
    "axes.titlesize": 12,
    "axes.titlelocation": "left",
    "axes.titleweight": "bold",
    "axes.labelsize": 13,
    "figure.labelsize": 13,
    "axes.labelcolor": INK,
    "axes.edgecolor": MUTED,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#EBEBEB",
    "xtick.color": INK,
    "ytick.color": INK,
    "lines.linewidth": 1.8,
    "legend.frameon": False,
    "legend.fontsize": 11,
}
_MARGIN = 0.1  # inches of white on either side of the axes and below them


@contextmanager
def applied() -> Iterator[None]:
    """Within this block figures have the common style; they need no screen.

    Raises
    ------
    ImportError
        Without matplotlib; the message says how to install it.
    """
    try:
        import matplotlib as mpl
    except ImportError as error:
        raise ImportError("a plot needs matplotlib: pip install 'contactlaw[demo]'") from error
    with mpl.rc_context(_SETTINGS):
        yield


def figure(width: float, height: float, title: str, subtitle: str) -> Figure:
    """Make an empty figure of a size in inches, with a message and a line on what it shows."""
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    head, lines = textwrap.wrap(title, int(7.6 * width)), textwrap.wrap(subtitle, int(10.6 * width))
    # The axes leave room for the lines above them.
    below = 0.22 + 0.28 * len(head)
    room = below + 0.02 + 0.2 * len(lines)
    layout = ConstrainedLayoutEngine(
        rect=(_MARGIN / width, _MARGIN / height, 1.0 - 2.0 * _MARGIN / width, 1.0 - (room + _MARGIN) / height)
    )
    made = Figure(figsize=(width, height), layout=layout)
    left = 0.15 / width
    plain: dict[str, Any] = {"va": "top", "parse_math": False}  # names of materials may have a $
    made.text(left, 1.0 - 0.15 / height, "\n".join(head), fontsize=16, fontweight="bold", color=INK, **plain)
    made.text(left, 1.0 - below / height, "\n".join(lines), fontsize=11.5, color=MUTED, **plain)
    return made


def decades(axis: Axis, steps: Sequence[float]) -> None:
    """Give a logarithmic axis ticks at steps from 1 to 10 in each decade, as plain numbers."""
    from matplotlib.ticker import LogLocator, NullLocator

    axis.set_major_locator(LogLocator(subs=steps, numticks=10))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter("{x:g}")


def png(figure: Figure) -> bytes:
    """Render a figure as a small file."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image

    canvas: Any = FigureCanvasAgg(figure)  # its methods are untyped
    canvas.draw()  # savefig would draw twice, once for the layout
    drawn, small = Image.fromarray(np.asarray(canvas.buffer_rgba())), io.BytesIO()
    # 256 colours take a third of the space, without a visible difference
    reduced = drawn.convert("RGB").quantize(256, dither=Image.Dither.NONE)
    reduced.save(small, "PNG", optimize=True)
    return small.getvalue()
