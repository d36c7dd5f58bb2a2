"""How much the COR moves with each input: elasticities d ln e/d ln x.

Inputs are changed one by one, and each time the impacts are integrated. No answer depends on the
units of length, time and mass, so three of the eight elasticities follow from the others:

    R = -H    E1 + E2 + sigma_Y = -V0/2    rho1 + rho2 = V0/2

but for bodies with a rate of strain, hardening or losses, whose other constants have units, too.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from contactlaw._arrays import Array, ByValue
from contactlaw.answers.tabulated import Border, TableLookup
from contactlaw.answers.varied import Number, solver, with_numbers
from contactlaw.physical.arguments import shaped
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.rate import rates
from contactlaw.physical.strengths import USUAL

# Step of central differences of ln e. They err by 2e-9 times the third derivative, which is up to
# 3e4 next to a corner, and by 2e-9 from the solver, whose errors are alike at the two ends.
_STEP = 1e-4
_RTOL = 1e-10


@dataclass(frozen=True, eq=False)
class Sensitivity(ByValue):
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
    Ten times an impact is integrated. Errors are within 1e-5, and larger only for impacts that turn
    nearer than 5e-4 (relatively) to a kink of the law, where the derivatives may jump. Numbers that
    were given in the name of a law are held fixed.
    """

    speed: float | Array
    radius: float | Array
    thickness: float | Array
    sphere_density: float | Array
    plate_density: float | Array
    sphere_modulus: float | Array
    plate_modulus: float | Array
    yield_strength: float | Array


def sensitivity(tabulated: TableLookup, impacts: Impacts) -> Sensitivity:
    """Differentiate the COR of impacts inside the table, by integration.

    If the law takes numbers from the pair, they change with the inputs.
    """
    bodies = tabulated.bodies
    pair, law = bodies.pair, bodies.law
    units = bodies.numbers(bodies.impact(impacts))
    found, _ = Border("raise").look_up(bodies.data, tabulated.packed, units)
    yields = np.asarray(found.elastic_compression > found.yield_ratio)
    materials = pair.sphere, pair.plate

    def by(*inputs: str | Number) -> Array:
        def cor(factor: float) -> Array:
            sizes = {name: getattr(impacts, name) for name in ("speed", "radius", "thickness")}
            numbers = {}
            for one in inputs:
                if isinstance(one, str):
                    sizes[one] = factor * sizes[one]
                else:
                    numbers[one] = factor * getattr(getattr(pair, one[0]), one[1], 1.0)
            other = with_numbers(materials, numbers)
            made = solver(other, law, rates(sizes["speed"], sizes["radius"]), _RTOL, USUAL)
            given = Impacts(**sizes, shape=impacts.speed.shape)
            if impacts.mass is not None:
                share = bodies.impact(impacts).mass
                given = replace(given, mass=share * made.bodies.solid_mass(given.radius))
            hit = made.rebounds(given)
            return np.asarray(hit.restitution)

        low, high = (cor(math.exp(step)) for step in (-_STEP, _STEP))
        with np.errstate(invalid="ignore", divide="ignore"):  # ln(0/0)
            quotient = np.log(high / low) / (2.0 * _STEP)
        return np.where(np.isfinite(quotient), quotient, 0.0)

    by_speed, by_thickness = by("speed"), by("thickness")
    by_density, by_modulus = by(("sphere", "density")), by(("sphere", "youngs_modulus"))
    by_strength = np.where(yields, by(("sphere", "flow_stress"), ("plate", "flow_stress")), 0.0)
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
    if any(body.rate or body.loss_factor or isinstance(body.hardening, float) for body in materials):
        # other inputs with a unit are held: rate0, the frequency at which moduli are known, or the
        # hardness from which two strengths follow
        named["radius"] = by("radius")
        named["plate_density"] = by(("plate", "density"))
        named["plate_modulus"] = by(("plate", "youngs_modulus"))
    return Sensitivity(**{name: shaped(values, impacts.shape) for name, values in named.items()})
