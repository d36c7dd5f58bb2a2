"""The law fem for bodies that harden: its limits. Finite elements are in tests/validation/fem/test_fit.py."""

import dataclasses

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.laws import fem

IDEAL = cl.Material("steel", 207e9, 0.3, 7850, yield_strength=350e6)
PLATE = cl.Material("plate", 70e9, 0.22, 2500)


def model(sphere, plate=PLATE):
    return cl.ImpactModel(cl.Pair(sphere, plate))


def hardening(b, n, body=IDEAL):
    return dataclasses.replace(body, hardening=(b, n))


@pytest.mark.parametrize("speed", [0.05, 1.0, 8.0])
def test_without_any_rise_the_answers_are_those_of_an_ideal_body(speed):
    """The least B changes next to nothing; with n near 0 the flow stress is A + B at any strain."""
    impact = speed, 1e-3, 4e-3
    ideal = model(IDEAL).solve(*impact)
    slight = model(hardening(0.3e6, 1.0)).solve(*impact)
    step = model(hardening(300e6, 1e-9)).solve(*impact)
    stronger = model(dataclasses.replace(IDEAL, yield_strength=650e6)).solve(*impact)
    for name in ("restitution", "contact_time", "peak_force", "plastic_fraction"):
        assert getattr(slight, name) == pytest.approx(getattr(ideal, name), rel=3e-5, abs=1e-9)
        assert getattr(step, name) == pytest.approx(getattr(stronger, name), rel=1e-5, abs=1e-9)


def test_restitution_rises_with_hardening_and_flow_begins_at_the_yield_strength():
    speeds = np.array([0.3, 1.0, 3.0, 10.0])
    answers = [model(hardening(b, 0.3)) for b in (1e6, 100e6, 400e6, 1600e6)]
    cors = np.array([one.solve(speeds, 1e-3, 4e-3).restitution for one in answers])
    assert (np.diff(cors, axis=0) > 0.0).all()
    onset = model(IDEAL).yield_speed(1e-3, 4e-3)
    # tables know the elastic compression of impacts that reach the law's own yield, a little later
    ends = [one.yield_speed(1e-3, 4e-3) for one in answers[::3]]
    assert ends == pytest.approx([onset] * 2, rel=3e-3)


@pytest.mark.parametrize("role", ["sphere", "plate"])
def test_all_metals_that_harden_have_a_law_and_flow_on_from_yield(role):
    """Bodies of a low Poisson's ratio yielded before they strained, and then no longer flowed."""
    other = "plate" if role == "sphere" else "sphere"
    draw = np.random.default_rng(20261213)
    for _ in range(40):
        share, nu, nu_other, n = draw.uniform([0.01, 0.0, 0.0, 0.2], [0.99, 0.5, 0.5, 0.7])
        ratio, times = np.exp(draw.uniform(np.log([15.0, 0.2]), np.log([1200.0, 4.0])))
        made = fem.law_of(
            fem.Given(
                **{
                    "modulus_share": share,
                    f"{role}_ratio": ratio,
                    f"{other}_ratio": ratio / 4.0,
                    "poissons_ratio": nu,
                    "plate_poissons_ratio": nu_other,
                    f"{role}_hardening": times,
                    f"{role}_exponent": n,
                }
            ),
            fem.fitted(),
        )
        dm = np.geomspace(1.0, made.range[1], 50)
        left = np.array([made.residual(one) for one in dm])
        assert (np.diff(left / dm) > 0.0).all()
