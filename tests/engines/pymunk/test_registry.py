"""Attaching, registering, leaving; and what else lives in the space."""

import copy
import math
import pickle
import sys

import pymunk
import pymunk_room as room
import pytest
from pymunk_room import DT, EXACT, R, Stub, drop, make_bead, make_plate, make_space

from contactlaw.engines.pymunk import attach


def test_detach_restores_everything():
    space, body, impacts = drop(Stub(0.5), gravity=0.0)
    (circle,) = body.shapes
    assert circle.collision_type == impacts.bead_type
    assert space.collision_slop == pytest.approx(0.1 * R)
    space.step(DT)
    impacts.detach()
    impacts.detach()
    assert {shape.collision_type for shape in space.shapes} == {0}
    assert space.collision_slop == pymunk.Space().collision_slop and "step" not in vars(space)
    assert len(impacts.collisions()) == 1
    body.velocity = (0, -1)
    space.step(DT)
    assert body.velocity.y == pytest.approx(0.0, abs=EXACT)  # the shapes' own elasticity
    assert len(impacts.collisions()) == 1
    with pytest.raises(RuntimeError, match="detached"):
        impacts.add_bead(circle)
    again = attach(space, Stub(0.25))
    assert again.add_bead(circle) == 0
    assert again.bead_type != impacts.bead_type


def test_attach_twice_is_refused():
    space, _, impacts = drop(Stub())
    with pytest.raises(RuntimeError, match="attached already; detach"):
        attach(space, Stub())


@pytest.mark.parametrize("method", ["step", "on_collision"])
def test_a_method_of_the_users_own_is_kept(method):
    space, calls = make_space(0.0), []

    def own(*args, **kwargs):
        calls.append(args)
        getattr(pymunk.Space, method)(space, *args, **kwargs)

    setattr(space, method, own)
    impacts = attach(space, Stub())
    space.step(DT)
    impacts.detach()
    assert calls and getattr(space, method) is own


@pytest.mark.parametrize("duplicate", [copy.deepcopy, pymunk.Space.copy, pickle.dumps])
def test_copies_are_refused_while_attached(duplicate):
    space, _, impacts = drop(Stub())
    with pytest.raises(TypeError, match="detach"):
        duplicate(space)
    space.step(DT)
    impacts.detach()
    duplicate(space)


def test_other_contacts_and_handlers_are_untouched():
    space, body, impacts = drop(Stub(0.5), gravity=0.0)
    calls = []
    space.on_collision(impacts.bead_type, 7, begin=lambda *_: calls.append("goal"))
    space.on_collision(None, None, pre_solve=lambda *_: calls.append("any"))
    stranger = make_bead(space, (0.5, 1.01 * R), (0, -2))
    stranger.elasticity = body_elasticity = 0.9
    wall = make_plate(space, (-0.1, 5 * R), (0.1, 5 * R))
    wall.elasticity, wall.collision_type = 0.8, 7
    (bead,) = body.shapes
    bead.elasticity = body_elasticity
    for segment in space.static_body.shapes:
        segment.elasticity = 0.8
    space.step(DT)
    assert stranger.body.velocity.y == pytest.approx(2 * 0.9 * 0.8, abs=EXACT)
    assert body.velocity.y == pytest.approx(2 * 0.5, abs=EXACT)
    assert calls == ["any", "any"]
    room.steps(space, 50)
    assert "goal" in calls
    assert body.velocity.y == pytest.approx(-1 * 0.9 * 0.8, abs=EXACT)
    assert len(impacts.collisions()) == 1


def test_beads_and_plates_come_and_go():
    space, body, impacts = drop(Stub(0.5))
    (bead,), (plate,) = body.shapes, space.static_body.shapes
    space.on_collision(impacts.bead_type, impacts.plate_type, post_solve=lambda *_: space.remove(bead, body))
    space.step(DT)
    assert body not in space.bodies
    room.steps(space, 3)
    late = make_bead(space, (0, R), (0, -2))
    assert impacts.add_bead(late) == 1
    space.add(body, bead)
    body.position, body.velocity = (0.3, R), (0, -3)
    space.step(DT)
    space.remove(plate)
    for circle in (late, bead):
        if circle.body in space.bodies:
            circle.body.velocity = (0, -1)
    room.steps(space, 50)
    rows = impacts.collisions()
    assert rows["bead"].tolist().count(0) == 2 and rows["bead"].tolist().count(1) == 1


def test_slop_is_lowered_so_that_resting_beads_do_not_stay_in_the_plate():
    space, body, impacts = drop(Stub(0.0), speed=0.8 * R / DT, gap=0.0)
    space.step(DT)
    assert body.position.y < 0.3 * R
    room.steps(space, 5000)
    assert body.position.y == pytest.approx(0.9 * R, rel=0.05)  # pymunk's bias: 10 % in 1/60 s
    space.collision_slop = 0.05 * R
    impacts.add_bead(make_bead(space, (1, 1)))
    assert space.collision_slop == 0.05 * R  # small enough


@pytest.mark.parametrize(
    ("change", "error", "match"),
    [
        (lambda c: "bead", TypeError, "expected a pymunk.Circle, got 'bead'"),
        (lambda c: pymunk.Circle(c.body, R, (0, R)), ValueError, "circle.body: .*a single sphere: give each"),
        (lambda c: setattr(c.body, "center_of_gravity", (R, 0)), ValueError, "centre of gravity"),
        (lambda c: pymunk.Circle(pymunk.Body(1, 1), R, (0, R)), ValueError, "a single sphere"),
        (lambda c: pymunk.Circle(None, R), ValueError, "no body"),
        (lambda c: pymunk.Circle(c.space.static_body, R), ValueError, "dynamic body"),
        (lambda c: setattr(c, "sensor", True), ValueError, "sensor"),
        (lambda c: setattr(c, "collision_type", 3), ValueError, "collision_type: got 3"),
        (lambda c: c.unsafe_set_radius(0.0), ValueError, "radius.*0.0"),
        (lambda c: c.unsafe_set_radius(math.nan), ValueError, "radius.*nan"),
    ],
)
def test_what_is_no_bead(change, error, match):
    space, _, impacts = drop(Stub())
    circle = make_bead(space, (0, 1))
    with pytest.raises(error, match=match):
        impacts.add_bead(change(circle) or circle)
    assert impacts.add_bead(make_bead(space, (0, 2))) == 1


def test_registered_already():
    space, body, impacts = drop(Stub())
    (bead,), (plate,) = body.shapes, space.static_body.shapes
    for add in (lambda: impacts.add_bead(bead), lambda: impacts.add_plate(plate, 1e-3)):
        with pytest.raises(ValueError, match="registered already"):
            add()
    with pytest.raises(ValueError, match="circle.body: has other shapes"):
        impacts.add_bead(pymunk.Circle(body, R))


@pytest.mark.parametrize("thickness", [0, -1e-3, math.nan, "thin", None, [1e-3, 2e-3]])
def test_bad_thickness(thickness):
    space, _, impacts = drop(Stub())
    with pytest.raises(ValueError, match="thickness"):
        impacts.add_plate(make_plate(space), thickness)


def test_what_is_no_plate_and_no_model():
    space, _, impacts = drop(Stub())
    with pytest.raises(ValueError, match="no length"):
        impacts.add_plate(make_plate(space, (1, 1), (1, 1)), 1e-3)
    with pytest.raises(TypeError, match="pymunk.Segment or pymunk.Poly"):
        impacts.add_plate(pymunk.Circle(space.static_body, R), 1e-3)
    with pytest.raises(TypeError, match="model.*0.5"):
        attach(pymunk.Space(), 0.5)
    with pytest.raises(TypeError, match="space"):
        attach("space", Stub())


def test_a_copied_bead_must_be_registered():
    space, body, impacts = drop(Stub(0.5), gravity=0.0)
    (bead,) = body.shapes
    twin = bead.copy()  # with its body
    other = twin.body
    other.position = (0.5, R)
    space.add(other, twin)
    with pytest.raises(ValueError, match="never registered"):
        space.step(DT)
    other.velocity = (0, -1)
    assert impacts.add_bead(twin) == 1
    space.step(DT)
    assert other.velocity.y == pytest.approx(0.5, abs=EXACT)
    space.add(third := pymunk.Body(1, 1), copy := pymunk.Circle(third, R))
    copy.collision_type = impacts.bead_type  # as that of a copy that nobody registers
    impacts.detach()
    assert not twin.collision_type


def test_without_pymunk(monkeypatch):
    monkeypatch.setitem(sys.modules, "pymunk", None)
    with pytest.raises(ImportError, match=r"pip install contactlaw\[demo\]"):
        attach(object(), Stub())
