"""What table and solver say of every law: where flow begins, and what a sphere loses."""

import math

import numpy as np
import polymer
import pytest

import contactlaw as cl
from contactlaw import laws

R = 0.9e-3
PAIRS = {
    "the bead yields": ("gamma-alumina", "glass"),
    "the plate yields": ("bearing-steel-52100", "aluminium-6061-t6"),
    "both yield": ("carbon-steel-1020", "carbon-steel-1020"),
}


@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize("law", laws.names())
def test_at_the_yield_speed_flow_begins(law, pair):
    """From a half-space to plates of two thirds of the radius."""
    thickness = R / np.array([1e-12, 0.01, 0.5, 1.0, 1.5])
    model = cl.ImpactModel(cl.Pair(*PAIRS[pair]), law)
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
    if law in ("myc", "thornton") and pair == "the bead yields":
        below, above = (model.solve(speed * factor, R, thickness) for factor in (1 - 1e-4, 1 + 1e-4))
        assert (below.plastic_fraction == 0.0).all() and (above.plastic_fraction > 0.0).all()


@pytest.mark.parametrize("law", laws.names())
def test_what_the_sphere_loses_is_the_sum_over_the_channels(law):
    channels = [name for name in cl.Rebound.__dataclass_fields__ if name.endswith("_fraction")]
    assert channels == ["plastic_fraction", "wave_fraction", "other_fraction"]
    at = np.geomspace(0.01, 15.0, 40), R, R / 0.7
    for pair in (*(cl.Pair(*names) for names in PAIRS.values()), *(polymer.PAIRS[:2] if law == "fem" else ())):
        model = cl.ImpactModel(pair, law, outside="solve")
        for hit, bound in ((model.lookup(*at), 1e-5), (model.solve(*at, rtol=1e-10), 1e-9)):
            fractions = np.array([getattr(hit, name) for name in channels])
            assert 1.0 - hit.restitution**2 == pytest.approx(fractions.sum(axis=0), abs=bound)
            assert (fractions >= 0.0).all()
