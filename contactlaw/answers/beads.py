"""Impacts of one bead on another."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._jit import enable_caching
from contactlaw.answers import rated
from contactlaw.answers.solver import RTOL, within
from contactlaw.answers.tabulated import Border, Tabulated, curve, extent, table_for
from contactlaw.laws import DEFAULT, Law
from contactlaw.physical.arguments import broadcast, check, scalars, shaped
from contactlaw.physical.bodies import TwoSpheres
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.law import law_of
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.rebound import Rebound, rebound
from contactlaw.physical.scaling import log_overload, reduced
from contactlaw.table import Table, lookup

Array = NDArray[np.float64]
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
    table : callable, optional
        Function that gives the table for a law; by default it gives the law's own.
    """

    def __init__(
        self,
        sphere: Material | str,
        other: Material | str,
        law: str | Law,
        border: Border,
        table: Callable[[Law], Table] = lambda law: table_for(law, None),
    ) -> None:
        pair = Pair(sphere, other)
        weak, strong = (one.strength or math.inf for one in (pair.plate, pair.sphere))
        self._swapped = weak < strong
        self.pair = Pair(pair.plate, pair.sphere) if self._swapped else pair
        self.law = law_of(self.pair, law)
        self._bodies = TwoSpheres(self.pair, self.law)
        self._border, self._table_of = border, table

    @functools.cached_property
    def table(self) -> Table:
        """The table that serves the law."""
        return self._table_of(self.law)

    @functools.cached_property
    def _nodes(self) -> rated.Nodes | None:
        """Tables of several strengths, for materials with a rate of strain."""
        if rated.flow_of(self._bodies) is None:
            return None
        return rated.Nodes(self._bodies, None, self._border, on_plates=False)

    def rebounds(self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike) -> Rebound:
        """Everything about impacts; radii [m] in the order in which the materials were given."""
        impacts = self._impacts(speed, radius, other_radius)
        if self._nodes:
            return self._nodes.rebounds(impacts)[0]
        units = self._bodies.numbers(self._bodies.impact(impacts))
        found, flags = self._border.look_up(self.law, self.table.packed, units)
        unclamped = units.inelasticity, units.yield_ratio
        return rebound(self._bodies, impacts, units.time, unclamped, found, flags)

    def restitutions(
        self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike
    ) -> float | Array:
        """COR of impacts, as in `rebounds`."""
        if self._nodes:
            return self.rebounds(speed, radius, other_radius).restitution
        impacts = self._impacts(speed, radius, other_radius)
        units = self._bodies.numbers(self._bodies.impact(impacts))
        found, _ = self._border.look_up(self.law, self.table.packed, units)
        return shaped(found.restitution, impacts.shape)

    def integrated(
        self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike
    ) -> float | Array:
        """COR of impacts as in `rebounds`, integrated to nine digits; a few need no table."""
        enable_caching()
        impacts = self._impacts(speed, radius, other_radius)
        units = self._bodies.numbers(self._bodies.impact(impacts))
        found = within(self._bodies.data, units, RTOL, extent(self.law), few=True)
        return shaped(found.restitution, impacts.shape)

    def curve(self, radius: float, other_radius: float) -> Callable[[float], float]:
        """COR of beads of these radii [m] as a function of speed [m/s]."""
        impacts = self._impacts(1.0, *scalars(radius=radius, other_radius=other_radius))
        known, size = self._bodies.constants, impacts.radius.item()
        time = known.time * size * self._bodies.impact(impacts).mass.item() ** 0.4
        c_chi = log_overload(known._replace(time=time), known.yield_compression * size)
        if self._nodes:
            if known.plate.growth.modulus_power:
                return lambda v: float(self.rebounds(v, radius, other_radius).restitution)
            return rated.curve(
                (self._nodes.packed, 0.0, c_chi), (size, 0.0),
                lambda v: self.rebounds(v, radius, other_radius),
            )  # fmt: skip
        look_up = functools.partial(self._border.look_up, self.law)
        table, growth = self.table.packed, known.plate.growth
        if growth.modulus_power:
            table = lookup.with_growth(table, growth, math.log(time))
        return curve((table, 0.0, c_chi, 1.0, 0.0), self._bodies, impacts, look_up)

    def _impacts(self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike) -> Impacts:
        """Impacts of one body of R* and m* on a half-space."""
        v, r, o, shape = broadcast(speed=speed, radius=radius, other_radius=other_radius)
        check(speed=v, radius=r, other_radius=o)
        size, mass = reduced(self.pair, *((o, r) if self._swapped else (r, o)))
        return Impacts(v, size, np.full_like(size, math.inf), shape, mass=mass)


def beads_of(tabulated: Tabulated, other: Other) -> Beads:
    """Impacts of a model's sphere on another sphere."""
    sphere, law = tabulated.bodies.pair.sphere, tabulated.bodies.law
    takes = law.family if law.from_pair else law
    return Beads(sphere, other or sphere, takes, tabulated.border, tabulated.table_of)


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
    return Beads(sphere, other, law, Border("raise")).restitutions(speed, radius, other_radius)
