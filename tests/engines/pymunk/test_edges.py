"""Edges of plates: where they are, and what the model answers near them."""

import math

import pymunk
import pymunk_room as room
import pytest
from pymunk_room import R, Stub, make_bead, make_plate, make_space

import contactlaw as cl
from contactlaw.engines.pymunk import attach

H = 1e-3
NEAR, FAR = 1.5e-3, 15e-3  # [m]; edges are felt from 8.3 mm at 2 m/s
RING = [(0.05 * math.cos(a), 0.05 * math.sin(a)) for a in (math.pi * n / 11 for n in range(22))]  # turns by 16 degrees


def hit(model, x, shapes, edge, y=0.0, speed=2.0, slip=0.0, thickness=H, friction=None):
    """Row of the record, and body, of one bead that hits plates given by their corners."""
    space = make_space(0.0)
    impacts = attach(space, model)
    circle = make_bead(space, (x, y + 1.01 * R), (slip, -speed))
    impacts.add_bead(circle)
    body = room.moving_body(space, position=(1.0, 0.0))  # plates know where their body is
    for corners in shapes:
        corners = [(u - 1.0, v) for u, v in corners]
        shape = pymunk.Poly(body, corners)
        if len(corners) == 2:
            shape = make_plate(space, *corners, body=body)
        else:
            space.add(shape)
        impacts.add_plate(shape, thickness, edge=edge, friction=friction)
    room.step_to_impact(space, impacts, circle.body, 1e-5)
    (row,) = impacts.collisions()
    assert circle.body.velocity.y / speed == pytest.approx(row["restitution"], abs=1e-12)
    return row, circle.body


LONG, BOX = [(0, 0), (0.1, 0)], [(0, 0), (0.1, 0), (0.1, -0.01), (0, -0.01)]
PIECES = [[(0, 0), (1e-3, 0)], [(0.1, 0), (1e-3, 0)]]
NO_EDGE = {
    "far": (FAR, [LONG], "free"),
    "closed": (5e-3, [[one, RING[n - 1]] for n, one in enumerate(RING)], "clamped"),
    "round": (5e-3, [RING], "clamped"),
}


@pytest.mark.parametrize(
    "x, shapes, edge, kind",
    [
        (NEAR, [LONG], "free", "free"),
        (0.1 - NEAR, [LONG], "free", "free"),
        (NEAR, PIECES, "clamped", "clamped"),
        (0.1 - NEAR, [BOX], "supported", "supported"),
        (NEAR, [LONG, [(0, 0), (0, -0.1)]], "free", "supported"),  # a fold
        (0.5e-3, [BOX, [(0, 0), (-1e-3, 0)]], "clamped", "clamped"),
    ],
    ids=["start", "end", "pieces", "box", "fold", "box and strip"],
)
def test_the_distance_is_along_the_plates(model, x, shapes, edge, kind):
    row, _ = hit(model, x, shapes, edge)
    expected = model.restitution(row["approach_speed"], R, H, kind, NEAR)
    assert abs(expected - model.restitution(2.0, R, H)) > 0.01
    assert row["restitution"] == pytest.approx(expected, abs=2e-4)  # as the kernel integrates


@pytest.mark.parametrize("case", NO_EDGE)
def test_without_an_edge_nearby_the_answer_is_as_before(model, case):
    x, shapes, edge = NO_EDGE[case]
    y = RING[5][1] if case in ("closed", "round") else 0.0  # the highest side is level
    (row, _), (before, _) = (hit(model, x, shapes, one, y) for one in (edge, None))
    assert row == before


@pytest.mark.parametrize("turn, kind", [(19.0, "free"), (21.0, "supported")])
def test_plates_that_turn_by_20_degrees_continue_each_other(model, turn, kind):
    """As facets of walls do; a sharper fold holds the plate."""
    angle = math.radians(turn)
    slope = [(0, 0), (-1e-3 * math.cos(angle), -1e-3 * math.sin(angle))]
    row, _ = hit(model, NEAR, [LONG, slope], "free")
    distance = NEAR + (1e-3 if kind == "free" else 0.0)
    assert row["restitution"] == pytest.approx(model.restitution(2.0, R, H, kind, distance), abs=2e-4)


def test_the_record_has_the_answer_near_the_edge(model):
    row, body = hit(model, 0.8 * H, [LONG], "free")
    expected = model.lookup(row["approach_speed"], R, H, "free", 0.8 * H)
    assert row["flags"] == expected.flags and cl.Validity.NEAR_EDGE in cl.Validity(row["flags"])
    energy = 0.5 * body.mass * row["approach_speed"] ** 2
    assert row["wave_energy"] == pytest.approx(float(expected.wave_fraction) * energy)
    lost = row["wave_energy"] + row["plastic_energy"] + row["other_energy"]
    assert lost == pytest.approx((1.0 - row["restitution"] ** 2) * energy, abs=1e-4 * energy)


def test_plates_that_come_later_continue_a_plate(model):
    space = make_space(0.0)
    impacts = attach(space, model)
    circle = make_bead(space, (NEAR, 1.01 * R), (0, -2))
    impacts.add_bead(circle)
    impacts.add_plate(make_plate(space, (0, 0), (0.1, 0)), H, edge="free")
    room.steps(space, 5)
    impacts.add_plate(make_plate(space, (0, 0), (-0.1, 0)), H, edge="free")
    circle.body.position, circle.body.velocity = (NEAR, 1.01 * R), (0, -2)
    room.steps(space, 5)
    first, second = impacts.collisions()["restitution"]
    assert first < second - 0.01
    assert second == pytest.approx(model.curve(R, H)(2.0), rel=1e-14)  # one impact and a batch differ by rounding


def test_plates_that_go_leave_an_edge(model):
    space = make_space(0.0)
    impacts = attach(space, model)
    circle = make_bead(space, (NEAR, 1.01 * R), (0, -2))
    impacts.add_bead(circle)
    impacts.add_plate(make_plate(space, (0, 0), (0.1, 0)), H, edge="free")
    other = make_plate(space, (0, 0), (-0.1, 0))
    impacts.add_plate(other, H, edge="free")
    room.steps(space, 5)
    impacts.remove_plate(other)
    circle.body.position, circle.body.velocity = (NEAR, 1.01 * R), (0, -2)
    room.steps(space, 5)
    first, second = impacts.collisions()["restitution"]
    assert second < first - 0.01


@pytest.mark.parametrize("sliding", [0.5, 2.0, 12.0])
def test_friction_follows_the_normal_impulse(model, sliding):
    mu, speed = 0.2, 2.0
    row, _ = hit(model, NEAR, [LONG], "free", slip=sliding * mu * speed, friction=mu)
    expected = model.oblique(speed, sliding * mu * speed, R, H, mu, "solve", "free", row["x"])
    least = 1e-3 if sliding > 10.0 else 0.05
    assert row["sliding_speed_after"] == pytest.approx(float(expected.sliding_speed), abs=least * mu * speed)


@pytest.mark.parametrize(
    "edge, error, message",
    [
        ("loose", ValueError, "edge: got .*must be one of free, supported, clamped"),
        (("free", "clamped"), ValueError, "edge: got .*must be one of"),
        ("free", TypeError, "has no edge_kernel, which this thickness, friction or edge takes"),
    ],
)
def test_edges_that_cannot_be_are_refused(model, edge, error, message):
    space = make_space()
    with pytest.raises(error, match=message):
        attach(space, Stub() if error is TypeError else model).add_plate(make_plate(space), H, edge=edge)
