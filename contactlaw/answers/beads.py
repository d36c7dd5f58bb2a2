"""Impacts of one bead on another."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._jit import enable_caching
from contactlaw.answers import rated
from contactlaw.answers.backend import SphereOnPlate
from contactlaw.answers.solver import RTOL, within
from contactlaw.answers.tabulated import Border, Tabulated, curve, extent, table_for
from contactlaw.laws import DEFAULT, Law
from contactlaw.physical.arguments import broadcast, check, scalars, shaped
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.rebound import Impacts, Rebound, rebound
from contactlaw.physical.scaling import ContactConstants, law_of, scales, sphere_on_sphere
from contactlaw.physical.validity import Limits, limits
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
        self._bodies = SphereOnPlate(self.pair, self.law)
        self._border, self._table_of = border, table

    @functools.cached_property
    def table(self) -> Table:
        """The table that serves the law."""
        return self._table_of(self.law)

    @functools.cached_property
    def limits(self) -> Limits:
        """Limits of the model."""
        return limits(self.pair, self.law)

    @functools.cached_property
    def _nodes(self) -> rated.Nodes | None:
        """Tables of several strengths, for materials with a rate of strain."""
        if rated.flow_of(self._bodies) is None:
            return None
        return rated.Nodes(self._bodies, None, self._border, on_plates=False)

    def rebounds(self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike) -> Rebound:
        """Everything about impacts; radii [m] in the order in which the materials were given."""
        v, r, o, shape = _checked(speed, radius, other_radius)
        impacts = Impacts(v, r * o / (r + o), np.full_like(r, math.inf), shape)
        if self._nodes:
            return self._nodes.rebounds(self._contacts(r, o), impacts)[0]
        contact = self._contact(r, o)
        units = scales(contact, v)
        found, flags = self._border.look_up(self.law, self.table.packed, units)
        unclamped = units.inelasticity, units.yield_ratio
        return rebound(
            self.pair, self.law.data, self.limits, impacts, units.time, contact.mass, unclamped,
            found, flags,
        )  # fmt: skip

    def restitutions(
        self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike
    ) -> float | Array:
        """COR of impacts, as in `rebounds`."""
        if self._nodes:
            return self.rebounds(speed, radius, other_radius).restitution
        v, r, o, shape = _checked(speed, radius, other_radius)
        units = scales(self._contact(r, o), v)
        found, _ = self._border.look_up(self.law, self.table.packed, units)
        return shaped(found.restitution, shape)

    def integrated(
        self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike
    ) -> float | Array:
        """COR of impacts as in `rebounds`, integrated to nine digits; a few need no table."""
        enable_caching()
        v, r, o, shape = _checked(speed, radius, other_radius)
        if self._nodes:
            impacts, e = (
                Impacts(v, r * o / (r + o), np.full_like(r, math.inf), shape),
                np.empty(v.size),
            )
            contact, most = self._contacts(r, o), extent(self.law)
            for one in rated.solved(self._bodies, contact, impacts, extent=most, few=True):
                e[one.some] = one.outcome.restitution
            return shaped(e, shape)
        found = within(self.law, scales(self._contact(r, o), v), RTOL, extent(self.law), few=True)
        return shaped(found.restitution, shape)

    def curve(self, radius: float, other_radius: float) -> Callable[[float], float]:
        """COR of beads of these radii [m] as a function of speed [m/s]."""
        r, o = scalars(radius=radius, other_radius=other_radius)
        contact = self._contact(r, o)
        c_chi = -math.log(scales(contact, np.ones(1)).yield_ratio.item())
        if self._nodes:
            if contact.plate.growth.modulus_power:
                return lambda v: float(self.rebounds(v, radius, other_radius).restitution)
            reduced = (r * o / (r + o)).item()
            return rated.curve(
                (self._nodes.packed, 0.0, c_chi), (reduced, 0.0),
                lambda v: self.rebounds(v, radius, other_radius),
            )  # fmt: skip
        look_up = functools.partial(self._border.look_up, self.law)
        table, growth = self.table.packed, contact.plate.growth
        if growth.modulus_power:
            time = (contact.mass / contact.stiffness).item() ** 0.4
            table = lookup.with_growth(table, growth, math.log(time))
            c_chi = math.log(time / contact.yield_compression.item())
        return curve((table, 0.0, c_chi, 1.0, 0.0), lambda: contact, look_up)

    def _contact(
        self, radius: Array, other_radius: Array, bodies: SphereOnPlate | None = None
    ) -> ContactConstants:
        radii = (other_radius, radius) if self._swapped else (radius, other_radius)
        bodies = bodies or self._bodies
        return sphere_on_sphere(bodies.pair, bodies.law, *radii)

    def _contacts(self, radius: Array, other_radius: Array) -> rated.Contact:
        """Contacts of stronger materials."""
        return lambda bodies, some: self._contact(radius[some], other_radius[some], bodies)


def beads_of(tabulated: Tabulated, other: Other) -> Beads:
    """Impacts of a model's sphere on another sphere."""
    sphere, law = tabulated.bodies.pair.sphere, tabulated.bodies.law
    takes = law.family if law.from_pair else law
    return Beads(sphere, other or sphere, takes, tabulated.border, tabulated.table_of)


def _checked(speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike) -> Any:
    """Flat arrays and their shape."""
    v, r, o, shape = broadcast(speed=speed, radius=radius, other_radius=other_radius)
    check(speed=v, radius=r, other_radius=o)
    return v, r, o, shape


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
