"""What pymunk's adapter refuses: arguments in words, and in a step whatever goes wrong in a callback."""

import copy
import math
import re
import sys
from types import SimpleNamespace

import pymunk
import pymunk_room as room
import pytest
from pymunk_room import DT, EXACT, R, Stub, drop, make_bead, make_plate

import contactlaw as cl
from contactlaw.engines.pymunk import attach

MODEL = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
PIPE = cl.Shell(0.5e-3, 8 * R)


class Scene:
    """A space with a bead and a plate, and a circle and a segment that are not registered."""

    def __init__(self, model):
        self.space, body, self.impacts = drop(model)
        (self.bead,), (self.floor,) = body.shapes, self.space.static_body.shapes
        self.circle, self.segment = make_bead(self.space, (0, 1)), make_plate(self.space)

    def add_bead(self, circle=None, **changes):
        circle = circle or self.circle
        for name, value in changes.items():
            setattr(circle, name, value)
        self.impacts.add_bead(circle)

    def add_plate(self, thickness=1e-3, shape=None, **options):
        self.impacts.add_plate(shape or self.segment, thickness, **options)


REFUSED = {
    ValueError: [
        (lambda at: at.add_bead(pymunk.Circle(at.circle.body, R, (0, R))), "single sphere: give each"),
        (lambda at: at.add_bead(pymunk.Circle(at.bead.body, R)), "circle.body: has other shapes"),
        (lambda at: (setattr(at.circle.body, "center_of_gravity", (R, 0)), at.add_bead()), "centre of gravity"),
        (lambda at: at.add_bead(pymunk.Circle(at.space.static_body, R)), "dynamic body"),
        (lambda at: at.add_bead(sensor=True), "sensor"),
        (lambda at: at.add_bead(collision_type=3), "collision_type: got 3"),
        (lambda at: at.add_bead(make_bead(at.space, (0, 50), radius=20.0)), "radius: got 20.0; .*pixels"),
        (lambda at: at.add_bead(at.bead), "registered already"),
        (lambda at: at.impacts.add_bead(at.circle, material="gold"), "spheres of 'gold'.* 'gamma-alumina'"),
        (lambda at: at.impacts.remove_bead(at.floor), "is no such bead or plate"),
        (lambda at: at.add_plate(-1e-3), "thickness"),
        (lambda at: at.add_plate(shape=make_plate(at.space, (1, 1), (1, 1))), "no length"),
        (lambda at: at.add_plate(material="gold"), "plates of 'gold', only for 'glass'"),
        (lambda at: at.add_plate(friction=-0.2), "friction"),
        (lambda at: at.add_plate(edge="loose"), "edge: got .*must be one of free, supported, clamped"),
        (lambda at: at.add_plate(PIPE, edge="free"), "only bare sheets have edges"),
        (lambda at: at.add_plate(cl.Layers([("pmma", 1e-3)])), "beads touch 'pmma'"),
        (lambda at: attach(pymunk.Space(), []), "empty"),
        (lambda at: attach(pymunk.Space(), [MODEL, MODEL]), "two are for gamma-alumina on glass"),
        (lambda at: at.space.step(0.0), "dt"),
    ],
    TypeError: [
        (lambda at: at.add_bead("bead"), "expected a pymunk.Circle, got 'bead'"),
        (lambda at: at.add_plate(shape=at.circle), "pymunk.Segment or pymunk.Poly"),
        (lambda at: attach(pymunk.Space(), 0.5), "model.*0.5"),
        (lambda at: copy.deepcopy(at.space), "detach"),
    ],
    RuntimeError: [
        (lambda at: attach(at.space, MODEL), "attached already; detach"),
        (lambda at: (at.impacts.detach(), at.add_bead()), "detached"),
        (lambda at: (at.impacts.detach(), at.impacts.loads()), "loads: the plates were detached"),
    ],
}


@pytest.mark.parametrize(("error", "call", "words"), [(error, *row) for error, rows in REFUSED.items() for row in rows])
def test_what_is_refused_changes_nothing(error, call, words):
    at = Scene(MODEL)
    with pytest.raises(error, match=words):
        call(at)
    assert (len(at.impacts.beads()), len(at.impacts.plates())) == (1, 1)
    assert at.segment.collision_type == 0 and at.circle.collision_type in (0, 3)


@pytest.mark.parametrize(
    ("thickness", "options", "lacks"),
    [(PIPE, {}, "pair"), (1e-3, {"friction": 0.2}, "oblique"), (1e-3, {"edge": "free"}, "edge_kernel")],
)
def test_a_plate_that_the_model_does_not_know_is_refused(thickness, options, lacks):
    with pytest.raises(TypeError, match=f"has no {lacks}, which this thickness, friction or edge takes"):
        Scene(Stub()).add_plate(thickness, **options)


def test_without_pymunk(monkeypatch):
    monkeypatch.setitem(sys.modules, "pymunk", None)
    with pytest.raises(ImportError, match=r"pip install contactlaw\[demo\]"):
        attach(object(), Stub())


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda at: at.add_bead(make_bead(at.space, (0, 1), radius=0.9)), "radius: 0.9 is 0.9 m; 0.9e-3 for 0.9 mm"),
        (lambda at: at.add_plate(1.0), "thickness: 1 is 1 m; 1e-3 for 1 mm"),
        (lambda at: at.add_bead(make_bead(at.space, (0, 1), density=879 * 8)), "body.mass: .* 2.684e-06 kg.*set"),
    ],
)
def test_sizes_in_millimetres_and_masses_that_are_not_the_spheres_draw_a_warning(call, words):
    at = Scene(MODEL)
    for factor in (0.75, 1.4):  # such masses draw none
        at.add_bead(make_bead(at.space, (0, 1), density=879.0 * factor))
    with pytest.warns(UserWarning, match=words) as caught:
        call(at)
    assert caught[0].filename == __file__


# --- in a step ------------------------------------------------------------------------------------


def with_moment(factor):
    """A bead of another moment of inertia, over mass times the square of the radius, on a plate with friction."""
    space, body, impacts = drop(MODEL, 2.0, 1.0, friction=0.3)
    body.moment = factor * body.mass * R**2
    return space, body, impacts


def on_steel():
    """A bead on a plate for which the bead's material has no model."""
    models = MODEL, cl.ImpactModel(cl.Pair("carbon-steel-1020", "carbon-steel-1020"), law="myc")
    space = room.make_space()
    impacts = attach(space, models)
    impacts.add_plate(make_plate(space), 1e-3, material="carbon-steel-1020")
    impacts.add_bead(circle := make_bead(space, (0, 1.01 * R), (0, -2)))
    return space, circle.body, impacts


def raising(error):
    def fail(*_):
        raise error

    return fail


SAID = "bead 0 on plate 0 at 2 m/s"
STEPS = {
    "nan": (lambda: drop(Stub(math.nan)), ValueError, r"\[0, 1\].*nan", SAID),
    "of beads": (lambda: room.meet(Stub(math.nan)), ValueError, "nan", r"bead \d on bead \d at 2 m/s"),
    "no law of beads": (
        lambda: room.meet(SimpleNamespace(curve=lambda *_: lambda speed: 0.5)),
        TypeError,
        "sphere_sphere_curve",
        "bead",
    ),
    "a foil": (lambda: drop(MODEL, thickness=0.05e-3), ValueError, "inelasticity|lambda", SAID),  # lambda is about 20
    "stiff": (lambda: drop(MODEL, thickness=cl.Foundation(1e-3, 1e16)), ValueError, "swings", SAID),
    "no model": (on_steel, ValueError, r"Pair\('gamma-alumina', 'carbon-steel-1020'\)", SAID),
    "a disc": (lambda: with_moment(0.5), ValueError, r"body.moment: .* 2/5\*body.mass.*moment_for_circle", SAID),
}


@pytest.mark.parametrize("case", STEPS)
def test_an_impact_without_an_answer_is_an_error_of_the_step_that_names_it(case):
    make, error, words, note = STEPS[case]
    space, bodies, impacts = make()
    with pytest.raises(error, match=words) as caught:
        space.step(DT)
    assert re.search(note, caught.value.__notes__[0])
    assert len(impacts.collisions()) == 0


@pytest.mark.parametrize("error", [KeyError("x"), ZeroDivisionError(), KeyboardInterrupt()])
def test_an_error_in_the_model_reaches_the_caller_after_the_step(error):
    def answer(speed):
        if speed > 1.5:
            raise error
        return 0.5

    space, body, impacts = drop(Stub(answer))
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
    space, _, impacts = drop(Stub(lambda speed: raising(left.pop(0))()))
    impacts.add_bead(make_bead(space, (10 * R, 1.01 * R), (0, -2)))
    with pytest.raises(raised):
        space.step(DT)
    assert not left


@pytest.mark.parametrize("phase", ["begin", "pre_solve", "post_solve", "separate"])
@pytest.mark.parametrize("error", [LookupError("mine"), KeyboardInterrupt()])
def test_an_error_in_a_handler_of_the_user_reaches_the_caller(phase, error):
    space, _, impacts = drop(Stub())
    space.on_collision(impacts.bead_type, impacts.plate_type, **{phase: raising(error)})
    with pytest.raises(type(error)) as caught:
        room.steps(space, 20)
    assert caught.value is error
