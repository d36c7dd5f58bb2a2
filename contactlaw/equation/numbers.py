"""The dimensionless numbers of an impact, computed here for tables, solver, stepping and flags.

For a sphere on a plate they depend on speed V, radius R and thickness H through powers of
r = V^(1/5) [(m/s)^(1/5)] and of R/H; the factors are constants of the pair and its law, their
values at 1 m/s and R = H. For a thin plate

    lambda = c_lam r (R/H)^2,   h = transit r/(R/H),   x = x_at_one r^2,   T_H = (m/K)^(2/5)/r.

Another plate (`contactlaw.equation.corrections`) makes the contact stiffer: T_H is divided by
exp(eta), and r multiplied by it in lambda and h. From about 17 times the yield speed on
(`saturated`) x is constant in eta. A bulk impact, as of two spheres, has R/H = 0 and c_lam = 0.

Moduli of bodies with losses grow with the frequency of the impact (`ModulusGrowth`). They make the
contact stiffer, too: E* grows by g, and r by g^(2/5).
"""

import math
from typing import Any, NamedTuple

from contactlaw._arrays import Array
from contactlaw._jit import kernel, tuple_of
from contactlaw.equation.corrections import PlateCorrections, eta_of, is_thin, with_corrections
from contactlaw.equation.force import growth_at


class ModulusGrowth(NamedTuple):
    """How moduli grow with the frequency of an impact; all zero for bodies without losses.

    With T the T_H of an impact without this growth, E* grows by the factor
    g = (exp(log_time)/T)^modulus_power.
    """

    log_time: float  # ln T_H [s] of impacts in which the moduli are those of the pair
    modulus_power: float
    plate_power: float  # the same of the plate's modulus
    yield_power: float  # of g, by which d_Y grows: -2, or 0 if no body yields
    # ln of the factor by which losses change lambda, at lambda = 0 and its slope over lambda
    wave: float
    wave_slope: float


LIGHTEST, HEAVIEST = 0.65, 1e3
"""Masses that answer at a contact, over that of a solid sphere; a lighter one is a thin shell."""

ELASTIC = ModulusGrowth(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
"""Bodies whose moduli are the same at any frequency."""


class RateOfStrain(NamedTuple):
    """How a pair's strength k grows with the rate of an impact: k = 1 + slope ln(rate/rate0)."""

    slope: float
    per_speed: float  # rate/rate0 at 1 m/s, times d_Y [m]


RATE_POWER = 0.7
"""Power of the speed with which the representative rate grows, see `contactlaw.physical.rate`."""

NO_RATE = RateOfStrain(0.0, 0.0)
"""Bodies whose strength is the same at any rate."""


class PlateConstants(NamedTuple):
    """Constants of a pair for impacts on its plates, at 1 m/s and R = H."""

    inelasticity: float  # c_lam, lambda of a thin plate
    transit: float  # h of a loss-free contact, see `contactlaw.equation.corrections`
    x_at_one: float  # x, from which the stiffening eta follows
    saturated: float  # V^(1/5) from which on x is constant in eta; inf: nowhere
    corrections: PlateCorrections
    growth: ModulusGrowth
    rate: RateOfStrain


class PairConstants(NamedTuple):
    """Constants of a pair for impacts of solid spheres: all sizes follow from them."""

    plate: PlateConstants
    time: float  # T_H at 1 m/s, over R [s/m]
    mass: float  # over R^3 [kg/m3]
    yield_compression: float  # d_Y of a slow impact, over R; inf for a law that never yields


class Impact(NamedTuple):
    """What an impact is given by: numbers, or arrays of one length."""

    speed: Any  # V [m/s]
    radius: Any  # R [m]; R* of two spheres
    thickness: Any  # H [m]; inf for a half-space and for two spheres
    mass: Any = 1.0  # over that of the pair's solid sphere of radius R


class Numbers(NamedTuple):
    """Dimensionless numbers of impacts, and the units of Hertz's scale; floats or arrays."""

    inelasticity: Any  # lambda
    yield_ratio: Any  # y = d_Y/(V0 T_H); inf for a law that never yields
    time: Any  # T_H [s]
    compression: Any  # V0 T_H [m]
    force: Any  # m V0/T_H [N]
    stiffer: Any  # factor by which plate and frequency shorten the contact, exp(eta) g^(2/5)
    strength: Any  # ln k of the pair at the rate of the impact


@kernel(inline=True)
def relaxes(plate: PlateConstants) -> bool:
    """Whether moduli depend on the frequency of an impact."""
    return plate.growth.modulus_power > 0.0


@kernel(inline=True)
def plate_stiffening(plate: PlateConstants, root: float, ratio: float) -> float:
    """Stiffening eta of a contact by its plate, from V^(1/5) and R/H."""
    slow = min(root, plate.saturated)
    thin, h = plate.inelasticity * root * (ratio * ratio), plate.transit * root * (1.0 / ratio)
    return eta_of(plate.corrections, ratio, plate.x_at_one * (slow * slow), thin, h)


@kernel(inline=True)
def inelasticity_of(plate: PlateConstants, root: float, ratio: float, stiffer: float) -> float:
    """Inelasticity lambda of an impact, from V^(1/5), R/H and exp(eta)."""
    if is_thin(plate.corrections):
        return plate.inelasticity * root * (ratio * ratio)
    slow = min(root, plate.saturated)
    plastic = ratio * plate.x_at_one * (root * root - slow * slow)
    root *= stiffer
    thin, h = plate.inelasticity * root * (ratio * ratio), plate.transit * root
    bulk = plate.inelasticity * root * (h * h)
    lam = with_corrections(plate.corrections, thin, h * (1.0 / ratio), bulk, plastic)
    if relaxes(plate):
        lam *= math.exp(plate.growth.wave + plate.growth.wave_slope * min(lam, 1.0))
    return lam


@kernel(inline=True)
def scaled(plate: PlateConstants, inelasticity: float, transit: float, x: float, saturated: float) -> PlateConstants:
    """Plate whose constants are multiplied by these factors."""
    return tuple_of(
        PlateConstants,
        plate,
        inelasticity=plate.inelasticity * inelasticity,
        transit=plate.transit * transit,
        x_at_one=plate.x_at_one * x,
        saturated=plate.saturated * saturated,
    )


@kernel(inline=True)
def relaxed(plate: PlateConstants, root: float, log_time: float) -> tuple[PlateConstants, float, float]:
    """Plate and V^(1/5) with the moduli of an impact, from ln T_H without their growth; ln g.

    Returns V^(1/5) g^(2/5) in place of V^(1/5): T_H is that of a faster impact.
    """
    shorter = plate.growth.log_time - log_time
    growth, slower = plate.growth.modulus_power * shorter, math.exp(-0.5 * plate.growth.plate_power * shorter)
    plate = scaled(plate, slower, slower, math.exp(-growth), 1.0)
    return plate, root * math.exp(0.4 * growth), growth


@kernel(inline=True)
def strength_of(rate: RateOfStrain, speed: float, yield_compression: float) -> float:
    """Logarithm of a pair's strength in an impact, over that of a slow test."""
    relative = rate.per_speed * speed**RATE_POWER / yield_compression
    return math.log(1.0 + rate.slope * math.log(relative)) if relative > 1.0 else 0.0


@kernel(inline=True)
def of_mass(pair: PairConstants, mass: float) -> PairConstants:
    """Constants for spheres whose mass is a multiple of a solid one's.

    T_H grows as mass^(2/5), and what is given at 1 m/s and R = H follows from it.
    """
    slower = mass**0.4
    root = math.sqrt(slower)
    plate = scaled(pair.plate, mass / slower, 1.0 / slower, root, 1.0 / math.sqrt(root))
    return PairConstants(plate, pair.time * slower, pair.mass * mass, pair.yield_compression)


@kernel(inline=True)
def solid_mass(unit: Any, radius: Any) -> Any:
    """Mass of a solid sphere [kg], from the constants of one of radius 1 m."""
    return unit.mass * (radius * radius * radius)


@kernel(inline=True)
def mass_fits(share: Any) -> Any:
    """Whether masses, over those of solid spheres, are such that the model holds."""
    return (share >= LIGHTEST) & (share <= HEAVIEST)


@kernel(inline=True)
def share_of_solid(pair: PairConstants, radius: float, mass: float) -> float:
    """Mass [kg] over that of a solid sphere, for which inf stands; NaN if the model does not hold."""
    share = mass / solid_mass(pair, radius)
    return 1.0 if mass == math.inf else share if mass_fits(share) else math.nan


@kernel(entry=True)
def numbers(pair: PairConstants, laws: Array, impact: Impact) -> Numbers:
    """Numbers of an impact."""
    speed, radius, ratio = impact.speed, impact.radius, impact.radius / impact.thickness
    if impact.mass != 1.0:
        pair = of_mass(pair, impact.mass)
    plate, yielding = pair.plate, pair.yield_compression * radius
    strength = strength_of(plate.rate, speed, yielding)
    later = growth_at(laws, strength)
    root, time, growth = speed**0.2, pair.time * radius, 0.0
    yielding *= later
    if later != 1.0:  # a stronger pair yields later, and x is constant from a later speed on
        plate = scaled(plate, 1.0, 1.0, 1.0, math.sqrt(math.sqrt(later)))
    if relaxes(plate):
        plate, root, growth = relaxed(plate, root, math.log(time / root))
        yielding *= math.exp(plate.growth.yield_power * growth)
    stiffer = 1.0 if is_thin(plate.corrections) else math.exp(plate_stiffening(plate, root, ratio))
    unit = time / (root * stiffer)
    length = speed * unit
    lam = inelasticity_of(plate, root, ratio, stiffer)
    stiffer *= math.exp(0.4 * growth)
    force = solid_mass(pair, radius) * speed / unit
    return Numbers(lam, yielding / length, unit, length, force, stiffer, strength)


@kernel(cache=True)
def fill(pair: PairConstants, laws: Array, impact: Impact, out: Numbers) -> None:
    """`numbers` of many impacts; all arrays have scales length."""
    speed, radius, thickness, mass = impact.speed, impact.radius, impact.thickness, impact.mass
    for n in range(speed.size):
        scales = numbers(pair, laws, Impact(speed[n], radius[n], thickness[n], mass[n]))
        for k in range(len(scales)):
            out[k][n] = scales[k]
