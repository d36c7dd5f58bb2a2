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

    It is the same with the two in the other order, and does not have `belt` in it.
    """
    one, two = arbiter.bodies
    points = arbiter.contact_point_set
    (nx, ny), point = points.normal, points.points[0]
    vx, vy = one.velocity_at_world_point(point.point_a)
    ux, uy = two.velocity_at_world_point(point.point_b)
    return float(nx * (vy - uy) - ny * (vx - ux))


def belt(arbiter: pymunk.Arbiter, normal: tuple[float, float]) -> float:
    """Sliding speed that the ``surface_velocity`` of the shapes takes away [m/s]."""
    (nx, ny), (x, y) = normal, arbiter.surface_velocity
    return float(nx * y - ny * x)


def pushed(body: Any, at: tuple[float, float], impulse: tuple[float, float]) -> tuple[float, float]:
    """Change of the velocity [m/s] of a point [m] of a body that an impulse [N s] there makes."""
    (hub_x, hub_y), (jx, jy) = body.local_to_world(body.center_of_gravity), impulse
    x, y = at[0] - hub_x, at[1] - hub_y
    spin = (x * jy - y * jx) / body.moment
    return jx / body.mass - y * spin, jy / body.mass + x * spin
