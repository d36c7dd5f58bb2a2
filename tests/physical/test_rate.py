"""The strength of a pair at the rate of an impact."""

import dataclasses
import math

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.physical import rate
from contactlaw.physical.law import law_of

IRON = cl.Material("iron", 207e9, 0.3, 7850, yield_strength=175e6, hardening=(380e6, 0.32), rate=(0.06, 1.0))
ALLOY = cl.Material("alloy", 72e9, 0.33, 2770, yield_strength=265e6, rate=(0.015, 10.0))
GLASS = cl.Material("glass", 73e9, 0.21, 2500)


def flow_of(pair):
    return rate.flow_with_rate(pair, law_of(pair, "fem"))


@pytest.mark.parametrize(("slope", "rate0"), [(0.06, 1.0), (0.06, 1e3), (1e-9, 1e9), (0.3, 1e-3)])
def test_each_body_has_its_own_strength_at_the_rate_of_the_impact(slope, rate0):
    """Below rate0 of the weaker body, or above it alone, the other one had a strength too high."""
    pair = cl.Pair(ALLOY, dataclasses.replace(IRON, rate=(slope, rate0)))
    speed, radius = np.array([2.0]), np.array([1e-3])
    at = rate.SHARE * 2000.0 * (pair.yield_speed / 2.0) ** 0.3  # representative rate [1/s]
    factor = 1.0 + slope * math.log(max(at / rate0, 1.0))
    stronger = rate.strengthened(pair, rate.factors(pair, speed, radius).item())
    assert stronger.plate.yield_strength == pytest.approx(175e6 * factor)
    assert stronger.plate.hardening == pytest.approx((380e6 * factor, 0.32))
    assert stronger.sphere.yield_strength == pytest.approx(265e6 * (1.0 + 0.015 * math.log(at / 10.0)))
    assert stronger.sphere.rate is None and flow_of(stronger) is None
