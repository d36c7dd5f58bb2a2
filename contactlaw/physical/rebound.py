"""What comes of an impact, in SI units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation import zener
from contactlaw.equation.outcome import Outcome
from contactlaw.physical.arguments import shaped
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
        Time from first touch to separation [s].
    peak_force
        Largest contact force [N].
    peak_compression, residual_compression
        Largest relative compression of the bodies, and what of it is left at separation [m].
    plastic_fraction, wave_fraction
        Shares of the initial kinetic energy lost to plastic flow and to the bending wave [-].
        1 - restitution^2 is their sum.
    inelasticity, overload
        The dimensionless numbers lambda and chi of the impact [-].
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
    inelasticity: float | Array
    overload: float | Array
    flags: Validity | NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Impacts:
    """What the user asked for: flat arrays, and the shape of the answer (None: scalars)."""

    speed: Array  # [m/s]
    radius: Array  # [m]
    thickness: Array  # [m]
    shape: tuple[int, ...] | None


@kernel(cache=True)
def _with_units(
    law: Array,
    limits: Limits,
    speed: Array,
    radius: Array,
    thickness: Array,
    time: Array,
    mass: Array,
    asked_y: Array,
    outcome: Outcome,
    out: Array,
    flags: NDArray[np.int64],
) -> None:
    """Fields of `Rebound` from its contact time to its overload into out (8, n), and its flags."""
    for n in range(speed.size):
        v, t, m = speed[n], time[n], mass[n]
        lam, y = outcome.inelasticity[n], outcome.yield_ratio[n]
        w = outcome.compression_ratio[n] * outcome.elastic_compression[n]
        extremes = zener.extremes_at(law, w, y)
        contact_time = outcome.contact_time[n] * t
        out[0, n] = contact_time
        out[1, n] = extremes.peak_force * (m * v / t)
        out[2, n] = w * (v * t)
        out[3, n] = extremes.residual_compression * (v * t)
        out[4, n] = extremes.plastic_fraction
        out[5, n] = lam * outcome.wave_rate[n]
        out[6, n] = outcome.elastic_compression[n] / asked_y[n]
        flags[n] |= flags_of(limits, radius[n], thickness[n], asked_y[n], contact_time)


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
    """Give outcomes their units, and add what follows from the law.

    Parameters
    ----------
    law : ndarray
        Data of the law.
    limits : Limits
        Of the model.
    impacts : Impacts
        What was asked.
    time, mass : ndarray
        T_H [s] and effective mass [kg].
    asked : tuple of ndarray
        Inelasticity and yield ratio of the impacts; those of the outcomes are others where they
        were clamped.
    outcome : Outcome
        Of the impacts.
    flags : ndarray of int
        What is known of them already.

    Returns
    -------
    Rebound
    """
    inelasticity, yield_ratio = asked
    out = np.empty((7, time.size))
    _with_units(
        law, limits, impacts.speed, impacts.radius, impacts.thickness, time, mass, yield_ratio,
        outcome, out, flags,
    )  # fmt: skip
    shape = impacts.shape
    time_, force, compression, residual, plastic, wave, overload = (
        shaped(values, shape) for values in out
    )
    return Rebound(
        restitution=shaped(outcome.restitution, shape),
        contact_time=time_,
        peak_force=force,
        peak_compression=compression,
        residual_compression=residual,
        plastic_fraction=plastic,
        wave_fraction=wave,
        inelasticity=shaped(inelasticity, shape),
        overload=overload,
        flags=Validity(int(flags[0])) if shape is None else flags.reshape(shape),
    )
