"""What the figures of several subcommands share; matplotlib is loaded when one is drawn."""

from __future__ import annotations

import io
import itertools
import math
import os
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from contactlaw import _atomic
from contactlaw._arrays import Array, Integers
from contactlaw._readable import drawn
from contactlaw.physical.validity import Validity, count_flags, limits_in_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


SUFFIXES = ".png", ".svg", ".pdf"


def save(figure: Figure, path: str | os.PathLike[str]) -> None:
    """Write a figure as a whole file, in the format that its suffix names."""
    content = io.BytesIO()
    figure.savefig(content, format=PurePath(path).suffix[1:].lower())
    _atomic.write(path, content.getvalue())


def plate_of(thickness: float) -> str:
    """Name a plate by its thickness [m]."""
    return drawn(thickness) if thickness == math.inf else f"plate {drawn(thickness)}"


def colour_of(n: int, count: int) -> Any:
    """Colour of line n of some, from dark to bright, none too pale for a line."""
    from matplotlib import colormaps

    return colormaps["viridis"](0.82 * n / max(count - 1, 1))


class FlagLook(NamedTuple):
    """How a limit of accuracy is drawn where it is exceeded, and its words."""

    stroke: float  # length of the dashes, in widths of the line
    hatch: str  # in maps
    words: str


_GAP, _STROKES = 1.4, (3.2, 1.0, 6.5, 2.0, 10.0, 4.5)
_HATCHES = "///", "\\\\\\", "...", "|||", "---", "ooo"


def kinds_of(flags: Integers) -> dict[Validity, FlagLook]:
    """Limits of accuracy that some impacts exceed, each drawn in its own way; frequent ones first.

    Examples
    --------
    >>> kinds = kinds_of(np.array([0, 2, Validity.FAST_IMPACT | Validity.DEEP_CONTACT]))
    >>> [(kind.stroke, kind.words) for kind in kinds.values()]
    [(3.2, 'faster than the impacts that the law was checked for'), (1.0, 'compressed deeper \
than the finite elements that the law is made of')]
    """
    counts = count_flags(flags & Validity.ACCURACY)
    looks = itertools.cycle(zip(_STROKES, _HATCHES, strict=True))
    return {
        flag: FlagLook(*look, *limits_in_words(flag))
        for flag, look in zip(sorted(counts, key=lambda flag: -counts[flag]), looks, strict=False)
    }


def dashes_of(flags: int, kinds: dict[Validity, FlagLook]) -> Any:
    """Line style of impacts with some flags: each kind has a stroke in it, so that all are seen.

    Examples
    --------
    >>> kinds = kinds_of(np.array([0, 2, Validity.FAST_IMPACT | Validity.DEEP_CONTACT]))
    >>> dashes_of(0, kinds), dashes_of(Validity.FAST_IMPACT | Validity.DEEP_CONTACT, kinds)
    ('-', (0, [3.2, 1.4, 1.0, 1.4]))
    """
    strokes = [kind.stroke for flag, kind in kinds.items() if flags & flag]
    return (0, [length for stroke in strokes for length in (stroke, _GAP)]) if strokes else "-"


def curve(axes: Axes, x: Array, y: Array, flags: Integers, kinds: dict[Validity, FlagLook], **options: Any) -> None:
    """Draw a curve: dashed by kind where it exceeds limits of accuracy, otherwise solid."""
    exceeded = flags & Validity.ACCURACY
    changes = np.flatnonzero(np.diff(exceeded)) + 1
    for part in np.split(np.arange(exceeded.size), changes):
        # Each part goes to the first point of the next one, because otherwise there is a gap.
        to, dashes = min(part[-1] + 2, exceeded.size), dashes_of(exceeded[part[0]], kinds)
        axes.plot(x[part[0] : to], y[part[0] : to], linestyle=dashes, **options)
