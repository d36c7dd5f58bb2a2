"""Engines of the rain: each file whose name does not begin with ``_`` is one engine.

The file has all members of `Engine`, and ``--engine`` takes its name. To add an engine, add a file.
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
    """Members of the file of an engine: constants, and functions that simulate the rain.

    The command line reads the constants of all engines, installed or not, before it knows which one
    will run: so a file imports its engine, and contactlaw, inside functions only.

    Attributes
    ----------
    ABOUT : str
        Description of the engine for ``--help``.
    EXTRAS : str
        Extras of contactlaw that install the engine, separated by commas.
    DIMENSIONS : int
        Dimensions of the simulation, 2 or 3.
    DURATION, FRAME_RATE : float
        Default simulated time [s] and recorded frames per second [1/s].
    NO_CONSTANT_COR : str or None
        Why the engine cannot take one COR for all contacts; None if it can.
    BEAD_ON_BEAD : str or None
        How the report describes bead-on-bead contacts; None if they are in the record.
    """

    ABOUT: str
    EXTRAS: str
    DIMENSIONS: int
    DURATION: float
    FRAME_RATE: float
    NO_CONSTANT_COR: str | None
    BEAD_ON_BEAD: str | None

    def version(self) -> str:
        """Version of the engine; raises `ModuleNotFoundError` if it is missing."""

    def rank(self) -> int:
        """MPI rank of this process; 0 if it runs alone."""

    def time_step(self, scene: Scene, model: ImpactModel | ConstantRestitution) -> float:
        """Time step of the engine [s]."""

    def run(
        self,
        scene: Scene,
        model: ImpactModel | ConstantRestitution,
        recorder: Recorder | None,
    ) -> None:
        """Simulate the rain; frames and collisions go to the recorder, None on all ranks but 0.

        If the scene has friction, frames have the spins of the beads.
        """


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
    """Load the file of an engine; the engine itself is not imported.

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
        If the file lacks a member of `Engine`.

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
