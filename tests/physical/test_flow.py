"""The flow stress of metals: Johnson and Cook's formula, what a hardness says about it, and units of hardness."""

import dataclasses

import numpy as np
import pytest

import contactlaw as cl

STEEL = cl.Material("steel", 207e9, 0.3, 7850, yield_strength=350e6, kind="metal")
KGF = 9.80665e6  # Pa per kgf/mm2, by the definition of the kilogram-force


def with_flow(**numbers):
    return dataclasses.replace(STEEL, **numbers)


def test_flow_stress_is_johnson_and_cooks():
    # by hand: 350 + 275 * 0.1^0.36 = 470.041, times 1 + 0.022 ln 1000 = 1.15197
    flow = with_flow(hardening=(275e6, 0.36), rate=(0.022, 1.0)).flow
    assert flow.stress(0.1, 1000.0) == pytest.approx(541.473e6, rel=1e-5)
    assert flow.stress(0.1, 0.5) == flow.stress(0.1, 1.0)  # rates below rate0 count as rate0
    assert flow.stress(0.0) == 350e6


def test_hardness_fixes_the_flow_stress_at_tabors_strain():
    hard = dataclasses.replace(STEEL, yield_strength=None, hardness=1.5e9)
    assert hard.strength_from_hardness
    assert hard.strength == pytest.approx(0.5e9)
    bent = dataclasses.replace(hard, hardening=0.2)
    assert bent.flow.stress(0.08) == pytest.approx(0.5e9)
    # the flow stress begins on the elastic line, on a power of the strain through that point
    strain = bent.strength / STEEL.youngs_modulus
    assert bent.strength == pytest.approx(0.5e9 * (strain / 0.08) ** 0.2)
    known = with_flow(hardness=1.5e9, hardening=0.2)
    assert known.strength == 350e6
    assert known.flow.stress(0.08) == pytest.approx(0.5e9)
    assert not known.strength_from_hardness


def test_no_hardening_and_no_rate_are_none():
    assert with_flow(hardening=(0.0, 0.3), rate=(0.0, 1.0)) == STEEL
    assert STEEL.flow == (350e6, 0.0, 1.0, 0.0, 1.0)


def test_laws_without_hardening_take_the_flow_stress_of_the_hardness():
    known = dataclasses.replace(STEEL, yield_strength=None, hardness=600e6)
    hardening = dataclasses.replace(known, hardening=0.3)
    one, other = (
        cl.ImpactModel(cl.Pair(body, "glass"), law="thornton").solve(3.0, 1e-3, 5e-3) for body in (known, hardening)
    )
    assert one.restitution == other.restitution
    assert hardening.require_yield_strength("fem") < hardening.require_yield_strength("myc")


def hardness(text):
    return with_flow(hardness=text).hardness


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
