"""Figures as files of a folder: each file whose name does not begin with ``_`` draws one figure.

The file has a function ``draw(run) -> Figure``, and its name is the name of the picture. To add a
figure, add a file.
"""

import importlib
import pkgutil
from collections.abc import Sequence
from types import ModuleType
from typing import Any


class Gallery:
    """The figures in the folder of a package, whose ``__path__`` is `path`."""

    def __init__(self, package: str, path: Sequence[str]) -> None:
        self._package, self._path = package, path

    def names(self) -> list[str]:
        """Names of all figures, sorted."""
        found = (module.name for module in pkgutil.iter_modules(self._path))
        return sorted(name for name in found if not name.startswith("_"))

    def module(self, name: str) -> ModuleType:
        """Import the module that draws a figure; its docstring is the caption."""
        return importlib.import_module(f"{self._package}.{name}")

    def draw(self, name: str, run: Any) -> bytes:
        """Draw a figure by its name, of a run as the figures of this folder take it, as PNG."""
        from contactlaw import style  # matplotlib is loaded when a figure is drawn

        with style.applied():
            return style.png(self.module(name).draw(run))
