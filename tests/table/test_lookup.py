"""The arithmetic below the lookup; what it looks up is tested in test_table."""

import math

import numpy as np

from contactlaw._jit import kernel
from contactlaw.table import lookup


def compiled(inner):
    """Compile a caller for an inlined kernel, which Python would otherwise interpret."""

    @kernel(entry=True)
    def outer(*arguments):
        return inner(*arguments)

    return outer


log, fifth_root, exp = compiled(lookup.log), compiled(lookup.fifth_root), compiled(lookup.exp)


def test_logarithm_and_fifth_root():
    # dense enough to meet every mantissa's neighbourhood
    v = np.geomspace(lookup.V_MIN, lookup.V_MAX, 20_011)
    np.testing.assert_allclose([log(one) for one in v], np.log(v), rtol=1e-14, atol=2e-13)
    np.testing.assert_allclose([fifth_root(one) for one in v], v**0.2, rtol=1e-11)


def test_logarithm_and_root_do_not_crash_on_what_is_no_speed():
    for v in (0.0, -1.0, math.inf, -math.inf, math.nan, 5e-324, 1e308):
        log(v)
        fifth_root(v)  # garbage


def test_exponential():
    x = np.append(np.linspace(-40.0, 40.0, 10_001), [0.0, 1e-300, -600.0, 600.0])
    exact = [math.exp(one) for one in x]
    np.testing.assert_allclose([exp(one) for one in x], exact, rtol=1e-13)
