"""The motion of a plate at a point against the modes of a plate, the force itself, and closed forms."""

import math

import numpy as np
import pytest
from impacted import PAIR, impacted, thin_plate
from scipy.special import sici

import contactlaw as cl

THICKNESS, START, AWAY = 1e-3, 0.0123, 0.05
ONE = {"approach_speed": 1.0, "radius": 1e-3, "thickness": THICKNESS}
MOBILITY, SPREAD, AREAL = thin_plate(THICKNESS)
AT = 0.0, 0.0, 0.0


@pytest.fixture(scope="module")
def record():
    return impacted("hertz", **ONE, time=START, x=AWAY)


@pytest.fixture(scope="module")
def contact():
    return cl.ImpactModel(PAIR, "hertz").force_history(*ONE.values(), samples=501)


@pytest.mark.parametrize("quantity", ["velocity", "acceleration"])
def test_the_wave_is_that_of_the_modes_of_a_large_plate(record, contact, quantity):
    """A supported square plate, struck in its middle, until the first echo."""
    side, rate = 1.2, 2e6
    signal = cl.plate_signal(record, 0, AT, rate, quantity, edge_distance=0.5 * side - AWAY)
    wave = np.arange(1, 901, 2) * math.pi / side
    omega = (SPREAD * (wave[:, None] ** 2 + wave**2)).ravel()
    sine = np.sin(0.5 * wave * side)
    shape = np.outer(np.sin(wave * (0.5 * side - AWAY)) * sine, sine**2).ravel() * 4 / (AREAL * side**2)
    push = np.polyval(contact.force[::-1], np.exp(1j * omega * contact.time[1])) * contact.time[1]
    push *= shape * np.sinc(omega / (2 * math.pi * rate))  # mean over a sample
    if quantity == "acceleration":
        push *= -1j * omega
    # group speed of bending waves of half the rate, over the shortest path by an edge
    path = math.hypot(AWAY, side - 2 * AWAY)
    assert signal.first_echo == pytest.approx(path / (2 * math.sqrt(SPREAD * math.pi * rate)))
    since = signal.time - START
    early = np.flatnonzero((since > 3e-5) & (since < signal.first_echo))[::4]
    expected = np.array([(np.exp(-1j * omega * since[n]) * push).real.sum() for n in early])
    assert since[early].max() > 1.5e-4
    assert signal.value[early] == pytest.approx(expected, abs=0.01 * abs(expected).max())


def test_the_plate_follows_the_force_below_the_bead(record, contact):
    signal = cl.plate_signal(record, 0, (AWAY, 0.0, 0.0), 2e7)
    force = np.interp(signal.time - START, contact.time, contact.force, left=0.0, right=0.0)
    assert signal.value == pytest.approx(MOBILITY * force, abs=1e-3 * MOBILITY * force.max())
    impulse = contact.impulse[-1]
    assert signal.value.sum() / 2e7 == pytest.approx(MOBILITY * impulse, rel=1e-3)
    away = cl.plate_signal(record, 0, AT, 1e6)
    end = away.time[-1] + 0.5e-6 - START - np.average(contact.time, weights=contact.force)
    still = 1 - 2 / math.pi * sici(AWAY**2 / (4 * SPREAD) / end)[0]
    assert away.value.sum() / 1e6 == pytest.approx(MOBILITY * impulse * still, rel=1e-3)


def test_waves_add_up_and_a_slow_rate_filters_them():
    first, second = (ONE | {"approach_speed": v, "time": t, "x": AWAY} for v, t in ((1.0, 0.01), (3.0, 0.0102)))
    both = impacted("hertz", **{name: np.array([first[name], second[name]]) for name in first})
    rate = 1e6
    one, two, whole = (cl.plate_signal(some, 0, AT, rate).value for some in (both.part([0]), both.part([1]), both))
    assert whole[200 : one.size] == pytest.approx(one[200:] + two[: one.size - 200])
    slow, size = cl.plate_signal(both, 0, AT, rate / 25), whole.size // 25
    assert slow.time[0] == pytest.approx(0.01 + 12.5 / rate)
    assert slow.value[:size] == pytest.approx(whole[: 25 * size].reshape(size, 25).mean(axis=1), abs=1e-3 * whole.max())


def test_what_has_no_signal_is_refused_in_words(record):
    thick, place = impacted("fem", **ONE | {"thickness": math.inf}), np.arange(9) / 10
    plane = impacted("hertz", **{name: np.full(9, size) for name, size in ONE.items()}, x=place, y=place**2)
    parcels = plane.part([0])
    for name, factor in {"parcel": 2, "mass": 8, "wave_energy": 8}.items():
        parcels.rows[name] *= factor
    cases = {
        "has no impact on this wall": (record, 1, AT, 1e6),
        "lacks materials and law": (cl.Record(record.rows), 0, AT, 1e6),
        "parcels: their beads do not hit at one time": (parcels, 0, AT, 1e6),
        "is a half-space": (thick, 0, AT, 1e6),
        "must be the x, y and z": (record, 0, (0.0, 0.0), 1e6),
        "is not in one plane with the impacts": (plane, 0, (0.0, 0.0, 0.01), 1e6),
        "rate: got 100.0; must be .* or more": (record, 0, AT, 100.0),
        "must be 'velocity' or 'acceleration'": (record, 0, AT, 1e6, "speed"),
    }
    for words, arguments in cases.items():
        with pytest.raises(ValueError, match=words):
            cl.plate_signal(*arguments)
    assert cl.plate_signal(plane, 0, (0.5, 0.0, 0.0), 1e5).value.size
