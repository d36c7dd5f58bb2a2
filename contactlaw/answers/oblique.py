"""Answers for oblique impacts: tangential rebound, spin and what friction takes."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._jit import in_memory, kernel, switched_off
from contactlaw.answers.backend import Backend, renumbered
from contactlaw.answers.edges import with_edges
from contactlaw.answers.solver import Solver
from contactlaw.answers.tabulated import TableLookup
from contactlaw.equation.edge import Edge
from contactlaw.equation.numbers import share_of_solid
from contactlaw.physical import oblique
from contactlaw.physical.arguments import broadcast, check, vectors
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts, check_finite
from contactlaw.physical.oblique import FASTEST, ObliqueRebound
from contactlaw.physical.plates import Thickness, check_contact, wall_of
from contactlaw.physical.vectors import Vector
from contactlaw.table import lookup

Collide = Callable[..., tuple[Vector, Vector]]


class Oblique:
    """Oblique impacts of one model.

    The tangential motion reads the normal history and does not act back on it: the coefficient of
    friction changes nothing about the normal part, whose law ``"fem"`` has a friction of 0.1
    within the contact in it. Beads are solid spheres; rolling and drilling friction are outside
    the model. See `contactlaw.equation.tangential` for the method.
    """

    _tabulated: TableLookup

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
        if method not in ("table", "solve"):
            raise ArgumentError("method", method, "must be 'table' or 'solve'")
        bodies, wall = self._tabulated.bodies, wall_of(thickness)
        check_contact(thickness, bodies.pair.given[1])
        v, s, r, mu, near, hole, *more, shape = broadcast(
            speed=speed,
            sliding_speed=sliding_speed,
            radius=radius,
            friction=friction,
            edge_distance=edge_distance,
            hole_radius=hole_radius,
            **wall.numbers,
            **({} if mass is None else {"mass": mass}),
        )
        plates = replace(wall, numbers=dict(zip(wall.numbers, more, strict=False)))
        masses = more[len(wall.numbers) :]
        impacts = replace(bodies.given(v, r, plates, edge, near, hole, *masses, memory=True), shape=shape)
        check(sliding_speed=s, friction=mu)
        by: Backend = self._tabulated if method == "table" else Solver(bodies)
        return answer(with_edges(by, Solver(bodies), impacts), bodies, impacts, mu, s)

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
        (v, omega, n, w), shape = vectors(velocity=velocity, spin=spin, normal=normal, wall_velocity=wall_velocity)
        if not n.any(axis=1).all():
            raise ArgumentError("normal", normal, "must not be zero")
        oblique.unit_all(n)
        count = np.empty(shape[:-1])
        r, h, mu, _, *masses, within = broadcast(
            radius=radius,
            thickness=thickness,
            friction=friction,
            velocity=count,
            **({} if mass is None else {"mass": mass}),
        )
        if (within or ()) != shape[:-1]:
            v, omega, n, w = (
                np.array(np.broadcast_to(rows.reshape(shape), (*within, 3))).reshape(-1, 3) for rows in (v, omega, n, w)
            )
            shape = (*within, 3)
        check(friction=mu)
        tabulated = self._tabulated
        check_contact(thickness, tabulated.bodies.pair.given[1])
        given = tabulated.bodies.given(1.0, r, h, mass=masses[0] if masses else None)
        speed, size, e, changed = np.empty((4, r.size))
        oblique.approach_all(v, omega, n, w, r, speed, size)
        if switched_off():  # no table: all are answered as those beyond one
            e[:] = np.nan
        else:
            each = tabulated.bodies.impact(given)._replace(speed=speed)
            table, tangential = tabulated.packed, tabulated.slides
            oblique.tangential_all(table, tangential, each, mu, size, e, changed)
        beyond = np.isnan(e) & (speed >= lookup.V_MIN)
        if beyond.any():
            some = np.flatnonzero(beyond)
            check(speed=speed[beyond], sliding_speed=size[beyond])
            impacts = replace(given.part(some), speed=speed[beyond])
            with renumbered(some):
                found, changed[beyond] = _answer(tabulated, impacts, mu[beyond], size[beyond])
            e[beyond] = found.restitution
        hit = np.where(speed < lookup.V_MIN, 0.0, e + changed)
        check_finite(tabulated.bodies.pair, replace(given, speed=speed), hit)
        oblique.rebound_all(v, omega, n, w, r, e, changed)
        return v.reshape(shape), omega.reshape(shape)

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
        if switched_off():
            raise RuntimeError(
                "numba is switched off (NUMBA_DISABLE_JIT is set), and without its compiler the "
                "table of oblique impacts takes hours: call collide, which integrates then"
            )
        known = self._tabulated
        return _jitted(known.packed, known.slides, known.bodies.constants.mass)


def answer(backend: Backend, bodies: SphereOnPlate, impacts: Impacts, friction: Array, size: Array) -> ObliqueRebound:
    """Everything about impacts with these sliding speeds [m/s]."""
    normal, changed = _answer(backend, impacts, friction, size)
    return oblique.of(bodies, normal, impacts, friction, size, changed)


def _answer(backend: Backend, impacts: Impacts, friction: Array, size: Array) -> Any:
    """Everything about the normal part, and the change of the sliding speed [m/s]."""
    limit = friction * impacts.speed
    psi = np.zeros_like(limit)
    with np.errstate(over="ignore"):  # with next to no friction psi is inf
        np.divide(size, limit, out=psi, where=limit > 0.0)
    normal, changed = backend.oblique(impacts, np.clip(psi, -FASTEST, FASTEST))
    return normal, limit * changed


def _jitted(table: Array, slides: Array, density: float) -> Collide:
    """One collision as a jitted function that belongs to one table."""
    of_one, packed, tangential = oblique.collide, in_memory(table), in_memory(slides)

    @kernel(entry=True)
    def collide(
        velocity: Vector,
        spin: Vector,
        normal: Vector,
        radius: float,
        thickness: float,
        friction: float,
        wall_velocity: Vector,
        mass: float = math.inf,
    ) -> tuple[Vector, Vector]:
        share = share_of_solid(density, radius, mass)
        return of_one(packed(), tangential(), velocity, spin, normal, radius, thickness, share, friction, wall_velocity)

    return collide
