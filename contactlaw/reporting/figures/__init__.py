"""Figures of any run: each file whose name does not begin with ``_`` draws one.

The file has a function ``draw(run) -> Figure`` for a `contactlaw.reporting.run.Run`, its name is the
name of the picture, and its docstring is the caption. To add a figure, add a file.
"""

import importlib
import pkgutil
from types import ModuleType


def modules() -> dict[str, ModuleType]:
    """Import the module of each figure, by its name."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__))
    return {name: importlib.import_module(f"{__name__}.{name}") for name in names if not name.startswith("_")}
