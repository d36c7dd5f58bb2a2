"""Hardness in the units in which people write it."""

import pytest

from contactlaw.physical.hardness import pascals
from contactlaw.physical.materials import Material

KGF = 9.80665e6  # Pa per kgf/mm2, by the definition of the kilogram-force


def ball(hardness):
    return Material("ball", 203e9, 0.3, 7830, kind="metal", hardness=hardness)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("800 HV", 800),
        ("640HV10", 640),
        ("200 HB", 200),
        (" 94 hbw 2.5/62.5 ", 94),
        # ASTM E140-12, Table 1: Rockwell C and Vickers
        ("20 HRC", 238),
        ("25 HRC", 266),
        ("30 HRC", 302),
        ("35 HRC", 345),
        ("40 HRC", 392),
        ("45 HRC", 446),
        ("50 HRC", 513),
        ("55 HRC", 595),
        ("60 HRC", 697),
        ("62 HRC", 746),
        ("65 HRC", 832),
        ("68.0 HRC", 940),
        ("63.5 HRC", 786),  # halfway from 772 to 800
    ],
)
def test_hardness_is_stored_in_pascals(text, number):
    assert ball(text).hardness == pytest.approx(number * KGF, rel=1e-12)
    assert isinstance(ball(text).hardness, float)
    assert ball(text) == ball(number * KGF)


def test_rockwell_grows_evenly():
    """A slip of the pen in the table would bend it: its steps grow from 5 to 40."""
    table = [pascals(f"{number} HRC") / KGF for number in range(20, 69)]
    steps = [b - a for a, b in zip(table, table[1:], strict=False)]
    assert all(0.8 * a <= b <= 1.4 * a + 1 for a, b in zip(steps, steps[1:], strict=False))


@pytest.mark.parametrize("text", ["62 HRB", "7.3 GPa", "62", "HRC", "-62 HRC", "nan HV", "6 2 HV"])
def test_other_units_are_refused_with_those_that_are_known(text):
    with pytest.raises(ValueError, match="^hardness: .* HV, HB, HBW, HRC.* .material 'ball'") as caught:
        ball(text)
    assert repr(text) in str(caught.value)


@pytest.mark.parametrize("text", ["19.9 HRC", "68.5 HRC", "0 HRC"])
def test_rockwell_outside_its_scale_is_refused(text):
    with pytest.raises(ValueError, match="must be from 20 to 68 HRC.*give HV or HB"):
        ball(text)


def test_no_hardness_at_all_is_refused():
    with pytest.raises(ValueError, match="^hardness: got 0.0; must be positive"):
        ball("0 HV")
