"""Impacts of one bead on another."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._jit import enable_caching
from contactlaw.answers.solver import Solver
from contactlaw.answers.tabulated import Border, TableLookup, extent
from contactlaw.laws import DEFAULT, Law
from contactlaw.physical.arguments import broadcast, check, scalars
from contactlaw.physical.bodies import TwoSpheres
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.law import law_of
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.scaling import reduced
from contactlaw.table import Table

Other = Material | str | None  # material of the other bead; None: that of the first


class Beads:
    """Two spheres, looked up in the table of their law.

    Parameters
    ----------
    sphere, other : Material or str
        Materials; the weaker one comes first in `pair`, as the one that yields.
    law : str or Law
        A law that takes numbers from a pair takes those of the two spheres. Numbers that the user
        typed in its name hold here as they do on a plate.
    border : Border
        What to do with impacts outside the table.
    plates : TableLookup, optional
        Impacts on plates whose table serves here, too, if it fits the law; else it is the law's
        own.
    """

    def __init__(
        self,
        sphere: Material | str,
        other: Material | str,
        law: str | Law,
        border: Border,
        plates: TableLookup | None = None,
    ) -> None:
        pair = Pair(sphere, other)
        weak, strong = (one.strength or math.inf for one in (pair.plate, pair.sphere))
        self._swapped = weak < strong
        self.pair = Pair(pair.plate, pair.sphere) if self._swapped else pair
        self.law = law_of(self.pair, law)
        self._bulk = TableLookup(TwoSpheres(self.pair, self.law), None, border)
        if plates is not None:
            self._bulk.given = plates.given_for(self._bulk.law)

    @property
    def table(self) -> Table:
        """The table that serves the law."""
        return self._bulk.table

    def rebounds(self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike) -> Rebound:
        """Everything about impacts; radii [m] in the order in which the materials were given."""
        return self._bulk.rebounds(self._impacts(speed, radius, other_radius))

    def integrated(self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike) -> Rebound:
        """Everything about impacts as in `rebounds`, by a solver that needs no table."""
        enable_caching()
        within = Solver(self._bulk.bodies, extent=extent(self.law))
        return within.rebounds(self._impacts(speed, radius, other_radius))

    def curve(self, radius: float, other_radius: float) -> Callable[[float], float]:
        """COR of beads of these radii [m] as a function of speed [m/s]."""
        sizes = scalars(radius=radius, other_radius=other_radius)
        return self._bulk.curve(self._impacts(1.0, *sizes))

    def _impacts(self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike) -> Impacts:
        """Impacts of one body of R* and m* on a half-space."""
        v, r, o, shape = broadcast(speed=speed, radius=radius, other_radius=other_radius)
        check(speed=v, radius=r, other_radius=o)
        size, mass = reduced(self.pair, *((o, r) if self._swapped else (r, o)))
        return Impacts(v, size, np.full_like(size, math.inf), shape, mass=mass)


def beads_of(tabulated: TableLookup, other: Other) -> Beads:
    """Impacts of a model's sphere on another sphere."""
    sphere, law = tabulated.bodies.pair.sphere, tabulated.bodies.law
    takes = law.family if law.from_pair else law
    return Beads(sphere, other or sphere, takes, tabulated.border, tabulated)


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
    return Beads(sphere, other, law, Border("raise")).rebounds(speed, radius, other_radius).restitution
