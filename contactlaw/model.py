"""ImpactModel: what a bead's collision with a plate does, in SI units.

Its methods pass impacts on to the table or to the solver, which are interchangeable, or to another
module of `contactlaw.answers`.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._arrays import Array
from contactlaw.answers.beads import Other, beads_of
from contactlaw.answers.compiled import c_function, kernel_near, kernel_of
from contactlaw.answers.constant import Constant, Keep, constant
from contactlaw.answers.derivatives import Variants
from contactlaw.answers.find import PlateOf, Solutions, find
from contactlaw.answers.oblique import Collide, collide, collide_kernel, oblique
from contactlaw.answers.sensitivity import Sensitivity, sensitivity
from contactlaw.answers.solver import Solver
from contactlaw.answers.speed_table import SpeedTable, speed_table
from contactlaw.answers.tabulated import Outside, TableArgument, TableLookup, by_method
from contactlaw.answers.uncertainty import Uncertainty, uncertainty
from contactlaw.answers.yields import yield_speeds
from contactlaw.equation.edge import Edge
from contactlaw.laws import DEFAULT, Law
from contactlaw.physical.arguments import broadcast, scalars, shaped
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.history import ForceHistory
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.law import law_of
from contactlaw.physical.materials import warn_of_softened
from contactlaw.physical.oblique import ObliqueRebound
from contactlaw.physical.pair import Pair
from contactlaw.physical.plates import SHEETS, Thickness, sheet_of
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.validity import Limits
from contactlaw.table import Settings, Table


class ImpactModel:
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
        self._bodies = SphereOnPlate(pair, law_of(pair, law))
        self._tabulated = TableLookup(self._bodies, table, outside)
        self._variants = Variants(pair, self._bodies.law)
        self._edge_kernel = functools.cache(functools.partial(kernel_near, self._bodies))
        self._c_function = functools.cache(functools.partial(c_function, self._tabulated))
        self._beads = functools.cache(functools.partial(beads_of, self._tabulated))
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
        return self._tabulated.outside

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
        return self._tabulated.clamped.item()

    @clamped.setter
    def clamped(self, count: int) -> None:
        self._tabulated.clamped[:] = count

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
                return self._tabulated.rebounds(impacts).restitution
        else:
            # a short cut for engines that call this once per collision
            if isinstance(speed, float) and isinstance(radius, float) and isinstance(thickness, float):
                value = self._tabulated.restitution(speed, radius, thickness, 1.0)
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
        return self._tabulated.rebounds(impacts)

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
        return Solver(self._bodies, rtol).rebounds(impacts)

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
        beads = self._beads(other)
        return beads.rebounds(beads.between(speed, radius, other_radius))

    def force_history(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: Thickness,
        samples: int = 256,
        method: Literal["table", "solve"] = "table",
        edge: Edge = "free",
        edge_distance: ArrayLike = math.inf,
        hole_radius: ArrayLike = math.inf,
        mass: ArrayLike | None = None,
    ) -> ForceHistory:
        """Force, compression, impulse and displacement of the plate over contacts.

        Parameters
        ----------
        speed, radius, thickness : array_like
            As in `restitution`.
        samples : int, optional
            Number of even times from first touch to separation, at least 2.
        method : {"table", "solve"}, optional
            Interpolate shapes of contacts in the table, or integrate the equation.
        edge, edge_distance, hole_radius, mass
            As in `restitution`.

        Returns
        -------
        ForceHistory
            Arrays with the samples along the last axis, and flags. By ``"table"`` within 1e-3 of
            the peak force of those by ``"solve"``.

        Raises
        ------
        ValueError
            As in `restitution`; too few samples, or an unknown method.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> contact = model.force_history(speed=12.0, radius=0.9e-3, thickness=1e-3, samples=5)
        >>> contact.force.round(1)
        array([ 0. , 16.9, 28.2, 15.1,  0. ])
        """
        impacts = self._bodies.given(speed, radius, thickness, edge, edge_distance, hole_radius, mass, memory=True)
        return by_method(self._tabulated, method).histories(impacts, samples)

    def oblique(
        self,
        speed: ArrayLike,
        sliding_speed: ArrayLike,
        radius: ArrayLike,
        thickness: Thickness,
        friction: ArrayLike,
        method: Literal["table", "solve"] = "table",
        edge: Edge = "free",
        edge_distance: ArrayLike = math.inf,
        hole_radius: ArrayLike = math.inf,
        mass: ArrayLike | None = None,
    ) -> ObliqueRebound:
        """Everything about an oblique impact.

        Parameters
        ----------
        speed : array_like
            Normal approach speed [m/s], > 0.
        sliding_speed : array_like
            Speed of the contact point along the plate before the impact, from the motion of the
            centre and from spin [m/s]; of either sign, and 0 for a bead that rolls.
        radius, thickness : array_like
            Radius of the sphere and thickness of the plate [m]; ``inf`` is the half-space.
        friction : array_like
            Coulomb's coefficient of friction between bead and plate [-], from 0 to 1000.
        method : {"table", "solve"}, optional
            Interpolate in a table, which takes seconds to make once, or integrate.
        edge, edge_distance, hole_radius
            As in `ImpactModel.restitution`.
        mass : array_like, optional
            As in `ImpactModel.restitution`; the moment of inertia is 2/5 of it times R^2.

        Returns
        -------
        ObliqueRebound
            By ``"table"`` the sliding speed is within 2e-3 of friction times speed of that by
            ``"solve"``, which is within 1e-3 of the limit of many springs. With a restitution below
            0.05 or an overload above 50 it is within 7e-3.

        Raises
        ------
        ValueError
            An argument out of range, another method, or an impact outside the table.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> hit = model.oblique(3.0, [1.0, 5.0], 0.9e-3, 3e-3, friction=0.2, method="solve")
        >>> hit.sliding_speed.round(2), hit.impulse_ratio.round(3)
        (array([-0.26,  0.83]), array([0.061, 0.2  ]))
        """
        given = speed, radius, thickness, edge, edge_distance, hole_radius, mass
        return oblique(by_method(self._tabulated, method), given, sliding_speed, friction)

    def collide(
        self,
        velocity: ArrayLike,
        spin: ArrayLike,
        normal: ArrayLike,
        radius: ArrayLike,
        thickness: ArrayLike,
        friction: ArrayLike,
        wall_velocity: ArrayLike = 0.0,
        mass: ArrayLike | None = None,
    ) -> tuple[Array, Array]:
        """Velocity and spin of beads after impacts on plates, for event-driven codes.

        Parameters
        ----------
        velocity, spin : array_like
            Of the beads before, shape (..., 3), or the number 0 [m/s, rad/s].
        normal : array_like
            Normal of the plate towards the bead, of any length, shape (..., 3).
        radius, thickness, friction, mass : array_like
            As in `oblique`.
        wall_velocity : array_like, optional
            Velocity of the plate at the contact point, shape (..., 3), or the number 0 [m/s].

        Returns
        -------
        velocity, spin : ndarray of float64
            Shape (..., 3); those of a bead that recedes from the plate are as they were.

        Raises
        ------
        ValueError
            An argument out of range or without three components, or an impact outside the table.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> new, spin = model.collide([3.0, 0, -2.0], [0, 0, 0], [0, 0, 1], 0.9e-3, 3e-3, 0.2)
        >>> new.round(3), spin.round(-1)
        (array([2.205, 0.   , 1.973]), array([   0., 2210.,    0.]))
        """
        return collide(self._tabulated, velocity, spin, normal, radius, thickness, friction, wall_velocity, mass)

    @functools.cached_property
    def collide_kernel(self) -> Collide:
        """One collision as a numba-jitted function for loops of your own, as `kernel` is for COR.

        ``f(velocity, spin, normal, radius, thickness, friction, wall_velocity)`` takes vectors as
        tuples and gives two of them, velocity and spin. It cannot raise: bad input and an impact
        outside the table give NaN, whatever `outside` says. An eighth argument may be a mass [kg].

        Raises
        ------
        RuntimeError
            If numba is switched off.

        Examples
        --------
        >>> import contactlaw as cl, numba
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> collide, rest = model.collide_kernel, (0.0, 0.0, 0.0)
        >>> @numba.njit
        ... def bounce(velocity):
        ...     return collide(velocity, rest, (0.0, 0.0, 1.0), 0.9e-3, 3e-3, 0.2, rest)
        >>> velocity, spin = bounce((3.0, 0.0, -2.0))
        >>> round(velocity[2], 3)
        1.973
        """
        return collide_kernel(self._tabulated)

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
        return shaped(yield_speeds(self._tabulated, impacts), impacts.shape)

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
        impacts = self._bodies.given(speed, radius, thickness, mass=mass)
        inside = TableLookup(self._bodies, self._tabulated.given, "raise").rebounds(impacts)
        return sensitivity(self._variants, impacts, np.ravel(inside.overload) > 1.0)

    def uncertainty(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: ArrayLike,
        *,
        speed_error: float = 0.0,
        radius_error: float = 0.0,
        thickness_error: float = 0.0,
        mass: ArrayLike | None = None,
    ) -> Uncertainty:
        """How far a real impact may be from the answer, and why.

        Parameters
        ----------
        speed, radius, thickness : array_like
            As in `solve`, which integrates all of it.
        speed_error, radius_error, thickness_error : float, optional
            Relative standard errors of speed and sizes [-], 0 to 1. Those of materials are their
            `Material.uncertainty`; without any, only the law is uncertain.
        mass : array_like, optional
            As in `solve`; it has no error.

        Returns
        -------
        Uncertainty
            Quantiles of 16 and 84 % of COR, contact time and peak force, and their causes.

        Raises
        ------
        ValueError
            As in `solve`; an error out of range, or so large that a material is none any more.

        Notes
        -----
        Errors are log-normal and independent, also those of A, B and C of one fit. But if both
        bodies are of one and the same material, equal in all numbers and in its name, a number
        errs alike in both. A Poisson's ratio stays up to 0.5. Numbers that were given in the name
        of a law are held fixed. Quantiles are within 15 % of half the band's width of those of
        random pairs, for errors of strengths up to 30 % and of moduli up to 15 %.

        Examples
        --------
        >>> import contactlaw as cl
        >>> steel = cl.Material(
        ...     "my steel", 200e9, 0.29, 7800, yield_strength=400e6, kind="metal",
        ...     uncertainty={"yield_strength": 0.15},
        ... )
        >>> model = cl.ImpactModel(cl.Pair(steel, "glass"))
        >>> cor = model.uncertainty(3.0, 1e-3, 5e-3, thickness_error=0.05).restitution
        >>> round(cor.low, 2), round(cor.high, 2)
        (0.62, 0.71)
        >>> {name: round(size, 3) for name, size in cor.causes.items()}
        {'yield strength of the bead': 0.043, 'thickness': 0.002, 'model': 0.003}
        """
        impacts = self._bodies.given(speed, radius, thickness, mass=mass)
        errors = {"speed": speed_error, "radius": radius_error, "thickness": thickness_error}
        return uncertainty(self._variants, impacts, errors)

    def thickness(
        self, restitution: ArrayLike, speed: ArrayLike, radius: ArrayLike, plate: PlateOf | None = None
    ) -> Solutions | NDArray[np.object_]:
        """Every thickness of the plate that gives a COR; the COR may pass through a maximum.

        Parameters
        ----------
        restitution : array_like
            Coefficients of restitution [-], between 0 and 1.
        speed, radius : array_like
            As in `restitution`; all three are broadcast.
        plate : callable, optional
            Of a plate that is no bare sheet: a function of the thickness that is sought [m], such as that
            of a liner or of what lies under it, whose result goes where a thickness goes, as `Layers`.

        Returns
        -------
        Solutions or ndarray of Solutions
            One for each question. Those outside the table are not searched, whatever `outside` is.

        Raises
        ------
        ValueError
            An argument out of its range; an impact that no thickness brings into the table.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6"))
        >>> found = model.thickness(0.5, speed=2.0, radius=1.5e-3)
        >>> (1e3 * found.value).round(2)
        array([2.84])
        >>> model.thickness(0.8, speed=2.0, radius=1.5e-3).remark
        'no thickness: a half-space gives 0.6106, the largest COR; the range is 1.592e-06 to 0.6106'
        >>> clad = lambda h: cl.Layers([("aluminium-6061-t6", h), ("steel-s235", 1e-3)])
        >>> (1e3 * model.thickness(0.5, speed=2.0, radius=1.5e-3, plate=clad).value).round(2)
        array([1.15])
        """
        return find(self._tabulated, restitution, {"speed": speed, "radius": radius}, plate)

    def speed(self, restitution: ArrayLike, radius: ArrayLike, thickness: ArrayLike) -> Solutions | NDArray[np.object_]:
        """Every impact speed, from 0.1 mm/s, that gives a COR; all else is as in `thickness`.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6"))
        >>> model.speed(0.5, radius=1.5e-3, thickness=3e-3).value.round(3)
        array([2.2])
        """
        return find(self._tabulated, restitution, {"radius": radius, "thickness": thickness})

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

    def curve(self, radius: float, thickness: float, mass: float | None = None) -> Callable[[float], float]:
        """COR of one bead class on one plate, as a fast function of speed.

        Parameters
        ----------
        radius, thickness, mass : float
            As in `restitution`.

        Returns
        -------
        callable
            ``curve(speed)`` [m/s] -> COR; it raises the same errors as `restitution`.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> round(model.curve(radius=0.9e-3, thickness=1e-3)(5.0), 4)
        0.8966
        """
        scalars(radius=radius, thickness=thickness, **({} if mass is None else {"mass": mass}))
        return self._tabulated.curve(self._bodies.given(1.0, radius, thickness, mass=mass))

    def sphere_sphere_curve(self, radius: float, other_radius: float, other: Other = None) -> Callable[[float], float]:
        """COR of the pair's sphere and another one, as a fast function of approach speed.

        Parameters
        ----------
        radius, other_radius : float
            Radii of the beads [m].
        other : Material or str, optional
            Material of the other bead, without it that of the pair's sphere.

        Returns
        -------
        callable
            ``curve(speed)`` [m/s] -> COR; it raises the same errors as `restitution`.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> round(model.sphere_sphere_curve(1e-3, 1e-3)(20.0), 4)
        0.9616
        """
        beads, sizes = self._beads(other), scalars(radius=radius, other_radius=other_radius)
        return beads.curve(beads.between(1.0, *sizes))

    @functools.cached_property
    def kernel(self) -> Callable[..., float]:
        """COR as a numba-jitted ``f(speed, radius, thickness)`` for loops of your own [m/s, m, m].

        A fourth number may be the mass [kg], as in `restitution`.

        It reads this model's table as `restitution` does for three floats, but cannot raise (a
        raise would make a parallel loop serial): bad input and an impact outside the table give
        NaN, whatever `outside` says. Test for it with ``e != e``. Numba does not keep a caller of
        it on disk (``cache=True`` has no effect but a NumbaWarning), since the machine code
        contains the address of the table.

        Examples
        --------
        >>> import contactlaw as cl, numba
        >>> cor = cl.ImpactModel(cl.Pair("gamma-alumina", "glass")).kernel
        >>> @numba.njit
        ... def rebound_speeds(speed, radius, thickness):
        ...     return [cor(v, radius, thickness) * v for v in speed]
        >>> [round(u, 3) for u in rebound_speeds((1.0, 5.0), 0.9e-3, 1e-3)]
        [0.925, 4.483]
        """
        return kernel_of(self._tabulated)

    def edge_kernel(self, edge: Edge = "free") -> Callable[..., float]:
        """COR near an edge as a numba-jitted ``f(speed, radius, thickness, edge_distance)``.

        A fifth number may be the mass [kg], as in `restitution`.
        As `kernel`, but it integrates the equation, within 1e-3 of `solve`: 10 to 15 us per
        impact, longer where a sphere stays on a plate that recedes.

        Parameters
        ----------
        edge : {"free", "supported", "clamped"}, optional
            As in `restitution`.

        Raises
        ------
        ValueError
            If there is no such kind of edge.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> round(model.edge_kernel("free")(2.0, 0.9e-3, 0.5e-3, 1e-3), 3)
        0.592
        """
        return self._edge_kernel(edge)

    @property
    def address(self) -> int:
        """Address of a C function ``double f(double speed, double radius, double thickness)``.

        For engines in C and C++: `kernel` behind a plain function pointer, valid as long as this
        model lives, callable from any thread. It gives NaN where `kernel` does.

        Examples
        --------
        >>> import contactlaw as cl, ctypes
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> double = ctypes.c_double
        >>> f = ctypes.CFUNCTYPE(double, double, double, double)(model.address)
        >>> round(f(5.0, 0.9e-3, 1e-3), 4)
        0.8966
        """
        return int(self._c_function().address)
