"""Engines of the rain: each file here that does not begin with ``_`` is one engine.

It is what `Engine` says, and its name is what ``--engine`` takes. To add an engine, add a file.
"""

from __future__ import annotations

import importlib
import pkgutil
from typing import TYPE_CHECKING, Protocol, runtime_checkable

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.kit.recorder import Recorder
    from dem_demo.rain.baseline import ConstantRestitution
    from dem_demo.rain.scene import Scene


@runtime_checkable
class Engine(Protocol):
    """What the file of an engine has: its facts, and how it rains in it.

    The command line reads the facts of all engines, whichever of them are installed and before it
    knows which one is wanted: a file imports its engine, and contactlaw, inside functions only.

    Attributes
    ----------
    ABOUT : str
        What ``--help`` says of it.
    EXTRAS : str
        Extras of contactlaw that install all it needs, with commas between them.
    DIMENSIONS : int
        2 or 3.
    DURATION, FRAME_RATE : float
        Default simulated time [s] and recorded frames per second [1/s].
    NO_CONSTANT_COR : str or None
        Why it cannot take one COR for all contacts; None if it can.
    BEAD_ON_BEAD : str or None
        What the report says of beads that hit beads; None if they are in the record.
    """

    ABOUT: str
    EXTRAS: str
    DIMENSIONS: int
    DURATION: float
    FRAME_RATE: float
    NO_CONSTANT_COR: str | None
    BEAD_ON_BEAD: str | None

    def version(self) -> str:
        """Version of the engine; a `ModuleNotFoundError` where it is missing."""

    def rank(self) -> int:
        """Rank of this process among those that share the work; 0 if it is alone."""

    def time_step(self, scene: Scene, model: ImpactModel | ConstantRestitution) -> float:
        """Step [s] that the engine will take."""

    def run(
        self,
        scene: Scene,
        model: ImpactModel | ConstantRestitution,
        recorder: Recorder | None,
    ) -> None:
        """Let it rain; the recorder, None on all ranks but 0, gets frames and collisions."""


def names() -> list[str]:
    """Names of all engines, sorted.

    Examples
    --------
    >>> from dem_demo.rain import defaults
    >>> defaults.ENGINE in names()
    True
    """
    return sorted(m.name for m in pkgutil.iter_modules(__path__) if not m.name.startswith("_"))


def load(name: str) -> Engine:
    """Load the file of an engine, not the engine.

    Parameters
    ----------
    name : str
        One of `names`.

    Returns
    -------
    Engine

    Raises
    ------
    TypeError
        If the file lacks something that an `Engine` has.

    Examples
    --------
    >>> load(names()[0]).DIMENSIONS in (2, 3)
    True
    """
    module = importlib.import_module(f"{__name__}.{name}")
    if not isinstance(module, Engine):
        members = {*Engine.__annotations__, *(m for m in vars(Engine) if not m.startswith("_"))}
        lacking = ", ".join(sorted(m for m in members if not hasattr(module, m)))
        raise TypeError(f"{module.__file__}: no engine of the demo, it lacks {lacking}")
    return module
