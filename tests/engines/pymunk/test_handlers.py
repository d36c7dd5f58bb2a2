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


@pytest.fixture
def scene():
    return drop(Stub(0.6))


@pytest.mark.parametrize("phase", ["begin", "pre_solve", "post_solve", "separate"])
def test_a_handler_is_called_beside_the_model_until_it_is_taken_back(key, phase, scene):
    space, body, impacts = scene
    seen = []
    for name in ("first", "second"):
        space.on_collision(*key(impacts), **{phase: lambda *contact: seen.append(contact[2])}, data=name)
    room.steps(space, 20)
    assert body.velocity.y == pytest.approx(2 * 0.6, abs=EXACT)
    assert set(seen) == {"second"}  # the last one of a key, as ever
    count = len(seen)
    space.on_collision(*key(impacts), **{phase: pymunk.empty_callback})
    body.position, body.velocity = (0, 0.99 * R), (0, -2)
    room.steps(space, 20)
    assert len(seen) == count and impacts.collisions()["restitution"].tolist() == [0.6, 0.6]


def test_a_contact_that_the_user_switches_off_in_pre_solve_is_no_impact(key, scene):
    """Whether of a bead and a plate or of two beads."""
    space, body, impacts = scene
    space.on_collision(*key(impacts), pre_solve=room.setting(process_collision=False))
    for _ in range(30):
        space.step(DT)
        assert len(impacts.collisions()) == 0
    assert body.velocity.y == -2 and body.position.y < 0
    space, _, impacts = room.meet(Stub(0.8))
    types = [impacts.bead_type if one == impacts.plate_type else one for one in key(impacts)]
    space.on_collision(*types, pre_solve=room.setting(process_collision=False))
    room.steps(space, 5)
    assert len(impacts.collisions()) == 0


@pytest.mark.parametrize("earlier", [False, True])
def test_a_restitution_of_the_users_is_refused(key, earlier):
    """Also of a handler for any types that was there before the adapter."""
    space = make_space()
    if earlier:
        space.on_collision(None, None, pre_solve=room.setting(restitution=0.25))
    _, _, impacts = drop(Stub(0.6), space=space)
    if not earlier:
        space.on_collision(*key(impacts), pre_solve=room.setting(restitution=0.25))
    with pytest.raises(RuntimeError, match=r"restitution to 0.25 .* the model answers"):
        space.step(DT)


def test_a_restitution_for_other_shapes_is_the_users(key, scene):
    """Handlers for any collision type also get contacts that are not the adapter's."""
    space, body, impacts = scene
    stranger = make_bead(space, (0.5, 1.01 * R), (0, -2))  # not registered, on the plate

    def pre_solve(arbiter, space, data):
        if stranger in arbiter.shapes:
            arbiter.restitution = 0.25

    space.on_collision(*key(impacts), pre_solve=pre_solve)
    space.step(DT)
    expected = 2 * 0.25 if None in key(impacts)[1:] and key(impacts)[0] != impacts.bead_type else 0
    assert stranger.body.velocity.y == pytest.approx(expected, abs=EXACT)
    assert body.velocity.y == pytest.approx(2 * 0.6, abs=EXACT) and len(impacts.collisions()) == 1


def test_detach_leaves_the_users_handlers(key, scene):
    space, body, impacts = scene
    seen = []
    space.on_collision(*key(impacts), pre_solve=lambda *a: seen.append(a[2]), data=3)
    impacts.detach()
    circle, plate = *body.shapes, *space.static_body.shapes
    circle.collision_type, plate.collision_type = impacts.bead_type, impacts.plate_type
    circle.elasticity = plate.elasticity = 0.5
    space.step(DT)
    assert seen == [3] and body.velocity.y == pytest.approx(2 * 0.25, abs=EXACT)
    assert len(impacts.collisions()) == 0


def test_contacts_of_two_plates_are_the_users():
    space, body = make_space(), pymunk.Body(1e-3, 1e-6)
    body.position, body.velocity = (0, 0.999 * R), (0, -1)
    lid = pymunk.Poly.create_box(body, (4 * R, 2 * R))
    space.add(body, lid)
    impacts = room.registered(space, Stub(0.6), [], [make_plate(space), lid])
    space.on_collision(None, None, pre_solve=room.setting(restitution=0.25))
    space.step(DT)
    assert body.velocity.y == pytest.approx(0.25, abs=0.01)  # it also turns
    assert not len(impacts.collisions())
