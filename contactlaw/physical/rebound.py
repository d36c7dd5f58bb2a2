"""Outcomes of impacts in SI units."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from contactlaw._arrays import Array, ByValue, Integers
from contactlaw._jit import kernel
from contactlaw.equation import outcome as outcomes
from contactlaw.equation import zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.outcome import Outcome
from contactlaw.physical.arguments import shaped
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts, check_finite
from contactlaw.physical.validity import Validity, edge_flags, flags_of, limits_at, wall_flags


@dataclass(frozen=True, eq=False)
class Rebound(ByValue):
    """Outcome of an impact, or of many: every field a float, or an array of one shape.

    Attributes
    ----------
    restitution
        Rebound speed over impact speed [-]; smaller ones than 1e-7 are rounded up to that.
    contact_time
        Time from first touch to separation [s]; for a sphere that stays (restitution 1e-7), until
        so little energy is left in the contact that it could not rebound faster. Near an edge a
        sphere that stays is followed for 50 times the unit of time T_H, and has a restitution of
        0.
    peak_force
        Largest contact force [N].
    peak_compression, residual_compression
        Largest relative compression of the bodies, and the part left at separation [m].
    plastic_fraction, wave_fraction, other_fraction
        Shares of the initial kinetic energy lost to plastic flow, to the waves in the plate, and to
        friction, vibration and locked stresses of the bodies, which only the law ``"fem"`` has [-].
        Their sum is 1 - restitution^2.
    inelasticity
        The dimensionless number lambda of the impact [-].
    overload
        The dimensionless number chi of the impact [-].
    flags
        `Validity` limits that the impact exceeds; 0 if it exceeds none.
    """

    restitution: float | Array
    contact_time: float | Array
    peak_force: float | Array
    peak_compression: float | Array
    residual_compression: float | Array
    plastic_fraction: float | Array
    wave_fraction: float | Array
    other_fraction: float | Array
    inelasticity: float | Array
    overload: float | Array
    flags: Validity | Integers


def shaped_flags(flags: Integers, shape: tuple[int, ...] | None) -> Validity | Integers:
    """Undo `broadcast` for flags, which of a single impact have a type of their own."""
    return Validity(int(flags[0])) if shape is None else flags.reshape(shape)


@kernel(cache=True)
def _flag(
    limits: Array,
    strength: Array,
    radius: Array,
    thickness: Array,
    scale: Array,
    contact_time: Array,
    compression: Array,
    force: Array,
    flags: Integers,
) -> None:
    """Add the limits that impacts exceed, see `contactlaw.physical.validity.flags_of`."""
    own = limits_at(limits, 0.0)
    for n in range(flags.size):
        if limits.shape[0] > 1:
            own = limits_at(limits, strength[n])
        flags[n] |= flags_of(own, radius[n], thickness[n], scale[n], contact_time[n], compression[n], force[n])


def rebound(
    bodies: SphereOnPlate,
    impacts: Impacts,
    time: Array,
    unclamped: tuple[Array, Array],
    outcome: Outcome,
    flags: Integers,
    edges: Edges | None = None,
    interpolated: bool = False,
) -> Rebound:
    """Convert outcomes to SI units, with T_H [s], and complete them.

    The shares of the energy of outcomes that were interpolated are balanced.

    `unclamped` has inelasticities and yield ratios of the impacts. Those of the outcomes differ
    where impacts were clamped to the table's border, which the flags say already.
    """
    found = outcomes.extremes(time.size)
    zener.extremes(bodies.data, outcome, found)
    inelasticity, yield_ratio = unclamped
    scale, radius, thickness = impacts.speed * time, impacts.radius, impacts.thickness
    contact_time, deepest = found.contact_time * time, found.peak_compression * scale
    force = found.peak_force * (bodies.mass(impacts) * impacts.speed / time)
    shares = found.plastic_fraction, found.wave_fraction, found.other_fraction
    if interpolated:
        factor = outcomes.balance(outcome.restitution, sum(shares))
        shares = tuple(share * factor for share in shares)
    left, overload = found.residual_compression * scale, outcome.elastic_compression / yield_ratio
    fields = outcome.restitution, contact_time, force, deepest, left, *shares, inelasticity, overload
    check_finite(bodies.pair, impacts, *fields)
    _flag(bodies.limits_by_strength, outcome.strength, radius, thickness, scale, contact_time, deepest, force, flags)
    if impacts.mass is not None:
        flags |= bodies.mass_flags(impacts)
    if impacts.wall is not None:
        flags |= wall_flags(impacts.wall.numbers, radius, impacts.bending, contact_time, deepest)
    if edges is not None:
        distance = np.full(1, math.inf) if impacts.edge is None else impacts.edge.distance
        flags |= edge_flags(radius, thickness, deepest, distance, edges.again)
    columns: Any = zip(Rebound.__dataclass_fields__, (shaped(one, impacts.shape) for one in fields), strict=False)
    return Rebound(**dict(columns), flags=shaped_flags(flags, impacts.shape))
