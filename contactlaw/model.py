"""ImpactModel: what a bead's collision with a plate does, in SI units.

Its methods pass impacts on to the table or to the solver, which are interchangeable, or to another
module of `contactlaw.answers`. Those that engines call are in `contactlaw.answers.compiled`.
"""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._jit import enable_caching
from contactlaw.answers.beads import Other, beads_of
from contactlaw.answers.compiled import Compiled
from contactlaw.answers.constant import Constant, Keep, constant
from contactlaw.answers.edges import with_edges
from contactlaw.answers.histories import Histories
from contactlaw.answers.inverse import Inverse
from contactlaw.answers.oblique import Oblique
from contactlaw.answers.sensitivity import Sensitivity, sensitivity
from contactlaw.answers.solver import Solver
from contactlaw.answers.speed_table import SpeedTable, speed_table
from contactlaw.answers.tabulated import Border, Outside, TableArgument, TableLookup
from contactlaw.equation.edge import Edge
from contactlaw.laws import DEFAULT, Law
from contactlaw.physical.arguments import broadcast, scalars, shaped
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.law import law_of
from contactlaw.physical.materials import warn_of_softened
from contactlaw.physical.pair import Pair
from contactlaw.physical.plates import SHEETS, Thickness, sheet_of
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.validity import Limits
from contactlaw.table import Settings, Table


class ImpactModel(Compiled, Histories, Inverse, Oblique):
    """The modified Zener model of one pair of materials, ready to answer per collision.

    Adhesion, heating, rolling and drilling friction are outside it (see `Validity`).

    Parameters
    ----------
    pair : Pair
        Materials of sphere and plate.
    law : str or Law, optional
        Normal force law: ``"fem"``, read off finite elements, for metals, ceramics and glasses,
        of which either, both or neither body may yield; ``"myc"``, the paper's; another of
        `contactlaw.laws.names`; or a `contactlaw.laws.Law` of your own. A table for it is built
        when it is first needed, in one to two seconds, for a pair with a rate in three, and kept in
        the user's cache folder; `solve`, soft spheres and LAMMPS need none.
    table : Table, path-like or Settings, optional
        A table in place of the law's own. For `contactlaw.table.Settings` a larger or finer one is
        built when it is first needed, usually in seconds, and kept in the cache folder.
    outside : {"raise", "solve", "clamp"}, optional
        What to do outside the table: refuse, integrate the equation, or take the value at the
        border (each such impact is counted in `clamped` and flagged in `Rebound.flags`).

    Attributes
    ----------
    pair, law, outside
        As given; fixed. A law that takes numbers from the pair has them in its name.
    clamped : int
        Impacts answered with the value at the table's border so far.

    Raises
    ------
    ValueError
        Unknown law or `outside`; no yield strength where the law needs one; another law's table.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> round(model.restitution(speed=5.0, radius=0.9e-3, thickness=1e-3), 4)
    0.8966
    """

    def __init__(
        self, pair: Pair, law: str | Law = DEFAULT, table: TableArgument = None, outside: Outside = "raise"
    ) -> None:
        if not isinstance(pair, Pair):
            raise TypeError(f"pair: expected a contactlaw.Pair, got {pair!r}")
        for body in pair.given:
            warn_of_softened(body)
        self._border = Border(outside)
        self._bodies = SphereOnPlate(pair, law_of(pair, law))
        self._tabulated = TableLookup(self._bodies, table, self._border)
        self._beads = functools.cache(functools.partial(beads_of, self._tabulated))
        enable_caching()
        if not isinstance(table, Settings | None):
            self.table  # noqa: B018 - a wrong table is refused here, not at the first impact

    def __reduce__(self) -> tuple[Any, ...]:
        # compiled functions cannot be pickled; the receiving process makes its own
        return ImpactModel, (self.pair, self.force_law, self._tabulated.given, self.outside)

    def __repr__(self) -> str:
        law = self.force_law.family
        return f"ImpactModel({self.pair!r}, law={law!r}, outside={self.outside!r})"

    @property
    def pair(self) -> Pair:
        """Materials of sphere and plate."""
        return self._bodies.pair

    @property
    def outside(self) -> Outside:
        """What to do outside the table."""
        return self._border.outside

    @property
    def law(self) -> str:
        """Name of the normal force law."""
        return self._bodies.law.name

    @property
    def force_law(self) -> Law:
        """The normal force law itself, as data."""
        return self._bodies.law

    @property
    def table(self) -> Table:
        """The table of lookups, made when it is first needed; for Hertz's law that of MYC."""
        return self._tabulated.table

    @property
    def largest_inelasticity(self) -> float:
        """Largest lambda of the table; for the law's own, known before the table is made."""
        return self._tabulated.largest_inelasticity

    @property
    def limits(self) -> Limits:
        """Limits of the model for this pair, for kernels."""
        return self._bodies.limits

    @property
    def clamped(self) -> int:
        """Impacts answered with the value at the table's border so far; may be set."""
        return self._border.clamped

    @clamped.setter
    def clamped(self, count: int) -> None:
        with self._border.lock:
            self._border.clamped = count

    def restitution(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: Thickness,
        edge: Edge = "free",
        edge_distance: ArrayLike = math.inf,
        hole_radius: ArrayLike = math.inf,
        mass: ArrayLike | None = None,
    ) -> float | Array:
        """Coefficient of restitution, from the table.

        Parameters
        ----------
        speed : array_like
            Normal approach speed [m/s], > 0.
        radius, thickness : array_like
            Radius of the sphere and thickness of the plate [m]; ``inf`` is the half-space.
        edge : {"free", "supported", "clamped"}, optional
            What holds the plate at its edge; a hole has a free one.
        edge_distance : array_like, optional
            Distance of the impact from that edge [m]; ``inf`` is a plate without edges. Impacts
            near edges are integrated, whatever table there is. See docs/angles_and_edges.md.
        hole_radius : array_like, optional
            Radius of the hole whose rim the edge is [m]; ``inf`` is a straight edge.
        mass : array_like, optional
            Mass that answers at the contact [kg] of a bead that is no solid sphere: a hollow or
            coated one, a clump; 0.65 to 1000 times that of the solid one. See docs/laws.md.

        Returns
        -------
        float or ndarray of float64
            Rebound speed over approach speed, between 0 and 1; the arguments are broadcast.

        Raises
        ------
        ValueError
            An argument that is no positive number, or an impact outside the table.

        Notes
        -----
        Within 5e-5 of `solve`, 1e-4 for a pair with a rate of strain, and 1.5e-4 for a law whose
        slope jumps; a table that errs more warns when it is made.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> model.restitution([2.0, 10.0], radius=0.9e-3, thickness=0.5e-3).round(4)
        array([0.7156, 0.6211])
        >>> model.restitution(2.0, 0.9e-3, 0.5e-3, edge_distance=[1e-3, 4e-3]).round(3)
        array([0.592, 0.714])
        """
        bare = mass is None and edge == "free" and edge_distance is hole_radius is math.inf
        if not bare or type(thickness) not in SHEETS:
            impacts = self._bodies.given(speed, radius, thickness, edge, edge_distance, hole_radius, mass, memory=True)
            if impacts.remember is not None:
                by = with_edges(self._tabulated, Solver(self._bodies), impacts)
                return by.rebounds(impacts).restitution
        else:
            # a short cut for engines that call this once per collision
            if isinstance(speed, float) and isinstance(radius, float) and isinstance(thickness, float):
                value = self._tabulated.restitution(speed, radius, thickness)
                if value == value:  # not NaN
                    return value
            sheets: Any = thickness
            impacts = Impacts(*broadcast(speed=speed, radius=radius, thickness=sheets))
        return shaped(self._tabulated.restitutions(impacts), impacts.shape)

    def lookup(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: Thickness,
        edge: Edge = "free",
        edge_distance: ArrayLike = math.inf,
        hole_radius: ArrayLike = math.inf,
        mass: ArrayLike | None = None,
    ) -> Rebound:
        """Everything about the impact, from the table.

        Parameters
        ----------
        speed, radius, thickness, edge, edge_distance, hole_radius, mass
            As in `restitution`, which says what is refused.

        Returns
        -------
        Rebound
            Within 1e-3 of `solve`, over the largest value of each field, and contact times within
            2e-3; its restitution as in `restitution`. The shares of the energy add up to 1, and the
            plastic one is 0 below yield. Residual compressions above 1 % of the largest one are
            within 1e-3, relatively.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> hit = model.lookup(speed=12.0, radius=0.9e-3, thickness=1e-3)
        >>> f"{hit.peak_force:.1f} N for {hit.contact_time * 1e6:.2f} us"
        '28.3 N for 3.92 us'
        """
        impacts = self._bodies.given(speed, radius, thickness, edge, edge_distance, hole_radius, mass, memory=True)
        return with_edges(self._tabulated, Solver(self._bodies), impacts).rebounds(impacts)

    def solve(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: Thickness,
        rtol: float = 1e-8,
        edge: Edge = "free",
        edge_distance: ArrayLike = math.inf,
        hole_radius: ArrayLike = math.inf,
        mass: ArrayLike | None = None,
    ) -> Rebound:
        """Everything about the impact, by integrating the equation: the reference.

        Parameters
        ----------
        speed, radius, thickness : array_like
            As in `restitution`, but no table limits the range.
        rtol : float, optional
            Error allowed in each step of the integration, between 1e-13 and 1e-6. Near an edge,
            and on walls that swing back, steps have an error of 5e-7 at any rtol: the COR is
            within 3e-5 of that of finer steps.
        edge, edge_distance, hole_radius, mass
            As in `restitution`.

        Returns
        -------
        Rebound
            Its energies add up to 1 within 500 rtol, which is 5e-6 at the default; most do within
            rtol. Those of a pair with a rate of strain add up within 1e-6 at any rtol, because
            its laws are expanded less finely.

        Raises
        ------
        RuntimeError
            Too many steps: lambda far above 100, or above 20 with a body of next to no strength.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> hit = model.solve(speed=12.0, radius=0.9e-3, thickness=1e-3, rtol=1e-10)
        >>> lost = hit.plastic_fraction + hit.wave_fraction + hit.other_fraction
        >>> abs(1 - hit.restitution**2 - lost) < 1e-9
        True
        """
        impacts = self._bodies.given(speed, radius, thickness, edge, edge_distance, hole_radius, mass, memory=True)
        by = Solver.within(self._bodies, rtol)
        return with_edges(by, by, impacts).rebounds(impacts)

    def lookup_sphere_sphere(
        self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike, other: Other = None
    ) -> Rebound:
        """Impact of the pair's sphere and another sphere, from the table.

        The bulk limit: no energy is carried off by waves. The energy that the fractions refer to
        is that of the relative motion.

        Parameters
        ----------
        speed, radius, other_radius : array_like
            Normal approach speed of the two [m/s], and their radii [m].
        other : Material or str, optional
            Material of the other sphere, without it that of the pair's sphere.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> float(model.lookup_sphere_sphere(10.0, 0.9e-3, 0.9e-3).wave_fraction)
        0.0
        """
        return self._beads(other).rebounds(speed, radius, other_radius)

    def yield_speed(self, radius: ArrayLike, thickness: ArrayLike, mass: ArrayLike | None = None) -> float | Array:
        """Speed V_Y [m/s] from which bead or plate yields, whichever is first; ``inf`` for neither.

        The thinner the plate, the more it gives way and the later the bead yields (Peng et al.
        2021, section 3.2, without their fit of w_m).

        Parameters
        ----------
        radius, thickness, mass : array_like
            As in `restitution`.

        Raises
        ------
        ValueError
            As in `restitution`, or a plate so thin that lambda at V_Y is outside the table.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> model.yield_speed(radius=0.9e-3, thickness=[0.5e-3, float("inf")]).round(3)
        array([7.594, 6.156])
        """
        impacts = self._bodies.given(1.0, radius, thickness, mass=mass)
        return shaped(self._tabulated.yield_speeds(impacts), impacts.shape)

    def sensitivity(
        self, speed: ArrayLike, radius: ArrayLike, thickness: ArrayLike, mass: ArrayLike | None = None
    ) -> Sensitivity:
        """How much the COR moves with each input: elasticities d ln e/d ln x.

        Parameters
        ----------
        speed, radius, thickness, mass : array_like
            As in `restitution`, inside the table; a mass grows with radius and density.

        Returns
        -------
        Sensitivity
            Per cent by which the COR rises for 1 % more of each input [-].

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> moved = model.sensitivity(speed=12.0, radius=0.9e-3, thickness=1e-3)
        >>> round(moved.thickness, 3), round(moved.yield_strength, 3)
        (0.239, 0.176)
        """
        return sensitivity(self._tabulated, self._bodies.given(speed, radius, thickness, mass=mass))

    def constant(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: Thickness,
        keep: Keep = "energy",
        weights: ArrayLike = 1.0,
        mass: ArrayLike | None = None,
    ) -> Constant:
        """One COR in place of those of many impacts, for engines that take nothing else.

        Parameters
        ----------
        speed, radius, thickness : array_like
            Impacts that happen on a wall, as in `restitution`: samples, or values with their
            `weights`.
        keep : {"energy", "momentum"}, optional
            Which total on the wall is the same as with each impact's own COR: the dissipated
            energy, e^2 = sum(w R^3 V^2 e_i^2)/sum(w R^3 V^2), or the momentum,
            e = sum(w R^3 V e_i)/sum(w R^3 V).
        weights : array_like, optional
            How often each impact happens, in any unit; broadcast with the others.
        mass : array_like, optional
            As in `restitution`; it goes for R^3 then.

        Returns
        -------
        Constant
            The COR, its errors, and how many impacts exceed each limit.

        Raises
        ------
        ValueError
            As in `restitution`; no impact, another `keep`, weights below 0, not finite or all 0.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> best = model.constant([0.1, 1.0, 10.0], radius=0.9e-3, thickness=0.5e-3)
        >>> round(best.restitution, 4), round(best.mean, 4)
        (0.6225, 0.7343)
        """
        found = self.lookup(speed, radius, thickness, mass=mass)
        given = {"restitution": found.restitution, "flags": found.flags}
        size = radius if mass is None else np.cbrt(mass)
        v, r, w, e, flags, _ = broadcast(speed=speed, radius=size, weights=weights, **given)
        return constant(v, r, w, e, flags.astype(np.int64), keep)

    def speed_table(
        self, radius: float, thickness: Thickness, error: float = 1e-3, slowest: float = 0.1, fastest: float = 10.0
    ) -> SpeedTable:
        """COR over speed in few rows, for engines that interpolate in a table.

        Parameters
        ----------
        radius, thickness : float
            As in `restitution`.
        error : float, optional
            Largest error of the COR between rows, from 1e-5 to 0.1.
        slowest, fastest : float, optional
            First and last speed of the table [m/s].

        Returns
        -------
        SpeedTable
            Speeds and their own CORs. The rows are few, though not always the fewest: from each row
            the longest straight line is taken that keeps the error.

        Raises
        ------
        ValueError
            As in `restitution`; speeds that do not rise, or a range too wide for the error.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> rows = model.speed_table(radius=0.9e-3, thickness=1e-3, error=5e-3)
        >>> rows.speed.round(2), rows.restitution.round(3)
        (array([ 0.1 ,  0.88,  5.06, 10.  ]), array([0.952, 0.927, 0.896, 0.871]))
        """
        scalars(radius=radius, thickness=sheet_of(thickness))
        return speed_table(lambda v: self.lookup(v, radius, thickness), error, (slowest, fastest))
