"""The baseline: one coefficient of restitution for every contact."""

from __future__ import annotations

from collections.abc import Callable

from contactlaw import ArgumentError, Pair


class ConstantRestitution:
    """One COR for all contacts, as without contactlaw; an engine takes it like an `ImpactModel`.

    It has no ``lookup``: a constant does not give contact time, force or where the energy goes.

    Parameters
    ----------
    pair : Pair
        Materials; only the masses of the beads depend on them.
    restitution : float
        Coefficient of restitution of every contact [-], between 0 and 1.

    Raises
    ------
    ValueError
        If the restitution is not between 0 and 1.

    Examples
    --------
    >>> from contactlaw import Pair
    >>> same = ConstantRestitution(Pair("gamma-alumina", "glass"), 0.9)
    >>> same.curve(radius=0.9e-3, thickness=0.5e-3)(12.0)
    0.9
    """

    def __init__(self, pair: Pair, restitution: float) -> None:
        if not 0.0 <= restitution <= 1.0:
            raise ArgumentError("constant_cor", restitution, "must lie between 0 and 1")
        self.pair = pair
        self.restitution = restitution

    def curve(self, radius: float, thickness: float) -> Callable[[float], float]:
        """COR as a function of speed, whatever radius and thickness [m]."""
        return lambda speed: self.restitution

    def sphere_sphere_curve(self, radius: float, other_radius: float) -> Callable[[float], float]:
        """COR of bead on bead as a function of speed, whatever the radii [m]."""
        return lambda speed: self.restitution
