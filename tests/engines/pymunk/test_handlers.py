"""Handlers of the user on the adapter's collision types: nobody's pushes out the other's."""

import pymunk
import pymunk_room as room
import pytest
from pymunk_room import DT, EXACT, R, Stub, drop, make_bead, make_plate, make_space

# Every way to name the contact of a bead and a plate in pymunk.
KEYS = {
    "own": lambda i: (i.bead_type, i.plate_type),
    "the other way round": lambda i: (i.plate_type, i.bead_type),
    "bead and any": lambda i: (i.bead_type, None),
    "plate and any": lambda i: (i.plate_type, None),
    "any": lambda i: (None, None),
}


@pytest.fixture(params=list(KEYS))
def key(request):
    return KEYS[request.param]


def test_a_users_pre_solve_and_the_model_are_both_heard(key):
    space, body, impacts = drop(Stub(0.6), gravity=0.0)
    seen = []
    space.on_collision(*key(impacts), pre_solve=lambda arbiter, space, data: seen.append(data), data="mine")
    space.step(DT)
    assert body.velocity.y == pytest.approx(2 * 0.6, abs=EXACT)
    assert impacts.collisions()["restitution"].tolist() == [0.6]
    assert seen == ["mine"]


@pytest.mark.parametrize("phase", ["begin", "post_solve", "separate"])
def test_other_phases_are_as_they_were(key, phase):
    space, body, impacts = drop(Stub(0.6), gravity=0.0)
    seen = []
    handler = {phase: lambda arbiter, space, data: seen.append(data)}
    space.on_collision(*key(impacts), data="mine", **handler)
    room.steps(space, 20)
    assert body.velocity.y == pytest.approx(2 * 0.6, abs=EXACT)
    assert len(impacts.collisions()) == 1
    assert seen[0] == "mine"


def test_a_handler_for_any_type_that_was_there_before():
    space = make_space(0.0)
    seen = []
    override = []

    def pre_solve(arbiter, space, data):
        seen.append(data)
        if override:
            arbiter.restitution = override[0]

    space.on_collision(None, None, pre_solve=pre_solve, data=7)
    circle = make_bead(space, (0, 1.01 * R), (0, -2))
    room.registered(space, Stub(0.6), [circle], [make_plate(space)])
    space.step(DT)
    assert circle.body.velocity.y == pytest.approx(2 * 0.6, abs=EXACT)
    assert seen == [7]
    override.append(0.25)
    circle.body.velocity = (0, -2)
    with pytest.raises(RuntimeError, match=r"restitution to 0.25 .* the model answers"):
        space.step(DT)


def test_what_the_user_changes_in_a_contact_stays(key):
    space, body, impacts = drop(Stub(0.6), gravity=0.0)
    body.velocity = (1.0, -2.0)

    space.on_collision(*key(impacts), pre_solve=room.setting(friction=0.25))
    space.step(DT)
    assert body.velocity.y == pytest.approx(2 * 0.6, abs=EXACT)
    # Coulomb: 0.25 times the normal impulse, while the surface still slips (it needs 2/7 of 1 m/s)
    assert body.velocity.x == pytest.approx(1 - 2 / 7, abs=1e-9)
    assert 2 / 7 < 0.25 * (1 + 0.6) * 2


def test_a_contact_that_the_user_switches_off_in_pre_solve_is_no_impact(key):
    space, body, impacts = drop(Stub(), gravity=0.0)

    space.on_collision(*key(impacts), pre_solve=room.setting(process_collision=False))
    for _ in range(30):
        space.step(DT)
        assert len(impacts.collisions()) == 0
    assert body.velocity.y == -2 and body.position.y < 0


@pytest.mark.parametrize("pair", ["own", "bead and any", "any"])
def test_a_contact_of_beads_that_is_switched_off_is_no_impact(pair):
    space, _, impacts = room.meet(Stub(0.8))

    own = (impacts.bead_type, impacts.bead_type)
    space.on_collision(
        *(own if pair == "own" else KEYS[pair](impacts)), pre_solve=room.setting(process_collision=False)
    )
    room.steps(space, 5)
    assert len(impacts.collisions()) == 0


def test_a_restitution_of_the_users_is_refused(key):
    space, body, impacts = drop(Stub(0.6), gravity=0.0)

    space.on_collision(*key(impacts), pre_solve=room.setting(restitution=0.25))
    with pytest.raises(RuntimeError, match=r"restitution to 0.25 .* the model answers"):
        space.step(DT)


def test_a_restitution_for_other_shapes_is_the_users(key):
    """Handlers for any collision type also get contacts that are not the adapter's."""
    space, _, impacts = drop(Stub(0.6), gravity=0.0)
    stranger = make_bead(space, (0.5, 1.01 * R), (0, -2))  # not registered, on the plate

    def pre_solve(arbiter, space, data):
        if stranger in arbiter.shapes:
            arbiter.restitution = 0.25

    space.on_collision(*key(impacts), pre_solve=pre_solve)
    space.step(DT)
    expected = 2 * 0.25 if None in key(impacts)[1:] and key(impacts)[0] != impacts.bead_type else 0
    assert stranger.body.velocity.y == pytest.approx(expected, abs=EXACT)
    assert len(impacts.collisions()) == 1


def test_an_error_in_a_pre_solve_of_the_users_reaches_the_caller(key):
    space, _, impacts = drop(Stub(), gravity=0.0)

    def pre_solve(arbiter, space, data):
        raise LookupError("mine")

    space.on_collision(*key(impacts), pre_solve=pre_solve)
    with pytest.raises(LookupError, match="mine"):
        space.step(DT)


def test_a_handler_is_taken_back_as_in_pymunk(key):
    space, body, impacts = drop(Stub(0.6), gravity=0.0)
    seen = []
    for name in ("first", "second"):
        space.on_collision(*key(impacts), pre_solve=lambda *a: seen.append(a[2]), data=name)
    space.step(DT)
    assert seen == ["second"]  # the last one of a key, as ever
    space.on_collision(*key(impacts), pre_solve=pymunk.empty_callback)
    body.position, body.velocity = (0, 0.99 * R), (0, -2)
    space.step(DT)
    assert seen == ["second"]
    assert len(impacts.collisions()) == 2


def test_a_handler_that_is_made_in_a_step(key):
    space, body, impacts = drop(Stub(0.6), gravity=0.0)
    seen = []

    def begin(arbiter, space, data):
        space.on_collision(*key(impacts), pre_solve=lambda *a: seen.append(1))

    space.on_collision(impacts.bead_type, impacts.plate_type, begin=begin)
    space.step(DT)
    assert body.velocity.y == pytest.approx(2 * 0.6, abs=EXACT)
    assert len(impacts.collisions()) == 1
    # pymunk chose handlers other than (None, None) and our own before, for this contact.
    body.position, body.velocity = (0, 0.99 * R), (0, -2)
    space.step(DT)
    assert seen in ([1], [1, 1]) and len(impacts.collisions()) == 2


def test_detach_leaves_the_users_handlers(key):
    space, body, impacts = drop(Stub(0.6), gravity=0.0)
    seen = []
    space.on_collision(*key(impacts), pre_solve=lambda *a: seen.append(a[2]), data=3)
    impacts.detach()
    assert "on_collision" not in vars(space)
    circle, plate = *body.shapes, *space.static_body.shapes
    circle.collision_type, plate.collision_type = impacts.bead_type, impacts.plate_type
    circle.elasticity = plate.elasticity = 0.5
    space.step(DT)
    assert seen == [3] and body.velocity.y == pytest.approx(2 * 0.25, abs=EXACT)
    assert len(impacts.collisions()) == 0


@pytest.mark.parametrize(
    ("values", "speed"),
    [({"process_collision": False}, -1.0), ({"friction": 0.3}, 0.0), ({"restitution": 0.25}, 0.25)],
    ids=str,
)
def test_contacts_of_two_plates_are_the_users(values, speed):
    space, body = make_space(0.0), pymunk.Body(1e-3, 1e-6)
    body.position, body.velocity = (0, 0.999 * R), (0, -1)
    lid = pymunk.Poly.create_box(body, (4 * R, 2 * R))
    space.add(body, lid)
    impacts = room.registered(space, Stub(0.6), [], [make_plate(space), lid])
    space.on_collision(None, None, pre_solve=room.setting(**values))
    space.step(DT)
    assert body.velocity.y == pytest.approx(speed, abs=0.01)  # it also turns
    assert not len(impacts.collisions())
