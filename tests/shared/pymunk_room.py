"""pymunk for the tests: spaces with beads and plates, and models to go with them."""

import math
from types import SimpleNamespace

import numpy as np
import pymunk

from contactlaw.engines.pymunk import attach

R = 0.9e-3
G = 9.81
DT = 1e-4
# pymunk solves for velocities, with a few rounding errors of the size of the speed.
EXACT = 1e-12


class Stub:
    """A model whose COR is a constant or a function of speed; it keeps the speeds asked for."""

    def __init__(self, answer=0.7):
        self.answer = answer if callable(answer) else lambda speed: answer
        self.curves = []
        self.speeds = []

    def _ask(self, speed):
        self.speeds.append(speed)
        return self.answer(speed)

    def curve(self, radius, thickness):
        self.curves.append((radius, thickness))
        return self._ask

    def sphere_sphere_curve(self, radius, other_radius):
        self.curves.append((radius, other_radius))
        return self._ask


class Full(Stub):
    """A stub with all columns of the record, each with a distinct number."""

    pair = SimpleNamespace(sphere=SimpleNamespace(density=1000.0))
    flags = 0

    def lookup(self, speed, radius, thickness):
        self.speeds.append(speed.tolist())
        return SimpleNamespace(
            contact_time=radius,
            peak_force=thickness,
            plastic_fraction=np.full_like(speed, self.answer(speed)),
            wave_fraction=np.full_like(speed, 0.125),
            other_fraction=np.full_like(speed, 0.0625),
            flags=np.full(speed.shape, self.flags),
        )

    def lookup_sphere_sphere(self, speed, radius, other_radius):
        return self.lookup(speed, radius, other_radius)


def make_space(gravity=G):
    space = pymunk.Space()
    space.gravity = (0, -gravity)
    return space


def make_bead(space, position, velocity=(0, 0), radius=R, density=879.0):
    mass = 4 / 3 * math.pi * radius**3 * density
    body = pymunk.Body(mass, 0.4 * mass * radius**2)
    body.position, body.velocity = position, velocity
    circle = pymunk.Circle(body, radius)
    space.add(body, circle)
    return circle


def make_plate(space, a=(-1, 0), b=(1, 0), body=None, radius=0.0):
    segment = pymunk.Segment(body or space.static_body, a, b, radius)
    space.add(segment)
    return segment


def registered(space, model, beads, plates, thickness=1e-3):
    """Attach a model, and register these beads and plates."""
    impacts = attach(space, model)
    for circle in beads:
        impacts.add_bead(circle)
    for shape in plates:
        impacts.add_plate(shape, thickness)
    return impacts


def drop(model, speed=2.0, gravity=G, gap=0.02 * R, thickness=1e-3, **plate):
    """One bead just above one plate, on its way down."""
    space = make_space(gravity)
    circle = make_bead(space, (0, R + gap), (0, -speed))
    impacts = registered(space, model, [circle], [make_plate(space, **plate)], thickness)
    return space, circle.body, impacts


def meet(model, speed=1.0, radii=(R, R)):
    """Two beads that fly at each other, the left one first."""
    space = make_space(0.0)
    impacts = attach(space, model)
    left, right = (
        make_bead(space, (1.01 * side * radius, 0), (-side * speed, 0), radius=radius)
        for side, radius in zip((-1, 1), radii, strict=True)
    )
    assert [impacts.add_bead(circle) for circle in (left, right)] == [0, 1]
    return space, (left, right), impacts


def moving_body(space, velocity=(0, 0), spin=0.0, position=(0, 0)):
    """A kinematic body for plates, with a given velocity."""
    body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    body.position, body.velocity, body.angular_velocity = position, velocity, spin
    space.add(body)
    return body


def setting(**values):
    """A handler of the user's that sets these of a contact."""

    def handler(arbiter, space, data):
        for name, value in values.items():
            setattr(arbiter, name, value)

    return handler


def steps(space, count, dt=DT):
    for _ in range(count):
        space.step(dt)


def step_to_impact(space, impacts, body, dt=DT, steps=1000):
    """Velocity of the body before and after the step with the first impact."""
    for _ in range(steps):
        before = body.velocity
        space.step(dt)
        if len(impacts.collisions()):
            return before, body.velocity
    raise AssertionError("no impact")
