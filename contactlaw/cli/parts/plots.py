"""What the figures of several subcommands share; matplotlib is loaded when one is drawn."""

from __future__ import annotations

import math
from typing import Any

from contactlaw.cli.parts.quantities import LENGTH, formatted

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
