"""The load on a plate against what each contact brings to it."""

import math

import numpy as np
import pytest

import contactlaw as cl

R, H = 0.9e-3, 1e-3


def momentum(model, speed, radius=R, thickness=H):
    mass = 4 / 3 * math.pi * model.pair.sphere.density * np.asarray(radius) ** 3
    return mass * speed * (1 + model.restitution(speed, radius, thickness))


@pytest.mark.parametrize("rate", [1e3, 1e5, 1e8])
def test_no_momentum_is_lost_at_any_rate(model, rate):
    rng = np.random.default_rng(1)
    times, speed = rng.uniform(0.0, 1e-3, 300), rng.uniform(0.5, 20.0, 300)
    load = cl.load_signal(times, speed, R, H, model=model, rate=rate)
    expected = momentum(model, speed).sum()
    assert load.force.sum() / rate == pytest.approx(expected, rel=1e-6)


def test_a_fast_sensor_sees_the_force_itself(model):
    contact = model.force_history(8.0, R, H, samples=1025)
    start, rate = 3.21e-6, 1e9
    load = cl.load_signal(start, 8.0, R, H, model=model, rate=rate)
    force = np.interp(load.time - start, contact.time, contact.force, left=0.0, right=0.0)
    assert load.force == pytest.approx(force, abs=2e-3 * contact.force.max())


def test_each_contact_is_in_its_own_interval(model):
    load = cl.load_signal([5.5e-4, 1.5e-4], [3.0, 9.0], R, H, model=model, rate=1e4, duration=1e-3)
    assert np.flatnonzero(load.force).tolist() == [1, 5]
    assert load.force[1] / 1e4 == pytest.approx(momentum(model, 9.0), rel=1e-4)
    assert load.time == pytest.approx((np.arange(10) + 0.5) * 1e-4)


def test_what_is_outside_is_cut_off(model):
    options = {"model": model, "rate": 1e7}
    whole = cl.load_signal(2e-5, 5.0, R, H, **options, duration=1e-4)
    early = cl.load_signal([-1e-6, -1.0], 5.0, R, H, **options, duration=1e-4)
    assert early.force[:20] == pytest.approx(whole.force[210:230], abs=1e-9)
    short = cl.load_signal([2e-5, 2.0], 5.0, R, H, **options, duration=2.2e-5)
    assert short.force == pytest.approx(whole.force[:220])


def test_no_momentum_is_lost_on_a_thin_plate(model):
    """On a thin plate the force has a peak and a long tail, and few samples would miss the peak."""
    thickness = R / np.array([2.0, 5.0, 8.0])
    assert np.max(model.lookup(5.0, R, thickness).inelasticity) > 4.0
    load = cl.load_signal([0.0, 1e-4, 2e-4], 5.0, R, thickness, model=model, rate=1e6)
    expected = momentum(model, 5.0, thickness=thickness).sum()
    assert load.force.sum() / 1e6 == pytest.approx(expected, rel=1e-6)


def test_times_of_another_day(model):
    """Such times would overflow an integer sample number, and are cut off first."""
    load = cl.load_signal([1e20, -1e20, 0.0], 5.0, R, H, model=model, rate=1e3, duration=1e-2)
    assert load.force.sum() / 1e3 == pytest.approx(momentum(model, 5.0), rel=1e-6)


def test_whole_samples(model):
    options = {"speed": 5.0, "radius": R, "thickness": H, "model": model}
    assert cl.load_signal(0.0, **options, rate=100, duration=0.07).force.size == 7
    assert cl.load_signal(0.0, **options, rate=10, duration=0.25).force.size == 3


def test_no_impacts_no_load(model):
    load = cl.load_signal([], [], R, H, model=model, rate=1e3, duration=0.01)
    assert load.force.tolist() == [0.0] * 10


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"rate": 1e15}, "duration: got .*must be at most"),
        ({"times": [math.nan]}, "times: got nan"),
        ({"speed": -3.0}, "speed: got -3.0"),
    ],
)
def test_wrong_arguments(model, arguments, message):
    valid = {"times": [0.1], "speed": 5.0, "radius": R, "thickness": H, "model": model, "rate": 1e3}
    with pytest.raises(ValueError, match=message):
        cl.load_signal(**(valid | arguments))
