"""Thicknesses and speeds that give a COR, against the COR that they give."""

import json
import math

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.cli import main

ALUMINIUM = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6"))


@pytest.fixture(scope="module")
def steel():
    return cl.ImpactModel(cl.Pair("stainless-steel-304-ball", "glass"))


def test_every_solution_is_found_where_the_cor_has_a_maximum(steel):
    """A finer search that shares no code sees as many crossings, at the same places."""
    h = np.geomspace(0.3e-3, 10.0, 20_000)
    e = np.asarray(steel.solve(2.0, 1e-3, h).restitution)
    assert e.max() > e[-1] + 3e-5
    for wanted, count in ((0.5, 1), (e[-1] + 2e-5, 2), (e.max() + 2e-5, 0)):
        found = steel.thickness(wanted, 2.0, 1e-3)
        at = np.flatnonzero(np.diff(e > wanted))
        assert found.value.size == at.size == count
        assert ((h[at] <= found.value) & (found.value <= h[at + 1])).all()
        assert steel.solve(2.0, 1e-3, found.value, rtol=1e-10).restitution == pytest.approx(wanted, abs=1e-9)
        assert found.attainable[1] == pytest.approx(e.max(), abs=1e-5)
    assert found.remark.startswith("no thickness: 21.")


def test_a_half_space_is_a_solution_and_says_what_it_gives():
    most = ALUMINIUM.restitution(2.0, 1e-3, math.inf)
    beyond, thick = ALUMINIUM.thickness([0.8, most - 1e-5], 2.0, 1e-3)
    assert beyond.remark.startswith(f"no thickness: a half-space gives {most:.4g}, the largest")
    assert beyond.value.size == 0 and thick.value[0] > 0.1


def test_speeds_broadcast_and_flags_are_those_of_the_impact(steel):
    found = steel.speed([[0.3], [0.9]], 1e-3, [1e-3, 5e-3])
    assert found.shape == (2, 2)
    for (n, m), one in np.ndenumerate(found):
        hit = steel.lookup(one.value, 1e-3, (1e-3, 5e-3)[m])
        assert hit.restitution == pytest.approx((0.3, 0.9)[n], abs=1e-5)
        assert one.flags.tolist() == np.asarray(hit.flags).tolist()


@pytest.mark.parametrize(
    "layers",
    [
        lambda h: [("aluminium-6061-t6", h)],
        lambda h: [("aluminium-6061-t6", h), ("steel-s235", 1e-3)],
        lambda h: [("aluminium-6061-t6", 4e-4), ("steel-s235", h)],
    ],
    ids=["alone", "a liner on 1 mm of steel", "steel under 0.4 mm"],
)
def test_a_layer_is_found_from_above_and_from_below(layers):
    for wanted in (0.4, 0.5):
        found = ALUMINIUM.thickness(wanted, 2.0, 1.5e-3, lambda h: cl.Layers(layers(h)))
        (h,) = found.value
        hit = ALUMINIUM.solve(2.0, 1.5e-3, cl.Layers(layers(h)), rtol=1e-10)
        assert hit.restitution == pytest.approx(wanted, abs=1e-9) and found.flags.tolist() == [hit.flags]


def test_a_liner_is_flagged():
    thin = cl.Layers([("aluminium-6061-t6", 1e-4), ("steel-s235", 1e-3)])
    lined, flat = ALUMINIUM.speed(0.4, 1.5e-3, [thin, 1e-3])
    assert lined.flags & cl.Validity.LINER and not flat.flags & cl.Validity.LINER


def test_the_command_says_the_same(steel, capsys):
    steel_on_glass = "--sphere stainless-steel-304-ball --plate glass --radius 1mm"
    assert main(f"find speed {steel_on_glass} --cor 0.9,0.01 --thickness inf --json".split()) == 0
    row, found = json.loads(capsys.readouterr().out, parse_constant=pytest.fail), steel.speed(0.9, 1e-3, math.inf)
    assert (row["plate"], row["speed"], row["restitution"], row["thickness"]) == ("glass", found.value[0], 0.9, "inf")
