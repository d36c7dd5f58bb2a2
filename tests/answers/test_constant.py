"""One COR for many impacts against direct sums."""

import math

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import laws
from contactlaw.answers.constant import constant

R, H = 0.9e-3, 0.5e-3
RNG = np.random.default_rng(11)
SPEED = np.exp(RNG.uniform(math.log(0.05), math.log(10.0), 200))
RADIUS = RNG.uniform(0.4e-3, 0.9e-3, 200)


def lost(speed, radius, e):
    """Energy that impacts dissipate, over (2/3) pi rho."""
    return math.fsum(r**3 * v**2 * (1 - x**2) for v, r, x in np.broadcast(speed, radius, e))


def passed(speed, radius, e):
    """Momentum that impacts give to a wall, over (4/3) pi rho."""
    return math.fsum(r**3 * v * (1 + x) for v, r, x in np.broadcast(speed, radius, e))


@pytest.mark.parametrize("law", laws.names())
def test_it_keeps_what_it_is_asked_to(law):
    model = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6"), law=law)
    e = model.restitution(SPEED, RADIUS, 2e-3)
    best = model.constant(SPEED, RADIUS, 2e-3)
    true = lost(SPEED, RADIUS, e)
    assert lost(SPEED, RADIUS, best.restitution) == pytest.approx(true, rel=1e-12)
    assert best.energy_error == pytest.approx(0.0, abs=1e-12)
    assert best.mean == pytest.approx(math.fsum(e) / e.size, rel=1e-12)
    assert best.mean_energy_error == pytest.approx(lost(SPEED, RADIUS, best.mean) / true - 1)
    assert best.spread == pytest.approx(np.std(e), rel=1e-12)
    heights = np.sort(np.abs(best.restitution**2 / e**2 - 1))
    assert best.rebound_error == pytest.approx(heights[math.ceil(0.95 * 200) - 1], rel=1e-9)

    pushed = model.constant(SPEED, RADIUS, 2e-3, keep="momentum")
    assert passed(SPEED, RADIUS, pushed.restitution) == pytest.approx(passed(SPEED, RADIUS, e), rel=1e-12)
    wrong = lost(SPEED, RADIUS, pushed.restitution) / true - 1
    assert pushed.energy_error == pytest.approx(wrong, rel=1e-9) and abs(wrong) > 1e-4


def test_weights_are_repetitions(model):
    times = RNG.integers(0, 5, SPEED.size)
    weighted = model.constant(SPEED, RADIUS, H, weights=times)
    repeated = model.constant(np.repeat(SPEED, times), np.repeat(RADIUS, times), H)
    for name in ("restitution", "spread", "rebound_error", "mean", "mean_energy_error"):
        assert getattr(weighted, name) == pytest.approx(getattr(repeated, name), rel=1e-12), name
    scaled = model.constant(SPEED, RADIUS, H, weights=1e200 * times)
    assert scaled.restitution == pytest.approx(weighted.restitution, rel=1e-12)
    # speeds vary along one axis and radii along another
    grid = model.constant([1.0, 5.0, 9.0], [[0.5e-3], [0.9e-3]], H, weights=[[0.2], [0.8]])
    assert grid == model.constant([1.0, 5.0, 9.0] * 2, np.repeat([0.5e-3, 0.9e-3], 3), H, weights=[0.2] * 3 + [0.8] * 3)


@pytest.mark.parametrize(
    ("e", "name", "error"),
    [
        ([1.0, 1 - 2e-16], "mean_energy_error", 0.0),
        ([1e-170, 0.1], "rebound_error", math.inf),
        ([0.0, 0.0], "rebound_error", 0.0),
    ],
)
def test_a_loss_of_a_rounding_has_no_error_and_a_height_of_nothing_no_finite_one(e, name, error):
    """No impacts of a model have just these CORs."""
    one = np.ones(2)
    best = constant(one, one, one, np.array(e), np.zeros(2, dtype=int), "energy")
    assert getattr(best, name) == error and best.energy_error == pytest.approx(0.0, abs=1e-15)


def test_a_plain_mean_misses_a_third_of_the_energy(model):
    """The impact speeds are spread evenly over the logarithm from 0.05 to 10 m/s."""
    bounces = np.geomspace(0.05, 10, 400)
    errors = [model.constant(bounces, R, h).mean_energy_error for h in (0.5e-3, 1e-3, 3e-3)]
    assert errors == pytest.approx([-0.243, -0.308, -0.407], abs=1e-3)


def test_flags_are_counted(pair, model):
    thin = model.constant([1.0, 60.0], R, 0.4e-3)
    assert thin.flags == {cl.Validity.THIN_PLATE: 2, cl.Validity.FAST_IMPACT: 1}
    clamping = cl.ImpactModel(pair, law="myc", outside="clamp")
    assert clamping.constant([1.0, 1e4], R, H).flags[cl.Validity.CLAMPED] == 1
