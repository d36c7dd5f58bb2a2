"""Scenes that people build in pymunk: boxes, several materials, seams, shapes that come and go."""

import gc
import math
import tracemalloc
import warnings
from types import SimpleNamespace

import pymunk
import pymunk_room as room
import pytest
from pymunk_room import DT, EXACT, R, Stub, drop, make_bead, make_plate, make_space

import contactlaw as cl
from contactlaw.engines.pymunk import TunnellingError, attach

# --- shapes that go -------------------------------------------------------------------------------


def test_a_removed_bead_is_an_ordinary_circle():
    space, body, impacts = drop(Stub(0.6), gravity=0.0)
    (circle,), (plate,) = body.shapes, space.static_body.shapes
    space.step(DT)
    impacts.remove_bead(circle)
    assert circle.collision_type == 0 and circle in space.shapes
    circle.elasticity = plate.elasticity = 0.5
    body.position, body.velocity = (0, 0.99 * R), (0, -2)
    space.step(DT)
    assert body.velocity.y == pytest.approx(2 * 0.25, abs=EXACT)
    assert impacts.collisions()["bead"].tolist() == [0]
    assert impacts.add_bead(circle) == 1  # an index is never used twice
    body.position, body.velocity = (0, 0.99 * R), (0, -2)
    space.step(DT)
    assert impacts.collisions()["bead"].tolist() == [0, 1]
    assert impacts.beads()["radius"].tolist() == [R, R]
    for remove, shape in ((impacts.remove_bead, plate), (impacts.remove_plate, circle)):
        with pytest.raises(ValueError, match="is no "):
            remove(shape)


def test_a_removed_plate_is_an_ordinary_segment():
    space, body, impacts = drop(Stub(0.6), gravity=0.0)
    (plate,) = space.static_body.shapes
    impacts.remove_plate(plate)
    assert plate.collision_type == 0
    space.step(DT)
    assert body.velocity.y == pytest.approx(0.0, abs=EXACT) and len(impacts.collisions()) == 0
    assert impacts.add_plate(plate, 2e-3) == 1
    assert impacts.plates()["thickness"].tolist() == [1e-3, 2e-3]


def test_a_bead_may_go_in_the_middle_of_a_step():
    space, body, impacts = drop(Stub(0.6), gravity=0.0)
    (circle,) = body.shapes
    space.on_collision(impacts.bead_type, impacts.plate_type, post_solve=lambda *_: impacts.remove_bead(circle))
    room.steps(space, 3)
    assert body.velocity.y == pytest.approx(2 * 0.6, abs=EXACT)
    assert len(impacts.collisions()) == 1


def test_the_smallest_bead_sets_the_pace_while_it_is_there():
    space, body, impacts = drop(Stub(), speed=1.5 * R / DT, gravity=0.0, gap=100 * R)
    (small,) = body.shapes
    big = make_bead(space, (0.5, 5.2 * R), (0, -1.5 * R / DT), radius=5 * R)
    impacts.add_bead(big)
    impacts.remove_bead(small)
    space.step(DT)
    assert len(impacts.collisions()) == 1


def passing_beads(space, impacts, count):
    """Beads of different sizes that hit, and are taken out again."""
    for n in range(count):
        circle = make_bead(space, (0, 1.01 * R), (0, -2), radius=R * (1 - 1e-9 * n))
        impacts.add_bead(circle)
        space.step(DT)
        space.remove(circle, circle.body)


def passing_plates(space, impacts, count):
    for n in range(count):
        plate = make_plate(space, (n + 1, 0), (n + 2, 0))
        impacts.add_plate(plate, 1e-3)
        space.step(DT)
        space.remove(plate)
        plate.body = None  # otherwise its body keeps the shape alive


# Bytes of each: an impact in the record has 112 and a bead 16, in arrays that grow by an eighth; with
# the shapes kept it was 2800 and more.
@pytest.mark.parametrize(("passing", "most"), [(passing_beads, 200), (passing_plates, 150)])
def test_memory_of_what_left_is_released(passing, most):
    space = make_space(0.0)
    impacts = attach(space, SimpleNamespace(curve=lambda *_: lambda speed: 0.6))
    impacts.add_plate(make_plate(space), 1e-3)
    impacts.add_bead(make_bead(space, (0, 1)))
    passing(space, impacts, 200)
    gc.collect()
    tracemalloc.start()
    before, _ = tracemalloc.get_traced_memory()
    passing(space, impacts, 1000)
    gc.collect()
    space.step(DT)
    after, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert (after - before) / 1000 < most
    hits = 1200 if passing is passing_beads else 0
    assert impacts.collisions()["bead"].tolist() == list(range(1, 1 + hits))
    assert sorted([len(impacts.beads()), len(impacts.plates())]) == [1, 1201]


def test_a_bead_that_waits_outside_the_space_keeps_its_index():
    space, body, impacts = drop(Stub(0.5), gravity=0.0)
    (circle,) = body.shapes
    space.remove(circle, body)
    gc.collect()
    space.step(DT)
    space.add(body, circle)
    space.step(DT)
    assert impacts.collisions()["bead"].tolist() == [0]


# --- boxes and polygons ---------------------------------------------------------------------------


@pytest.mark.parametrize("speed", [2.0, 9.0])
@pytest.mark.parametrize("corner", [0.0, 0.1e-3])
@pytest.mark.parametrize("side", range(4))
def test_every_side_of_a_box_is_a_plate(model, side, corner, speed):
    space = make_space(0.0)
    box = pymunk.Poly.create_box(space.static_body, (0.04, 0.02), radius=corner)
    space.add(box)
    normal = pymunk.Vec2d(0, 1).rotated(side * math.pi / 2)
    height = (0.01, 0.02)[side % 2] + corner + 1.02 * R
    circle = make_bead(space, normal * height + normal.perpendicular() * 1e-3, normal * -speed)
    impacts = attach(space, model)
    impacts.add_bead(circle)
    assert impacts.add_plate(box, 1e-3) == 0
    before, after = room.step_to_impact(space, impacts, circle.body, dt=1e-5)
    expected = model.restitution(speed, R, 1e-3)
    assert after.dot(normal) / speed == pytest.approx(expected, abs=1e-9)
    assert after.cross(normal) == pytest.approx(0.0, abs=1e-9)
    (row,) = impacts.collisions()
    touch = pymunk.Vec2d(row["x"], row["y"]).dot(normal)
    assert touch == pytest.approx(height - 1.02 * R, abs=1e-5 * speed)  # less the path of a step


def test_a_sloping_side_of_a_turning_polygon():
    space = make_space(0.0)
    body = room.moving_body(space, spin=20.0)
    triangle = pymunk.Poly(body, [(-0.03, -0.02), (0.03, -0.02), (0.0, 0.03)])
    space.add(triangle)
    normal = pymunk.Vec2d(5, 3).normalized()
    middle = pymunk.Vec2d(0.02, -0.01 / 3)
    circle = make_bead(space, middle + normal * 1.05 * R, normal * -1)
    impacts = room.registered(space, Stub(0.6), [circle], [triangle])
    room.step_to_impact(space, impacts, circle.body, dt=1e-5)
    (row,) = impacts.collisions()
    turned = normal.rotated(body.angle)
    point = pymunk.Vec2d(row["x"], row["y"])
    plate = body.velocity_at_world_point(point)
    assert abs(plate.dot(turned)) > 0.1  # it turns away under the bead, or towards it
    assert row["approach_speed"] == pytest.approx(-(normal * -1 - plate).dot(turned), abs=1e-9)
    assert (circle.body.velocity - plate).dot(turned) == pytest.approx(0.6 * row["approach_speed"], abs=1e-9)


@pytest.mark.parametrize("ratio", [1.5, 3.0, 30.0])
def test_a_bead_never_jumps_into_or_over_a_box(ratio):
    space = make_space(0.0)
    box = pymunk.Poly.create_box(space.static_body, (0.04, 2 * R))
    speed = ratio * R / DT
    circle = make_bead(space, (0, 2.01 * R), (0, -speed))
    space.add(box)
    impacts = room.registered(space, Stub(0.6), [circle], [box])
    with pytest.raises(TunnellingError) as caught:
        space.step(DT)
    assert caught.value.safe_step == pytest.approx(R / speed, rel=EXACT)
    before, after = room.step_to_impact(space, impacts, circle.body, dt=0.99 * R / speed)
    assert after.y == pytest.approx(0.6 * speed, rel=1e-9)


def test_a_static_plate_may_have_a_speed():
    """The plate is a conveyor: pymunk never moves it, but counts its speed in every contact."""
    space, body, impacts = drop(Stub(0.5), gravity=0.0)
    for _ in range(2):
        space.static_body.velocity = (0, 1)
        body.position, body.velocity = (0, 0.99 * R), (0, -2)
        space.step(DT)
        assert body.velocity.y == pytest.approx(1 + 0.5 * 3, abs=EXACT)
        space.static_body.velocity = (0, 0)
        body.position, body.velocity = (0, 0.99 * R), (0, -2)
        space.step(DT)
        assert body.velocity.y == pytest.approx(0.5 * 2, abs=EXACT)
    assert impacts.collisions()["approach_speed"] == pytest.approx([3, 2, 3, 2], abs=EXACT)


def test_a_plate_that_stops_does_not_shake():
    space = make_space(0.0)
    body = room.moving_body(space)
    circle = make_bead(space, (0, 1.5 * R))
    impacts = room.registered(space, Stub(0.5), [circle], [make_plate(space, body=body)])
    for velocity in (0.1, -0.1, 0.1, -0.1):  # the speed changes by 0.2 m/s each step
        body.velocity = (0, velocity)
        space.step(1e-6)
    body.body_type, body.velocity = pymunk.Body.STATIC, (0, 0)
    circle.body.velocity = (0, -0.3)  # slower than twice that change
    room.steps(space, 200, 1e-5)
    assert impacts.collisions()["approach_speed"] == pytest.approx([0.3], abs=EXACT)


# --- several materials ----------------------------------------------------------------------------

STEEL = cl.material("carbon-steel").name
BEADS, PLATES = ("gamma-alumina", STEEL), ("glass", STEEL)


@pytest.fixture(scope="module")
def models():
    """Models of every kind of bead on every kind of plate."""
    return {(b, p): cl.ImpactModel(cl.Pair(b, p), law="jackson_green") for b in BEADS for p in PLATES}


def shower(models, speed=1.0):
    """Two kinds of beads, one each on two kinds of plates, and one pair of beads in mid-air."""
    space = make_space(0.0)
    impacts = attach(space, list(models.values()))
    for x, plate in enumerate(PLATES):
        impacts.add_plate(make_plate(space, (x, 0), (x + 0.9, 0)), 1e-3 * (x + 1), material=plate)
    bodies = []
    for x in range(2):
        for n, bead in enumerate(BEADS):
            rho = cl.material(bead).density
            circle = make_bead(space, (x + 0.3 + 0.3 * n, 1.01 * R), (0, -speed), density=rho)
            impacts.add_bead(circle, material=bead)
            bodies.append(circle.body)
    for n, bead in enumerate(BEADS):
        side, rho = (-1, 1)[n], cl.material(bead).density
        circle = make_bead(space, (1.01 * side * R, 1), (-side * speed, 0), radius=R * (1 + n), density=rho)
        circle.body.position = (side * R * (1 + n) * 1.01, 1)
        impacts.add_bead(circle, material=bead)
        bodies.append(circle.body)
    return space, impacts, bodies


def test_every_bead_and_plate_has_the_model_of_its_pair(models):
    speed = 1.0
    space, impacts, bodies = shower(models, speed)
    room.steps(space, 5, 1e-5)
    rows = impacts.collisions()
    rows = rows[rows["other"] < 0]
    assert len(rows) == 4
    beads, plates = impacts.beads(), impacts.plates()
    for row in rows:
        names = beads["material"][row["bead"]], plates["material"][row["plate"]]
        assert names == (BEADS[row["bead"] % 2], PLATES[row["plate"]])
        own = models[tuple(map(str, names))].lookup(speed, R, 1e-3 * (row["plate"] + 1))
        body = bodies[row["bead"]]
        assert body.velocity.y / speed == pytest.approx(float(own.restitution), abs=1e-9)
        assert row["peak_force"] == pytest.approx(float(own.peak_force), rel=1e-9)
        energy = 0.5 * body.mass * speed**2
        lost = row["plastic_energy"] + row["wave_energy"] + row["other_energy"]
        left = 0.5 * body.mass * body.velocity.y**2
        assert energy == pytest.approx(lost + left, rel=1e-4)  # the solver's balance, tabulated
    assert len({row["restitution"] for row in rows}) == 4


def test_beads_of_two_materials_meet(models):
    space, impacts, bodies = shower(models)
    light, heavy = bodies[-2:]
    momentum = light.mass * light.velocity.x + heavy.mass * heavy.velocity.x
    energy = 0.5 * (light.mass * light.velocity.x**2 + heavy.mass * heavy.velocity.x**2)
    room.steps(space, 20, 1e-5)
    rows = impacts.collisions()
    (row,) = rows[rows["other"] >= 0]
    cor = cl.restitution_sphere_sphere(*BEADS, 2.0, R, 2 * R, law="jackson_green")
    assert row["restitution"] == pytest.approx(cor, abs=1e-9)
    assert (heavy.velocity.x - light.velocity.x) / 2.0 == pytest.approx(cor, abs=1e-9)
    assert light.mass * light.velocity.x + heavy.mass * heavy.velocity.x == pytest.approx(momentum)
    left = 0.5 * (light.mass * light.velocity.x**2 + heavy.mass * heavy.velocity.x**2)
    lost = row["plastic_energy"] + row["wave_energy"] + row["other_energy"]
    assert energy - left == pytest.approx(lost, rel=1e-4)
    assert row["contact_time"] > 0.0


@pytest.mark.parametrize("law", ["myc", "jackson_green", "hertz"])
@pytest.mark.parametrize("pair", [("gamma-alumina", STEEL), (STEEL, "gamma-alumina")])
def test_a_model_answers_for_its_bead_on_one_of_another_material(pair, law):
    """Compare with the function that needs no model, and check the balance of energy."""
    bead, other = pair
    model = cl.ImpactModel(cl.Pair(bead, "glass"), law=law)
    speeds = [0.5, 2.0, 10.0]
    expected = cl.restitution_sphere_sphere(bead, other, speeds, R, 2 * R, law=law)
    found = model.lookup_sphere_sphere(speeds, R, 2 * R, other)
    assert found.restitution == pytest.approx(expected, abs=1e-12)
    curve = model.sphere_sphere_curve(R, 2 * R, other)
    assert [curve(speed) for speed in speeds] == pytest.approx(expected, abs=1e-9)
    lost = found.plastic_fraction + found.wave_fraction + found.other_fraction
    assert 1 - found.restitution**2 == pytest.approx(lost, abs=1e-4)
    # Either of the two beads may be the one that the model is made for.
    there = cl.ImpactModel(cl.Pair(other, "glass"), law=law)
    back = there.lookup_sphere_sphere(speeds, 2 * R, R, cl.material(bead))
    assert back.peak_force == pytest.approx(found.peak_force, rel=1e-12)
    assert model.sphere_sphere_curve(R, R, bead)(0.2) == model.sphere_sphere_curve(R, R)(0.2)


def test_a_pair_without_a_model_says_which(models):
    pairs = list(models)
    some = [models[pair] for pair in pairs if pair != (STEEL, STEEL)]
    space = make_space(0.0)
    impacts = attach(space, some)
    impacts.add_plate(make_plate(space), 1e-3, material="carbon-steel-1020")
    rho = cl.material("carbon-steel").density
    circle = make_bead(space, (0, 1.01 * R), (0, -2), density=rho)
    impacts.add_bead(circle, material=cl.material("carbon-steel"))
    with pytest.raises(ValueError, match=r"Pair\('carbon-steel-1020', 'carbon-steel-1020'\)") as caught:
        space.step(DT)
    assert "bead 0 on plate 0" in caught.value.__notes__[0]


def test_what_is_no_material(models):
    space = make_space(0.0)
    impacts = attach(space, list(models.values()))
    with pytest.raises(ValueError, match="spheres of 'gold'.* 'gamma-alumina', 'carbon-steel-1020'"):
        impacts.add_bead(make_bead(space, (0, 1)), material="gold")
    with pytest.raises(ValueError, match="plates of 'gold', only for 'glass', 'carbon-steel-1020'"):
        impacts.add_plate(make_plate(space), 1e-3, material="gold")
    one = models["gamma-alumina", "glass"]
    with pytest.raises(ValueError, match="two are for gamma-alumina on glass"):
        attach(make_space(), [one, one])
    with pytest.raises(ValueError, match="empty"):
        attach(make_space(), [])


# --- seams ----------------------------------------------------------------------------------------


def path(space, body, impacts, steps=400, dt=1e-5):
    places = []
    for _ in range(steps):
        space.step(dt)
        places.append((*body.position, *body.velocity))
    return places, impacts.collisions()


def floor(pieces, radius=0.0, turn=0.0, neighbours=False, boxes=False, at=0.0):
    """A bead that falls on a floor of so many pieces; they meet at x = 0 and elsewhere."""
    space = make_space(0.0)
    circle = make_bead(space, pymunk.Vec2d(at, 1.03 * R + radius).rotated(turn))
    circle.body.velocity = pymunk.Vec2d(0.05, -2).rotated(turn)
    impacts = attach(space, Stub(0.4))
    impacts.add_bead(circle)
    xs = [-0.02 + 0.04 * n / pieces for n in range(pieces + 1)]
    for a, b in zip(xs, xs[1:], strict=False):
        if boxes:
            corners = [(a, 0), (b, 0), (b, -0.01), (a, -0.01)]
            shape = pymunk.Poly(space.static_body, [pymunk.Vec2d(*c).rotated(turn) for c in corners], radius=radius)
        else:
            ends = [pymunk.Vec2d(x, 0).rotated(turn) for x in (a, b)]
            shape = pymunk.Segment(space.static_body, *ends, radius)
            if neighbours:
                shape.set_neighbors(*[pymunk.Vec2d(x, 0).rotated(turn) for x in (2 * a - b, 2 * b - a)])
        space.add(shape)
        impacts.add_plate(shape, 1e-3)
    return space, circle.body, impacts


@pytest.mark.parametrize("at", [0.0, 1e-9, -2e-8, 3e-6, 1e-4, -2e-4])
@pytest.mark.parametrize("turn", [0.0, 0.7])
@pytest.mark.parametrize("radius", [0.0, 0.2e-3])
@pytest.mark.parametrize("kind", [{}, {"neighbours": True}, {"boxes": True}])
def test_a_bead_on_a_seam_hits_once_and_rebounds_as_from_one_plate(at, turn, radius, kind):
    whole = path(*floor(1, radius, turn, at=at, boxes="boxes" in kind))
    parts = path(*floor(2, radius, turn, at=at, **kind))
    assert len(whole[1]) == len(parts[1]) == 1
    for one, two in zip(whole[0], parts[0], strict=True):
        assert two == pytest.approx(one, abs=1e-9)


def test_a_corner_between_two_plates_is_still_hit_on_both_sides():
    space = make_space(0.0)
    circle = make_bead(space, (1.01 * R, 1.01 * R), (-2, -2))
    plates = [make_plate(space, (0, 0), end) for end in ((0.05, 0), (0, 0.05))]
    impacts = room.registered(space, Stub(0.5), [circle], plates)
    space.step(DT)
    assert sorted(impacts.collisions()["plate"].tolist()) == [0, 1]
    assert circle.body.velocity == pytest.approx((1, 1), abs=EXACT)


def test_a_ridge_is_hit_once():
    space = make_space(0.0)
    circle = make_bead(space, (0, 1.01 * R), (0, -2))
    plates = [make_plate(space, (0, 0), (0.05 * side, -0.02)) for side in (-1, 1)]
    impacts = room.registered(space, Stub(0.5), [circle], plates)
    space.step(DT)
    (row,) = impacts.collisions()
    assert circle.body.velocity == pytest.approx((0, 1), abs=1e-9)


@pytest.mark.parametrize("gone", ["removed", "unregistered", "filtered", "a sensor"])
def test_a_neighbour_that_is_not_there_has_no_part(gone):
    space, _, impacts = floor(2)
    first, _ = sorted(space.static_body.shapes, key=lambda shape: shape.a.x)
    if gone == "unregistered":
        impacts.remove_plate(first)
    if gone in ("removed", "unregistered"):
        space.remove(first)
    elif gone == "filtered":
        first.filter = pymunk.ShapeFilter(mask=0)
    else:
        first.sensor = True
    space.step(DT)
    assert impacts.collisions()["plate"].tolist() == [1]


# --- sensors --------------------------------------------------------------------------------------


@pytest.mark.parametrize("dt", [DT, 20 * DT], ids=["overlaps", "jumps"])
@pytest.mark.parametrize("which", ["bead", "plate"])
def test_a_sensor_lets_pass_and_hits_nothing(which, dt):
    """A sensor has no impacts in steps with or without overlap; it has again as a solid shape."""
    space, body, impacts = drop(Stub(0.5), gravity=0.0)
    (circle,), (plate,) = body.shapes, space.static_body.shapes
    shape = circle if which == "bead" else plate
    shape.sensor = True
    room.steps(space, round(40 * DT / dt), dt)
    assert body.position.y < -R and body.velocity == (0, -2)
    assert len(impacts.collisions()) == 0
    shape.sensor = False
    body.velocity = (0, 2)
    before, after = room.step_to_impact(space, impacts, body)
    assert (before.y, after.y) == pytest.approx((2, -1), abs=EXACT)


@pytest.mark.parametrize("which", [0, 1])
def test_a_bead_that_is_a_sensor_hits_no_bead(which):
    space, both, impacts = room.meet(Stub(0.8))
    both[which].sensor = True
    room.steps(space, 40)
    assert both[0].body.position.x > R and len(impacts.collisions()) == 0


# --- masses and lengths ---------------------------------------------------------------------------


def test_a_length_in_pixels_is_refused():
    space = make_space()
    impacts = attach(space, Stub())
    circle = make_bead(space, (0, 50), radius=20.0)
    with pytest.raises(ValueError, match=r"radius: got 20.0; .*pixels.*metres"):
        impacts.add_bead(circle)
    assert circle.collision_type == 0


def test_sizes_that_are_likely_millimetres_draw_a_warning(model):
    space = make_space()
    impacts = attach(space, model)
    with pytest.warns(UserWarning, match="radius: 0.9 is 0.9 m; 0.9e-3 for 0.9 mm"):
        impacts.add_bead(make_bead(space, (0, 1), radius=0.9))
    plate = pymunk.Segment(space.static_body, (-1, 0), (1, 0), 0)
    space.add(plate)
    with pytest.warns(UserWarning, match="thickness: 1 is 1 m; 1e-3 for 1 mm"):
        impacts.add_plate(plate, 1.0)


@pytest.mark.parametrize("factor", [1e-3, 1 / 1.6, 8.0, 4e5])
def test_a_mass_that_is_not_the_spheres_is_told(model, factor):
    space = make_space()
    impacts = attach(space, model)
    circle = make_bead(space, (0, 1), density=879.0 * factor)
    with pytest.warns(UserWarning, match=r"body.mass: .* gamma-alumina .* 2.684e-06 kg.*set") as told:
        impacts.add_bead(circle)
    assert told[0].filename == __file__


@pytest.mark.parametrize("factor", [0.75, 1.0, 1.4])
def test_a_mass_that_is_about_the_spheres(model, factor):
    space = make_space()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        attach(space, model).add_bead(make_bead(space, (0, 1), density=879.0 * factor))
