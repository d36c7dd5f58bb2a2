"""Figures of a run: each file here that does not begin with ``_`` is one figure.

It has a function ``draw(run) -> Figure``, and its name is the picture's. To add a figure, add a
file.
"""

from __future__ import annotations

import importlib
import pkgutil
from types import ModuleType
from typing import NamedTuple

from dem_demo.reader import Run


def names() -> list[str]:
    """Names of all figures, sorted.

    Examples
    --------
    >>> "energy" in names()
    True
    """
    return sorted(m.name for m in pkgutil.iter_modules(__path__) if not m.name.startswith("_"))


def module(name: str) -> ModuleType:
    """File of a figure; its docstring is the caption."""
    return importlib.import_module(f"{__name__}.{name}")


class Picture(NamedTuple):
    """One figure, as PNG files."""

    wide: bytes
    """For a slide or a screen."""
    narrow: bytes
    """For a phone."""


def draw(name: str, run: Run) -> Picture:
    """Draw a figure of a run.

    Parameters
    ----------
    name : str
        One of `names`.
    run : Run
        The run, as read from its file.
    """
    from dem_demo import style  # matplotlib is loaded when a figure is drawn

    drawn = []
    for narrow in (False, True):
        with style.applied(narrow=narrow):
            drawn.append(style.png(module(name).draw(run)))
    return Picture(*drawn)
