"""The dimensionless numbers of an impact, which tables, solver, stepping and flags ask for here.

Of a sphere on a plate, all that speed V, radius R and thickness H change is a product of powers of
r = V^(1/5) [(m/s)^(1/5)] and R/H; what remains are constants of the pair and its law, at 1 m/s and
R = H:

    lambda = c_lam r (R/H)^2,    h = transit r/(R/H),    x = reach r^2,    T_H = (m/K)^(2/5)/r,

each for a thin plate. Its next orders (`contactlaw.equation.waves`) make the contact stiffer by
exp(eta): T_H is shorter by that, and r longer in lambda and h. x stops to grow where the force
does, some way beyond yield. A bulk impact, as of two spheres, has R/H = 0 and c_lam = 0.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation.waves import Waves, is_thin, stiffening, with_waves

Array = NDArray[np.float64]


class PlateConstants(NamedTuple):
    """What the plates of a pair bring into impacts, at 1 m/s and R = H."""

    inelasticity: float  # c_lam, of a thin plate
    transit: float  # h of a loss-free contact, see `contactlaw.equation.waves`
    reach: float  # x, of which the stiffening eta is made
    saturated: float  # V^(1/5) at which x stops to grow; inf: it never does
    waves: Waves


class Numbers(NamedTuple):
    """Impacts on Hertz's scale, and the units of that scale; floats or arrays."""

    inelasticity: Any  # lambda
    yield_ratio: Any  # y = d_Y/(V0 T_H); inf for a law that never yields
    time: Any  # T_H [s]
    compression: Any  # V0 T_H [m]
    force: Any  # m V0/T_H [N]
    stiffer: Any  # exp(eta): what the plate shortens the contact by


@kernel(inline=True)
def stiffening_of(plate: PlateConstants, root: float, ratio: float) -> float:
    """Stiffening eta of a contact by its plate, from V^(1/5) and R/H."""
    slow = min(root, plate.saturated)
    thin, h = plate.inelasticity * root * (ratio * ratio), plate.transit * root / ratio
    return stiffening(plate.waves, ratio, plate.reach * (slow * slow), thin, h)


@kernel(inline=True)
def inelasticity_of(plate: PlateConstants, root: float, ratio: float, more: float) -> float:
    """Inelasticity lambda of an impact, from V^(1/5), R/H and exp(eta)."""
    if is_thin(plate.waves):
        return plate.inelasticity * root * (ratio * ratio)
    slow = min(root, plate.saturated)
    plastic = ratio * plate.reach * (root * root - slow * slow)
    root *= more
    thin, h = plate.inelasticity * root * (ratio * ratio), plate.transit * root
    bulk = plate.inelasticity * root * (h * h)
    return with_waves(plate.waves, thin, h / ratio, bulk, plastic)


@kernel(entry=True)
def numbers(
    plate: PlateConstants,
    mass: float,
    stiffness: float,
    yield_compression: float,
    speed: float,
    ratio: float,
) -> Numbers:
    """Numbers of an impact, from m [kg], K [N/m^1.5], d_Y [m], V [m/s] and R/H."""
    root, time = speed**0.2, (mass / stiffness) ** 0.4
    more = 1.0 if is_thin(plate.waves) else math.exp(stiffening_of(plate, root, ratio))
    unit = time / (root * more)
    way = speed * unit
    lam = inelasticity_of(plate, root, ratio, more)
    return Numbers(lam, yield_compression / way, unit, way, mass * speed / unit, more)


@kernel(cache=True)
def fill(
    plate: PlateConstants,
    mass: Array,
    stiffness: Array,
    yield_compression: Array,
    speed: Array,
    ratio: Array,
    out: Numbers,
) -> None:
    """`numbers` of many impacts, of one shape."""
    for n in range(speed.size):
        one = numbers(
            plate, mass[n], stiffness[n], yield_compression[n], speed[n], ratio[n]
        )  # fmt: skip
        out.inelasticity[n], out.yield_ratio[n] = one.inelasticity, one.yield_ratio
        out.time[n], out.compression[n] = one.time, one.compression
        out.force[n], out.stiffer[n] = one.force, one.stiffer
