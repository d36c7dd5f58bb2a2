"""Tunnelling, and numbers that are not finite, are found before the step."""

import math
import pickle
import resource

import pymunk
import pymunk_room as room
import pytest
from pymunk_room import DT, EXACT, R, Stub, drop, make_bead, make_plate, make_space

from contactlaw.engines.pymunk import TunnellingError, attach

BOX = [(-0.02, -2 * R), (0.02, -2 * R), (0.02, 0), (-0.02, 0)]


@pytest.mark.parametrize("ratio", [0.5, 0.99, 1.5, 50.0])
@pytest.mark.parametrize("plate, side", [((), 1), ((), -1), (BOX, 1)], ids=["above", "below", "box"])
@pytest.mark.parametrize("offset", [-0.005, 0.6, 0.99])
def test_a_fast_bead_rebounds_or_is_reported(ratio, plate, side, offset):
    """A step covers half a radius to fifty, and the contact begins anywhere within the step or before."""
    space, speed = make_space(), ratio * R / DT
    bead = make_bead(space, (0, side * (R + offset * speed * DT)), (0.1, -side * speed))
    impacts, body = room.registered(space, Stub(0.7), [bead], [make_plate(space, *plate)]), bead.body
    depth = (1 - offset) * ratio  # how far the first overlapping step goes in, in radii
    dt, state = DT, (body.position, body.velocity)
    if depth >= 1:
        with pytest.raises(TunnellingError, match="bead 0 would pass unnoticed") as caught:
            space.step(DT)
        error = caught.value
        assert (error.bead, error.plate) == (0, 0)
        assert error.time == pytest.approx(DT, rel=EXACT)
        assert error.speed == pytest.approx(speed, rel=EXACT)
        assert error.safe_step == pytest.approx(R / speed + min(offset, 0.0) * DT, rel=EXACT)
        assert pickle.loads(pickle.dumps(error)).safe_step == error.safe_step
        # The space is as it was: the same bead rebounds with a step below the safe one. (At 0.99999
        # of it the centre ends at 1e-8 m from the line, where roundings tilt the normal.)
        assert (body.position, body.velocity) == state and impacts.time == 0.0
        dt = 0.99 * error.safe_step
    _, before = room.step_to_impact(space, impacts, body, dt)
    assert body.velocity.y == pytest.approx(-0.7 * before.y, abs=EXACT * speed)


@pytest.mark.parametrize(
    ("motion", "height", "fall", "speed"),
    [
        ({"spin": 100.0}, 0.003, 0.0, 100.0),  # at a distance of 1 m it sweeps over 10 mm a step
        ({"velocity": (0, 100.0)}, 0.003, 0.0, 100.0),
        ({"velocity": (0, 0.6 * R / DT)}, R, 0.6 * R / DT, 1.2 * R / DT),  # each travels less than a radius
    ],
)
def test_a_fast_plate_is_reported(motion, height, fall, speed):
    space = make_space()
    body = room.moving_body(space, position=(-1, 0), **motion)
    bead, plate = make_bead(space, (0, height), (0, -fall)), make_plate(space, (0, 0), (1.5, 0), body=body)
    room.registered(space, Stub(), [bead], [plate])
    with pytest.raises(TunnellingError) as caught:
        space.step(DT)
    assert caught.value.speed == pytest.approx(speed, rel=1e-2)  # the arc against its chord


def test_the_worst_of_several_is_named():
    """Beads that have left the attachment do not count, however small they are."""
    space = make_space()
    impacts = attach(space, Stub())
    for x, radius in ((-1, 0.0), (0, R)):
        impacts.add_plate(make_plate(space, (x, 0), (x + 0.9, 0), radius=radius), 1e-3)
    beads = [make_bead(space, (x, 2.1 * R), (0, -speed)) for x, speed in ((-0.5, 30), (0.5, 90), (0.6, 30))]
    for circle in beads:
        impacts.add_bead(circle)
    with pytest.raises(TunnellingError) as caught:
        space.step(DT)
    error = caught.value
    assert (error.bead, error.plate) == (1, 1)
    assert error.safe_step == pytest.approx(R / 90, rel=EXACT)
    impacts.add_bead(make_bead(space, (0.2, 7 * R), (0, -20), radius=5 * R))
    for circle in beads:
        impacts.remove_bead(circle)
    space.step(DT)
    assert impacts.collisions()["bead"].tolist() == [3]


def test_what_is_no_tunnelling():
    space = make_space()
    impacts = attach(space, Stub())
    plate, gone = make_plate(space, (0, 0), (1, 0)), make_plate(space, (2, 0), (3, 0))
    for segment in (plate, gone):
        impacts.add_plate(segment, 1e-3)
    beside = make_bead(space, (-2 * R, 1.5 * R), (0, -50))
    along = make_bead(space, (0.5, 1.1 * R), (50, 0))
    filtered, grouped, removed, over_nothing = (make_bead(space, (x, 1.5 * R), (0, -50)) for x in (0.2, 0.3, 0.7, 2.5))
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
    space, body, impacts = drop(Stub(), speed=0, gap=-0.95 * R)
    space.step(DT)  # rests, deep in the plate: 0.05 R before its middle
    body.velocity = (0, -0.1 * R / DT)
    with pytest.raises(TunnellingError, match="pressed through plate 0") as caught:
        space.step(DT)
    assert caught.value.safe_step is None


@pytest.mark.parametrize("which", ["bead 1", "plate 0"])
@pytest.mark.parametrize("name", ["position", "velocity"])
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_numbers_that_are_not_finite_are_found_before_the_step(which, name, value):
    space = make_space()
    mount, bad = room.moving_body(space), make_bead(space, (10 * R, 1))
    _, body, impacts = drop(Stub(), space=space, mount=mount)
    impacts.add_bead(bad)
    setattr(bad.body if which == "bead 1" else mount, name, (0, value))
    before = body.position
    with pytest.raises(ValueError, match=f"{which}: not finite: .*{name} .*{value}"):
        space.step(DT)
    assert (impacts.time, body.position) == (0.0, before)


def test_steps_take_no_more_memory():
    """pymunk never frees the memory of a `Buffer`; one for each step took 6 kB a step for 150 bodies."""
    space = make_space()
    circles = [make_bead(space, (0.01 * n, 0.01)) for n in range(150)]
    room.registered(space, Stub(), circles, [make_plate(space)])
    room.steps(space, 200)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    room.steps(space, 3000)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 6000  # [kB]; 19000 with the leak
