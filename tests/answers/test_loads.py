"""The load on a plate against what each contact brings to it."""

import math

import numpy as np
import pytest

import contactlaw as cl

R, H = 0.9e-3, 1e-3


def momentum(model, speed, thickness=H):
    mass = 4 / 3 * math.pi * model.pair.sphere.density * R**3
    return mass * speed * (1 + model.restitution(speed, R, thickness))


RANDOM = np.random.default_rng(1).uniform([[0.0], [0.5]], [[1e-3], [20.0]], (2, 300))


@pytest.mark.parametrize(
    ("times", "speed", "thickness", "options"),
    [
        *((*RANDOM, H, {"rate": rate}) for rate in (1e3, 1e5, 1e8)),
        # on a thin plate the force has a peak and a long tail, and few samples would miss the peak
        ([0.0, 1e-4, 2e-4], 5.0, R / np.array([2.0, 5.0, 8.0]), {"rate": 1e6}),
        # times of another day would overflow an integer sample number, and are cut off first
        ([1e20, -1e20, 0.0], [0.0, 0.0, 5.0], H, {"rate": 1e3, "duration": 1e-2}),
        ([], [], H, {"rate": 1e3, "duration": 0.01}),
    ],
    ids=["slow", "usual", "fast", "thin", "another day", "none"],
)
def test_no_momentum_is_lost(model, times, speed, thickness, options):
    speed = np.asarray(speed)
    load = cl.load_signal(times, np.maximum(speed, 1.0), R, thickness, model=model, **options)
    expected = np.where(speed > 0.0, momentum(model, np.maximum(speed, 1.0), thickness), 0.0).sum()
    assert load.force.sum() / options["rate"] == pytest.approx(expected, rel=1e-6)


def test_a_fast_sensor_sees_the_force_itself(model):
    contact = model.force_history(8.0, R, H, samples=1025)
    start, rate = 3.21e-6, 1e9
    load = cl.load_signal(start, 8.0, R, H, model=model, rate=rate)
    force = np.interp(load.time - start, contact.time, contact.force, left=0.0, right=0.0)
    assert load.force == pytest.approx(force, abs=2e-3 * contact.force.max())


def test_contacts_are_in_their_own_samples_and_cut_off_at_the_ends(model):
    load = cl.load_signal([5.5e-4, 1.5e-4], [3.0, 9.0], R, H, model=model, rate=1e4, duration=1e-3)
    assert np.flatnonzero(load.force).tolist() == [1, 5]
    assert load.force[1] / 1e4 == pytest.approx(momentum(model, 9.0), rel=1e-4)
    assert load.time == pytest.approx((np.arange(10) + 0.5) * 1e-4)

    def force(times, duration, rate=1e7):
        return cl.load_signal(times, 5.0, R, H, model=model, rate=rate, duration=duration).force

    whole = force(2e-5, 1e-4)
    assert force([-1e-6, -1.0], 1e-4)[:20] == pytest.approx(whole[210:230], abs=1e-9)
    assert force([2e-5, 2.0], 2.2e-5) == pytest.approx(whole[:220])
    assert [force(0.0, 0.07, rate=100).size, force(0.0, 0.25, rate=10).size] == [7, 3]
