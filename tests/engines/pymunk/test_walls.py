"""Plates that swing back or are lined."""

import numpy as np
import pymunk_room as room
import pytest
from pymunk_room import R, Stub, make_bead, make_plate, make_space

import contactlaw as cl
from contactlaw.engines.pymunk import attach
from contactlaw.physical.plates import sheet_of

MODEL = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
H = 0.5e-3
WALLS = {
    "foundation": cl.Foundation(H, 1e12),
    "pipe": cl.Shell(H, 8 * R),
    "dome": cl.Shell(H, -20 * R, "sphere"),
    "lined": cl.Layers([("glass", 0.1e-3), ("steel-s235", 0.4e-3)]),
}


def hit(wall, speed=5.3, slip=0.0, friction=None, model=MODEL):
    """Row of the record of one bead on a plate."""
    space = make_space(0.0)
    circle, impacts = make_bead(space, (0, 1.01 * R), (slip, -speed)), attach(space, model)
    impacts.add_bead(circle)
    impacts.add_plate(make_plate(space), wall, friction=friction)
    room.step_to_impact(space, impacts, circle.body, 1e-5)
    (row,) = impacts.collisions()
    assert circle.body.velocity.y / speed == pytest.approx(row["restitution"], abs=1e-12)
    return row


@pytest.mark.parametrize("name", WALLS)
def test_a_wall_rebounds_as_in_solve(name):
    expected, flat = MODEL.solve(5.3, R, WALLS[name]), MODEL.solve(5.3, R, H)
    row = hit(WALLS[name])
    assert row["restitution"] == pytest.approx(expected.restitution, abs=1e-4)
    assert abs(expected.restitution - flat.restitution) > 0.005
    assert row["flags"] == expected.flags and row["thickness"] == float(sheet_of(WALLS[name]))
    for column in ("peak_force", "contact_time"):
        assert row[column] == pytest.approx(getattr(expected, column), rel=5e-3)
    energy = 0.5 * row["mass"] * 5.3**2
    assert row["wave_energy"] == pytest.approx(expected.wave_fraction * energy, rel=1e-4)


def test_friction_knows_the_wall():
    bed = WALLS["foundation"]
    row = hit(bed, slip=2.0, friction=0.2)
    expected = MODEL.oblique(5.3, 2.0, R, bed, 0.2)
    assert row["sliding_speed_after"] == pytest.approx(expected.sliding_speed, abs=1e-4)
    assert expected.sliding_speed != pytest.approx(MODEL.oblique(5.3, 2.0, R, H, 0.2).sliding_speed, abs=1e-3)


def test_no_foundation_is_the_sheet():
    sheet, *others = (hit(h)["restitution"] for h in (H, cl.Foundation(H, 0.0), cl.Shell(H, np.inf)))
    assert others == pytest.approx([sheet] * 2, abs=1e-4)  # a wall that swings is interpolated in the speed


@pytest.mark.parametrize(
    ("model", "wall", "edge", "said"),
    [
        (MODEL, cl.Foundation(H, -1.0), None, "stiffness: got -1"),
        (MODEL, WALLS["pipe"], "free", "only bare sheets have edges"),
        (MODEL, cl.Layers([("pmma", 1e-3)]), None, "beads touch 'pmma'"),
        (Stub(), WALLS["pipe"], None, "has no pair, which this thickness"),
    ],
)
def test_what_is_refused(model, wall, edge, said):
    space = make_space()
    with pytest.raises((ValueError, TypeError), match=said):
        attach(space, model).add_plate(make_plate(space), wall, edge=edge)


def test_a_contact_in_which_a_wall_swings_too_often_is_refused():
    with pytest.raises(ValueError, match="swings") as caught:
        hit(cl.Foundation(H, 1e16))
    assert "for bead 0 on plate 0" in caught.value.__notes__[0]
