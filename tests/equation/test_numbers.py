"""The dimensionless numbers of an impact are the same wherever they are asked for."""

import math

import numpy as np
import polymer
import pytest

import contactlaw as cl
from contactlaw.equation.corrections import CONTACT_TIME, SATURATION, eta_of, with_corrections
from contactlaw.equation.numbers import Impact
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.scaling import plate_mobility
from contactlaw.softsphere import resized, unit_spring
from contactlaw.stepping.spring import impact

STEEL = cl.Pair("stainless-steel-304", "stainless-steel-304")
PAIRS = [
    cl.Pair("gamma-alumina", "glass"),
    STEEL,
    cl.Pair("glass", "carbon-steel-1020"),
    cl.Pair("aluminium-6061-t6", "pmma"),
    *polymer.PAIRS[:2],
]


def shear_modulus(body):
    return 0.5 * body.youngs_modulus / (1.0 + body.poissons_ratio)


@pytest.mark.parametrize("law", ["fem", "myc"])
@pytest.mark.parametrize("pair", PAIRS[:2], ids=repr)
def test_they_are_those_of_the_paper_with_the_next_orders(pair, law):
    """Each number follows from SI quantities by its formula; `numbers` scales with speed."""
    model = cl.ImpactModel(pair, law)
    bodies = SphereOnPlate(pair, model.force_law)
    plate, share = bodies.constants.plate, bodies.constants.yield_compression
    for v, r, h in ((1e-3, 1e-5, 1e-4), (2.0, 1e-3, 1e-3), (80.0, 5e-3, 4e-3), (300.0, 1.0, 9.0)):
        time = r * (math.pi * pair.sphere.density / pair.effective_modulus / math.sqrt(v)) ** 0.4
        mass = 4 / 3 * math.pi * pair.sphere.density * r**3
        transit = h * math.sqrt(pair.plate.density / shear_modulus(pair.plate)) / CONTACT_TIME
        lam, more = float(plate_mobility(pair.plate, h)) * mass / time, 1.0
        if law == "fem":
            x = math.sqrt(v * time / r)
            least = min(x, SATURATION * math.sqrt(share))
            more = math.exp(eta_of(plate.corrections, r / h, least, lam, transit / time))
            time /= more
            thin, echo = lam * more, transit / time
            lam = with_corrections(plate.corrections, thin, echo, thin * echo**2, r / h * (x - least))
        units = bodies.numbers(Impact(v, r, h))
        ours = units.inelasticity, units.time, units.compression, units.force, units.stiffer
        assert ours == pytest.approx((lam, time, v * time, mass * v / time, more), rel=1e-13)
        assert law == "myc" or more > 1.0


@pytest.mark.parametrize(
    ("pair", "law"), [*((pair, "fem") for pair in PAIRS), (STEEL, "myc"), (PAIRS[0], "hertz")], ids=repr
)
def test_they_are_the_same_in_a_time_step(pair, law):
    """Those of tables and of the solver are compared in tests/answers/test_kinds.py."""
    model, ends = cl.ImpactModel(pair, law), np.log([(1e-4, 1e-6, 1e-2), (100.0, 0.1, 4.0)])
    v, r, slenderness = np.exp(np.random.default_rng(1).uniform(*ends, (600, 3))).T
    h = np.where(slenderness < 0.02, math.inf, r / slenderness)
    units = SphereOnPlate(pair, model.force_law).numbers(Impact(v, r, h))
    for n in range(v.size):
        one = impact(model.force_law.data, resized(unit_spring(model, h[n]), r[n]), v[n])
        theirs = units.inelasticity[n], units.time[n], units.compression[n]
        assert (one.inelasticity, one.time, one.compression) == pytest.approx(theirs, rel=1e-14)
