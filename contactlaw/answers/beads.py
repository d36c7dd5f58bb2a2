"""Impacts of one bead on another."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw.answers.tabulated import Outside, TableLookup
from contactlaw.laws import DEFAULT, Law
from contactlaw.physical.arguments import broadcast, check
from contactlaw.physical.bodies import TwoSpheres
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.law import law_of
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.scaling import reduced

Other = Material | str | None  # material of the other bead; None: that of the first


class Beads(TableLookup):
    """Two spheres, looked up in the table of their law.

    Parameters
    ----------
    sphere, other : Material or str
        Materials; of `bodies` the weaker one comes first, as the one that yields.
    law : str or Law
        A law that takes numbers from a pair takes those of the two spheres. Numbers that the user
        typed in its name hold here as they do on a plate.
    outside : str
        What to do with impacts outside the table.
    """

    def __init__(self, sphere: Material | str, other: Material | str, law: str | Law, outside: Outside) -> None:
        pair = Pair(sphere, other)
        first, second = (body.strength or math.inf for body in pair.bodies)
        self._swapped = second < first
        if self._swapped:
            pair = Pair(pair.plate, pair.sphere)
        super().__init__(TwoSpheres(pair, law_of(pair, law)), None, outside)

    def between(self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike) -> Impacts:
        """Impacts of one body of R* and m* on a half-space; radii [m] are in the order of the materials."""
        v, r, o, shape = broadcast(speed=speed, radius=radius, other_radius=other_radius)
        check(speed=v, radius=r, other_radius=o)
        size, mass = reduced(self.bodies.pair, *((o, r) if self._swapped else (r, o)))
        return Impacts(v, size, np.full_like(size, math.inf), shape, mass=mass)


def beads_of(plates: TableLookup, other: Other) -> Beads:
    """Impacts of a model's sphere on another sphere."""
    sphere, law = plates.bodies.pair.sphere, plates.bodies.law
    beads = Beads(sphere, other or sphere, law.family if law.from_pair else law, plates.outside)
    beads.clamped = plates.clamped
    return beads


def restitution_sphere_sphere(
    sphere: Material | str,
    other: Material | str,
    speed: ArrayLike,
    radius: ArrayLike,
    other_radius: ArrayLike,
    *,
    law: str | Law = DEFAULT,
) -> float | Array:
    """Coefficient of restitution of bead on bead: the bulk limit.

    Parameters
    ----------
    sphere, other : Material or str
        Materials of the two spheres; the weaker one yields.
    speed : array_like
        Normal approach speed [m/s].
    radius, other_radius : array_like
        Radii [m].
    law : str or Law, optional
        Normal force law, as in `ImpactModel`.

    Returns
    -------
    float or ndarray of float64

    Raises
    ------
    ValueError
        As `ImpactModel` and `ImpactModel.restitution` do.

    Notes
    -----
    The plate's law with lambda = 0, R* = R1 R2/(R1 + R2) and m* = m1 m2/(m1 + m2): no wave carries
    energy off.

    Examples
    --------
    >>> import contactlaw as cl
    >>> bead = "gamma-alumina"
    >>> cl.restitution_sphere_sphere(bead, bead, [20.0, 80.0], 1e-3, 1e-3).round(4)
    array([0.9616, 0.6966])
    """
    beads = Beads(sphere, other, law, "raise")
    return beads.rebounds(beads.between(speed, radius, other_radius)).restitution
