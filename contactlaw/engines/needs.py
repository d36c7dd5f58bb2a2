"""What an engine asks of a model; `contactlaw.ImpactModel` answers all of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol, TypeGuard

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from contactlaw import Pair, Rebound

Array = NDArray[np.float64]
Curve = Callable[[float], float]  # COR [-] by normal speed of approach [m/s]


class RestitutionModel(Protocol):
    """The least: the COR of a bead on a plate."""

    def curve(self, radius: float, thickness: float, /) -> Curve:
        """COR of beads of a radius [m] on a plate of a thickness [m], ``inf``: a half-space."""
        ...


class BeadModel(RestitutionModel, Protocol):
    """Where beads meet: their COR, too.

    Where beads of two materials meet, an engine gives the other bead's as one more argument.
    """

    def sphere_sphere_curve(self, radius: float, other_radius: float, /) -> Curve:
        """COR of two beads of these radii [m]."""
        ...


class ReboundModel(BeadModel, Protocol):
    """For the whole impact record: what else is to be known of impacts, many at a time."""

    @property
    def pair(self) -> Pair:
        """Materials; the masses of beads follow from them."""
        ...

    def lookup(self, speed: Array, radius: Array, thickness: Array, /) -> Rebound:
        """Everything about impacts on plates; speed [m/s], lengths [m]."""
        ...

    def lookup_sphere_sphere(self, speed: Array, radius: Array, other_radius: Array, /) -> Rebound:
        """Everything about impacts of two beads; speed [m/s], lengths [m]."""
        ...


# Not isinstance(): from Python 3.12 on it would not see what a model passes on to another one by
# __getattr__, and 3.11 does.
def knows_beads(model: object) -> TypeGuard[BeadModel]:
    """Whether a model has an answer where beads meet."""
    return hasattr(model, "sphere_sphere_curve")


def knows_rebounds(model: object) -> TypeGuard[ReboundModel]:
    """Whether a model can complete the impact record.

    Examples
    --------
    >>> import contactlaw as cl
    >>> knows_rebounds(cl.ImpactModel(cl.Pair("gamma-alumina", "glass")))
    True
    """
    return all(hasattr(model, name) for name in ("pair", "lookup", "lookup_sphere_sphere"))
