"""Tunnelling, and numbers that are not finite, are found before the step."""

import math
import pickle
import resource

import pymunk
import pymunk_room as room
import pytest
from pymunk_room import DT, EXACT, R, Stub, drop, make_bead, make_plate, make_space

from contactlaw.engines.pymunk import TunnellingError, attach


@pytest.mark.parametrize("ratio", [0.5, 0.99, 1.5, 3.0, 50.0])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("offset", [0.01, 0.3, 0.6, 0.99])
def test_a_fast_bead_rebounds_or_is_reported(ratio, side, offset):
    """A step covers half a radius to fifty, and the contact begins anywhere within the step."""
    speed = ratio * R / DT
    space, body, impacts = drop(Stub(0.7), speed=0, gravity=0.0)
    body.position = (0, side * (R + offset * speed * DT))
    body.velocity = (0.1, -side * speed)
    depth = (1 - offset) * ratio  # how far the first overlapping step goes in, in radii
    if depth < 1:
        before, after = room.step_to_impact(space, impacts, body)
        assert after.y == pytest.approx(-0.7 * before.y, abs=EXACT * speed)
        return
    state = body.position, body.velocity
    with pytest.raises(TunnellingError, match="bead 0 would pass unnoticed") as caught:
        space.step(DT)
    error = caught.value
    assert (error.bead, error.plate) == (0, 0)
    assert error.time == pytest.approx(DT, rel=EXACT)
    assert error.speed == pytest.approx(speed, rel=EXACT)
    assert error.safe_step == pytest.approx(R / speed, rel=EXACT)
    # The space is as it was: the same bead rebounds with a step below the safe one. (At 0.99999
    # of it the centre ends at 1e-8 m from the line, where roundings tilt the normal.)
    assert (body.position, body.velocity) == state and impacts.time == 0.0
    before, after = room.step_to_impact(space, impacts, body, dt=0.99 * error.safe_step)
    assert after.y == pytest.approx(-0.7 * before.y, abs=EXACT * speed)
    assert pickle.loads(pickle.dumps(error)).safe_step == error.safe_step


def test_safe_step_of_a_bead_that_overlaps_already():
    space, body, _ = drop(Stub(), speed=1.2 * R / DT, gravity=0.0, gap=-0.5 * R)
    with pytest.raises(TunnellingError) as caught:
        space.step(DT)
    assert caught.value.safe_step == pytest.approx(0.5 / 1.2 * DT, rel=EXACT)


@pytest.mark.parametrize("motion", [{"spin": 100.0}, {"velocity": (0, 100.0)}], ids=str)
def test_a_fast_plate_is_reported(motion):
    space = make_space(0.0)
    body = room.moving_body(space, position=(-1, 0), **motion)
    room.registered(space, Stub(), [make_bead(space, (0, 0.003))], [make_plate(space, (0, 0), (1.5, 0), body=body)])
    # At a distance of 1 m the turning plate sweeps over 10 mm a step, too.
    with pytest.raises(TunnellingError) as caught:
        space.step(DT)
    assert caught.value.speed == pytest.approx(100.0, rel=1e-2)  # the arc against its chord


@pytest.mark.parametrize("share", [0.45, 0.6])
def test_what_bead_and_plate_travel_counts_together(share):
    """They move towards each other, each by less than a radius, and a bit of overlap is left."""
    space, speed = make_space(0.0), share * R / DT
    body = room.moving_body(space, velocity=(0, speed))
    bead = make_bead(space, (0, R), (0, -speed))
    impacts = room.registered(space, Stub(), [bead], [make_plate(space, body=body)])
    if share > 0.5:
        with pytest.raises(TunnellingError):
            space.step(DT)
        return
    space.step(DT)
    assert len(impacts.collisions()) == 1


def test_the_worst_of_several_is_named():
    space = make_space(0.0)
    impacts = attach(space, Stub())
    impacts.add_plate(make_plate(space, (-1, 0), (-0.1, 0)), 1e-3)
    impacts.add_plate(make_plate(space, (0, 0), (1, 0), radius=R), 1e-3)
    for x, speed in ((-0.5, 30), (0.5, 90), (0.6, 30)):
        impacts.add_bead(make_bead(space, (x, 2.1 * R), (0, -speed)))
    with pytest.raises(TunnellingError) as caught:
        space.step(DT)
    error = caught.value
    assert (error.bead, error.plate) == (1, 1)
    assert error.safe_step == pytest.approx(R / 90, rel=EXACT)


def test_what_is_no_tunnelling():
    space = make_space(0.0)
    impacts = attach(space, Stub())
    plate, gone = make_plate(space, (0, 0), (1, 0)), make_plate(space, (2, 0), (3, 0))
    for segment in (plate, gone):
        impacts.add_plate(segment, 1e-3)
    beside = make_bead(space, (-2 * R, 1.5 * R), (0, -50))
    along = make_bead(space, (0.5, 1.1 * R), (50, 0))
    filtered = make_bead(space, (0.2, 1.5 * R), (0, -50))
    over_nothing = make_bead(space, (2.5, 1.5 * R), (0, -50))
    removed = make_bead(space, (0.7, 1.5 * R), (0, -50))
    grouped = make_bead(space, (0.3, 1.5 * R), (0, -50))
    leaving = make_bead(space, (0.9, 0), (0, 50))  # put on the line, and off
    for circle in (beside, along, filtered, over_nothing, removed, grouped, leaving):
        impacts.add_bead(circle)
    filtered.filter = pymunk.ShapeFilter(categories=2)
    grouped.filter = pymunk.ShapeFilter(group=5)
    plate.filter = pymunk.ShapeFilter(group=5, mask=pymunk.ShapeFilter.ALL_MASKS() ^ 2)
    space.remove(gone, removed)
    space.step(DT)
    assert all(circle.body.position.y < 0 for circle in (filtered, removed, grouped))
    assert len(impacts.collisions()) == 0


def test_a_bead_that_is_pressed_through_is_reported():
    space, body, impacts = drop(Stub(), speed=0, gravity=0.0, gap=-0.95 * R)
    space.step(DT)  # rests, deep in the plate: 0.05 R before its middle
    body.velocity = (0, -0.1 * R / DT)
    with pytest.raises(TunnellingError, match="pressed through plate 0") as caught:
        space.step(DT)
    assert caught.value.safe_step is None


@pytest.mark.parametrize("name", ["position", "velocity"])
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_numbers_that_are_not_finite_are_found_before_the_step(name, value):
    space, body, impacts = drop(Stub())
    bad = make_bead(space, (10 * R, 1))
    impacts.add_bead(bad)
    setattr(bad.body, name, (0, value))
    before = body.position
    with pytest.raises(ValueError, match=f"bead 1: not finite: .*{name} .*{value}"):
        space.step(DT)
    assert (impacts.time, body.position) == (0.0, before)
    space.remove(bad, bad.body)
    space.step(DT)


def test_a_plate_that_is_not_finite():
    space = make_space()
    body = room.moving_body(space)
    room.registered(space, Stub(), [make_bead(space, (0, 1))], [make_plate(space, body=body)])
    body.velocity = (0, math.nan)
    with pytest.raises(ValueError, match="plate 0: not finite"):
        space.step(DT)


def test_steps_take_no_more_memory():
    """pymunk never frees the memory of a `Buffer`; one for each step took 6 kB a step for 150 bodies."""
    space = make_space(0.0)
    circles = [make_bead(space, (0.01 * n, 0.01)) for n in range(150)]
    room.registered(space, Stub(), circles, [make_plate(space)])
    room.steps(space, 200)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    room.steps(space, 3000)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 6000  # [kB]; 19000 with the leak
