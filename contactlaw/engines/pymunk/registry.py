"""Beads and plates as the pymunk adapter knows them, and what may become one."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

from contactlaw.engines.needs import Curve, RestitutionModel, knows_beads
from contactlaw.physical.arguments import broadcast, check

if TYPE_CHECKING:
    import pymunk

Vector = tuple[float, float]
NEVER = (-1, 0.0, 0.0)  # what `Plate.touched` has of a bead that never did


@dataclass(slots=True, eq=False)
class Bead:
    """A registered sphere, which hits plates and other spheres."""

    index: int
    circle: pymunk.Circle
    body: pymunk.Body
    radius: float
    pair_curve: Callable[[float, float], Curve]  # of two beads by their radii, the smaller first
    shake: ClassVar[float] = 0.0  # nothing drives a bead; see `Plate`

    def __str__(self) -> str:
        return f"bead {self.index}"

    def contact(self, nx: float, ny: float) -> Vector:
        """Point of its surface in the direction of a normal [m]."""
        x, y = self.body.position
        return x + self.radius * nx, y + self.radius * ny

    def curve(self, radius: float) -> Curve:
        """Restitution of a bead of this radius on this one by speed."""
        return self.pair_curve(*sorted((radius, self.radius)))

    def motion(self, bead: Bead, nx: float, ny: float) -> tuple[Vector, None]:
        """Its velocity [m/s]; the normal is through its centre, so that any point will do."""
        return self.body.velocity, None

    def passed(self, bead: Bead, nx: float, ny: float, step: int) -> bool:
        """Beads that were pressed through each other go unnoticed."""
        return False


@dataclass(slots=True, eq=False)
class Plate:
    """A registered plate, and what is remembered of it from step to step."""

    index: int
    segment: pymunk.Segment
    body: pymunk.Body
    thickness: float
    model: RestitutionModel
    curves: dict[float, Curve] = field(default_factory=dict)  # by bead radius
    # by bead: the last step in which it touched, and the normal then
    touched: dict[int, tuple[int, float, float]] = field(default_factory=dict)
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)  # at the last step [m/s], [rad/s]
    change: float = 0.0  # of that velocity, within the last step [m/s]
    shake: float = 0.0  # the same while it goes on, else about 0 [m/s]

    def __str__(self) -> str:
        return f"plate {self.index}"

    def curve(self, radius: float) -> Curve:
        """Restitution of beads of this radius by speed; made once."""
        curve = self.curves.get(radius)
        if curve is None:
            curve = self.curves[radius] = self.model.curve(radius, self.thickness)
        return curve

    def motion(self, bead: Bead, nx: float, ny: float) -> tuple[Vector, Vector]:
        """Its velocity [m/s] at the point [m] where a bead touches it, and that point."""
        point = bead.contact(nx, ny)
        return self.body.velocity_at_world_point(point), point

    def passed(self, bead: Bead, nx: float, ny: float, step: int) -> bool:
        """Whether a bead that touches has been pressed through: its normal has turned round."""
        last, old_nx, old_ny = self.touched.get(bead.index, NEVER)
        self.touched[bead.index] = (step, nx, ny)
        return last == step - 1 and old_nx * nx + old_ny * ny < 0.0

    def watch(self, dt: float) -> float:
        """Update `shake` of a kinematic plate; speed of the plate's fastest point [m/s]."""
        import pymunk

        body = self.body
        if body.body_type == pymunk.Body.STATIC:
            self.shake = self.change = 0.0
            return 0.0
        (vx, vy), spin = body.velocity, body.angular_velocity
        ends, centre = (self.segment.a, self.segment.b), body.center_of_gravity
        extent = max((end - centre).length for end in ends)
        if body.body_type == pymunk.Body.KINEMATIC:  # a dynamic one is moved by the impacts
            old_vx, old_vy, old_spin = self.velocity
            turning = extent * (abs(spin - old_spin) + spin**2 * dt)
            change = math.hypot(vx - old_vx, vy - old_vy) + turning
            # The lesser of two steps: a plate that jumps to its speed strikes, it does not shake.
            self.shake = min(change, self.change)
            self.velocity, self.change = (vx, vy, spin), change
        return math.hypot(vx, vy) + abs(spin) * extent


def body_of(shape: Any, kind: type, space: pymunk.Space, collision_type: int) -> pymunk.Body:
    """Body of a shape that may be registered."""
    if not isinstance(shape, kind):
        raise TypeError(f"expected a pymunk.{kind.__name__}, got {shape!r}")
    shape_of: Any = shape
    body: pymunk.Body | None = shape_of.body
    if body is None or shape_of.sensor:
        raise ValueError(f"{shape!r} has no body, or is a sensor: it would never rebound")
    if shape_of.space not in (None, space):
        raise ValueError(f"{shape!r} belongs to another space")
    if shape_of.collision_type not in (0, collision_type):  # a copied shape brings ours with it
        raise ValueError(
            f"collision_type: the attachment needs its own, {shape!r} has "
            f"{shape_of.collision_type}; leave it 0 and make handlers for impacts.bead_type and "
            "impacts.plate_type"
        )
    return body


def checked_model(
    model: RestitutionModel, beads: RestitutionModel | None = None
) -> RestitutionModel:
    """Refuse what cannot answer, or answers for other spheres than the model of the beads."""
    if not callable(getattr(model, "curve", None)):
        raise TypeError(f"model: expected an ImpactModel, or a like with curve(), got {model!r}")
    own, others = _sphere(model), _sphere(beads)
    if None not in (own, others) and own != others:
        raise ValueError(f"model: made for spheres of {own}, but the beads are of {others}")
    return model


def _sphere(model: RestitutionModel | None) -> Any:
    return getattr(getattr(model, "pair", None), "sphere", None)


def scalar(**argument: float) -> float:
    """One number within the limits of the argument of that name."""
    values, shape = broadcast(**argument)
    check(**dict.fromkeys(argument, values))
    if shape is not None:
        raise ValueError(f"{next(iter(argument))}: expected one number, got shape {shape}")
    return float(values[0])


def sphere_curve(model: RestitutionModel, radius: float, other_radius: float) -> Curve:
    """Restitution of two beads by speed."""
    if not knows_beads(model):
        raise TypeError(f"beads meet, but {model!r} has no sphere_sphere_curve()")
    return model.sphere_sphere_curve(radius, other_radius)


def unregistered(shape: Any) -> ValueError:
    """Make the error for a shape that copied a collision type."""
    return ValueError(
        f"{shape!r} has the collision type of this attachment, but was never registered (a copy of "
        "a bead?): call add_bead or add_plate"
    )
