"""What comes of an impact, in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._jit import kernel
from contactlaw.equation import outcome as outcomes
from contactlaw.equation import zener
from contactlaw.equation.outcome import Extremes, Outcome
from contactlaw.physical.arguments import broadcast, check, shaped
from contactlaw.physical.validity import Limits, Validity, flags_of

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Rebound:
    """Outcome of an impact, or of many: every field a float, or an array of one shape.

    Attributes
    ----------
    restitution
        Rebound speed over impact speed [-].
    contact_time
        Time from first touch to separation [s]; of a sphere that stays (restitution 1e-9), until
        what is left of its energy could not throw it off any faster.
    peak_force
        Largest contact force [N].
    peak_compression, residual_compression
        Largest relative compression of the bodies, and what of it is left at separation [m].
    plastic_fraction, wave_fraction, other_fraction
        Shares of the initial kinetic energy lost to plastic flow, to the waves in the plate, and to
        friction, vibration and locked stresses of the bodies, which only the law ``"fem"`` knows
        [-]. 1 - restitution^2 is their sum.
    inelasticity
        The dimensionless number lambda of the impact [-].
    overload
        The dimensionless number chi of the impact [-].
    flags
        `Validity` limits that the impact exceeds; 0 is inside all of them.
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
    flags: Validity | NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Impacts:
    """What the user asked for: flat arrays, and the shape of the answer (None: scalars)."""

    speed: Array  # [m/s]
    radius: Array  # [m], R* of two spheres
    thickness: Array  # [m]
    shape: tuple[int, ...] | None

    @staticmethod
    def on_plates(speed: ArrayLike, radius: ArrayLike, thickness: ArrayLike) -> Impacts:
        """Broadcast and check what the user gave."""
        v, r, h, shape = broadcast(speed=speed, radius=radius, thickness=thickness)
        check(speed=v, radius=r, thickness=h)
        return Impacts(v, r, h, shape)


class Units(NamedTuple):
    """Fields of `Rebound` that take units, or are quotients."""

    contact_time: Array
    peak_compression: Array
    wave_fraction: Array
    overload: Array


@kernel(cache=True)
def _with_units(
    limits: Limits,
    speed: Array,
    radius: Array,
    thickness: Array,
    time: Array,
    mass: Array,
    asked_y: Array,
    outcome: Outcome,
    extremes: Extremes,
    out: Units,
    flags: NDArray[np.int64],
) -> None:
    """Give outcomes their units; those of `extremes` in place."""
    for n in range(speed.size):
        v, t = speed[n], time[n]
        contact_time = outcome.contact_time[n] * t
        out.contact_time[n] = contact_time
        w = outcome.compression_ratio[n] * outcome.elastic_compression[n]
        unit = v * t
        out.peak_compression[n] = w * unit
        out.wave_fraction[n] = outcome.inelasticity[n] * outcome.wave_rate[n]
        out.overload[n] = outcome.elastic_compression[n] / asked_y[n]
        extremes.peak_force[n] *= mass[n] * v / t
        extremes.residual_compression[n] *= unit
        flags[n] |= flags_of(
            limits, radius[n], thickness[n], unit, contact_time, w * unit, extremes.peak_force[n]
        )


def rebound(
    law: Array,
    limits: Limits,
    impacts: Impacts,
    time: Array,
    mass: Array,
    asked: tuple[Array, Array],
    outcome: Outcome,
    flags: NDArray[np.int64],
) -> Rebound:
    """Give outcomes their units, with T_H [s] and effective masses [kg], and what the law adds.

    What was asked are inelasticity and yield ratio: those of the outcomes differ from them where
    impacts were clamped, as the flags say already.
    """
    inelasticity, yield_ratio = asked
    out = Units(*np.empty((len(Units._fields), time.size)))
    found = outcomes.extremes(time.size)
    zener.extremes(law, outcome, found)
    _with_units(
        limits, impacts.speed, impacts.radius, impacts.thickness, time, mass, yield_ratio,
        outcome, found, out, flags,
    )  # fmt: skip
    shape = impacts.shape
    named = {**out._asdict(), **found._asdict(), "restitution": outcome.restitution}
    return Rebound(
        **{name: shaped(values, shape) for name, values in named.items()},
        inelasticity=shaped(inelasticity, shape),
        flags=Validity(int(flags[0])) if shape is None else flags.reshape(shape),
    )
