"""The paper's figures and the project's own: each file ``figNN_<topic>.py`` is one figure.

The file has a function ``draw() -> (Figure, numbers)``; tests assert the named numbers, and the
report prints them. Its docstring is the caption, and `PART` the part of the report. To add a
figure, add a file.
"""

from __future__ import annotations

import importlib
import pkgutil
from types import ModuleType

PRACTICE = "practice"  # for people who simulate
FINITE_ELEMENTS = "finite elements"
PAPER = "paper"


def names() -> list[str]:
    """Names of all figures in the order of their numbers.

    Examples
    --------
    >>> from validation import figures
    >>> figures.names()[0]
    'fig03_force'
    """
    return sorted(m.name for m in pkgutil.iter_modules(__path__) if m.name.startswith("fig"))


def module(name: str) -> ModuleType:
    """Import a figure."""
    return importlib.import_module(f"{__name__}.{name}")
