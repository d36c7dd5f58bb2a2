"""Impacts of metals that harden and are stronger at rate: those of the fit, and those kept out.

The impacts of the fit have random constants of the flow stress; those kept out are of metals whose
constants Johnson and Cook published (Proc. 7th Int. Symp. Ballistics, 1983, table 1).
"""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw.laws import fem
from contactlaw.physical import rate as rates
from validation.fem import fit, journal, store
from validation.fem.cases import Case
from validation.fem.impact import TYPICAL

Array = NDArray[np.float64]

# The first impacts kept out showed that bodies of like strength, which share the flow, harden less
# than those that flow alone; "metals_alike" are for the fit of how much, and the last set was drawn
# then, to judge it.
SEEDS = {"metals": 20261128, "metals_alike": 20261130, "metals_kept_out": 20261129, "metals_kept_out_2": 20261201}
FITTED = {"metals": 56, "metals_alike": 14}
FIT = (*FITTED, "bodies")  # the sets of the fit, see `validation.fem.bodies`
# The catalogue's metal of like modulus and density, and A [Pa], B [Pa], n, C, rate0 [1/s].
PUBLISHED = {
    "OFHC copper": "copper-c11000, flow 90e6 292e6 0.31 0.025 1",
    "cartridge brass": "brass-c26000, flow 112e6 505e6 0.42 0.009 1",
    "Armco iron": "carbon-steel-1020, flow 175e6 380e6 0.32 0.060 1",
    "Carpenter electrical iron": "carbon-steel-1020, flow 290e6 339e6 0.40 0.055 1",
    "1006 steel": "carbon-steel-1020, flow 350e6 275e6 0.36 0.022 1",
    "2024-T351 aluminium": "aluminium-2024-t3, flow 265e6 426e6 0.34 0.015 1",
    "7039 aluminium": "aluminium-2024-t3, flow 337e6 343e6 0.41 0.010 1",
    "4340 steel": "carbon-steel-1020, flow 792e6 510e6 0.26 0.014 1",
}
_RIGID = ("glass", "alumina", "tungsten-carbide")  # bodies that do not yield
_BASES = ("carbon-steel-1020", "copper-c11000", "aluminium-6061-t6", "titanium-ti-6al-4v")
_RADII = (0.3e-3, 3e-3)  # [m], drawn by its logarithm, as all below
_SPEEDS = (0.3, 30.0), (0.5, 15.0)  # [m/s], of the fit and kept out
_SLENDERNESS = (0.1, 1.4)  # R/H
_RATIOS = (30.0, 1500.0)  # E*/A
_DEEPEST = 0.35  # radius of the contact over that of the sphere, by a rough estimate
_STEP = 0.05  # relative, of the differences of a fit
_SHALLOWEST = 3.0  # speed over the yield speed


def draw(name: str) -> list[Case]:
    """List the impacts of one of `SEEDS`."""
    generator = np.random.default_rng(SEEDS[name])
    if name in FITTED:
        listed: list[Case] = []
        while len(listed) < FITTED[name]:
            with_rate, alike = len(listed) % 2 == 1, name == "metals_alike"
            case = _of_fit(generator, with_rate=with_rate, alike=alike)
            if fits(case):
                listed.append(case)
        return listed
    return [_published(generator) for _ in range(40)]


def log_uniform(generator: np.random.Generator, limits: tuple[float, float]) -> float:
    """Draw a number evenly in its logarithm, and round it to four digits."""
    return float(f"{np.exp(generator.uniform(*np.log(limits))):.4g}")


def sizes(
    generator: np.random.Generator, speeds: tuple[float, float], slenderness: tuple[float, float] = _SLENDERNESS
) -> tuple[float, float, float]:
    """Speed, thickness and radius, in the order of `Case`."""
    speed, radius = log_uniform(generator, speeds), log_uniform(generator, _RADII)
    thickness = float(f"{radius / log_uniform(generator, slenderness):.4g}")
    return speed, thickness, radius


def _of_fit(generator: np.random.Generator, *, with_rate: bool, alike: bool) -> Case:
    """Random constants of sphere, plate or both; the other body is elastic."""
    bodies = [str(generator.choice(_BASES)), str(generator.choice(_BASES))]
    modulus = cl.Pair(*bodies).effective_modulus
    kinds = ((True, False), (False, True), (True, True))
    yields, plate_yields = kinds[2 if alike else generator.integers(3)]
    strength = modulus / log_uniform(generator, _RATIOS)
    hardening = generator.uniform(0.0, 4.0)
    exponent = generator.uniform(0.2, 0.7)
    rate = generator.uniform(0.01, 0.08) if with_rate else 0.0
    for n, flows in enumerate((yields, plate_yields)):
        # where both flow, the other one is stronger by up to 2, or by 0.8 to 1.25 if alike
        own = strength
        if n and yields:
            own *= generator.uniform(0.8, 1.25) if alike else generator.uniform(1.0, 2.0)
        flow = f"{own:.4g} {hardening * own:.4g} {exponent:.3f} {rate:.3f} 1"
        if flows:
            bodies[n] += f", flow {flow}"
    sphere, plate = bodies
    return Case(*sizes(generator, _SPEEDS[0]), sphere, plate, yields=yields, plate_yields=plate_yields, meshes=1)


def ideal(case: Case) -> cl.Pair:
    """Pair whose sphere has the lowest flow stress of the bodies that flow, as a constant."""
    pair = case.pair
    flows = [
        body.flow.stress(*TYPICAL)
        for body, may in ((pair.sphere, case.yields), (pair.plate, case.plate_yields))
        if may and body.flow is not None
    ]
    sphere = dataclasses.replace(pair.sphere, yield_strength=min(flows), hardening=None, rate=None)
    return cl.Pair(sphere, pair.plate)


def fits(case: Case) -> bool:
    """Whether a body flows, and no deeper than elements bear, by a half-space of its strength."""
    pair = ideal(case)
    strength = pair.sphere.require_yield_strength("fem")
    # the kinetic energy is spent at a pressure of three strengths: m V^2/2 = 3 sigma pi a^4/(4 R)
    width = (8.0 / 9.0 * pair.sphere.density * case.speed**2 / strength) ** 0.25
    return width < _DEEPEST and case.speed > _SHALLOWEST * pair.yield_speed


def _published(generator: np.random.Generator) -> Case:
    """Bead and plate of published metals, or one of them of a body that does not yield."""
    known = list(PUBLISHED.values())
    sphere, plate = (known[generator.integers(len(known))] for _ in range(2))
    which = generator.integers(4)  # twice as often as plate alone, the sphere alone or both
    if which < 2:
        plate = str(generator.choice(_RIGID))
    elif which == 2:
        sphere = str(generator.choice(_RIGID))
    return Case(
        *sizes(generator, _SPEEDS[1]), sphere, plate, yields=", flow " in sphere, plate_yields=", flow " in plate
    )


class Constants(NamedTuple):
    """Constants that are fitted to the impacts of `FIT`."""

    strain: float  # representative strain over sqrt(d/R) ...
    both: float  # ... less by this share where both bodies flow alike, ...
    by_exponent: float  # ... larger with the exponent n, by this slope of the logarithm, ...
    by_ratio: float  # ... and with this power of E*/sigma
    rate: float  # representative rate over (V0/R)(V_Y/V0)^0.3


def shipped() -> Constants:
    """Constants of the law."""
    strain, _, both, by_exponent, by_ratio = fem.fitted()["strain"]
    return Constants(strain, both, by_exponent, by_ratio, fem.fitted()["rate"])


def at_rate(pair: cl.Pair, case: Case, share: float = rates.SHARE) -> cl.Pair:
    """Pair without rate, as strong as an impact makes it, with another representative rate."""
    if rates.leading(pair) is None:
        return pair
    size = np.array(case.radius * rates.SHARE / share)  # rates go with share/radius
    return rates.strengthened(pair, rates.factors(pair, np.array(case.speed), size).item())


def errors(name: str, constants: Constants) -> Array:
    """Errors in COR of the law with other constants; below 0.3 over 0.3, 0 where it is flagged.

    Spheres much stiffer than the plate count: their flag was set after the fit.
    """
    data = store.read(name).data
    keys = [field.name for field in dataclasses.fields(Case) if field.name in data]
    late = fem.fitted()["strain"][1]
    found = {**fem.fitted(), "strain": [constants.strain, late, *constants[1:-1]]}
    off = np.zeros(data["speed"].size)
    for n, row in enumerate(zip(*(data[key].tolist() for key in keys), strict=True)):
        case = Case(**dict(zip(keys, row, strict=True)))
        pair = at_rate(fit.pair_of(dataclasses.asdict(case)), case, constants.rate)
        law = fem.law_of(fit.numbers_of(pair), found)
        hit = cl.ImpactModel(pair, law).solve(case.speed, case.radius, case.thickness)
        measured = float(data["restitution"][n])
        if not hit.flags & cl.Validity.ACCURACY & ~cl.Validity.UNTRIED_STRENGTH:
            off[n] = (float(hit.restitution) - measured) / max(measured, 0.3)
    return off


def step(constants: Constants) -> Constants:
    """Step of the fit from some constants, by Gauss and Newton; zeros at the optimum."""
    here = np.concatenate([errors(name, constants) for name in FIT])
    slopes = []
    for n, value in enumerate(constants):
        moved = constants._replace(**{Constants._fields[n]: (1.0 + _STEP) * value})
        there = np.concatenate([errors(name, moved) for name in FIT])
        slopes.append((there - here) / (_STEP * value))
    return Constants(*np.linalg.lstsq(np.stack(slopes, axis=1), -here, rcond=None)[0].tolist())


def compute(name: str, processes: int) -> None:
    """Compute the impacts of one of `SEEDS`."""
    listed = draw(name)
    about = f"{len(listed)} impacts of metals with hardening and rate, seed {SEEDS[name]}"
    journal.impacts(name, about, listed, processes)
