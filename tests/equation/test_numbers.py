"""The dimensionless numbers of an impact are the same wherever they are asked for.

What they are is held by finite elements in tests/fitting, and by other integrators in tests/physical.
"""

import math

import numpy as np
import polymer
import pytest

import contactlaw as cl
from contactlaw.equation.numbers import Impact
from contactlaw.physical.bodies import SphereOnPlate
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


@pytest.mark.parametrize(
    ("pair", "law"), [*((pair, "fem") for pair in PAIRS), (STEEL, "myc"), (PAIRS[0], "hertz")], ids=repr
)
def test_those_of_a_time_step_are_the_same(pair, law):
    """Those of tables and of the solver are compared in tests/answers/test_kinds.py."""
    model, ends = cl.ImpactModel(pair, law), np.log([(1e-4, 1e-6, 1e-2), (100.0, 0.1, 4.0)])
    v, r, slenderness = np.exp(np.random.default_rng(1).uniform(*ends, (600, 3))).T
    h = np.where(slenderness < 0.02, math.inf, r / slenderness)
    units = SphereOnPlate(pair, model.force_law).numbers(Impact(v, r, h))
    for n in range(v.size):
        one = impact(model.force_law.data, resized(unit_spring(model, h[n]), r[n]), v[n])
        theirs = units.inelasticity[n], units.time[n], units.compression[n]
        assert (one.inelasticity, one.time, one.compression) == pytest.approx(theirs, rel=1e-14)
