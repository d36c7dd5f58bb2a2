"""Numbers with units, lists and ranges, as people write them on the command line."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactlaw._readable import in_unit
from contactlaw.cli.parts.options import reader_of
from contactlaw.quantities import ANGLE, FRICTION, LENGTH, MASS, SPEED, STRESS, TIME, value, values

POWERS = {"m": 0, "cm": -2, "mm": -3, "um": -6, "µm": -6, "μm": -6, "nm": -9}


@pytest.mark.parametrize(
    ("text", "quantity", "expected"),
    [
        ("0.9mm", LENGTH, [0.9e-3]),
        ("500um", LENGTH, [500e-6]),
        (".5mm, +1.mm ,2e0mm", LENGTH, [0.5e-3, 1e-3, 2e-3]),
        ("36km/h,2cm/s,5mm/s,3m/s", SPEED, [10.0, 0.02, 5e-3, 3.0]),
        ("0:10:5", SPEED, [0.0, 2.5, 5.0, 7.5, 10.0]),
        ("0.1:10:3log", SPEED, [0.1, 1.0, 10.0]),
        ("1mm:1cm:2,inf", LENGTH, [1e-3, 1e-2, math.inf]),
        ("100:1000:2 log, 5", SPEED, [100.0, 1000.0, 5.0]),
        ("30%, 5 %", FRICTION, [0.3, 0.05]),
        ("10°:60°:2", ANGLE, [10.0, 60.0]),
        ("-1", SPEED, [-1.0]),  # the model refuses it, not the parser
    ],
)
def test_what_people_write(text, quantity, expected):
    assert values(text, quantity) == pytest.approx(expected, rel=1e-15, abs=0)


@given(st.floats(1e-30, 1e30), st.sampled_from(sorted(POWERS)))
def test_a_unit_is_a_shift_of_the_decimal_point(number, unit):
    """0.9mm is 0.9e-3 to the last bit, which the product 0.9*1e-3 need not be."""
    mantissa, _, exponent = f"{number!r}".partition("e")
    shifted = float(f"{mantissa}e{int(exponent or 0) + POWERS[unit]}")
    assert value(f"{number!r}{unit}", LENGTH) == shifted


@given(st.floats(1e-6, 1e3), st.floats(1e-6, 1e3), st.integers(2, 300), st.booleans())
def test_a_range_has_its_ends_and_even_steps(start, stop, count, log):
    found = np.array(values(f"{start!r}:{stop!r}:{count}{'log' * log}", SPEED))
    assert (found[0], found[-1], found.size) == (start, stop, count)
    steps = np.diff(np.log(found) if log else found)
    assert steps == pytest.approx(steps.mean(), rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(
    ("text", "quantity", "message"),
    [
        ("", LENGTH, "expected a length"),
        ("1,,5", SPEED, "expected a speed"),
        ("5m", SPEED, "'m' is no unit of speed; take m/s, cm/s, mm/s or km/h, or none for m/s"),
        ("fast", FRICTION, "expected a coefficient of friction such as 0.5 or 0.5%"),
        ("5MM", LENGTH, "'MM' is no unit of length"),
        ("0.5,1mm", LENGTH, "'0.5' has no unit and others have: give each number its unit, as 0.5mm"),
        ("1,5mm", LENGTH, "as 1mm; 1.5mm if it is a decimal comma"),
        ("0.5:2mm:3", LENGTH, "'0.5' has no unit"),
        ("1:2:3:4", SPEED, "a range is start:stop:count"),
        ("1:2:2000000", SPEED, "from 2 to 100000 values"),
        ("1:2:2.5", SPEED, "a range is start:stop:count"),
        ("1:inf:5", LENGTH, "finite"),
        ("1e99999999999999999999", LENGTH, "too large"),
        ("٣", SPEED, "expected a speed"),
    ],
)
def test_what_is_refused_and_how(text, quantity, message):
    with pytest.raises(ValueError, match="^got ") as refused:
        values(text, quantity)
    assert message in str(refused.value)


def test_a_list_that_begins_with_0_is_doubted_where_0_is_unlikely(capsys):
    assert reader_of(values, ANGLE)("0,45") == (0.0, 45.0)
    assert reader_of(values, FRICTION)("0,0.2,0.4") == (0.0, 0.2, 0.4)
    assert capsys.readouterr().err == ""
    assert reader_of(values, FRICTION)("0,5") == (0.0, 5.0)
    assert "is it a decimal comma? Write 0.5" in capsys.readouterr().err


def test_one_value_where_one_is_needed():
    with pytest.raises(ValueError, match="got '1,2', expected one length"):
        value("1,2", LENGTH)


@given(st.floats(-9.0, 3.0).map(lambda power: 10.0**power), st.sampled_from([LENGTH, TIME, MASS, STRESS]))
def test_what_is_written_can_be_read(size, quantity):
    assert value(in_unit(size, quantity.si), quantity) == pytest.approx(size, rel=1e-5)


def test_sizes_are_written_in_the_unit_that_suits_them():
    lengths = 0.9e-3, 50e-6, 1.5, math.inf, 12e-3
    assert [in_unit(length, "m") for length in lengths] == ["0.9 mm", "50 um", "1.5 m", "inf", "12 mm"]
    assert in_unit(0.05, "m/s") == "0.05 m/s"
