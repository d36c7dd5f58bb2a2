"""Whatever goes wrong in a callback reaches the caller of `space.step`."""

import math
import signal
import sys
import threading
from types import SimpleNamespace

import pymunk_room as room
import pytest
from pymunk_room import DT, EXACT, R, Stub, drop, make_bead, make_plate, make_space

from contactlaw.engines.pymunk import attach


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
    with pytest.raises(ValueError, match=rf"\[0, 1\].*{answer}.*bead 0 on plate 0 at 2 m/s"):
        space.step(DT)
    assert body.velocity.y == pytest.approx(0.0, abs=EXACT)
    assert len(impacts.collisions()) == 0


def test_bad_restitution_between_beads():
    space, _, _ = room.meet(Stub(math.nan))
    with pytest.raises(ValueError, match=r"bead \d on bead \d at 2 m/s"):
        space.step(DT)


def test_beads_meet_without_a_law_for_them():
    space, _, _ = room.meet(SimpleNamespace(curve=lambda radius, thickness: lambda speed: 0.5))
    with pytest.raises(TypeError, match="sphere_sphere_curve"):
        space.step(DT)


def test_exception_in_a_worker_thread():
    space, _, _ = drop(Stub(math.nan))
    caught = []

    def work():
        try:
            space.step(DT)
        except ValueError as error:
            caught.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert len(caught) == 1


def test_exception_in_a_handler_of_the_user():
    space, _, impacts = drop(Stub())
    seen = sys.unraisablehook

    def begin(arbiter, space, data):
        raise LookupError("mine")

    space.on_collision(impacts.bead_type, impacts.plate_type, begin=begin)
    with pytest.raises(LookupError, match="mine"):
        space.step(DT)
    assert sys.unraisablehook is seen


def test_exception_in_another_thread_is_left_alone(monkeypatch):
    def fail(arbiter, space, data):
        raise LookupError("not ours")

    other, _, elsewhere = drop(Stub())
    elsewhere.detach()
    other.on_collision(0, 0, pre_solve=fail)

    def answer(speed):
        thread = threading.Thread(target=other.step, args=(DT,))
        thread.start()
        thread.join()
        return 0.5

    reports = []
    monkeypatch.setattr(sys, "unraisablehook", lambda report: reports.append(report.exc_value))
    space, _, _ = drop(Stub(answer))
    space.step(DT)
    assert [type(error) for error in reports] == [LookupError]


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no interval timer here")
def test_interrupt_is_never_lost():
    """A signal arrives mostly between pymunk's C code and our callback, where cffi swallows it."""
    space = make_space(0.0)
    impacts = attach(space, Stub(0.0))
    impacts.add_plate(make_plate(space), 1e-3)
    for k in range(300):
        impacts.add_bead(make_bead(space, (3 * k * R, 0.99 * R), (0, -1)))
    space.step(1e-6)

    def interrupt(number, frame):
        raise KeyboardInterrupt

    old = signal.signal(signal.SIGALRM, interrupt)
    try:
        for k in range(40):
            with pytest.raises(KeyboardInterrupt):
                signal.setitimer(signal.ITIMER_REAL, 1e-3 + 5e-5 * k)
                room.steps(space, 1000, 1e-6)  # 2 ms each
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, old)


@pytest.mark.parametrize("dt", [0.0, -1e-4, math.nan, math.inf])
def test_bad_step(dt):
    space, _, _ = drop(Stub())
    with pytest.raises(ValueError, match="dt"):
        space.step(dt)
