"""The one formatter of values with errors and of shares."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactlaw._readable import percent, rounded, scale_of, with_error

SIZES = st.floats(1e-12, 1e15)
SIGNED = SIZES | SIZES.map(float.__neg__)
SHOWN = re.compile(r"(\(?)(-?\d+(?:\.\d+)?) \+- (\d+(?:\.\d+)?)\)?(?:e(-?\d+))? (\S+)")


def read_back(text):
    """Value and error in the unit that is shown, and the places after the point of both."""
    bracket, value, error, power, _ = SHOWN.fullmatch(text).groups()
    assert bool(bracket) == bool(power)
    scale = 10.0 ** int(power or 0)
    places = [len(number.partition(".")[2]) for number in (value, error)]
    return float(value) * scale, float(error) * scale, places


@given(SIGNED, st.floats(1e-6, 1e3), st.sampled_from(["Pa", "m", "s", "kg/m3"]))
def test_value_and_error_are_rounded_to_the_second_digit_of_the_error(value, share, unit):
    error = share * abs(value)
    text = with_error(value, error, unit)
    found, stated, places = read_back(text)
    _, scale = scale_of(max(abs(value), error), unit)
    assert places[0] == places[1]
    assert stated * scale == pytest.approx(error, rel=0.051)  # two digits: 1.05 may be 1.1
    assert abs(found * scale - value) <= 0.0501 * error
    assert len(re.sub(r"\D", "", SHOWN.fullmatch(text)[3]).lstrip("0").rstrip("0")) <= 2


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (852e6, 190e6, "850 +- 190 MPa"),
        (3130e6, 290e6, "3130 +- 290 MPa"),
        (99.6e6, 9.96e6, "100 +- 10 MPa"),  # 9.96 has its second digit before the point
        (203.4e9, 2.1e9, "203.4 +- 2.1 GPa"),
        (793e-6, 12e-6, "0.793 +- 0.012 mm"),
        (3e-6, 0.4e-6, "3.00 +- 0.40 um"),
        (20e6, 1900e6, "0 +- 1900 MPa"),
        (2700.0, 0.0, "2700 +- 0 kg/m3"),
        (0.0, 0.0, "0 +- 0 nm"),
        (0.0, 5e-324, "0 +- 0 kg/m3"),
        (2700.0, 1e-9, "2700.0000 +- 0.0027 kg/m3"),
        (1e9, math.inf, "1000 +- inf MPa"),
    ],
)
def test_as_one_would_write_it(value, error, text):
    unit = text.split()[-1]
    assert with_error(value, error, unit.lstrip("MGumn") or "m") == text


@given(SIGNED)
def test_rounded_keeps_two_digits(number):
    assert float(rounded(number)) == pytest.approx(number, rel=0.0501)
    if 1e-4 < abs(number) < 9e6:
        assert "e" not in rounded(number)


@given(SIGNED.filter(lambda share: abs(share) >= 1e-4) | st.just(0.0))
def test_a_share_says_what_it_is(share):
    number, unit = percent(share).split()
    assert float(number) * {"%": 0.01, "times": 1.0}[unit] == pytest.approx(share, rel=0.0501)
    assert "e" not in number or abs(share) > 9e6


def test_a_tiny_share_is_below_what_matters():
    assert percent(2.2e-14) == percent(-9e-5) == "below 0.01 %"
