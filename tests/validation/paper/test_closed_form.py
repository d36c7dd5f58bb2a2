"""Closed forms against the solver, limits and each other."""

import dataclasses
import math

import numpy as np
import pytest
from oracle import yield_ratio
from scipy.integrate import quad

import contactlaw as cl
from contactlaw import laws
from contactlaw.equation import zener
from contactlaw.equation.numbers import Impact
from contactlaw.physical.bodies import SphereOnPlate
from validation.paper import closed_form, turning_point

SPEEDS = np.concatenate([np.linspace(0.03, 2.0, 24), np.linspace(2.2, 20.0, 72)])
INELASTICITIES = np.linspace(0.0, 0.5, 31)

# each form of the COR, with its arguments but the first, whose largest value stands beside them
COR = {
    closed_form.mueller: ((), 2.0),
    closed_form.raman: ((), 2.0 / turning_point.WAVE_SLOPE),
    closed_form.zener: ((), 100.0),
    closed_form.thornton: ((), 1e6),
    closed_form.thornton_asymptote: ((), 1e6),
    closed_form.half_space: ((), 1e6),
    closed_form.eq_21: ((), 1e6),
    closed_form.peng: ((1.0, 0.1), 20.0),
    closed_form.eq_22: ((1.0, 0.1), 20.0),
    turning_point.restitution: ((0.2,), 20.0),
}


def solved(v, lam_y, law="myc"):
    one = zener.solve(laws.law(law).data, lam_y * v**0.2, yield_ratio(v), 1e-11)
    return one.restitution


@pytest.fixture(scope="module")
def surface():
    """COR of the solver over (lambda_Y, v)."""
    return np.array([[solved(v, lam_y) for v in SPEEDS] for lam_y in INELASTICITIES])


def test_wave_slope_is_the_integral_over_a_lossless_contact():
    # w = w_m (1 - x^2): no root of the speed at the turning point
    w_m = 1.25**0.4

    def rate(x):
        w = w_m * (1 - x * x)
        return 4 * w_m * x * w**3 / math.sqrt(1 - (w / w_m) ** 2.5)

    assert quad(rate, 1e-12, 1)[0] == pytest.approx(turning_point.WAVE_SLOPE, rel=1e-9)
    assert pytest.approx(1.7302, abs=5e-5) == turning_point.WAVE_SLOPE


@pytest.mark.parametrize("form", [closed_form.raman, closed_form.zener])
def test_slopes_at_no_inelasticity(form):
    near, far = (1 - form(h) for h in (1e-3, 2e-3))
    assert (4 * near - far) / 2e-3 == pytest.approx(turning_point.WAVE_SLOPE, rel=1e-4)


def test_eta_is_the_inelasticity_at_yield(pair):
    impact = Impact(2.5 * pair.yield_speed, 0.9e-3, 0.5e-3)
    lam = SphereOnPlate(pair, laws.law("myc")).numbers(impact).inelasticity.item()
    assert closed_form.eta(pair) * 1.8**2 * 2.5**0.2 == pytest.approx(lam, rel=1e-12)
    assert closed_form.eta(pair) == pytest.approx(0.0751, abs=5e-5)


@pytest.mark.parametrize("v", [0.5, 1.0, 3.0, 6.0, 50.0])
def test_half_space_is_exact(v):
    assert closed_form.half_space(v) == pytest.approx(solved(v, 0.0), abs=1e-9)


@pytest.mark.parametrize("v", [0.5, 1.5, 8.0, 60.0])
def test_thornton_is_exact(v):
    assert closed_form.thornton(v) == pytest.approx(solved(v, 0.0, "thornton"), abs=1e-9)


def test_thornton_asymptote():
    assert closed_form.thornton_asymptote(1e5) == pytest.approx(closed_form.thornton(1e5), rel=1e-5)
    v = np.array([5.0, 10.0, 100.0])
    high = closed_form.thornton_asymptote(v) / closed_form.thornton(v) - 1
    assert high == pytest.approx([0.025, 0.012, 0.0012], rel=0.05)


def largest_error(form, surface, lam_y, v):
    """Largest error over the part of the surface up to (lam_y, v)."""
    rows, columns = lam_y + 1e-9 >= INELASTICITIES, v >= SPEEDS
    part = np.ix_(rows, columns)
    return np.abs(form(SPEEDS[columns], INELASTICITIES[rows, None]) / surface[part] - 1).max()


@pytest.mark.parametrize(
    ("lam_y", "v", "stated"),
    [
        (0.3, 10.0, 5e-4),
        (0.4, 10.0, 5e-4),
        (0.5, 10.0, 31e-4),
        (0.3, 20.0, 13e-4),
        (0.4, 20.0, 50e-4),
        (0.5, 20.0, 160e-4),
    ],
)
def test_the_turning_point_form_errs_by_what_it_states(surface, lam_y, v, stated):
    error = largest_error(turning_point.restitution, surface, lam_y, v)
    assert 0.8 * stated < error < stated


def test_the_two_fits_of_the_turning_point_form():
    lam = np.linspace(0.01, 0.6, 30)
    share = closed_form.elastic_compression(lam) / 1.25**0.4
    assert turning_point.loading(lam) == pytest.approx(share, rel=7e-5)
    x = lam * share**0.25
    released = closed_form.zener(lam) / share**1.25
    assert turning_point._release(x) == pytest.approx(released, rel=9e-4)
    far = np.linspace(0.01, 2.0, 30)
    share = closed_form.elastic_compression(far) / 1.25**0.4
    assert turning_point.loading(far) == pytest.approx(share, rel=4e-3)


def test_the_turning_point_form_is_exact_on_the_half_space():
    v = np.geomspace(0.1, 20.0, 50)
    assert turning_point.restitution(v, 0.0) == pytest.approx(closed_form.half_space(v), abs=1e-14)


def test_the_turning_point_form_is_continuous():
    v = np.linspace(0.5, 10.0, 400_001)
    e = turning_point.restitution(v, 0.2)
    assert np.abs(np.diff(e)).max() < 1e-5  # slope 0.2 times a step of 2.4e-5


@pytest.mark.parametrize("form", COR, ids=lambda form: form.__name__)
def test_a_cor_lies_between_0_and_1_up_to_the_limits(form):
    others, largest = COR[form]
    low = 5.0 if form is closed_form.thornton_asymptote else 0.0
    e = form(np.concatenate([[low], np.geomspace(max(low, 1e-300), largest, 60)[:-1], [largest]]), *others)
    assert ((0.0 <= e) & (e <= 1.0)).all()  # NaN is in no range
    assert low > 0.0 or e[0] == pytest.approx(1.0, abs=1e-11)


def test_a_pair_without_yield_strength_has_no_eta():
    with pytest.raises(ValueError, match="yield"):
        closed_form.eta(cl.Pair("glass", "glass"))
    with pytest.raises(ValueError, match="yield"):
        closed_form.eta(cl.Pair("glass", "aluminium-6061-t6"))  # it is the sphere that yields


def test_eta_does_not_know_that_the_plate_yields():
    weak = cl.material("aluminium-6061-t6")
    elastic = dataclasses.replace(weak, yield_strength=None)
    ours = closed_form.eta(cl.Pair("bearing-steel-52100", weak))
    assert ours == closed_form.eta(cl.Pair("bearing-steel-52100", elastic))
