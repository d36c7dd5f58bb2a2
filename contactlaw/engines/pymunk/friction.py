"""Friction of beads: the model's on plates with a coefficient, the engine's own elsewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from contactlaw._errors import ArgumentError

if TYPE_CHECKING:
    import pymunk

SOLID = 2.0 / 5.0  # moment of inertia of a solid sphere over m R^2
SAME_MOMENT = 1e-3
# Coulomb's limit, which the model's answer has in it, is this many times looser for the engine. Its
# normal impulse has a step's gravity in it, which is half of the slowest impact's.
LOOSE = 2.0


def check_moment(body: Any, radius: float) -> None:
    """Refuse to let friction act on a bead whose moment of inertia is not a solid sphere's."""
    sphere = SOLID * body.mass * radius**2
    if not abs(body.moment - sphere) <= SAME_MOMENT * sphere:
        raise ArgumentError(
            "body.moment",
            body.moment,
            f"the model's friction is that of solid spheres, here of {sphere:.6g} kg m2: set "
            "body.moment = 2/5*body.mass*radius**2 (pymunk.moment_for_circle is for discs)",
        )


def sliding(arbiter: pymunk.Arbiter) -> float:
    """Speed of one surface along the other [m/s], counter-clockwise round its body.

    It is the same with the two in the other order, and does not have the ``surface_velocity`` in it.
    """
    one, two = arbiter.bodies
    points = arbiter.contact_point_set
    (touch,) = points.points
    velocity = one.velocity_at_world_point(touch.point_a) - two.velocity_at_world_point(touch.point_b)
    return points.normal.cross(velocity)


def change_of_sliding(arbiter: pymunk.Arbiter, normal: pymunk.Vec2d) -> float:
    """Change of that speed [m/s] that the impulse of the contact makes."""
    (touch,) = arbiter.contact_point_set.points
    change, along, impulse = 0.0, normal.perpendicular(), arbiter.total_impulse
    for body, point in zip(arbiter.bodies, (touch.point_a, touch.point_b), strict=True):
        arm = point - body.local_to_world(body.center_of_gravity)
        change += impulse.dot(along) / body.mass + arm.cross(impulse) * arm.cross(along) / body.moment
    return change
