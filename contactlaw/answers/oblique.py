"""Answers for oblique impacts: tangential rebound, spin and what friction takes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._jit import in_memory, kernel, switched_off
from contactlaw.answers.backend import Backend, renumbered
from contactlaw.answers.tabulated import TableLookup
from contactlaw.equation.edge import Edge
from contactlaw.equation.numbers import share_of_solid
from contactlaw.physical import oblique as kernels
from contactlaw.physical.arguments import broadcast, check, vectors
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts, check_finite
from contactlaw.physical.oblique import FASTEST, ObliqueRebound, Vector
from contactlaw.physical.plates import Thickness, check_contact, wall_of
from contactlaw.table import lookup

Collide = Callable[..., tuple[Vector, Vector]]


def oblique(
    by: Backend,
    speed: ArrayLike,
    sliding_speed: ArrayLike,
    radius: ArrayLike,
    thickness: Thickness,
    friction: ArrayLike,
    edge: Edge,
    edge_distance: ArrayLike,
    hole_radius: ArrayLike,
    mass: ArrayLike | None,
) -> ObliqueRebound:
    """Everything about oblique impacts, see `contactlaw.ImpactModel.oblique`.

    The tangential motion reads the normal history and does not act back on it. Beads are solid
    spheres, without rolling and drilling friction. `contactlaw.equation.tangential` has the method.
    """
    bodies, wall = by.bodies, wall_of(thickness)
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
    return answer(by, bodies, impacts, mu, s)


def collide(
    tabulated: TableLookup,
    velocity: ArrayLike,
    spin: ArrayLike,
    normal: ArrayLike,
    radius: ArrayLike,
    thickness: ArrayLike,
    friction: ArrayLike,
    wall_velocity: ArrayLike,
    mass: ArrayLike | None,
) -> tuple[Array, Array]:
    """Velocity and spin of beads after impacts, see `contactlaw.ImpactModel.collide`."""
    (v, omega, n, w), shape = vectors(velocity=velocity, spin=spin, normal=normal, wall_velocity=wall_velocity)
    if not n.any(axis=1).all():
        raise ArgumentError("normal", normal, "must not be zero")
    kernels.unit_all(n)
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
    check_contact(thickness, tabulated.bodies.pair.given[1])
    given = tabulated.bodies.given(1.0, r, h, mass=masses[0] if masses else None)
    speed, size, e, changed = np.empty((4, r.size))
    kernels.approach_all(v, omega, n, w, r, speed, size)
    if switched_off():  # no table: all are answered as those beyond one
        e[:] = np.nan
    else:
        each = tabulated.bodies.impact(given)._replace(speed=speed)
        table, tangential = tabulated.packed, tabulated.slides
        kernels.tangential_all(table, tangential, each, mu, size, e, changed)
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
    kernels.rebound_all(v, omega, n, w, r, e, changed)
    return v.reshape(shape), omega.reshape(shape)


def collide_kernel(tabulated: TableLookup) -> Collide:
    """One collision as a jitted function, see `contactlaw.ImpactModel.collide_kernel`."""
    if switched_off():
        raise RuntimeError(
            "numba is switched off (NUMBA_DISABLE_JIT is set), and without its compiler the "
            "table of oblique impacts takes hours: call collide, which integrates then"
        )
    return _jitted(tabulated.packed, tabulated.slides, tabulated.bodies.constants.mass)


def answer(backend: Backend, bodies: SphereOnPlate, impacts: Impacts, friction: Array, size: Array) -> ObliqueRebound:
    """Everything about impacts with these sliding speeds [m/s]."""
    normal, changed = _answer(backend, impacts, friction, size)
    return kernels.of(bodies, normal, impacts, friction, size, changed)


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
    of_one, packed, tangential = kernels.collide, in_memory(table), in_memory(slides)

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
