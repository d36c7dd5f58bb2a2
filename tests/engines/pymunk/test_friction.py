"""Friction in pymunk: the model's on plates that have a coefficient, the engine's elsewhere."""

import math
from types import SimpleNamespace

import numpy as np
import pymunk
import pymunk_room as room
import pytest
from pymunk_room import ALONG, EXACT, G, R, Stub, drop

from contactlaw.engines.record import Kind

H, MU = 1e-3, 0.3


def hit(space, impacts, body):
    """The row of the first impact, and velocity and spin before it, which do not change until then."""
    spin = body.angular_velocity
    row, before = room.step_to_impact(space, impacts, body, 1e-6)
    return row, before, spin


SOLVERS = {}, {"collision_slop": 1e-6, "collision_bias": 0.0}, {"iterations": 1}, {"threads": 2}
MOUNTS = {
    "still": None,
    "belt": None,
    "moves": lambda space: room.moving_body(space, (0.2, -0.4)),
    "turns": lambda space: room.moving_body(space, (0.2, -0.4), 20.0),
}


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("gravity", [0.0, G])
@pytest.mark.parametrize("motion", list(MOUNTS))
def test_an_isolated_impact_is_that_of_collide(model, motion, gravity, seed):
    random = np.random.default_rng(seed)
    angle, friction = random.uniform(0.0, 2.0 * math.pi), 10.0 ** random.uniform(-2.0, 0.0)
    slip, speed = random.uniform(-8.0, 8.0), 10.0 ** random.uniform(-0.3, 1.0)
    solver = SOLVERS[seed]
    space = pymunk.Space(threaded="threads" in solver)
    for name, value in (solver | {"gravity": (0, -gravity)}).items():
        setattr(space, name, value)
    mount = MOUNTS[motion] and MOUNTS[motion](space)
    space, bead, impacts = drop(model, speed, slip, angle, space=space, mount=mount, friction=friction)
    bead.angular_velocity = random.normal(scale=4000.0)
    (plate,) = (mount or space.static_body).shapes
    if motion == "belt":
        plate.surface_velocity = ALONG.rotated(angle) * -3.0
    row, before, spin = hit(space, impacts, bead)
    point = pymunk.Vec2d(row["x"], row["y"])
    normal = (bead.position - point).normalized()
    along = normal.perpendicular()
    wall = plate.surface_velocity + plate.body.velocity_at_world_point(point)
    velocity, turned = model.collide((*before, 0), (0, 0, spin), (*normal, 0), R, H, friction, (*wall, 0))
    fall = along * (-gravity * 1e-6 * along.y)  # along the plate it falls in every step
    assert bead.velocity - fall == pytest.approx(tuple(velocity[:2]), abs=1e-9)
    assert R * bead.angular_velocity == pytest.approx(R * turned[2], abs=1e-9)
    slip = (before - wall).dot(along) - R * spin
    answer = model.oblique(row["approach_speed"], abs(slip), R, H, friction)
    assert row["sliding_speed"] == pytest.approx(abs(slip), abs=1e-9)
    assert row["sliding_speed_after"] == pytest.approx(answer.sliding_speed, abs=1e-9)
    assert row["spin_z"] == pytest.approx(turned[2], abs=1e-9 / R)
    assert row["friction_energy"] == pytest.approx(answer.friction_energy, abs=1e-15)
    assert row[["bead", "plate", "other", "kind", "spin_x", "spin_y"]].tolist() == (0, 0, -1, Kind.IMPACT, 0.0, 0.0)
    assert row["time"] == impacts.time and bead.position.get_distance(point) == pytest.approx(R, abs=1e-15)
    velocity, turned = bead.velocity, bead.angular_velocity
    room.steps(space, 3, 1e-6)  # the bead still overlaps the plate
    assert bead.velocity == pytest.approx(tuple(velocity + (0, -3e-6 * gravity)), abs=1e-9)
    assert R * bead.angular_velocity == pytest.approx(R * turned, abs=1e-9)


def test_a_plate_that_is_free_has_the_reaction(model):
    """A light plate gets no more friction than Coulomb's law allows; momentum is kept."""
    space, plate = room.make_space(), pymunk.Body(1e-6, 3e-7)
    space.add(plate)
    _, bead, impacts = drop(model, 3.0, 1.0, space=space, mount=plate, friction=0.1)
    row, before, _ = hit(space, impacts, bead)
    momentum = bead.mass * bead.velocity + plate.mass * plate.velocity
    assert momentum / bead.mass == pytest.approx(tuple(before), abs=1e-6)
    along, up = bead.velocity - before
    assert 0.0 > along >= -0.1 * up * (1.0 + 1e-9)
    away = bead.velocity - plate.velocity_at_world_point((row["x"], row["y"]))
    assert away.y / 3.0 == pytest.approx(row["restitution"], abs=1e-6)
    assert row["sliding_speed_after"] == pytest.approx(away.x + R * bead.angular_velocity, abs=1e-6)


@pytest.mark.parametrize("slope", [0.2, 0.9, 1.3])
def test_a_resting_bead_rolls_down_or_slides_by_coulombs_law(slope):
    """It begins to slide at a slope of 3.5 times the coefficient: it has no rolling friction."""
    angle = math.atan(slope)
    own = SimpleNamespace(curve=lambda *_: lambda speed: 0.0, oblique=None)
    space, bead, impacts = drop(own, 0.0, angle=angle, gravity=G, gap=-0.01 * R, friction=MU)
    room.steps(space, 1000, 1e-5)
    bead.velocity, bead.angular_velocity = (0, 0), 0.0
    room.steps(space, 2000, 1e-5)
    pull = G * math.sin(angle)
    grip = min(2.0 / 7.0 * pull, MU * G * math.cos(angle))
    assert bead.velocity.length == pytest.approx((pull - grip) * 0.02, rel=1e-3)
    assert abs(bead.angular_velocity) == pytest.approx(2.5 * grip * 0.02 / R, rel=1e-3)
    assert len(impacts.collisions()) == 0 < impacts.resting


def test_a_model_of_ones_own_with_oblique_is_asked():
    asked, own = [], Stub(0.5)
    own.oblique = lambda *impact: asked.append(impact) or SimpleNamespace(sliding_speed=0.25)
    space, bead, impacts = drop(own, 2.0, 1.0, friction=MU)
    hit(space, impacts, bead)
    assert bead.velocity.x + R * bead.angular_velocity == pytest.approx(0.25, abs=EXACT)
    assert asked == [pytest.approx((2.0, 1.0, R, H, MU), abs=EXACT)]


@pytest.mark.parametrize("by", ["shapes", "handler", "late handler"])
@pytest.mark.parametrize("friction", [0.05, 0.9])
def test_the_engines_own_friction_is_recorded(model, friction, by):
    """A rigid contact slides with Coulomb's law, or sticks: it has no spring."""
    space, bead, impacts = drop(model, 2.0, 1.0)
    bead.angular_velocity = 300.0
    if by == "shapes":
        for shape in space.shapes:
            shape.friction = math.sqrt(friction)
    else:
        other = None if by == "late handler" else impacts.bead_type
        space.on_collision(impacts.plate_type, other, pre_solve=room.setting(friction=friction))
    before = bead.kinetic_energy
    row, _, spin = hit(space, impacts, bead)
    slip = 1.0 + spin * R
    after = max(slip - 3.5 * friction * (1.0 + row["restitution"]) * 2.0, 0.0)
    assert row["sliding_speed"] == pytest.approx(slip, abs=EXACT)
    assert row["sliding_speed_after"] == pytest.approx(after, abs=EXACT)
    assert row["spin_z"] == bead.angular_velocity != spin
    lost = 0.5 * (before - bead.kinetic_energy) - 0.5 * bead.mass * 2.0**2 * (1.0 - row["restitution"] ** 2)
    assert row["friction_energy"] == pytest.approx(lost, rel=1e-9)
