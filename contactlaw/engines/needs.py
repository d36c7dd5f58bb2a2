"""What an adapter requires of a model; `contactlaw.ImpactModel` has all of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol, TypeGuard

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from contactlaw import Pair, Rebound
    from contactlaw.physical.oblique import ObliqueRebound

Array = NDArray[np.float64]
CorBySpeed = Callable[[float], float]  # COR [-] by normal speed of approach [m/s]


class RestitutionModel(Protocol):
    """A model of the COR of beads on plates, the least that an adapter needs."""

    def curve(self, radius: float, thickness: float, /) -> CorBySpeed:
        """COR by speed, by radius [m] and plate thickness [m]; ``inf`` is the half-space."""
        ...


class BeadModel(RestitutionModel, Protocol):
    """A model that knows the COR of two beads, too.

    For beads of two materials, an adapter passes that of the other bead as one more argument.
    """

    def sphere_sphere_curve(self, radius: float, other_radius: float, /) -> CorBySpeed:
        """COR by speed of two beads of these radii [m]."""
        ...


class ObliqueModel(RestitutionModel, Protocol):
    """A model that knows friction on plates, too.

    An adapter asks `contactlaw.ImpactModel.collide_kernel` where a model has it, which is faster.
    """

    def oblique(
        self, speed: float, sliding_speed: float, radius: float, thickness: float,
        friction: float, /,
    ) -> ObliqueRebound:  # fmt: skip
        """Everything about an oblique impact; an adapter reads its ``sliding_speed``."""
        ...


class ReboundModel(BeadModel, Protocol):
    """A model that fills all columns of the impact record, for many impacts at a time."""

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


# Not isinstance(), because from Python 3.12 on that does not see methods that a model passes on to
# another one by __getattr__.
def knows_beads(model: object) -> TypeGuard[BeadModel]:
    """Whether a model knows the COR of two beads."""
    return hasattr(model, "sphere_sphere_curve")


def knows_friction(model: object) -> TypeGuard[ObliqueModel]:
    """Whether a model knows friction."""
    return hasattr(model, "oblique")


def knows_edges(model: object) -> bool:
    """Whether a model knows edges of plates, as `contactlaw.ImpactModel` does."""
    return hasattr(model, "edge_kernel")


def knows_rebounds(model: object) -> TypeGuard[ReboundModel]:
    """Whether a model can complete the impact record.

    Examples
    --------
    >>> import contactlaw as cl
    >>> knows_rebounds(cl.ImpactModel(cl.Pair("gamma-alumina", "glass")))
    True
    """
    return all(hasattr(model, name) for name in ("pair", "lookup", "lookup_sphere_sphere"))
