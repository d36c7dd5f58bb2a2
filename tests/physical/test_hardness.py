"""Hardness in the units in which people write it."""

import numpy as np
import pytest

import contactlaw as cl

KGF = 9.80665e6  # Pa per kgf/mm2, by the definition of the kilogram-force


def hardness(text):
    return cl.Material("ball", 203e9, 0.3, 7830, kind="metal", hardness=text).hardness


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("800 HV", 800),
        ("640HV10", 640),
        ("200 HB", 200),
        (" 94 hbw 2.5/62.5 ", 94),
        # ASTM E140-12, Table 1: Rockwell C and Vickers
        ("20 HRC", 238),
        ("30 HRC", 302),
        ("40 HRC", 392),
        ("50 HRC", 513),
        ("60 HRC", 697),
        ("65 HRC", 832),
        ("68.0 HRC", 940),
        ("63.5 HRC", 786),  # halfway from 772 to 800
    ],
)
def test_hardness_is_stored_in_pascals(text, number):
    assert hardness(text) == pytest.approx(number * KGF, rel=1e-12)
    assert isinstance(hardness(text), float)


def test_rockwell_grows_evenly():
    """A slip of the pen in the table would bend it: its steps grow from 5 to 40."""
    steps = np.diff([hardness(f"{number} HRC") / KGF for number in range(20, 69)])
    assert (0.8 * steps[:-1] <= steps[1:]).all() and (steps[1:] <= 1.4 * steps[:-1] + 1).all()
