"""The arithmetic below the lookup; what it looks up is tested in test_table."""

import math

import numpy as np
import pytest

from contactlaw._jit import kernel
from contactlaw.table import lookup


def compiled(inner):
    """Compile a caller for an inlined kernel, which Python would otherwise interpret."""

    @kernel(entry=True)
    def outer(*arguments):
        return inner(*arguments)

    return outer


log_and_root, exp, evaluate, weights = map(
    compiled, (lookup.log_and_root, lookup.exp, lookup.evaluate, lookup.weights)
)


def test_logarithm_and_fifth_root():
    # dense enough to meet every mantissa's neighbourhood; the series end at 1e-13 and 5e-12
    v = np.geomspace(lookup.V_MIN, lookup.V_MAX, 20_011)
    log, root = np.array([log_and_root(one) for one in v]).T
    np.testing.assert_allclose(log, np.log(v), rtol=1e-14, atol=2e-13)
    np.testing.assert_allclose(root, v**0.2, rtol=1e-11)


def test_logarithm_and_root_do_not_crash_on_what_is_no_speed():
    for v in (0.0, -1.0, math.inf, -math.inf, math.nan, 5e-324, 1e308):
        log_and_root(v)  # garbage, but an index within the table of roots


def test_power_series_is_horners():
    c = tuple(np.random.default_rng(0).normal(size=21))
    for t in (-1.0, -0.3, 0.0, 0.7, 1.0):
        assert evaluate(c, t) == pytest.approx(np.polyval(c[::-1], t), rel=1e-13)


def test_weights_are_the_b_splines():
    from scipy.interpolate import BSpline

    for t in (0.0, 0.25, 0.9, 1.0):
        # the uniform cubic B-spline on [0, 4]; each weight is one of its four pieces
        spline = BSpline.basis_element(np.arange(5.0), extrapolate=False)
        expected = [float(spline(3.0 - k + t)) if 3.0 - k + t < 4.0 else 0.0 for k in range(4)]
        assert np.array(weights(t)) / 6 == pytest.approx(expected, abs=1e-15)


def test_exponential():
    x = np.append(np.linspace(-40.0, 40.0, 10_001), [0.0, 1e-300, -600.0, 600.0])
    exact = [math.exp(one) for one in x]
    np.testing.assert_allclose([exp(one) for one in x], exact, rtol=1e-15)
