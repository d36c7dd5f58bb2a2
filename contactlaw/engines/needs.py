"""What an adapter requires of a model; `contactlaw.ImpactModel` has all of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

CorBySpeed = Callable[[float], float]  # COR [-] by normal speed of approach [m/s]


class RestitutionModel(Protocol):
    """A model of the COR of beads on plates, the least that an adapter needs.

    The record is complete if all models have a ``pair``, ``lookup(speed, radius, thickness)`` and
    ``lookup_sphere_sphere(speed, radius, other_radius)``, which answer with a `contactlaw.Rebound`.
    An adapter asks for more where it is there: ``sphere_sphere_curve(radius, other_radius)`` gives
    the COR by speed of two beads [m], for beads of two materials with that of the other bead as one
    more argument; ``oblique(speed, sliding_speed, radius, thickness, friction)``, or the faster
    ``collide_kernel``, the ``sliding_speed`` after an impact with friction; ``edge_kernel(kind)``
    the COR near edges.
    """

    def curve(self, radius: float, thickness: float, /) -> CorBySpeed:
        """COR by speed, by radius [m] and plate thickness [m]; ``inf`` is the half-space."""
        ...


def knows(model: object, *methods: str) -> bool:
    """Whether a model has some methods, by itself or by one to which it passes questions on."""
    # not isinstance(), because from Python 3.12 on that does not see what __getattr__ passes on
    return all(hasattr(model, name) for name in methods)


def knows_rebounds(model: object) -> bool:
    """Whether a model can complete the impact record."""
    return knows(model, "pair", "lookup", "lookup_sphere_sphere")
