"""Friction in pymunk: the model's on plates that have a coefficient, the engine's elsewhere."""

import math
from types import SimpleNamespace

import numpy as np
import pymunk
import pymunk_room as room
import pytest
from pymunk_room import EXACT, Full, G, R, Stub, make_bead, make_plate, make_space

import contactlaw as cl
from contactlaw.engines.pymunk import attach
from contactlaw.engines.record import Kind

H, MU = 1e-3, 0.3
UP = pymunk.Vec2d(0, 1)


def scene(model, velocity=(1, -2), spin=0.0, friction=MU, gravity=0.0, angle=0.0, mount=None):
    """One bead just above one plate, which is turned by an angle; `mount` makes its body."""
    space = make_space(gravity)
    side = UP.rotated(angle).perpendicular()
    circle = make_bead(space, UP.rotated(angle) * 1.02 * R, velocity)
    circle.body.angular_velocity = spin
    plate = make_plate(space, side, -side, mount(space) if mount else None)
    impacts = attach(space, model)
    impacts.add_bead(circle)
    impacts.add_plate(plate, H, friction=friction)
    return space, circle.body, plate, impacts


def hit(space, impacts, body):
    """The row of the first impact, and velocity and spin before it."""
    while not len(impacts.collisions()):
        before = body.velocity, body.angular_velocity
        assert impacts.time < 1e-3
        space.step(1e-6)
    return impacts.collisions()[0], *before


def energy(*bodies):
    return 0.5 * sum(body.kinetic_energy for body in bodies)  # pymunk's is twice the energy


def taken(rows):
    return sum(rows[name].sum() for name in rows.dtype.names if name.endswith("_energy"))


# --- the model's friction -------------------------------------------------------------------------

MOUNTS = {
    "still": None,
    "belt": None,
    "moves": lambda space: room.moving_body(space, (0.2, -0.4)),
    "turns": lambda space: room.moving_body(space, (0.2, -0.4), 20.0),
}


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("gravity", [0.0, G])
@pytest.mark.parametrize("motion", list(MOUNTS))
def test_an_isolated_impact_is_that_of_collide(model, motion, gravity, seed):
    random = np.random.default_rng(seed)
    angle, friction = random.uniform(0.0, 2.0 * math.pi), 10.0 ** random.uniform(-2.0, 0.0)
    came = pymunk.Vec2d(random.uniform(-8.0, 8.0), -(10.0 ** random.uniform(-0.3, 1.0)))
    space, bead, plate, impacts = scene(
        model, came.rotated(angle), random.normal(scale=4000.0), friction, gravity, angle, MOUNTS[motion]
    )
    if motion == "belt":
        plate.surface_velocity = UP.rotated(angle).perpendicular() * 3.0
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
    assert row["kind"] == Kind.IMPACT and row["spin_x"] == row["spin_y"] == 0.0
    velocity, turned = bead.velocity, bead.angular_velocity
    room.steps(space, 3, 1e-6)  # the bead still overlaps the plate
    assert bead.velocity == pytest.approx(tuple(velocity + (0, -3e-6 * gravity)), abs=1e-9)
    assert R * bead.angular_velocity == pytest.approx(R * turned, abs=1e-9)


@pytest.mark.parametrize("angle", [45.0, 65.0, 85.0])
def test_the_record_closes_the_energy_of_a_run(model, angle):
    """Beads of one group, which pass each other, between a floor and a ceiling."""
    space, random = make_space(0.0), np.random.default_rng(1)
    impacts = attach(space, model)
    for y in (-0.003, 0.003):
        impacts.add_plate(make_plate(space, (-1, y), (1, y)), H, friction=MU)
    bodies = []
    for y in random.uniform(-1e-3, 1e-3, 10):
        velocity = pymunk.Vec2d(0, -8).rotated(math.radians(angle))
        circle = make_bead(space, (0, float(y)), velocity, density=model.pair.sphere.density)
        circle.filter = pymunk.ShapeFilter(group=1)
        circle.body.angular_velocity = random.normal(scale=5000.0)
        impacts.add_bead(circle)
        bodies.append(circle.body)
    before = energy(*bodies)
    room.steps(space, 3000, 1e-5)
    rows = impacts.collisions()
    assert len(rows) >= 40 and set(rows["kind"]) == {Kind.IMPACT}
    assert rows["friction_energy"].sum() > 0.1 * taken(rows)
    assert before - energy(*bodies) == pytest.approx(taken(rows), abs=1e-6 * before)


@pytest.mark.parametrize("ratio", [0.3, 1e9])
def test_a_plate_that_is_free_has_the_reaction(model, ratio):
    """A light plate gets no more friction than Coulomb's law allows; momentum is kept."""

    def mount(space):
        space.add(body := pymunk.Body(ratio * 3e-6, 1e-6 * ratio))
        return body

    space, bead, plate, impacts = scene(model, (1.0, -3.0), friction=0.1, mount=mount)
    row, before, _ = hit(space, impacts, bead)
    momentum = bead.mass * bead.velocity + plate.body.mass * plate.body.velocity
    assert momentum / bead.mass == pytest.approx(tuple(before), abs=1e-6)
    along, up = bead.velocity - before
    assert 0.0 > along >= -0.1 * up * (1.0 + 1e-9)
    away = bead.velocity - plate.body.velocity_at_world_point((row["x"], row["y"]))
    assert away.y / 3.0 == pytest.approx(row["restitution"], abs=1e-6)
    slide = away.x + R * bead.angular_velocity
    assert row["sliding_speed_after"] == pytest.approx(slide, abs=1e-6)
    assert row["spin_z"] == bead.angular_velocity
    if ratio > 1.0:
        answer = model.oblique(3.0, 1.0, R, H, 0.1)
        assert slide == pytest.approx(answer.sliding_speed, abs=1e-6)
        assert row["friction_energy"] == pytest.approx(answer.friction_energy, rel=1e-6)


@pytest.mark.parametrize("slope", [0.2, 0.9, 1.3])
def test_a_resting_bead_rolls_down_or_slides_by_coulombs_law(slope):
    """It begins to slide at a slope of 3.5 times the coefficient: it has no rolling friction."""
    angle = math.atan(slope)
    own = SimpleNamespace(curve=lambda *_: lambda speed: 0.0, oblique=None)
    space, bead, _, impacts = scene(own, (0, 0), gravity=G, angle=angle)
    bead.position = UP.rotated(angle) * R * 0.99
    room.steps(space, 1000, 1e-5)
    bead.velocity, bead.angular_velocity = (0, 0), 0.0
    room.steps(space, 2000, 1e-5)
    pull = G * math.sin(angle)
    grip = min(2.0 / 7.0 * pull, MU * G * math.cos(angle))
    assert bead.velocity.length == pytest.approx((pull - grip) * 0.02, rel=1e-3)
    assert abs(bead.angular_velocity) == pytest.approx(2.5 * grip * 0.02 / R, rel=1e-3)
    assert len(impacts.collisions()) == 0 < impacts.resting


@pytest.mark.parametrize("speed", [0.0, -2.0])
def test_seams_do_not_catch_a_bead_that_rolls_or_hits(model, speed):
    ends = []
    for pieces in (1, 60):
        space = make_space()
        circle = make_bead(space, (-0.02, 0.995 * R), (0.5, speed))
        impacts = attach(space, model)
        impacts.add_bead(circle)
        x = np.linspace(-0.03, 0.03, pieces + 1).tolist()
        for a, b in zip(x[:-1], x[1:], strict=True):
            impacts.add_plate(make_plate(space, (a, 0), (b, 0)), H, friction=MU)
        room.steps(space, 5000, 1e-5)
        body = circle.body
        ends.append((*body.position, *body.velocity, R * body.angular_velocity))
    assert ends[0] == pytest.approx(ends[1], abs=1e-6)
    if speed == 0.0:
        assert ends[0][2] == pytest.approx(5.0 / 7.0 * 0.5, rel=1e-4)  # it rolls


# --- models, beads and handlers that do not fit ---------------------------------------------------


def test_a_model_of_ones_own_with_oblique_is_asked():
    asked = []
    own = Stub(0.5)
    own.oblique = lambda *impact: asked.append(impact) or SimpleNamespace(sliding_speed=0.25)
    space, bead, _, impacts = scene(own)
    hit(space, impacts, bead)
    assert bead.velocity.x + R * bead.angular_velocity == pytest.approx(0.25, abs=EXACT)
    assert asked == [pytest.approx((2.0, 1.0, R, H, MU), abs=EXACT)]


def test_a_model_without_friction_is_refused():
    space = make_space()
    impacts = attach(space, Stub())
    with pytest.raises(TypeError, match="has no oblique, which this thickness, friction or edge takes"):
        impacts.add_plate(make_plate(space), H, friction=0.2)
    with pytest.raises(ValueError, match="friction"):
        impacts.add_plate(make_plate(space), H, friction=-0.2)
    assert impacts.plates().size == 0


def test_no_table_before_the_first_impact_with_friction(pair):
    fresh = cl.ImpactModel(pair, law="myc")
    space, bead, _, impacts = scene(fresh, friction=0.0)
    hit(space, impacts, bead)
    assert bead.velocity.x == pytest.approx(1.0, abs=EXACT) and "collide_kernel" not in vars(fresh)


@pytest.mark.parametrize("moment", [math.inf, 0.5, 0.402])
def test_a_moment_that_is_no_spheres_is_refused(model, moment):
    message = r"body.moment: .* 2/5\*body.mass\*radius\*\*2 .*moment_for_circle"
    space = make_space(0.0)
    impacts = attach(space, model)
    plate, bead = make_plate(space), make_bead(space, (0, 1.02 * R), (1, -2))
    bead.body.moment = moment * bead.body.mass * R**2
    impacts.add_bead(bead)
    impacts.add_plate(plate, H, friction=MU)
    with pytest.raises(ValueError, match=message) as caught:
        room.steps(space, 100, 1e-5)
    assert "for bead 0 on plate 0" in caught.value.__notes__[0]
    assert len(impacts.collisions()) == 0


# --- the engine's friction, and the record --------------------------------------------------------


@pytest.mark.parametrize("by", ["shapes", "handler", "late handler"])
@pytest.mark.parametrize("friction", [0.05, 0.9])
def test_the_engines_own_friction_is_recorded(friction, by):
    """A rigid contact slides with Coulomb's law, or sticks: it has no spring."""
    space, bead, plate, impacts = scene(Full(0.5), spin=300.0, friction=None)

    if by == "shapes":
        (circle,) = bead.shapes
        circle.friction, plate.friction = 1.0, friction
    else:
        late = (impacts.plate_type, None)
        kinds = late if by == "late handler" else (impacts.bead_type, impacts.plate_type)
        space.on_collision(*kinds, pre_solve=room.setting(friction=friction))
    before = energy(bead)
    row, _, _ = hit(space, impacts, bead)
    slip = 1.0 + 300.0 * R
    after = max(slip - 3.5 * friction * 1.5 * 2.0, 0.0)
    assert row["sliding_speed"] == pytest.approx(slip, abs=EXACT)
    assert row["sliding_speed_after"] == pytest.approx(after, abs=EXACT)
    assert row["spin_z"] == bead.angular_velocity != 300.0
    lost = before - energy(bead) - 0.5 * bead.mass * 2.0**2 * (1.0 - 0.5**2)
    # the energies are those of a sphere of the stub's density, 1000
    assert row["friction_energy"] * 0.879 == pytest.approx(lost, rel=1e-9)


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_beads_have_the_engines_friction(friction):
    space, both, impacts = room.meet(Full(0.8), radii=(R, 2 * R))
    one, two = bodies = [circle.body for circle in both]
    both[0].friction = both[1].friction = friction
    one.angular_velocity, two.angular_velocity = 500.0, -200.0
    before = energy(*bodies)
    room.steps(space, 300, 1e-6)
    (row,) = impacts.collisions()
    assert row["sliding_speed"] == pytest.approx(abs(500 * R - 200 * 2 * R), abs=EXACT)
    assert row["spin_z"] == bodies[int(row["bead"])].angular_velocity
    reduced = one.mass * two.mass / (one.mass + two.mass)
    lost = before - energy(*bodies) - 0.5 * reduced * 2.0**2 * (1.0 - 0.8**2)
    assert row["friction_energy"] * 0.879 == pytest.approx(lost, rel=1e-6, abs=1e-18)
    assert (row["friction_energy"] > 0.0) == (friction > 0.0)


def test_what_friction_took_of_a_bead_that_is_gone_is_not_known():
    space, bead, plate, impacts = scene(Full(0.5), friction=None)
    (circle,) = bead.shapes
    circle.friction = plate.friction = 1.0
    kinds = impacts.bead_type, impacts.plate_type
    space.on_collision(*kinds, post_solve=lambda *_: space.remove(circle, bead))
    row, _, _ = hit(space, impacts, bead)
    assert math.isnan(row["friction_energy"]) and row["spin_z"] == bead.angular_velocity


def test_a_second_impact_within_one_overlap_is_struck(model):
    space, bead, _, impacts = scene(model)
    hit(space, impacts, bead)
    bead.velocity = (1.0, -1.0)
    space.step(1e-6)
    bead.velocity, bead.position = (1.0, -1.0), (0, 1.01 * R)
    room.steps(space, 100, 1e-6)
    assert impacts.collisions()["kind"].tolist() == [Kind.IMPACT, Kind.STRUCK, Kind.IMPACT]
