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
from contactlaw.answers.backend import renumbered
from contactlaw.answers.solver import Solver
from contactlaw.answers.tabulated import TableLookup
from contactlaw.equation.numbers import share_of_solid
from contactlaw.physical import oblique as kernels
from contactlaw.physical.arguments import broadcast, check, vectors
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.oblique import FASTEST, ObliqueRebound
from contactlaw.physical.vectors import Vector
from contactlaw.table import lookup

_SMALLEST = 1e-300  # [m/s]: without friction nothing slides
Collide = Callable[..., tuple[Vector, Vector]]


def oblique(by: Solver, given: tuple[Any, ...], sliding_speed: ArrayLike, friction: ArrayLike) -> ObliqueRebound:
    """Everything about oblique impacts, see `contactlaw.ImpactModel.oblique`; `given` is as `restitution` takes it.

    The tangential motion reads the normal history and does not act back on it. Beads are solid
    spheres, without rolling and drilling friction. `contactlaw.equation.tangential` has the method.
    """
    speed, *sizes = given
    v, _, _, shape = broadcast(speed=speed, sliding_speed=sliding_speed, friction=friction)
    impacts = by.bodies.given(v.reshape(shape or ()), *sizes, memory=True)
    whole = impacts.speed.reshape(impacts.shape or ())
    s, mu, _, _ = broadcast(sliding_speed=sliding_speed, friction=friction, speed=whole)
    check(sliding_speed=s, friction=mu)
    return answer(by, impacts, mu, s)


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
    mu, _, around = broadcast(friction=friction, velocity=np.empty(shape[:-1]))
    check(friction=mu)
    given = tabulated.bodies.given(np.ones(around or ()), radius, thickness, mass=mass)
    whole = given.shape or ()
    mu = np.broadcast_to(mu.reshape(around or ()), whole).ravel()
    v, omega, n, w = (
        np.broadcast_to(one.reshape(shape), (*whole, 3)).reshape(-1, 3).copy() for one in (v, omega, n, w)
    )
    speed, size, e, changed = np.zeros((4, mu.size))
    kernels.approach_all(v, omega, n, w, given.radius, speed, size)
    moving = np.flatnonzero(speed >= lookup.V_MIN)
    check(speed=speed[moving], sliding_speed=size[moving])
    impacts = replace(given.part(moving), speed=speed[moving])
    with renumbered(moving):
        hit = answer(tabulated, impacts, mu[moving], size[moving])
    e[moving], changed[moving] = hit.restitution, size[moving] - hit.sliding_speed
    kernels.rebound_all(v, omega, n, w, given.radius, e, changed)
    return v.reshape(*whole, 3), omega.reshape(*whole, 3)


def collide_kernel(tabulated: TableLookup) -> Collide:
    """One collision as a jitted function, see `contactlaw.ImpactModel.collide_kernel`."""
    if switched_off():
        raise RuntimeError(
            "numba is switched off (NUMBA_DISABLE_JIT is set), and without its compiler the "
            "table of oblique impacts takes hours: call collide, which integrates then"
        )
    of_one, packed, slides = kernels.collide, in_memory(tabulated.packed), in_memory(tabulated.slides)
    pair = tabulated.bodies.constants

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
        share = share_of_solid(pair, radius, mass)
        return of_one(packed(), slides(), velocity, spin, normal, radius, thickness, share, friction, wall_velocity)

    return collide


def answer(solver: Solver, impacts: Impacts, friction: Array, size: Array) -> ObliqueRebound:
    """Everything about impacts with these sliding speeds [m/s]."""
    limit = friction * impacts.speed
    psi = np.clip(size, -FASTEST * limit, FASTEST * limit) / np.maximum(limit, _SMALLEST)
    parts, changed = solver.parts(impacts), np.empty_like(psi)
    for part in parts:
        changed[part.places] = limit[part.places] * solver.slid(part, psi[part.places])
    return kernels.of(solver.bodies, solver.together(parts, impacts), impacts, friction, size, changed)
