"""What an adapter requires of a model; `contactlaw.ImpactModel` has all of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from contactlaw import Pair, Rebound

Array = NDArray[np.float64]
CorBySpeed = Callable[[float], float]  # COR [-] by normal speed of approach [m/s]


class RestitutionModel(Protocol):
    """A model of the COR of beads on plates, the least that an adapter needs.

    An adapter asks for more where it is there: ``sphere_sphere_curve(radius, other_radius)`` gives
    the COR by speed of two beads [m], for beads of two materials with that of the other bead as one
    more argument; ``oblique(speed, sliding_speed, radius, thickness, friction)``, or the faster
    ``collide_kernel``, the ``sliding_speed`` after an impact with friction; ``edge_kernel(kind)``
    the COR near edges.
    """

    def curve(self, radius: float, thickness: float, /) -> CorBySpeed:
        """COR by speed, by radius [m] and plate thickness [m]; ``inf`` is the half-space."""
        ...


class ReboundModel(RestitutionModel, Protocol):
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


def knows(model: object, *methods: str) -> bool:
    """Whether a model has some methods, by itself or by one to which it passes questions on."""
    # not isinstance(), because from Python 3.12 on that does not see what __getattr__ passes on
    return all(hasattr(model, name) for name in methods)


def knows_rebounds(model: object) -> bool:
    """Whether a model can complete the impact record."""
    return knows(model, "pair", "lookup", "lookup_sphere_sphere")
