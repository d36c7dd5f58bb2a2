"""From SI units to the two dimensionless numbers that determine an impact, and back.

A contact is a mass on a Hertzian spring in series with the plate's mobility. With the speed, mass
and spring define the time T_H, and with it the dimensionless numbers that the table and the solver
work with: the inelasticity lambda, and the yield compression y on Hertz's scale.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._jit import kernel
from contactlaw.equation import numbers
from contactlaw.equation.corrections import CONTACT_TIME, SATURATION, THIN, plate_corrections
from contactlaw.equation.edge import Edges
from contactlaw.equation.numbers import Impact, ModulusGrowth, Numbers, PairConstants, PlateConstants, RateOfStrain
from contactlaw.laws import Law
from contactlaw.laws.myc import C_YIELD
from contactlaw.physical.arguments import within
from contactlaw.physical.impacts import Impacts, PlateEdge
from contactlaw.physical.materials import Material, sphere_mass
from contactlaw.physical.pair import Pair
from contactlaw.physical.plates import Wall
from contactlaw.physical.rate import SHARE, flow_with_rate, per_rate
from contactlaw.physical.responses import response_of
from contactlaw.table.lookup import R_MIN


def plate_mobility(plate: Material, thickness: Any) -> Any:
    """Speed of an infinite plate under a point force, per force [m/(s N)]; 0 for a half-space.

    alpha = sqrt(3 rho2 (1 - nu2^2)/E2)/(4 rho2 H^2) = 1/(8 sqrt(D rho2 H)), D = E2' H^3/12
    (Zener 1941; Peng et al. 2021, below Eq. 1).
    """
    wave_speed = math.sqrt(plate.plane_modulus / plate.density)
    with np.errstate(over="ignore"):  # a plate of 1e200 m is a half-space
        area = np.square(thickness)
    return math.sqrt(3.0) / (4.0 * plate.density * wave_speed * area)


def _yield_compression(pair: Pair, law: Law) -> float:
    """Compute d_Y/R, Eq. 18 for the sphere's material; inf for Hertz's law, which has none."""
    if law.scale is not None:
        return law.scale
    if law.yield_coefficient is None:
        return math.inf
    return pair.yield_share(law.yield_coefficient, pair.sphere.require_yield_strength(law.name))


def yield_share(pair: Pair, law: Law) -> float:
    """d_Y/R of the body that yields first, by the law's criterion or MYC's; inf if none does."""
    if law.scale is not None:
        return (law.onset or law.scale) if law.yields else math.inf
    return pair.yield_share(law.yield_coefficient or C_YIELD)


def yield_scales(pair: Pair, coefficient: float, radius: float) -> tuple[float, float]:
    """Yield compression d_Y [m] and force F_Y [N] of a sphere on a plate."""
    compression = pair.yield_share(coefficient, pair.sphere.require_yield_strength("measured")) * radius
    stiffness = 4.0 / 3.0 * pair.effective_modulus * math.sqrt(radius)  # K in F = K d^1.5
    return compression, stiffness * compression**1.5


def constants_of(pair: Pair, law: Law) -> PairConstants:
    """Constants of a pair for impacts of spheres on plates: R* = R, m* = m."""
    return PairConstants(
        plate=_plate_constants(pair, law),
        time=unit_time(pair),
        mass=sphere_mass(pair.sphere.density, 1.0),
        yield_compression=_yield_compression(pair, law),
    )


def without_plate(constants: PairConstants) -> PairConstants:
    """Constants for impacts in which no wave carries energy off, as those of two spheres."""
    given = constants.plate
    bulk = PlateConstants(0.0, 0.0, 0.0, math.inf, THIN, given.growth, given.rate)
    return constants._replace(plate=bulk)


def reduced(pair: Pair, radius: Array, other_radius: Array) -> tuple[Array, Array]:
    """R* = R1 R2/(R1 + R2) [m] and m* = m1 m2/(m1 + m2) [kg] of two spheres."""
    mass = sphere_mass(pair.sphere.density, radius)
    other = sphere_mass(pair.plate.density, other_radius)
    return radius * other_radius / (radius + other_radius), mass * other / (mass + other)


def _plate_constants(pair: Pair, law: Law) -> PlateConstants:
    """Constants of a pair's plates, at 1 m/s and R = H; they are the same for all sizes."""
    mass, time = sphere_mass(pair.sphere.density, 1.0), unit_time(pair)
    corrections = THIN
    if law.waves is not None:
        share = pair.effective_modulus / pair.plate.plane_modulus
        b, b_h, b4, b_p = law.waves
        corrections = plate_corrections(pair.plate.poissons_ratio, b * share, b_h * share, b4, b_p * share)
    shear = 0.5 * pair.plate.youngs_modulus / (1.0 + pair.plate.poissons_ratio)
    # beyond yield the force grows no faster than the compression
    most = SATURATION * SATURATION * _yield_compression(pair, law) / time
    return PlateConstants(
        inelasticity=float(plate_mobility(pair.plate, 1.0)) * mass / time,
        transit=math.sqrt(pair.plate.density / shear) / CONTACT_TIME / time,  # of a shear wave
        x_at_one=math.sqrt(time),
        saturated=most**0.25,
        corrections=corrections,
        growth=modulus_growth(pair, law),
        rate=rate_of_strain(pair, law),
    )


def rate_of_strain(pair: Pair, law: Law) -> RateOfStrain:
    """How the strength of a pair grows with the rate of an impact."""
    flow = flow_with_rate(pair, law)
    if flow is None or law.scale is None:
        return numbers.NO_RATE
    return RateOfStrain(flow.rate, SHARE / flow.rate0 * per_rate(pair) * law.scale)


def modulus_growth(pair: Pair, law: Law) -> ModulusGrowth:
    """How the moduli of a pair grow with the frequency of an impact.

    That frequency is 1/(2 contact times), of an elastic impact on a thick plate. As T_H falls with
    the modulus, an exponent a of the modulus becomes a/(1 - 0.4 a).
    """
    if pair.frequency is None or not law.parameters.get("loss_factor"):
        return numbers.ELASTIC
    share = pair.effective_modulus / pair.plate.plane_modulus  # of the plate in the compliance
    modulus = (1.0 - share) * pair.sphere.relaxation + share * pair.plate.relaxation
    again = 1.0 - 0.4 * modulus
    # The plate takes less, since the force of a body with losses is lower and falls earlier, and
    # more if it has losses itself, as its speed lags behind the force. By least squares to the
    # impacts of `validation.fem.viscoelastic`, tan delta 0.05 to 0.4 and lambda 0.05 to 0.8.
    a, delta = 2.0 / math.pi * math.atan(pair.loss_factor), pair.plate.loss_angle
    return ModulusGrowth(
        log_time=-math.log(2.0 * CONTACT_TIME * pair.frequency),
        modulus_power=modulus / again,
        plate_power=pair.plate.relaxation / again,
        yield_power=-2.0 if law.yields else 0.0,
        wave=-a * (0.641 + 0.917 * a) + delta * (0.124 + 0.136 * delta),
        wave_slope=-a * (0.348 + 0.378 * a) + delta * (0.414 + 1.065 * delta),
    )


def unit_time(pair: Pair) -> float:
    """T_H of a sphere of radius 1 m at 1 m/s [s]."""
    return float((math.pi * pair.sphere.density / pair.effective_modulus) ** 0.4)


def numbers_of(constants: PairConstants, laws: Array, impact: Impact) -> Numbers:
    """Dimensionless numbers and units of impacts, which are broadcast; `laws` as kernels read."""
    given = np.broadcast_arrays(*impact)
    # copies: kernels are compiled for writeable arrays, and broadcast ones are not
    flat = Impact(*(np.array(one, dtype=float).ravel() for one in given))
    out = Numbers(*np.empty((len(Numbers._fields), flat.speed.size)))
    numbers.fill(constants, laws, flat, out)
    return Numbers(*(values.reshape(given[0].shape) for values in out))


_FAR = 1e300  # [m] no plate is so large
_LONGEST = 500.0  # T_H over tau near holes: the response was fitted for forces of 2000 tau
# A plate is softer in torsion than Kirchhoff's by the strip of this share of its thickness along an
# edge: a band of width b is as stiff as one of b - 2 times that (St Venant; Timoshenko & Goodier,
# Theory of Elasticity, 3rd ed., section 109). A wave twists the rim of a hole, which is as soft as
# that of a hole wider by the strip. With it, three impacts near holes are within 2 % of finite
# elements in three dimensions, without it within 3.5 %; near straight edges they are without.
SOFT_RIM = 0.315
NEAREST = 1e-3  # of the thickness; nearer than that a contact is at the edge itself


def wave_path(plate: Material) -> float:
    """sqrt(D/(rho2 H)) over H [m/s]: in a time t a bending wave gets about sqrt(that H t) far."""
    return math.sqrt(plate.plane_modulus / (12.0 * plate.density))


@kernel
def wave_rate(path: float, thickness: Any, distance: Any) -> Any:
    """1/tau [1/s] at a distance from an edge [m], from the plate's `wave_path` [m/s]."""
    share = np.maximum(distance / thickness, NEAREST)
    return path / (share * share * thickness)


@kernel
def from_rim(path: float, thickness: Any, distance: Any, hole_radius: Any, time: Any) -> Any:
    """Distance from an edge [m] that an impact with this T_H [s] has in the equation.

    Right at the rim of a hole a contact is as long in tau as any that the response was fitted for.
    The arguments are numbers or arrays, `path` is that of `wave_path`.
    """
    nearest = np.minimum(np.sqrt(path * thickness * time / _LONGEST), _FAR)  # a half-space has inf
    return np.maximum(distance, (hole_radius < math.inf) * nearest)


def share_of(distance: Array, hole_radius: Array, thickness: Array) -> Array:
    """s/(s + a) at distances s from rims of holes of radius a [m]; 0 near straight edges.

    a is larger than the radius by `SOFT_RIM`.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        wide = distance / (distance + hole_radius + SOFT_RIM * thickness)
    return np.where(hole_radius < math.inf, wide, 0.0)


@kernel
def coupling_of(pair: PairConstants, units: Numbers, impact: Impact) -> Any:
    """Mobility of a thin plate over that of the contact, at most 1: what comes back is a bending wave.

    The arguments have numbers or arrays.
    """
    root, ratio = pair.time * impact.radius / units.time, impact.radius / impact.thickness
    thin = pair.plate.inelasticity * root * (ratio * ratio) * impact.mass / units.inelasticity
    # of bodies with losses both have the moduli of the impact
    return np.minimum(np.maximum(thin, 1.0 * numbers.relaxes(pair.plate)), 1.0)


def edges_of(
    plate: Material, constants: PairConstants, units: Numbers, impact: Impact, impacts: Impacts
) -> Edges | None:
    """Give the equation what comes back to impacts, from edges or from walls that swing; None for neither."""
    none, kind = np.zeros(impact.speed.size), ""
    if impacts.edge is not None:
        path, thickness, (kind, distance, hole_radius) = wave_path(plate), impact.thickness, impacts.edge
        distance = from_rim(path, thickness, distance, hole_radius, units.time)
        share, rate = share_of(distance, hole_radius, thickness), wave_rate(path, thickness, distance)
    elif impacts.frequency is not None and impacts.wall is not None:
        kind, share, rate = impacts.wall.kind, none, impacts.frequency
    else:
        return None
    response = response_of(kind, plate.poissons_ratio, share)
    return Edges(response, coupling_of(constants, units, impact), rate * units.time, none)


def on_wall(plate: Material, impacts: Impacts, memory: bool) -> Impacts:
    """Complete impacts on what is no flat sheet of the plate's material."""
    wall = impacts.wall
    assert wall is not None
    h, given, kind = impacts.thickness, wall.numbers, wall.kind
    unknown = np.full(h.size, math.nan)
    areal, bending, membrane = (given.get(name, unknown) for name in ("areal", "bending", "membrane"))
    sheet = np.isnan(areal)
    wave = np.where(sheet, wave_path(plate) * h, np.sqrt(bending / areal))
    fast = np.where(sheet, plate.youngs_modulus / plate.density, membrane / areal)
    if np.isnan(fast).any() and (impacts.edge is not None or "wall_radius" in given):
        raise ArgumentError("thickness", None, "curved walls and plates with edges cannot be Orthotropic")
    numbers = {**given, "wave": wave}
    if impacts.edge is not None and "areal" in given:
        # as far in wave lengths on the plate that answers alike
        farther = np.where(sheet | (h == math.inf), 1.0, np.sqrt(wave_path(plate) * h / wave))
        kind_of_edge, *lengths = impacts.edge
        impacts = replace(impacts, edge=PlateEdge(kind_of_edge, *(one * farther for one in lengths)))
    if not kind:
        return replace(impacts, wall=Wall(numbers))
    wall = replace(wall, numbers=numbers)
    if not memory or impacts.edge is not None:
        reason = "walls that swing back have neither edges nor tables: take solve, lookup or oblique"
        raise ArgumentError("thickness", None, reason)
    bends = None
    if "wall_radius" in given:
        curvature = 1.0 / _checked_radius(given["wall_radius"], impacts.radius)
        bends = 1.0 / (1.0 - curvature * impacts.radius)
        bends = np.sqrt(bends) if kind == "cylinder" else bends
        square = fast * curvature**2
    else:
        within("stiffness", given["stiffness"], 0.0, 1e30, "N/m3")
        square = given["stiffness"] / np.where(sheet, plate.density * h, areal)
    frequency = np.where(h < math.inf, np.sqrt(square), 0.0)
    return replace(impacts, wall=wall, bending=bends, frequency=frequency)


def swing_of(plate: Material, thickness: Any) -> tuple[str, float]:
    """Kind of the response of one wall, and its frequency w0, 0 of a flat sheet [1/s]."""
    given = Impacts.on_plates(1.0, R_MIN, thickness)
    if given.wall is None or not given.wall.kind:
        return "", 0.0
    (frequency,) = np.asarray(on_wall(plate, given, True).frequency)
    return given.wall.kind, float(frequency)


def _checked_radius(wall: Array, radius: Array) -> Array:
    """Refuse walls that are not larger than the bead."""
    small = ~(abs(wall) > radius)
    if small.any():
        n = int(np.argmax(small))
        reason = f"the wall's radius must be larger than the bead's, {radius[n]:g} m; negative outside"
        raise ArgumentError("radius", wall[n], reason, n if wall.size > 1 else None)
    return wall
