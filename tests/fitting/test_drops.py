"""Heights and times of bounces: their speeds and CORs."""

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.fitting.drops import rebounds_of
from contactlaw.physical import flight

pytestmark = pytest.mark.filterwarnings("ignore:the air changes")


def test_heights_times_and_speeds_of_one_drop_agree_in_air():
    """A bead of light alumina, whose COR would be 8 % wrong without the air."""
    radius, density, cor = 0.9e-3, 879.0, [0.8, 0.85, 0.9]
    fall, drop = flight.of_height(0.5, radius, density), 0.5
    height, time, speed = [], [], []
    for e in cor:
        speed.append(float(fall.down))
        low, high = 0.0, 0.5
        for _ in range(60):  # bisection: the height to which it rises
            middle = 0.5 * (low + high)
            low, high = (
                (middle, high) if flight.of_height(middle, radius, density).up < e * speed[-1] else (low, middle)
            )
        fall = flight.of_height(low, radius, density)
        height.append(low)
        time.append(float(fall.time))
    for noted in (
        dict(zip(("bounce", "bounce2", "bounce3"), height, strict=True)),
        dict(zip(("t1", "t2", "t3"), time, strict=True)),
        {"bounce": height[0], "t2": time[1], "bounce3": height[2]},
    ):
        found = rebounds_of({"drop": drop, "radius": radius} | noted, density)
        assert found["speed"] == pytest.approx(speed, rel=1e-6)
        assert found["restitution"] == pytest.approx(cor, rel=1e-6)
    bare = rebounds_of({"drop": drop, "radius": 1.0, "bounce": height[0]}, flight.NO_AIR)
    assert bare["restitution"][0] < 0.93 * cor[0]


def test_errors_of_cors_are_those_of_random_instants():
    rng = np.random.default_rng(0)
    instants = np.cumsum([0.0, 0.4, 0.3, 0.24]) + rng.normal(0.0, 1e-3, (4000, 4))
    t1, t2, t3 = np.diff(instants).T
    found = rebounds_of({"t1": t1, "t2": t2, "t3": t3, "time_error": 1e-3, "radius": 1.0}, flight.NO_AIR)
    for n, cor in enumerate((0.75, 0.8)):
        off = found["restitution"][n::2] - cor
        assert off.std() == pytest.approx(found["restitution_error"][n::2].mean(), rel=0.05)


def test_errors_of_heights():
    """The COR is the root of their ratio."""
    data = {"drop": 0.3, "drop_error": 0.003, "bounce": 0.2, "bounce_error": 0.004, "radius": 1.0}
    found = rebounds_of(data, flight.NO_AIR)
    assert found["restitution_error"] == pytest.approx(np.sqrt(2 / 3) * 0.5 * np.hypot(0.01, 0.02))


def test_a_row_per_drop_with_gaps_and_other_columns():
    data = {"drop": [0.3, np.nan], "t1": [0.4, 0.4], "t2": [np.nan, 0.3], "contact_time": [5e-6, np.nan], "radius": 1.0}
    found = rebounds_of(data | {"line": [2, 3]}, flight.NO_AIR)
    assert found["line"].tolist() == [2, 3] and found["restitution"] == pytest.approx([0.808508, 0.75], rel=1e-4)
    assert found["contact_time"] == pytest.approx([5e-6, np.nan], nan_ok=True)
    alone = rebounds_of({"drop": 0.3, "restitution": 0.7, "radius": 1.0}, flight.NO_AIR)
    assert alone["speed"] == pytest.approx(np.sqrt(0.6 * flight.GRAVITY)) and alone["restitution"] == 0.7


def test_of_each_row_either_a_drop_or_a_speed_and_what_is_refused_or_left_out():
    """None in a list is a gap, and rows without a COR are named."""
    data = {"speed": [2.4, None], "drop": [None, 0.3], "bounce": [0.18, 0.17], "radius": 1.0}
    assert cl.Measurements.of(data).speed == pytest.approx([2.4, 2.4257], rel=1e-4)
    with pytest.warns(UserWarning, match=r"a bounce alone has no COR: .*; rows \[1\] are left out"):
        assert len(cl.Measurements.of({"drop": [0.3, None], "bounce": [0.18, 0.1], "radius": 1.0})) == 1
    one = {"drop": [0.3, 0.3], "bounce": [0.18, 0.1], "radius": 1.0}
    for more, words in (
        ({"bounce_error": -1e-3}, "bounce_error: got -0.001 .*; must lie between 0"),
        ({"time_error": 1e-3}, "time_error: there is no bounce whose COR it enters"),
        ({"bounce_error": 1e-3, "restitution_error": 0.01}, "restitution_error: leave it out beside bounce"),
        ({"radius": [1.0, np.nan]}, "radius: got nan"),
        ({"radius": -1.0}, "radius: got -1.0"),
        ({"drop": [None, None]}, "drop: a bounce alone has no COR"),
        ({"drop": [], "bounce": []}, "got no rebound"),
    ):
        with pytest.raises(cl.ArgumentError, match=words):
            cl.Measurements.of(one | more)
    with pytest.raises(cl.ArgumentError, match="density: got 2.5; .* in g/cm3"):
        cl.Measurements.of(one, density=2.5)
    with pytest.raises(cl.ArgumentError, match="radius: got 1e-05; such a bead has fallen at its terminal speed"):
        flight.of_height([0.3, np.nan], 1e-5, 2500.0)


def test_recordings_are_heard_by_others():
    """As by phyphox, whose exports tests/cli/test_fit.py reads."""
    assert not {"bounces", "Bounces"} & {*cl.__all__}
    with pytest.raises(AttributeError, match="no attribute 'bounces'"):
        cl.bounces  # noqa: B018
