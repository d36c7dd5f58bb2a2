"""Circles of rigid bodies in pymunk: the mass that answers, and friction by the engine."""

import math

import numpy as np
import pymunk
import pytest
from pymunk_room import R, make_plate, make_space

import contactlaw as cl
from contactlaw.engines.pymunk import attach
from contactlaw.engines.record import Kind

H, PAIR = 0.5e-3, cl.Pair("gamma-alumina", "glass")
MASS = 2 * 4 / 3 * math.pi * R**3 * PAIR.sphere.density
MOMENT = 1.4 * MASS * R**2  # of two touching spheres across their axis


def fallen(angle, friction, velocity=(0.3, -1.0), edge=None):
    """A dumbbell at an angle from the vertical after its first impact: its body, its plate, the record."""
    space, body = make_space(0.0), pymunk.Body(MASS, MOMENT)
    arm = R * pymunk.Vec2d(math.sin(angle), -math.cos(angle))
    circles = [pymunk.Circle(body, R, side * arm) for side in (1, -1)]
    body.position, body.velocity = (0, 1.02 * R - arm.y), velocity
    space.add(body, *circles)
    plate = make_plate(space, (-1, 0), (1, 0))
    impacts = attach(space, cl.ImpactModel(PAIR))
    impacts.add_plate(plate, H, friction=friction, edge=edge)
    for circle in circles:
        impacts.add_bead(circle)
    came = body.kinetic_energy / 2
    while not len(impacts.collisions()):
        space.step(1e-6)
    return body, arm, came, impacts


@pytest.mark.parametrize("friction", [None, 0.2])
@pytest.mark.parametrize("angle", np.linspace(0.0, 1.4, 6))
def test_a_dumbbell_rebounds_with_the_mass_of_its_contact(angle, friction):
    body, arm, came, impacts = fallen(angle, friction)
    row = impacts.collisions()[0]
    mass = 1 / (1 / MASS + (R * math.sin(angle)) ** 2 / MOMENT)
    assert row["kind"] == Kind.OF_BODY and row["mass"] == pytest.approx(mass, rel=1e-3)
    found = impacts._models.all[0].solve(row["approach_speed"], R, H, mass=row["mass"])
    assert row["restitution"] == pytest.approx(found.restitution, abs=1e-3)
    point = body.velocity_at_world_point(body.local_to_world(arm) + pymunk.Vec2d(0, -R))
    assert point.y == pytest.approx(row["restitution"] * row["approach_speed"], rel=1e-6)
    lost = sum(row[name] for name in row.dtype.names if name.endswith("_energy"))
    assert came - body.kinetic_energy / 2 == pytest.approx(lost, rel=1e-3)


def test_beads_of_bodies_near_edges_and_in_fast_turns(model):
    near = fallen(0.5, None, edge="free")[3].collisions()[0]
    assert near["kind"] == Kind.OF_BODY  # a plate of 2 m has no edge near
    body, *_, impacts = fallen(0.5, None)
    body.angular_velocity = -3e6
    with pytest.raises(RuntimeError, match="would pass unnoticed"):
        impacts._space.step(1e-6)
    assert len(impacts.beads()) == 2 and not impacts.record().left_out
