"""Closed forms against the solver, limits and each other."""

import math

import numpy as np
import pytest
from oracle import yield_ratio
from scipy.integrate import quad

import contactlaw as cl
from contactlaw import closed_form, laws, turning_point, zener
from contactlaw.impact import scales, sphere_on_plate

SPEEDS = np.linspace(0.05, 10.0, 41)
INELASTICITIES = np.linspace(0.0, 0.3, 13)


def solved(v, lam_y, law="myc"):
    one = zener.solve(laws.law(law).functions, lam_y * v**0.2, yield_ratio(v), 1e-11)
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

    assert quad(rate, 1e-12, 1)[0] == pytest.approx(closed_form.WAVE_SLOPE, rel=1e-9)
    assert pytest.approx(1.7302, abs=5e-5) == closed_form.WAVE_SLOPE


@pytest.mark.parametrize("form", [closed_form.raman, closed_form.zener])
def test_slopes_at_no_inelasticity(form):
    near, far = (1 - form(h) for h in (1e-3, 2e-3))
    assert (4 * near - far) / 2e-3 == pytest.approx(closed_form.WAVE_SLOPE, rel=1e-4)


def test_mueller_slope_is_another():
    assert (1 - closed_form.mueller(1e-6)) / 1e-6 == pytest.approx(math.pi / 2, rel=1e-5)


@pytest.mark.parametrize(
    ("lam", "printed", "ode"), [(0.1, 0.8545, 0.8433), (0.5, 0.444, 0.437), (1.0, 0.163, 0.184)]
)
def test_elastic_forms(lam, printed, ode):
    assert closed_form.mueller(lam) == pytest.approx(printed, abs=5e-4)
    assert closed_form.zener(lam) == pytest.approx(ode, abs=5e-4)


def test_eta_is_the_inelasticity_at_yield(pair):
    v = np.array([2.5 * pair.yield_speed])
    contact = sphere_on_plate(pair, laws.law("myc"), np.array([0.9e-3]), np.array([0.5e-3]))
    lam = scales(contact, v).inelasticity.item()
    assert closed_form.eta(pair) * 1.8**2 * 2.5**0.2 == pytest.approx(lam, rel=1e-12)
    assert closed_form.eta(pair) == pytest.approx(0.0751, abs=5e-5)


@pytest.mark.parametrize("v", [0.5, 1.0, 3.0, 6.0, 50.0])
def test_half_space_is_exact(v):
    assert closed_form.half_space(v) == pytest.approx(solved(v, 0.0), abs=1e-9)


def test_eq_21_holds_up_to_the_linear_branch():
    v = (2.14 / 0.68) ** 1.25
    assert v == pytest.approx(4.19, abs=5e-3)
    ratio = closed_form.half_space([v, 10.0], printed=True) / closed_form.half_space([v, 10.0])
    assert ratio == pytest.approx([1.0, 1.0437], abs=1e-4)


@pytest.mark.parametrize("v", [0.5, 1.5, 8.0, 60.0])
def test_thornton_is_exact(v):
    assert closed_form.thornton(v) == pytest.approx(solved(v, 0.0, "thornton"), abs=1e-9)


def test_thornton_asymptote():
    assert closed_form.thornton_asymptote(1e5) == pytest.approx(closed_form.thornton(1e5), rel=1e-5)


def test_yield_speed_is_the_models(pair, model):
    lam_y = closed_form.eta(pair) * 1.8**2
    expected = model.yield_speed(0.9e-3, 0.5e-3) / pair.yield_speed
    assert closed_form.yield_speed_ratio(lam_y) == pytest.approx(expected, rel=1e-8)


def test_eq_22_jumps_as_printed_and_is_continuous_with_the_factor():
    eta = 0.0751
    g = closed_form.yield_speed_ratio(eta * 1.8**2, printed=True)
    around = g * (1 + np.array([-1e-9, 1e-9]))
    below, above = closed_form.peng(around, 1.8, eta, printed=True)
    assert (below, above) == pytest.approx((0.669, 1.0), abs=1e-3)
    assert np.diff(closed_form.peng(around, 1.8, eta)) == pytest.approx(0.0, abs=1e-6)


def test_the_turning_point_form_is_within_a_thousandth(surface):
    form = turning_point.restitution(SPEEDS, INELASTICITIES[:, None])
    error = np.abs(form / surface - 1)
    assert error.max() < 6e-4
    # Eq. 22, its continuous form, over the same range: 4.6 %
    ratio = np.sqrt(INELASTICITIES / 0.0751)
    peng = closed_form.peng(SPEEDS, ratio[:, None], 0.0751)
    assert np.abs(peng / surface - 1).max() > 0.04


def test_the_two_fits_of_the_turning_point_form():
    lam = np.linspace(0.01, 0.6, 30)
    share = closed_form.elastic_compression(lam) / 1.25**0.4
    assert turning_point.loading(lam) == pytest.approx(share, rel=7e-5)
    x = lam * share**0.25
    assert turning_point.release(x) == pytest.approx(closed_form.zener(lam) / share**1.25, rel=9e-4)


def test_the_turning_point_form_is_exact_on_the_half_space():
    v = np.geomspace(0.1, 1e3, 50)
    assert turning_point.restitution(v, 0.0) == pytest.approx(closed_form.half_space(v), abs=1e-14)


def test_the_turning_point_form_is_continuous():
    v = np.linspace(0.5, 10.0, 400_001)
    e = turning_point.restitution(v, 0.2)
    assert np.abs(np.diff(e)).max() < 1e-5  # slope 0.2 times a step of 2.4e-5


def test_unloading_is_the_second_half_of_an_elastic_impact():
    """What the turning-point form rests on, exactly: whatever the loading was."""
    myc, hertz = laws.law("myc"), laws.law("hertz").functions
    v, lam_y = 8.0, 0.25
    y = yield_ratio(v)
    one = zener.solve(myc.functions, lam_y * v**0.2, y, 1e-12)
    dm = one.peak_compression / y
    force, span = myc.loading(math.sqrt(dm)), dm - myc.residual(dm)
    # the elastic impact that turns with the same x = lambda_Y sqrt(f/s), by bisection in lambda
    low, high = 0.0, 2.0
    for _ in range(60):
        lam = 0.5 * (low + high)
        w_m = zener.elastic_compression(hertz, lam, 1e-13)[1] / 1.25**0.4
        low, high = (lam, high) if lam * w_m**0.25 < lam_y * math.sqrt(force / span) else (low, lam)
    released = zener.solve(hertz, lam, 1.0, 1e-13).restitution / w_m**1.25
    assert one.restitution == pytest.approx(math.sqrt(force * span) / v * released, rel=1e-9)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: closed_form.mueller(2.0), "inelasticity: got 2.0; must lie between 0 and 2"),
        (lambda: closed_form.raman([0.1, math.nan]), "inelasticity: got nan"),
        (lambda: closed_form.half_space(-1.0), "speed_ratio: got -1.0"),
        (lambda: turning_point.restitution(0.0, 0.1), "speed_ratio: got 0.0"),
        (lambda: closed_form.peng([1, 2], [1, 2, 3], 0.1), "shapes do not broadcast"),
    ],
)
def test_bad_arguments_are_named(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_a_pair_without_yield_strength_has_no_eta():
    with pytest.raises(ValueError, match="yield"):
        closed_form.eta(cl.Pair("glass", "glass"))
