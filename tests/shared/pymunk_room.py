"""pymunk for the tests: spaces with beads and plates, and a model to go with them."""

import math

import pymunk

import contactlaw as cl
from contactlaw.engines.pymunk import attach

R = 0.9e-3
G = 9.81
DT = 1e-4
UP, ALONG = pymunk.Vec2d(0, 1), pymunk.Vec2d(1, 0)
# pymunk solves for velocities, with a few rounding errors of the size of the speed.
EXACT = 1e-12


class Stub:
    """A model whose COR is a constant or a function of speed; it keeps what it is asked for."""

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

    sphere_sphere_curve = curve


def make_space(gravity=0.0):
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


def make_plate(space, *corners, body=None, radius=0.0):
    """A segment between two corners, 2 m long if none are given, or a polygon."""
    body, corners = body or space.static_body, corners or (-ALONG, ALONG)
    if len(corners) == 2:
        shape = pymunk.Segment(body, *corners, radius)
    else:
        shape = pymunk.Poly(body, corners, radius=radius)
    space.add(shape)
    return shape


def registered(space, model, beads, plates, thickness=1e-3, **options):
    """Attach a model, and register these beads and plates."""
    impacts = attach(space, model)
    for circle in beads:
        impacts.add_bead(circle)
    for shape in plates:
        impacts.add_plate(shape, thickness, **options)
    return impacts


def drop(
    model, speed=2.0, slip=0.0, angle=0.0, gravity=0.0, gap=0.02 * R, thickness=1e-3, space=None, mount=None, **options
):
    """One bead that flies at a plate just below it, which is turned by an angle, and slips along it."""
    space, normal, along = space or make_space(gravity), UP.rotated(angle), ALONG.rotated(angle)
    circle = make_bead(space, normal * (R + gap), along * slip - normal * speed)
    plate = make_plate(space, -along, along, body=mount)
    return space, circle.body, registered(space, model, [circle], [plate], thickness, **options)


def meet(model, radii=(R, R), materials=(None, None)):
    """Two beads that fly at each other with 1 m/s each, the left one first."""
    space, circles = make_space(), []
    impacts = attach(space, model)
    for side, radius, material in zip((-1, 1), radii, materials, strict=True):
        density = cl.material(material or "gamma-alumina").density
        circles.append(make_bead(space, (1.01 * side * radius, 0), (-side, 0), radius, density))
        impacts.add_bead(circles[-1], material=material)
    return space, circles, impacts


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


def step_to_impact(space, impacts, body, dt=DT):
    """Step until the first impact; give its row, and the velocity of a body before it."""
    for _ in range(1000):
        before = body.velocity
        space.step(dt)
        if len(impacts.collisions()):
            return impacts.collisions()[0], before
    raise AssertionError("no impact")
