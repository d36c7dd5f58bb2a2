"""Heights and times of bounces: their speeds and CORs."""

import numpy as np
import pytest
from scipy.optimize import brentq

import contactlaw as cl
from contactlaw.physical import flight

pytestmark = pytest.mark.filterwarnings("ignore:the air changes")


def test_heights_times_and_speeds_of_one_drop_agree_in_air():
    """A bead of light alumina, whose COR would be 8 % wrong without the air."""
    radius, density, cor = 0.9e-3, 879.0, [0.8, 0.85, 0.9]
    fall = flight.of_height(0.5, radius, density)
    heights, times, speed = [], [], []
    for e in cor:
        speed.append(float(fall.down))
        rise = brentq(lambda h, up=e * speed[-1]: flight.of_height(h, radius, density).up - up, 1e-6, 0.5, xtol=1e-15)
        fall = flight.of_height(rise, radius, density)
        heights.append(rise)
        times.append(float(fall.time))
    for noted in (
        dict(zip(("bounce", "bounce2", "bounce3"), heights, strict=True)),
        dict(zip(("t1", "t2", "t3"), times, strict=True)),
        {"bounce": heights[0], "t2": times[1], "bounce3": heights[2]},
    ):
        measured = cl.Measurements.of({"drop": 0.5, "radius": radius} | noted, density=density)
        assert measured.speed == pytest.approx(speed, rel=1e-6)
        assert measured.restitution == pytest.approx(cor, rel=1e-6)
    bare = cl.Measurements.of({"drop": 0.5, "radius": 1.0, "bounce": heights[0]})
    assert bare.restitution[0] < 0.93 * cor[0]


def test_errors_of_cors_are_those_of_random_instants():
    rng = np.random.default_rng(0)
    instants = np.cumsum([0.0, 0.4, 0.3, 0.24]) + rng.normal(0.0, 1e-3, (4000, 4))
    t1, t2, t3 = np.diff(instants).T
    measured = cl.Measurements.of({"t1": t1, "t2": t2, "t3": t3, "time_error": 1e-3, "radius": 1.0})
    for n, cor in enumerate((0.75, 0.8)):
        off = measured.restitution[n::2] - cor
        assert off.std() == pytest.approx(measured.restitution_error[n::2].mean(), rel=0.05)


def test_errors_of_heights():
    """The COR is the root of their ratio."""
    data = {"drop": 0.3, "drop_error": 0.003, "bounce": 0.2, "bounce_error": 0.004, "radius": 1.0}
    measured = cl.Measurements.of(data)
    assert measured.restitution_error == pytest.approx(np.sqrt(2 / 3) * 0.5 * np.hypot(0.01, 0.02))


def test_rows_have_gaps_and_other_columns_and_either_a_drop_or_a_speed():
    """None in a list is a gap, too, and rows without a COR are left out."""
    data = {"drop": [0.3, np.nan], "t1": [0.4, 0.4], "t2": [np.nan, 0.3], "contact_time": [5e-6, np.nan], "radius": 1.0}
    measured = cl.Measurements.of(data | {"line": [2, 3]})
    assert measured.line.tolist() == [2, 3] and measured.restitution == pytest.approx([0.808508, 0.75], rel=1e-4)
    assert measured.contact_time == pytest.approx([5e-6, np.nan], nan_ok=True)
    alone = cl.Measurements.of({"drop": 0.3, "restitution": 0.7, "radius": 1.0})
    assert alone.speed == pytest.approx(np.sqrt(0.6 * flight.GRAVITY)) and alone.restitution == 0.7
    data = {"speed": [2.4, None], "drop": [None, 0.3], "bounce": [0.18, 0.17], "radius": 1.0}
    assert cl.Measurements.of(data).speed == pytest.approx([2.4, 2.4257], rel=1e-4)
    with pytest.warns(UserWarning, match=r"a bounce alone has no COR: .*; rows \[1\] are left out"):
        assert len(cl.Measurements.of({"drop": [0.3, None], "bounce": [0.18, 0.1], "radius": 1.0})) == 1
