"""Where flow begins, by the solver, for every law."""

import math

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import laws

R = 0.9e-3


@pytest.mark.parametrize(
    "names",
    [
        ("gamma-alumina", "glass"),  # the bead yields
        ("bearing-steel-52100", "aluminium-6061-t6"),  # the plate yields
        ("carbon-steel-1020", "carbon-steel-1020"),  # both yield
    ],
    ids="-".join,
)
@pytest.mark.parametrize("law", laws.names())
def test_at_the_yield_speed_flow_begins(law, names):
    """From a half-space to plates of two thirds of the radius."""
    thickness = R / np.array([1e-12, 0.01, 0.5, 1.0, 1.5])
    model = cl.ImpactModel(cl.Pair(*names), law)
    speed = model.yield_speed(R, thickness)
    hit = model.solve(speed, R, thickness)
    if law == "fem":
        assert hit.overload == pytest.approx(1.0, rel=1e-6)
    else:
        strengths = [body.yield_strength for body in (model.pair.sphere, model.pair.plate)]
        strain = math.pi * min(filter(None, strengths)) / model.pair.effective_modulus
        least = (model.force_law.yield_coefficient or 0.68) * strain**2 * R
        assert hit.peak_compression == pytest.approx(least, rel=1e-8)
    # The bead yields where some compression is left after the rebound: another way to find it.
    if law in ("myc", "thornton") and "glass" in names:
        below, above = (model.solve(speed * factor, R, thickness) for factor in (1 - 1e-4, 1 + 1e-4))
        assert (below.plastic_fraction == 0.0).all() and (above.plastic_fraction > 0.0).all()
