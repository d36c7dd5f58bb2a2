"""Every registered law, by being registered."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from contactlaw import laws

ALL = laws.names()
DEEPEST = 60.0  # the packaged table ends at chi = 40


def compressions(law):
    """Largest compressions around and between the law's kinks."""
    near = [kink * (1 + step) for kink in law.kinks for step in (-1e-3, 0.0, 1e-3)]
    return [0.3, 0.9, *near, 1.7, 5.0, DEEPEST]


def unloading(law, q, dm):
    """Force on the unloading curve from dm."""
    return law.unloading(q, *law.unloading_curve(dm))


@pytest.fixture(params=ALL)
def law(request):
    return laws.law(request.param)


def test_is_hertz_below_yield(law):
    q = np.linspace(0.0, 1.0, 11)
    assert [law.loading(x) for x in q] == pytest.approx(q**3, rel=1e-15)
    assert [unloading(law, x, 0.999) for x in q[:-1]] == pytest.approx(q[:-1] ** 3, rel=1e-14)
    assert law.residual(0.999) == 0.0
    assert law.dissipation(0.999) == 0.0


def test_first_kink_is_yield(law):
    assert law.kinks == () or law.kinks[0] == 1.0
    assert (law.yield_coefficient is None) == (law.kinks == ())


def test_loading_is_continuous_and_rises(law):
    d = np.linspace(1e-6, DEEPEST, 200_001)
    force = np.array([law.loading(math.sqrt(x)) for x in d])
    steps = np.diff(force)
    assert (steps > 0).all()
    # Hertz's slope at the same compression bounds every softer loading curve: no jump hides
    assert (steps <= 1.5 * np.sqrt(d[1:]) * np.diff(d) * (1 + 1e-6)).all()


def test_unloading_starts_on_the_loading_curve_and_ends_at_the_residual(law):
    for dm in compressions(law):
        residual = law.residual(dm)
        assert 0.0 <= residual < dm
        start = unloading(law, math.sqrt(dm - residual), dm)
        assert start == pytest.approx(law.loading(math.sqrt(dm)), rel=1e-13)
        assert unloading(law, 0.0, dm) == 0.0


def test_unloading_lies_below_loading(law):
    for dm in compressions(law):
        residual = law.residual(dm)
        for d in np.linspace(residual, dm, 50):
            down = unloading(law, math.sqrt(max(0.0, d - residual)), dm)
            assert down <= law.loading(math.sqrt(d)) * (1 + 1e-12)


def test_dissipation_is_the_area_between_the_curves(law):
    for dm in compressions(law):
        residual = law.residual(dm)
        inner = [k for k in law.loading_kinks if k < dm]
        up = quad(lambda d: law.loading(math.sqrt(d)), 0, dm, points=inner or None)[0]
        down = quad(
            lambda d, r=residual, m=dm: unloading(law, math.sqrt(max(d - r, 0.0)), m), residual, dm
        )[0]
        # quad is good to about 1e-9 of the areas themselves
        assert law.dissipation(dm) == pytest.approx(up - down, abs=1e-8 * up)
        assert law.dissipation(dm) >= 0.0


def test_dissipation_keeps_its_digits_just_above_yield():
    # leading term of 0.4 dm^1.5 dr with dr = (dm - 1)^2/2; a difference of areas would be noise
    step = 1e-7
    assert laws.law("myc").dissipation(1 + step) == pytest.approx(0.2 * step**2, rel=1e-6)


def test_myc_is_as_printed():
    """Eqs. 16-18 of the paper in physical symbols, with d_Y = 1."""
    myc, p = laws.law("myc"), 2.14 / 0.68
    d = 7.0
    assert myc.loading(math.sqrt(d)) == pytest.approx(p**1.5 + 1.5 * math.sqrt(p) * (d - p))
    assert myc.residual(d) == pytest.approx(d - math.sqrt(2 * d - 1))
    x = (5.0 - myc.residual(d)) / (d - myc.residual(d))
    at_five = unloading(myc, math.sqrt(5.0 - myc.residual(d)), d)
    assert at_five == pytest.approx(myc.loading(math.sqrt(d)) * x**1.5)


def test_unknown_law_lists_the_known():
    with pytest.raises(ValueError, match=r"law: unknown law 'hertzz'.*'hertz'.*hertz, myc"):
        laws.law("hertzz")
