"""One COR for many impacts against direct sums, and against beads dropped in an engine."""

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


def given(speed, radius, e):
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
    assert best.impacts == 200

    pushed = model.constant(SPEED, RADIUS, 2e-3, keep="momentum")
    assert given(SPEED, RADIUS, pushed.restitution) == pytest.approx(given(SPEED, RADIUS, e), rel=1e-12)
    wrong = lost(SPEED, RADIUS, pushed.restitution) / true - 1
    assert pushed.energy_error == pytest.approx(wrong, rel=1e-9)
    assert abs(wrong) > 1e-4


def test_weights_are_repetitions(model):
    times = RNG.integers(0, 5, SPEED.size)
    weighted = model.constant(SPEED, RADIUS, H, weights=times)
    repeated = model.constant(np.repeat(SPEED, times), np.repeat(RADIUS, times), H)
    for name in ("restitution", "spread", "rebound_error", "mean", "mean_energy_error"):
        assert getattr(weighted, name) == pytest.approx(getattr(repeated, name), rel=1e-12), name
    scaled = model.constant(SPEED, RADIUS, H, weights=1e200 * times)
    assert scaled.restitution == pytest.approx(weighted.restitution, rel=1e-12)


def test_values_broadcast(model):
    """Speeds vary along one axis and radii along another; each impact has a weight."""
    speeds, sizes = np.array([1.0, 5.0, 9.0]), np.array([[0.5e-3], [0.9e-3]])
    shares = np.array([[0.2], [0.8]])
    grid = model.constant(speeds, sizes, H, weights=shares)
    v, r, w = (part.ravel() for part in np.broadcast_arrays(speeds, sizes, shares))
    assert grid == model.constant(v, r, H, weights=w)
    assert grid.impacts == 6
    assert model.constant(5.0, R, H).restitution == pytest.approx(model.restitution(5.0, R, H), rel=1e-15)


def test_nothing_is_lost_on_a_half_space_below_yield(pair):
    best = cl.ImpactModel(pair, law="hertz").constant([1.0, 5.0], R, math.inf)
    assert best.restitution == pytest.approx(1.0, abs=1e-12)
    assert (best.energy_error, best.mean_energy_error) == (0.0, 0.0)
    assert best.rebound_error < 1e-12


@pytest.mark.parametrize("e", [[1.0, 1.0], [1.0, 1 - 2e-16]])
def test_a_loss_of_a_rounding_has_no_error(e):
    one = np.ones(2)
    best = constant(np.array([1.0, 2.0]), one, one, np.array(e), np.zeros(2, dtype=int), "energy")
    assert (best.energy_error, best.mean_energy_error) == (0.0, 0.0)


@pytest.mark.parametrize("e, error", [([0.0, 0.2], math.inf), ([1e-170, 0.1], math.inf), ([0.0, 0.0], 0.0)])
def test_a_height_of_nothing_has_no_finite_error(e, error):
    one = np.ones(2)
    best = constant(one, one, one, np.array(e), np.zeros(2, dtype=int), "energy")
    assert best.rebound_error == error


def test_a_plain_mean_misses_a_third_of_the_energy(model):
    """The impact speeds are spread evenly over the logarithm from 0.05 to 10 m/s."""
    bounces = np.geomspace(0.05, 10, 400)
    found = [model.constant(bounces, R, h).mean_energy_error for h in (0.5e-3, 1e-3, 3e-3)]
    assert found == pytest.approx([-0.243, -0.308, -0.407], abs=1e-3)


def test_flags_are_counted_and_what_is_outside_is_refused(pair, model):
    best = model.constant([1.0, 60.0, 70.0], R, H)
    assert best.flags == {cl.Validity.FAST_IMPACT: 2}
    thin = model.constant([1.0, 60.0], R, 0.4e-3)
    assert thin.flags == {cl.Validity.THIN_PLATE: 2, cl.Validity.FAST_IMPACT: 1}
    with pytest.raises(ValueError, match="impact 1 is outside the table"):
        model.constant([1.0, 1e4], R, H)
    clamping = cl.ImpactModel(pair, law="myc", outside="clamp")
    assert clamping.constant([1.0, 1e4], R, H).flags[cl.Validity.CLAMPED] == 1
    assert clamping.clamped == 1
    solving = cl.ImpactModel(pair, law="myc", outside="solve")
    v = np.array([1.0, 1e4])
    e = solving.solve(v, R, H, rtol=1e-10).restitution
    assert lost(v, R, solving.constant(v, R, H).restitution) == pytest.approx(lost(v, R, e), rel=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"speed": []}, "speed: got no impact"),
        ({"speed": [1.0, math.nan]}, "speed: got nan"),
        ({"radius": [R, R, R]}, "speed: shapes do not broadcast"),
        ({"keep": "mass"}, "keep: got 'mass'; must be 'energy' or 'momentum'"),
        ({"weights": [1.0, -1.0]}, "weights: got -1.0 .*must lie between 0"),
        ({"weights": [1.0, math.inf]}, "weights: got inf .*must lie between 0"),
        ({"weights": [1.0, math.nan]}, "weights: got nan .*must lie between 0"),
        ({"weights": 0.0}, "weights: all of them are 0"),
        ({"weights": "many"}, "weights: got .many.; expected a number"),
    ],
)
def test_what_is_refused(model, change, message):
    with pytest.raises(ValueError, match=message):
        model.constant(**{"speed": [1.0, 2.0], "radius": R, "thickness": H, **change})
