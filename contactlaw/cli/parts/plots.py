"""What the figures of several subcommands share; matplotlib is loaded when one is drawn."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contactlaw.cli.parts.quantities import LENGTH, formatted
from contactlaw.physical.validity import Validity, limits_in_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

_HALF_SPACE = "half-space"
SUFFIXES = ".png", ".svg", ".pdf"


def plate_of(thickness: float) -> str:
    """Name a plate by its thickness [m].

    Examples
    --------
    >>> plate_of(1e-3), plate_of(math.inf)
    ('plate 1 mm', 'half-space')
    """
    return _HALF_SPACE if thickness == math.inf else f"plate {length_of(thickness)}"


def length_of(length: float) -> str:
    """Write a length [m] in a suitable unit; an infinite one is that of a half-space."""
    return _HALF_SPACE if length == math.inf else formatted(length, LENGTH).replace("um", "µm")


def colour_of(n: int, count: int) -> Any:
    """Colour of line n of some, from dark to bright, none too pale for a line."""
    from matplotlib import colormaps

    return colormaps["viridis"](0.82 * n / max(count - 1, 1))


def curve(
    axes: Axes, x: Array, y: Array, flags: NDArray[np.int64], colour: Any, **options: Any
) -> None:
    """Draw a curve: dashed where it has flags of `Validity.ACCURACY`, otherwise solid."""
    flagged = (flags & Validity.ACCURACY) != 0
    changes = np.flatnonzero(np.diff(flagged)) + 1
    for part in np.split(np.arange(flagged.size), changes):
        # Each part goes to the first point of the next one, because otherwise there is a gap.
        to = min(part[-1] + 2, flagged.size)
        line = (0, (3.0, 1.6)) if flagged[part[0]] else "-"
        axes.plot(x[part[0] : to], y[part[0] : to], linestyle=line, color=colour, linewidth=2.4,
                  **(options if part[0] == 0 else {}))  # fmt: skip


def limits_of(flags: NDArray[np.int64]) -> str:
    """Say which limits of accuracy any of some impacts exceed; "" if none does.

    Examples
    --------
    >>> limits_of(np.array([0, Validity.FAST_IMPACT | Validity.DAMAGE]))
    'faster than the impacts that the law was checked for'
    """
    exceeded = int(np.bitwise_or.reduce(flags, axis=None)) & Validity.ACCURACY
    return "; or ".join(limits_in_words(exceeded))
