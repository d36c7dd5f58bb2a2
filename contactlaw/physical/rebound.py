"""Outcomes of impacts in SI units."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, ByValue, Integers
from contactlaw._jit import kernel
from contactlaw.equation import outcome as outcomes
from contactlaw.equation import zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.outcome import Extremes, Outcome
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


class Units(NamedTuple):
    """Fields of `Rebound` that `_with_units` computes."""

    contact_time: Array
    peak_compression: Array
    wave_fraction: Array
    overload: Array


def shaped_flags(flags: Integers, shape: tuple[int, ...] | None) -> Validity | Integers:
    """Undo `broadcast` for flags, which of a single impact have a type of their own."""
    return Validity(int(flags[0])) if shape is None else flags.reshape(shape)


@kernel(cache=True)
def _with_units(
    limits: Array,
    speed: Array,
    radius: Array,
    thickness: Array,
    time: Array,
    mass: Array,
    unclamped_y: Array,
    outcome: Outcome,
    extremes: Extremes,
    out: Units,
    flags: Integers,
) -> float:
    """Convert outcomes to SI units, those of `extremes` in place; `unclamped_y` as in `rebound`.

    Returns 0, or NaN where a field is not finite.
    """
    wrong, same = 0.0, limits_at(limits, 0.0)
    for n in range(speed.size):
        own = same if limits.shape[0] == 1 else limits_at(limits, outcome.strength[n])
        v, t = speed[n], time[n]
        contact_time = outcome.contact_time[n] * t
        out.contact_time[n] = contact_time
        w = outcome.compression_ratio[n] * outcome.elastic_compression[n]
        unit = v * t
        out.peak_compression[n] = w * unit
        out.wave_fraction[n] = outcome.inelasticity[n] * outcome.wave_rate[n]
        out.overload[n] = outcome.elastic_compression[n] / unclamped_y[n]
        extremes.peak_force[n] *= mass[n] * v / t
        extremes.residual_compression[n] *= unit
        flags[n] |= flags_of(own, radius[n], thickness[n], unit, contact_time, w * unit, extremes.peak_force[n])
        total = contact_time + w * unit + out.wave_fraction[n] + out.overload[n]
        total += extremes.peak_force[n] + extremes.residual_compression[n]
        total += outcome.restitution[n] + extremes.plastic_fraction[n] + extremes.other_fraction[n]
        wrong += total - total
    return wrong


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
    if edges is not None and impacts.edge_distance is not None:
        deepest = outcome.compression_ratio * outcome.elastic_compression * impacts.speed * time
        flags |= edge_flags(impacts.radius, impacts.thickness, deepest, impacts.edge_distance, edges.again)
    inelasticity, yield_ratio = unclamped
    out = Units(*np.empty((len(Units._fields), time.size)))
    wrong = _with_units(
        bodies.limits_by_strength,
        impacts.speed,
        impacts.radius,
        impacts.thickness,
        time,
        bodies.mass(impacts),
        yield_ratio,
        outcome,
        found,
        out,
        flags,
    )
    if interpolated:
        lost = found.plastic_fraction + out.wave_fraction + found.other_fraction
        for share in (found.plastic_fraction, out.wave_fraction, found.other_fraction):
            share *= outcomes.balance(outcome.restitution, lost)
    if impacts.mass is not None:
        flags |= bodies.mass_flags(impacts)
    if impacts.wall is not None:
        flags |= wall_flags(
            impacts.wall.numbers, impacts.radius, impacts.bending, out.contact_time, out.peak_compression
        )
    if edges is not None and impacts.frequency is not None:
        flags |= np.where(edges.again > 0.0, int(Validity.STRIKES_AGAIN), 0)
    shape = impacts.shape
    named = {**out._asdict(), **found._asdict(), "restitution": outcome.restitution}
    if wrong != 0.0:
        check_finite(bodies.pair, impacts, *named.values())
    return Rebound(
        **{name: shaped(values, shape) for name, values in named.items()},
        inelasticity=shaped(inelasticity, shape),
        flags=shaped_flags(flags, impacts.shape),
    )
