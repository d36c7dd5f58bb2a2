"""Fits of two unknowns to exact data: within two standard errors, or with alternatives, or refused."""

import dataclasses
import itertools

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

import contactlaw as cl
from contactlaw.fitting.measurements import NORMAL
from contactlaw.fitting.unknowns import UNKNOWNS

QUESTIONS = list(itertools.combinations([name for name in UNKNOWNS if name != "friction"], 2))
# One answer was 3130 +- 290 MPa and 0.509 +- 0.004 mm for 205 and 1.
STEEL_ON_ALUMINA = cl.Pair("stainless-steel-304", "alumina")
SPEED = np.geomspace(1.0, 12.0, 12)
UNKNOWN = "yield_strength", "thickness"


def data_of(pair, speed, radius, thickness, kinds, unknown):
    """Exact rebounds with a stated error of 1 %, without the sizes that are unknown."""
    hit = cl.ImpactModel(pair, outside="solve").solve(speed, radius, thickness, rtol=1e-10)
    sizes = {"radius": radius, "thickness": thickness}
    data = {"speed": speed} | {name: size for name, size in sizes.items() if name not in unknown}
    for kind in kinds:
        data[kind] = getattr(hit, kind)
        data[f"{kind}_error"] = 0.01 * data[kind]
    return data


def test_exact_data_of_a_soft_bead_are_not_those_of_a_hard_one_on_a_thin_plate():
    data = data_of(STEEL_ON_ALUMINA, SPEED, 1e-3, 1e-3, ("restitution",), UNKNOWN)
    found = cl.fit(STEEL_ON_ALUMINA, data, UNKNOWN)
    truth = STEEL_ON_ALUMINA.sphere.yield_strength, 1e-3
    assert [found.values[name] for name in UNKNOWN] == pytest.approx(truth, rel=1e-6)
    assert not found.alternatives


def test_a_second_regime_that_fits_as_well_is_told():
    """Within 5 %, four of these rebounds also fit a hard bead on a thin plate."""
    data = data_of(STEEL_ON_ALUMINA, SPEED[::3], 1e-3, 1e-3, ("restitution",), UNKNOWN)
    data["restitution_error"] = 0.05 * data["restitution"]
    found = cl.fit(STEEL_ON_ALUMINA, data, UNKNOWN)
    assert found.alternatives
    for regime in found.alternatives:
        assert regime["thickness"] < 0.6e-3 and regime["yield_strength"] > 1e9
        bead = dataclasses.replace(found.pair.sphere, yield_strength=regime["yield_strength"])
        there = cl.ImpactModel(cl.Pair(bead, found.pair.plate)).solve(data["speed"], 1e-3, regime["thickness"])
        assert np.sqrt(np.mean((there.restitution / data["restitution"] - 1.0) ** 2)) < 0.05
    assert any("fitted as well by yield strength of the bead" in note for note in found.notes)


def log(low, high):
    """Draw numbers that are even in their logarithm."""
    return st.floats(np.log(low), np.log(high)).map(lambda x: float(np.exp(x)))


@st.composite
def measurements(draw):
    """Draw bodies of the catalogue, speeds up to 30 m/s, and two unknowns that the bodies have."""
    unknown, bodies = draw(st.sampled_from(QUESTIONS)), []
    for prefix in ("", "plate_"):
        body = cl.material(draw(st.sampled_from(sorted(cl.materials()))))
        assume(f"{prefix}yield_strength" not in unknown or body.yield_strength is not None)
        loss = (draw(st.floats(0.02, 0.4)), 1e4)
        bodies.append(dataclasses.replace(body, loss_factor=loss) if f"{prefix}loss_factor" in unknown else body)
    pair, radius, slowest = cl.Pair(*bodies), draw(log(0.1e-3, 5e-3)), draw(log(0.05, 5.0))
    speed = np.geomspace(slowest, min(slowest * draw(st.floats(3.0, 30.0)), 30.0), draw(st.integers(6, 16)))
    kinds = draw(st.lists(st.sampled_from(list(NORMAL)), min_size=1, max_size=3, unique=True))
    thickness = radius / draw(log(0.1, 1.8))
    assume(np.min(cl.ImpactModel(pair, outside="solve").solve(speed, radius, thickness).restitution) > 0.05)
    return pair, speed, radius, thickness, kinds, unknown


@settings(max_examples=2, derandomize=True, deadline=None, suppress_health_check=list(HealthCheck))
@given(measurements())
def test_random_fits_are_within_their_errors_or_have_alternatives(measured):
    pair, _, radius, thickness, _, unknown = measured
    truth = {"radius": radius, "thickness": thickness}
    for name in {*unknown} - {*truth}:
        value = getattr(getattr(pair, UNKNOWNS[name].body), UNKNOWNS[name].field)
        truth[name] = value[0] if isinstance(value, tuple) else value  # tan delta of a loss factor
    try:
        found = cl.fit(pair, data_of(*measured), unknown)
    except cl.UnidentifiedError:
        return
    off = [abs(found.values[name] - truth[name]) / found.errors[name] for name in unknown]
    assert found.alternatives or max(off) <= 2.0
