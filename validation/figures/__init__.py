"""The paper's figures and the project's own, in a module for each part of the report.

A function ``figNN_<topic>() -> (Figure, numbers)`` is a figure: its docstring is the caption, the
report prints its numbers, and tests assert them. `PART` of its module is the part of the report.
To add a figure, add a function.
"""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Callable
from typing import Any, NamedTuple

PRACTICE = "practice"  # for people who simulate
FINITE_ELEMENTS = "finite-elements"
PAPER = "paper"
PARTS = PRACTICE, FINITE_ELEMENTS, PAPER, "derivations"  # of the report
_MODULES = "paper", "elements", "practice"


class Drawing(NamedTuple):
    """A figure that can be drawn."""

    part: str  # of the report
    caption: str
    draw: Callable[[], Any]  # returns the figure and its numbers, named


def drawings() -> dict[str, Drawing]:
    """Give all figures by their names, in the order of their numbers.

    Examples
    --------
    >>> from validation import figures
    >>> next(iter(figures.drawings()))
    'fig03_force'
    """
    found = {
        name: Drawing(module.PART, str(inspect.getdoc(one)), one)
        for module in (importlib.import_module(f"{__name__}.{part}") for part in _MODULES)
        for name, one in vars(module).items()
        if re.match(r"fig\d", name)
    }
    return dict(sorted(found.items()))
