"""How much the COR moves with each input: elasticities d ln e/d ln x.

The COR is a function of lambda and y = d_Y/(V0 T_H), and with some laws of r = E*/sigma_Y too. All
are products of powers of the inputs. With w = E*/E1' for the sphere and E*/E2' for the plate (they
sum to 1) the powers are

                V0    R    H    rho1   rho2    E1       E2             sigma_Y
    lambda     0.2    2   -2    0.6   -0.5    0.4 w    0.4 w - 0.5     0
    y         -0.8    0    0   -0.4    0     -1.6 w   -1.6 w           2
    r          0      0    0    0      0      w        w              -1

so d ln e/d ln x is a sum of terms, power by derivative. The derivatives are central differences: of
the table if it is as accurate as promised, else of the solver; those by r are always of the solver.

A law with corrections of the plate (`contactlaw.equation.corrections`) depends on more numbers of
the pair, and lambda is no product of powers. There, inputs are changed one by one, and each time
the impacts are integrated. No answer depends on the units of length, time and mass, so three of
the eight elasticities follow from the others:

    R = -H    E1 + E2 + sigma_Y = -V0/2    rho1 + rho2 = V0/2

but for bodies with a rate of strain, hardening or losses, whose other constants have units, too.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactlaw import laws
from contactlaw.answers.solver import solved, within
from contactlaw.answers.tabulated import Border, Tabulated
from contactlaw.equation import outcome
from contactlaw.equation.outcome import Outcome
from contactlaw.laws import Law
from contactlaw.physical.arguments import shaped
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.law import law_for_pair, pair_numbers
from contactlaw.physical.pair import Pair
from contactlaw.physical.rate import scaled
from contactlaw.table import lookup
from contactlaw.table.nodes import Table

Array = NDArray[np.float64]

# Step of central differences of ln e. They err by 2e-9 times the third derivative, which is up to
# 3e4 next to a corner, and by 1e-8 from the solver, which is accurate to 1e-12 in ln e.
_STEP = 1e-4
_RTOL = 1e-13


@dataclass(frozen=True)
class Sensitivity:
    """Elasticities d ln(COR)/d ln(input): per cent by which COR rises for 1 % more of an input.

    Each field is a float, or an array of one shape. An input that is known to 10 % leaves the COR
    uncertain by ten times its elasticity, in per cent.

    Attributes
    ----------
    speed, radius, thickness
        Speed of the impact, radius of the sphere, thickness of the plate.
    sphere_density, plate_density
        Mass densities.
    sphere_modulus, plate_modulus
        Young's moduli, at fixed Poisson's ratios.
    yield_strength
        Of the sphere; with the law ``"fem"`` of all bodies that yield, changed together, and with
        it the hardening: the whole flow stress, also where it follows from a hardness.

    Notes
    -----
    Errors are within 1e-4 for lambda up to 1, 1e-3 up to 2, 2e-2 up to 5, from the table; with
    ``"myc"`` and ``"hertz"`` within 3e-5, 6e-4 and 5e-3. Impacts that turn nearer than 5e-4
    (relatively) to a kink of the law, where the derivatives may jump, are up to 5e-3 off. Laws
    whose loading curves have corners (``"stronge"``, ``"kogut_etsion"``, ``"jackson_green"``) are
    integrated, four times an impact: within 1e-4 for lambda up to 5. So are those whose table
    exceeds its bound for the COR (of coarse `Settings`), and the dependence on E*/sigma_Y of
    ``"jackson_green"``, which takes it from the pair; numbers that were given in the name of a law
    are held fixed. With ``"fem"``, of which all inputs change the law or the plate, everything is
    integrated, ten times an impact, within 1e-5.
    """

    speed: float | Array
    radius: float | Array
    thickness: float | Array
    sphere_density: float | Array
    plate_density: float | Array
    sphere_modulus: float | Array
    plate_modulus: float | Array
    yield_strength: float | Array


def sensitivity(tabulated: Tabulated, impacts: Impacts) -> Sensitivity:
    """Differentiate the COR of impacts inside the table, by the method that suits the law."""
    pair, law = tabulated.bodies.pair, tabulated.bodies.law
    units = tabulated.bodies.numbers(tabulated.bodies.impact(impacts))
    found, _ = Border("raise").look_up(law.data, tabulated.packed, units)
    if not law.thin_plate:
        return by_inputs(pair, law, impacts, _yields(found))
    if follows(tabulated.table):
        by_lam, by_y = by_table(tabulated.packed, found)
    else:
        by_lam, by_y = by_solver(law, found)
    by_ratio = by_modulus_ratio(pair, law, found)
    return elasticities(pair, by_lam, by_y, by_ratio, impacts.shape)


def follows(table: Table) -> bool:
    """Whether a table's derivatives are accurate.

    They are if the table's COR is as accurate as promised, and if the law's loading curve has no
    corners, next to which a spline's derivative is far worse than its value.
    """
    promised = table.certificate is not None and "restitution" not in table.exceeded
    return promised and not any(map(table.law.has_corner, table.law.loading_kinks))


def by_table(table: Array, found: Outcome) -> tuple[Array, Array]:
    """Differentiate ln e with respect to ln(lambda) and ln(y), from a packed table."""

    def outcomes(lam: Array, y: Array) -> Outcome:
        moved = outcome.at(lam, y)
        lookup.fields(table, True, moved)  # at the border by a one-sided difference
        return moved

    return _differences(outcomes, found)


def by_solver(law: Law, found: Outcome) -> tuple[Array, Array]:
    """Differentiate ln e with respect to ln(lambda) and ln(y), by integration."""

    def outcomes(lam: Array, y: Array) -> Outcome:
        return solved(law.data, lam, y, _RTOL)

    return _differences(outcomes, found)


def _differences(
    outcomes: Callable[[Array, Array], Outcome], found: Outcome
) -> tuple[Array, Array]:
    """Central differences; nearer to a kink than the step, means of those on its two sides."""
    lam, y = found.inelasticity, found.yield_ratio
    steps = (math.exp(-_STEP), math.exp(_STEP))
    low, high = (outcomes(lam * step, y) for step in steps)
    by_lam = _quotient(low, high, "inelasticity")
    low, high = (outcomes(lam, y * step) for step in steps)
    return by_lam, np.where(_yields(found), _quotient(low, high, "yield_ratio"), 0.0)


def _quotient(low: Outcome, high: Outcome, number: str) -> Array:
    """Difference of ln e over that of the logarithm of a number."""
    with np.errstate(invalid="ignore", divide="ignore"):  # ln(0/0), inf/inf
        length = np.log(getattr(high, number) / getattr(low, number))
        quotient = np.log(high.restitution / low.restitution) / length
    return np.where(np.isfinite(quotient), quotient, 0.0)


def by_modulus_ratio(pair: Pair, law: Law, found: Outcome) -> Array:
    """Differentiate ln e with respect to ln(E*/sigma_Y), if the law takes that from the pair."""
    if "modulus_ratio" not in law.from_pair:
        return np.zeros_like(found.restitution)
    ratio = pair.effective_modulus / pair.sphere.require_yield_strength(law.name)
    # parameters of a law are rounded to six digits
    low, high = (float(f"{ratio * math.exp(step):.6g}") for step in (-_STEP, _STEP))
    below, above = (
        solved(
            laws.law(law.family, **{**pair_numbers(pair, law.family), "modulus_ratio": value}).data,
            found.inelasticity,
            found.yield_ratio,
            _RTOL,
        ).restitution
        for value in (low, high)
    )
    return np.where(_yields(found), np.log(above / below) / math.log(high / low), 0.0)


def by_inputs(pair: Pair, law: Law, impacts: Impacts, yields: NDArray[np.bool_]) -> Sensitivity:
    """Differentiate ln e with respect to the inputs themselves, by integration.

    If the law takes numbers from the pair, they change with the inputs.
    """
    speed, radius, thickness = impacts.speed, impacts.radius, impacts.thickness
    bodies = pair.sphere, pair.plate

    def by(move: Callable[[float], tuple[Pair, Array, Array, Array]]) -> Array:
        ends = (move(math.exp(step)) for step in (-_STEP, _STEP))
        low, high = (_moved(one, law, *sizes) for one, *sizes in ends)
        with np.errstate(invalid="ignore", divide="ignore"):  # ln(0/0)
            quotient = np.log(high / low) / (2.0 * _STEP)
        return np.where(np.isfinite(quotient), quotient, 0.0)

    def by_number(number: str, *roles: str) -> Array:
        return by(lambda x: (_changed(pair, number, x, roles), speed, radius, thickness))

    by_speed = by(lambda x: (pair, x * speed, radius, thickness))
    by_thickness = by(lambda x: (pair, speed, radius, x * thickness))
    by_density = by_number("density", "sphere")
    by_modulus = by_number("youngs_modulus", "sphere")
    stronger = by(lambda x: (Pair(*(scaled(one, x) for one in bodies)), speed, radius, thickness))
    by_strength = np.where(yields, stronger, 0.0)
    named = {
        "speed": by_speed,
        "radius": -by_thickness,
        "thickness": by_thickness,
        "sphere_density": by_density,
        "plate_density": 0.5 * by_speed - by_density,
        "sphere_modulus": by_modulus,
        "plate_modulus": -0.5 * by_speed - by_modulus - by_strength,
        "yield_strength": by_strength,
    }
    if any(body.rate or body.loss_factor or isinstance(body.hardening, float) for body in bodies):
        # other inputs with a unit are held: rate0, the frequency at which moduli are known, or the
        # hardness from which two strengths follow
        named["radius"] = by(lambda x: (pair, speed, x * radius, thickness))
        named["plate_density"] = by_number("density", "plate")
        named["plate_modulus"] = by_number("youngs_modulus", "plate")
    return Sensitivity(**{name: shaped(values, impacts.shape) for name, values in named.items()})


def _changed(pair: Pair, number: str, factor: float, roles: tuple[str, ...]) -> Pair:
    """Multiply a number of the bodies that have it."""
    bodies = {"sphere": pair.sphere, "plate": pair.plate}
    for role in roles:
        value = getattr(bodies[role], number)
        if value is not None:
            bodies[role] = dataclasses.replace(bodies[role], **{number: factor * value})
    return Pair(**bodies)


def _moved(pair: Pair, law: Law, speed: Array, radius: Array, thickness: Array) -> Array:
    """COR of impacts of other bodies, integrated, with the law's numbers for those bodies."""
    bodies = SphereOnPlate(pair, law_for_pair(pair, law))
    units = bodies.numbers(bodies.impact(Impacts(speed, radius, thickness, None)))
    return np.asarray(within(bodies.data, units, _RTOL, None).restitution)


def _yields(found: Outcome) -> NDArray[np.bool_]:
    """Whether the elastic compression w_m is above y: elsewhere yield does not matter."""
    return np.asarray(found.elastic_compression > found.yield_ratio)


def elasticities(
    pair: Pair, by_lam: Array, by_y: Array, by_ratio: Array, shape: tuple[int, ...] | None
) -> Sensitivity:
    """Chain the derivatives of ln e with the powers of the inputs."""
    sphere = pair.effective_modulus / pair.sphere.plane_modulus
    plate = 1.0 - sphere
    powers = {
        "speed": (0.2, -0.8, 0.0),
        "radius": (2.0, 0.0, 0.0),
        "thickness": (-2.0, 0.0, 0.0),
        "sphere_density": (0.6, -0.4, 0.0),
        "plate_density": (-0.5, 0.0, 0.0),
        "sphere_modulus": (0.4 * sphere, -1.6 * sphere, sphere),
        "plate_modulus": (0.4 * plate - 0.5, -1.6 * plate, plate),
        "yield_strength": (0.0, 2.0, -1.0),
    }
    return Sensitivity(
        **{
            name: shaped(a * by_lam + b * by_y + c * by_ratio, shape)
            for name, (a, b, c) in powers.items()
        }
    )
