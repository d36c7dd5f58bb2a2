"""Figures of a run: each file here that does not begin with ``_`` is one figure.

It has a function ``draw(run) -> Figure``, and its name is the picture's. To add a figure, add a
file.
"""

from __future__ import annotations

import importlib
import pkgutil
from pathlib import Path

from dem_demo.reader import Run


def names() -> list[str]:
    """Names of all figures, sorted.

    Examples
    --------
    >>> names()
    ['energy', 'load', 'rebound_height', 'restitution', 'snapshot']
    """
    return sorted(m.name for m in pkgutil.iter_modules(__path__) if not m.name.startswith("_"))


def draw_all(run: Run, folder: Path) -> None:
    """Draw every figure of a run as a PNG file.

    Parameters
    ----------
    run : Run
        The run, as read from its file.
    folder : Path
        Existing folder for the pictures.
    """
    from dem_demo import style  # matplotlib is loaded when a figure is drawn

    with style.applied():
        for name in names():
            figure = importlib.import_module(f"{__name__}.{name}").draw(run)
            figure.savefig(folder / f"{name}.png")
