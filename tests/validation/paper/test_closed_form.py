"""Closed forms against the solver, limits and each other."""

import numpy as np
import pytest
from oracle import yield_ratio

from contactlaw import laws
from contactlaw.equation import zener
from contactlaw.equation.numbers import Impact
from contactlaw.physical.bodies import SphereOnPlate
from validation.paper import closed_form, turning_point

SPEEDS = np.concatenate([np.linspace(0.03, 2.0, 24), np.linspace(2.2, 20.0, 72)])
INELASTICITIES = np.linspace(0.0, 0.5, 31)


def solved(v, lam_y, law="myc"):
    one = zener.solve(laws.law(law).data, lam_y * v**0.2, yield_ratio(v), 1e-11)
    return one.restitution


@pytest.fixture(scope="module")
def surface():
    """COR of the solver over (lambda_Y, v)."""
    return np.array([[solved(v, lam_y) for v in SPEEDS] for lam_y in INELASTICITIES])


def test_eta_is_the_inelasticity_at_yield(pair):
    impact = Impact(2.5 * pair.yield_speed, 0.9e-3, 0.5e-3)
    lam = SphereOnPlate(pair, laws.law("myc")).numbers(impact).inelasticity.item()
    assert closed_form.eta(pair) * 1.8**2 * 2.5**0.2 == pytest.approx(lam, rel=1e-12)
    assert closed_form.eta(pair) == pytest.approx(0.0751, abs=5e-5)


@pytest.mark.parametrize(("form", "law"), [(closed_form.half_space, "myc"), (closed_form.thornton, "thornton")])
@pytest.mark.parametrize("v", [0.5, 1.0, 1.5, 3.0, 6.0, 8.0, 50.0, 60.0])
def test_half_spaces_are_exact(form, law, v):
    assert form(v) == pytest.approx(solved(v, 0.0, law), abs=1e-9)


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
