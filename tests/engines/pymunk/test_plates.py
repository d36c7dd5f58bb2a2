"""Plates of several pieces: edges and what the model answers near them, seams, polygons, plates that move."""

import math

import pymunk
import pymunk_room as room
import pytest
from pymunk_room import ALONG, DT, EXACT, UP, G, R, Stub, drop, make_bead, make_plate, make_space

import contactlaw as cl
from contactlaw.engines.pymunk import attach

# --- edges ----------------------------------------------------------------------------------------

H = 1e-3
NEAR, FAR = 1.5e-3, 15e-3  # [m]; edges are felt from 8.3 mm at 2 m/s
RING = [ALONG.rotated(math.pi * n / 11) * 0.05 for n in range(22)]  # turns by 16 degrees
LONG, BOX = [(0, 0), (0.1, 0)], [(0, 0), (0.1, 0), (0.1, -0.01), (0, -0.01)]


def slope(degrees):
    """A short plate that goes on where `LONG` begins, and turns."""
    return [(0, 0), -1e-3 * ALONG.rotated_degrees(degrees)]


EDGES = {  # place of the bead [m], plates, their edges, and the kind and distance of the edge that counts
    "start": ((NEAR, 0), [LONG], "free", "free", NEAR),
    "at the edge": ((0.8 * H, 0), [LONG], "free", "free", 0.8 * H),
    "pieces": ((NEAR, 0), [[(0, 0), (1e-3, 0)], [(0.1, 0), (1e-3, 0)]], "clamped", "clamped", NEAR),
    "box": ((0.1 - NEAR, 0), [BOX], "supported", "supported", NEAR),
    "fold": ((NEAR, 0), [LONG, [(0, 0), (0, -0.1)]], "free", "supported", NEAR),
    # Plates that turn by 20 degrees continue each other, as facets of walls do; a sharper fold holds the plate.
    "turn of 19": ((NEAR, 0), [LONG, slope(19)], "free", "free", NEAR + 1e-3),
    "turn of 21": ((NEAR, 0), [LONG, slope(21)], "free", "supported", NEAR),
    "far": ((FAR, 0), [LONG], "free", None, None),
    # The highest side of the ring is level.
    "closed": ((5e-3, RING[5].y), [[one, RING[n - 1]] for n, one in enumerate(RING)], "clamped", None, None),
}


def hit(model, place, shapes, edge, slip=0.0, friction=None):
    """Row of the record of one bead that hits plates given by their corners with 2 m/s."""
    space = make_space()
    body = room.moving_body(space, position=(1.0, 0.0))  # plates know where their body is
    plates = [make_plate(space, *((x - 1.0, y) for x, y in corners), body=body) for corners in shapes]
    circle = make_bead(space, place + 1.01 * R * UP, (slip, -2.0))
    impacts = room.registered(space, model, [circle], plates, H, edge=edge, friction=friction)
    row, _ = room.step_to_impact(space, impacts, circle.body, 1e-5)
    assert circle.body.velocity.y == pytest.approx(2.0 * row["restitution"], abs=1e-12)
    return row


@pytest.mark.parametrize("case", EDGES)
def test_an_impact_knows_the_kind_of_the_edge_and_its_distance_along_the_plates(model, case):
    place, shapes, edge, kind, distance = EDGES[case]
    row = hit(model, place, shapes, edge)
    near = (kind, distance) if kind else ()
    expected = model.lookup(row["approach_speed"], R, H, *near)
    assert row["restitution"] == pytest.approx(float(expected.restitution), abs=2e-4)  # as the kernel integrates
    assert (abs(expected.restitution - model.restitution(2.0, R, H)) > 0.004) == bool(kind)
    assert row["flags"] == expected.flags
    assert (cl.Validity.NEAR_EDGE in cl.Validity(row["flags"])) == (case == "at the edge")
    energy = 0.5 * row["mass"] * row["approach_speed"] ** 2
    assert row["wave_energy"] == pytest.approx(float(expected.wave_fraction) * energy)
    lost = row["wave_energy"] + row["plastic_energy"] + row["other_energy"]
    assert lost == pytest.approx((1.0 - row["restitution"] ** 2) * energy, abs=4e-4 * energy)


def test_plates_that_come_later_continue_a_plate_until_they_go(model):
    space = make_space()
    circle = make_bead(space, (NEAR, 1.01 * R))
    impacts = room.registered(space, model, [circle], [make_plate(space, *LONG)], H, edge="free")

    def again():
        circle.body.position, circle.body.velocity = (NEAR, 1.01 * R), (0, -2)
        room.steps(space, 5)

    again()
    later = make_plate(space, (0, 0), (-0.1, 0))
    impacts.add_plate(later, H, edge="free")
    again()
    impacts.remove_plate(later)
    again()
    first, continued, last = impacts.collisions()["restitution"]
    assert first == last < continued - 0.01
    assert continued == pytest.approx(model.restitution(2.0, R, H), rel=1e-14)


@pytest.mark.parametrize("sliding", [0.5, 2.0, 12.0])
def test_friction_near_an_edge_follows_the_normal_impulse(model, sliding):
    mu, speed = 0.2, 2.0
    row = hit(model, (NEAR, 0), [LONG], "free", sliding * mu * speed, mu)
    expected = model.oblique(speed, sliding * mu * speed, R, H, mu, "solve", "free", row["x"])
    least = 1e-3 if sliding > 10.0 else 0.05
    assert row["sliding_speed_after"] == pytest.approx(float(expected.sliding_speed), abs=least * mu * speed)


# --- seams ----------------------------------------------------------------------------------------

FORMS = {
    "segments": {},
    "turned": {"turn": 0.7, "radius": 0.2e-3},
    "neighbours": {"neighbours": True, "turn": 0.7},
    "boxes": {"boxes": True, "radius": 0.2e-3},
    "turned boxes": {"boxes": True, "turn": 0.7},
}
FALLS = [(at, (0.05, -2), 0.0) for at in (0.0, 1e-9, -2e-8, 3e-6, 1e-4, -2e-4)]
ROLLS, BOUNCES = (-0.02, (0.5, 0), G), (-0.02, (0.5, -2), G)


def floor(pieces, model, turn=0.0, radius=0.0, neighbours=False, boxes=False):
    """A floor of so many pieces of 60 mm in all, with friction; two of them meet at x = 0."""
    space = make_space()
    xs = [0.06 * n / pieces - 0.03 for n in range(pieces + 1)]
    corners = [[pymunk.Vec2d(x, 0).rotated(turn) for x in pair] for pair in zip(xs, xs[1:], strict=False)]
    down = UP.rotated(turn) * -0.01
    impacts = attach(space, model)
    for a, b in corners:
        shape = make_plate(space, *((a, b, b + down, a + down) if boxes else (a, b)), radius=radius)
        if neighbours:
            shape.set_neighbors(2 * a - b, 2 * b - a)
        impacts.add_plate(shape, H, friction=None if isinstance(model, Stub) else 0.3)
    return space, impacts


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("start", [*FALLS, ROLLS, BOUNCES], ids=str)
def test_a_floor_of_pieces_is_one_plate_for_a_bead_that_hits_or_rolls(model, form, start):
    ends, (at, velocity, gravity) = [], start
    turn, radius = (FORMS[form].get(name, 0.0) for name in ("turn", "radius"))
    for pieces in (1, 60):
        space, impacts = floor(pieces, model, **FORMS[form])
        space.gravity = pymunk.Vec2d(0, -gravity).rotated(turn)
        height = radius + (0.995 if velocity == (0.5, 0) else 1.03) * R
        circle = make_bead(space, pymunk.Vec2d(at, height).rotated(turn), pymunk.Vec2d(*velocity).rotated(turn))
        impacts.add_bead(circle)
        room.steps(space, 5000 if gravity else 400, 1e-5)
        body = circle.body
        ends.append((*body.position, *body.velocity, R * body.angular_velocity, len(impacts.collisions())))
    assert ends[1] == pytest.approx(ends[0], abs=1e-6 if gravity else 1e-9)
    assert gravity or ends[0][-1] == 1


@pytest.mark.parametrize(
    ("ends", "start", "plates", "after"),
    [([(0.05, 0), (0, 0.05)], (1.01, -2), [0, 1], (1, 1)), ([(-0.05, -0.02), (0.05, -0.02)], (0, -2), [0], (0, 1))],
    ids=["corner", "ridge"],
)
def test_a_corner_between_two_plates_is_hit_on_both_sides_and_a_ridge_once(ends, start, plates, after):
    space, (x, speed) = make_space(), start
    circle = make_bead(space, (x * R, 1.01 * R), (speed if x else 0, speed))
    shapes = [make_plate(space, (0, 0), end) for end in ends]
    impacts = room.registered(space, Stub(0.5), [circle], shapes)
    space.step(DT)
    assert sorted(impacts.collisions()["plate"].tolist()) == plates
    assert circle.body.velocity == pytest.approx(after, abs=1e-9)


@pytest.mark.parametrize("gone", ["removed", "unregistered", "filtered", "a sensor"])
def test_a_neighbour_that_is_not_there_has_no_part(gone):
    space, impacts = floor(2, Stub(0.4))
    impacts.add_bead(make_bead(space, (0, 1.03 * R), (0.05, -2)))
    first, _ = sorted(space.static_body.shapes, key=lambda shape: shape.a.x)
    if gone == "unregistered":
        impacts.remove_plate(first)
    if gone in ("removed", "unregistered"):
        space.remove(first)
    elif gone == "filtered":
        first.filter = pymunk.ShapeFilter(mask=0)
    else:
        first.sensor = True
    space.step(DT)
    assert impacts.collisions()["plate"].tolist() == [1]


# --- polygons, and plates that move ---------------------------------------------------------------


def test_a_static_plate_may_have_a_speed():
    """The plate is a conveyor: pymunk never moves it, but counts its speed in every contact."""
    space, body, impacts = drop(Stub(0.5))
    for speed in (1, 0, 1, 0):
        space.static_body.velocity = (0, speed)
        body.position, body.velocity = (0, 0.99 * R), (0, -2)
        space.step(DT)
        assert body.velocity.y == pytest.approx(speed + 0.5 * (2 + speed), abs=EXACT)
    assert impacts.collisions()["approach_speed"] == pytest.approx([3, 2, 3, 2], abs=EXACT)
