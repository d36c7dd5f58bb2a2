"""Whatever goes wrong in a callback reaches the caller of `space.step`."""

import math
import re
from types import SimpleNamespace

import pymunk
import pymunk_room as room
import pytest
from pymunk_room import DT, EXACT, R, Stub, drop, make_bead


@pytest.mark.parametrize("error", [KeyError("x"), ZeroDivisionError(), KeyboardInterrupt()])
def test_exception_in_the_model_reaches_the_caller(error):
    def answer(speed):
        if speed > 1.5:
            raise error
        return 0.5

    space, body, impacts = drop(Stub(answer), speed=2.0, gravity=0.0)
    slow = make_bead(space, (10 * R, 1.005 * R), (0, -1))
    impacts.add_bead(slow)
    for shape in space.shapes:
        shape.elasticity = 0.9  # pymunk's own restitution, which must not be used
    with pytest.raises(type(error)) as caught:
        room.steps(space, 10)
    assert caught.value is error and "answer" in [entry.name for entry in caught.traceback]
    # The engine has finished the step: no rebound in the failed contact, the other one is right.
    assert impacts.time == DT
    assert body.velocity.y == pytest.approx(0.0, abs=EXACT)
    assert slow.body.velocity.y == pytest.approx(0.5, abs=EXACT)
    assert impacts.collisions()["bead"].tolist() == [1]
    body.velocity = (0, -1)
    space.step(DT)
    assert body.velocity.y == pytest.approx(0.5, abs=EXACT)


@pytest.mark.parametrize(
    ("errors", "raised"), [((KeyError, IndexError), KeyError), ((KeyError, KeyboardInterrupt), KeyboardInterrupt)]
)
def test_the_first_of_several_errors_or_the_interrupt_is_raised(errors, raised):
    left = list(errors)

    def answer(speed):
        raise left.pop(0)

    space, _, impacts = drop(Stub(answer), gravity=0.0)
    impacts.add_bead(make_bead(space, (10 * R, 1.01 * R), (0, -2)))
    with pytest.raises(raised):
        space.step(DT)
    assert not left


@pytest.mark.parametrize("answer", [math.nan, -0.1, 1.0001, math.inf])
def test_bad_restitution_never_reaches_the_engine(answer):
    space, body, impacts = drop(Stub(answer), speed=2.0, gravity=0.0)
    with pytest.raises(ValueError, match=rf"\[0, 1\].*{answer}") as caught:
        space.step(DT)
    assert "bead 0 on plate 0 at 2 m/s" in caught.value.__notes__[0]
    assert body.velocity.y == pytest.approx(0.0, abs=EXACT)
    assert len(impacts.collisions()) == 0


def test_bad_restitution_between_beads():
    space, _, _ = room.meet(Stub(math.nan))
    with pytest.raises(ValueError) as caught:
        space.step(DT)
    assert re.search(r"bead \d on bead \d at 2 m/s", caught.value.__notes__[0])


def test_beads_meet_without_a_law_for_them():
    space, _, _ = room.meet(SimpleNamespace(curve=lambda radius, thickness: lambda speed: 0.5))
    with pytest.raises(TypeError, match="sphere_sphere_curve"):
        space.step(DT)


@pytest.mark.parametrize("phase", ["begin", "pre_solve", "post_solve", "separate"])
@pytest.mark.parametrize("error", [LookupError("mine"), KeyboardInterrupt()])
def test_exception_in_a_handler_of_the_user(phase, error):
    space, _, impacts = drop(Stub())

    def fail(arbiter, space, data):
        raise error

    space.on_collision(impacts.bead_type, impacts.plate_type, **{phase: fail})
    with pytest.raises(type(error)) as caught:
        room.steps(space, 20)
    assert caught.value is error
    space.on_collision(impacts.bead_type, impacts.plate_type, **{phase: pymunk.empty_callback})
    room.steps(space, 20)


@pytest.mark.parametrize("dt", [0.0, -1e-4, math.nan, math.inf])
def test_bad_step(dt):
    space, _, _ = drop(Stub())
    with pytest.raises(ValueError, match="dt"):
        space.step(dt)
