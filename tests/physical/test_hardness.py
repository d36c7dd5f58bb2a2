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
