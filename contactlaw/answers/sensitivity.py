"""How much the COR moves with each input: elasticities d ln e/d ln x, by `derivatives`."""

import math
from dataclasses import dataclass

import numpy as np

from contactlaw._arrays import Array, ByValue, Mask
from contactlaw.answers.derivatives import STEP, Number, Variants
from contactlaw.physical.arguments import shaped
from contactlaw.physical.impacts import Impacts

_INPUTS: dict[str, tuple[Number, ...]] = {
    "speed": (("impact", "speed"),),
    "radius": (("impact", "radius"),),
    "thickness": (("impact", "thickness"),),
    "sphere_density": (("sphere", "density"),),
    "plate_density": (("plate", "density"),),
    "sphere_modulus": (("sphere", "youngs_modulus"),),
    "plate_modulus": (("plate", "youngs_modulus"),),
    "yield_strength": (("sphere", "flow_stress"), ("plate", "flow_stress")),
}
_MASS_POWERS = {"radius": 3.0, "sphere_density": 1.0}  # powers with which the mass of a bead grows


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
    An impact is integrated sixteen times. Errors are within 1e-5, and larger only for impacts that turn
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


def sensitivity(variants: Variants, impacts: Impacts, yields: Mask) -> Sensitivity:
    """Differentiate the COR of impacts, of which those where a body yields depend on its strength.

    If the law takes numbers from the pair, they change with the inputs.
    """

    def elasticity(name: str) -> Array:
        def log_cor(factor: float) -> Array:
            factors = dict.fromkeys(_INPUTS[name], factor)
            if impacts.mass is not None:
                factors["impact", "mass"] = factor ** _MASS_POWERS.get(name, 0.0)
            return np.log(variants.answers(impacts, factors).restitution)

        return np.asarray((log_cor(math.exp(STEP)) - log_cor(math.exp(-STEP))) / (2.0 * STEP))

    found = {name: elasticity(name) for name in _INPUTS}
    found["yield_strength"] *= yields
    return Sensitivity(**{name: shaped(values, impacts.shape) for name, values in found.items()})
