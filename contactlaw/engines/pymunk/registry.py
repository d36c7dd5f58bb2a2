"""Registered beads and plates of the pymunk adapter, and checks of shapes to be registered."""

from __future__ import annotations

import math
import warnings
import weakref
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

from contactlaw._errors import ArgumentError
from contactlaw.engines.needs import CorBySpeed, knows
from contactlaw.engines.pymunk.friction import Slide, check_moment, slide_of
from contactlaw.engines.pymunk.models import ModelsByBead
from contactlaw.physical.arguments import scalars
from contactlaw.physical.materials import sphere_mass
from contactlaw.physical.plates import sheet_of

if TYPE_CHECKING:
    import pymunk

    Face = pymunk.Segment | pymunk.Poly

Vector = tuple[float, float]
Edges = tuple[str | None, str | None]  # kinds of a plate's edges, at its start and its end
BeadKind = tuple[float, int]  # beads that rebound alike: radius [m], number of the material
# a shared end [m], in the body's coordinates, and the other plate
Joint = tuple[float, float, "PlateShape"]
LARGEST = 1.0  # radius [m] of a boulder; a larger one was given in pixels
# Allows for porosity and for a density that is not quite the material's. A disc, a mass of 1 or a
# diameter taken for the radius are far outside.
MASS_RATIO = 1.5


# The attachment holds weak references to shapes and bodies, because otherwise all beads that have
# ever been in a space would stay in memory.
@dataclass(slots=True, eq=False)
class BeadShape:
    """A registered sphere, which hits plates and other spheres."""

    index: int
    shape: weakref.ref[pymunk.Circle]
    body: weakref.ref[pymunk.Body]
    body_id: int  # pymunk may give it to another body after this one
    radius: float
    kind: BeadKind
    # COR by speed of two beads, the smaller first
    pair_curve: Callable[[BeadKind, BeadKind], CorBySpeed]
    shake: ClassVar[float] = 0.0  # nothing drives a bead; see `PlateShape`

    def __str__(self) -> str:
        return f"bead {self.index}"

    def touched(self, circle: Any, at: Vector, normal: Vector) -> Vector:
        """Where it is touched [m] by a bead with this normal."""
        (x, y), (nx, ny) = circle.body.position, normal
        return x - self.radius * nx, y - self.radius * ny

    def velocity_at(self, circle: Any, at: Vector, normal: Vector) -> Vector:
        """Velocity of its surface [m/s] where a bead with this normal touches it."""
        (ux, uy), (nx, ny), speed = circle.body.velocity, normal, self.radius * circle.body.angular_velocity
        return ux + speed * ny, uy - speed * nx

    def curve(self, bead: BeadShape, shape: pymunk.Circle) -> CorBySpeed:
        """COR by speed of a bead on this one."""
        if shape.radius != self.radius:
            raise changed(self, shape)
        return self.pair_curve(*sorted((bead.kind, self.kind)))


@dataclass(slots=True, eq=False)
class PlateShape:
    """A registered plate, and its state from step to step."""

    index: int
    shape: weakref.ref[Face]
    mount: Mount
    thickness: float
    wall: Any  # the thickness, or what swings back
    models: ModelsByBead
    friction: float | None = None  # None: the engine's own
    edge: Edges | None = None  # None: endless
    joints: list[Joint] = field(default_factory=list)  # ends shared with other plates
    curves: dict[BeadKind, CorBySpeed] = field(default_factory=dict)
    slides: dict[BeadKind, Slide] = field(default_factory=dict)
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)  # at the last step [m/s], [rad/s]
    change: float = 0.0  # change of that velocity in the last step [m/s]
    shake: float = 0.0  # the change per step of a plate that keeps changing, else about 0 [m/s]

    def __str__(self) -> str:
        return f"plate {self.index}"

    def curve(self, bead: BeadShape, shape: pymunk.Shape) -> CorBySpeed:
        """COR by speed of beads of this kind; made once."""
        curve = self.curves.get(bead.kind)
        if curve is None:
            radius, material = bead.kind
            curve = self.models[material].curve(radius, self.thickness)
            if sheet_of(self.wall) is not self.wall:
                curve = self.models.swinging(bead.kind, self.wall)
            self.curves[bead.kind] = curve
        return curve

    def slide(self, bead: BeadShape) -> Slide:
        """Sliding speed after impacts of beads of this kind on a plate with friction; made once."""
        slide = self.slides.get(bead.kind)
        if slide is None:
            radius, material = bead.kind
            model: Any = self.models[material]
            slide = slide_of(model, radius, self.wall, self.friction or 0.0)
            self.slides[bead.kind] = slide
        return slide

    def touched(self, shape: Any, at: Vector, normal: Vector) -> Vector:
        """Where it is touched [m]: where the bead touches it."""
        return at

    def velocity_at(self, shape: Any, at: Vector, normal: Vector) -> Vector:
        """Velocity of the plate [m/s] where a bead touches it."""
        mount = self.mount
        if mount.still:
            return 0.0, 0.0
        if mount.still is None:
            mount.still = not any(shape.body.velocity) and not shape.body.angular_velocity
        velocity: Vector = shape.body.velocity_at_world_point(at)
        return velocity

    def watch(self, body: pymunk.Body, dt: float) -> float:
        """Update `shake` of a kinematic plate; return the speed of its fastest point [m/s]."""
        import pymunk

        shape = self.shape()
        if shape is None:
            return 0.0
        (vx, vy), spin = body.velocity, body.angular_velocity
        centre = body.center_of_gravity
        extent = max((end - centre).length for end in ends(shape))
        if body.body_type == pymunk.Body.KINEMATIC:  # a dynamic one is moved by the impacts
            old_vx, old_vy, old_spin = self.velocity
            turning = extent * (abs(spin - old_spin) + spin**2 * dt)
            change = math.hypot(vx - old_vx, vy - old_vy) + turning
            # The smaller change of two steps: a plate that jumps to its speed does not shake.
            self.shake = min(change, self.change)
            self.velocity, self.change = (vx, vy, spin), change
        return math.hypot(vx, vy) + abs(spin) * extent


@dataclass(slots=True, eq=False)
class Mount:
    """A rigid body that carries plates, with its pose in the present step."""

    key: int  # id of the body
    body: weakref.ref[pymunk.Body]
    plates: dict[int, PlateShape] = field(default_factory=dict)
    # Whether the body has no velocity; None for a static body, until that is looked up. To ask
    # pymunk for the velocity of a point takes a tenth of the time of a collision.
    still: bool | None = False
    free: bool = False  # whether impacts move the body
    frame: tuple[float, float, float, float] | None = None  # origin [m], cosine and sine of angle

    def watch(self, dt: float) -> float:
        """Prepare for a step; return the speed of the fastest point of its plates [m/s]."""
        import pymunk

        body = self.body()
        self.frame = None
        if body is None or body.body_type == pymunk.Body.STATIC:
            if self.still is False:
                for plate in self.plates.values():
                    plate.shake = plate.change = 0.0
            self.still, self.free = None, False
            return 0.0
        self.still = False
        self.free = body.body_type == pymunk.Body.DYNAMIC
        return max((plate.watch(body, dt) for plate in self.plates.values()), default=0.0)

    def local(self, x: float, y: float) -> Vector:
        """Point in coordinates of the body [m]."""
        if self.frame is None:
            body: Any = self.body()
            self.frame = (*body.local_to_world((0.0, 0.0)), *body.rotation_vector)
        u, v, c, s = self.frame
        return c * (x - u) + s * (y - v), c * (y - v) - s * (x - u)


def ends(shape: Face) -> list[pymunk.Vec2d]:
    """Corners of a plate [m], in coordinates of its body; those of a polygon in order."""
    import pymunk

    return [shape.a, shape.b] if isinstance(shape, pymunk.Segment) else shape.get_vertices()


def may_meet(circle: pymunk.Circle, shape: pymunk.Shape) -> bool:
    """Whether both are in one space, no sensors, and their filters let them meet."""
    a, b = circle.filter, shape.filter
    grouped = a.group != 0 and a.group == b.group
    masked = not (a.categories & b.mask and b.categories & a.mask)
    if circle.space is None or circle.space is not shape.space or circle.sensor or shape.sensor:
        return False
    return not (grouped or masked)


def body_of(shape: Any, kinds: Sequence[type], space: pymunk.Space, collision_type: int) -> pymunk.Body:
    """Body of a shape that may be registered."""
    if not isinstance(shape, tuple(kinds)):
        expected = " or ".join(f"pymunk.{kind.__name__}" for kind in kinds)
        raise TypeError(f"expected a {expected}, got {shape!r}")
    shape_of: Any = shape
    body: pymunk.Body | None = shape_of.body
    if body is None or shape_of.sensor:
        raise ValueError(f"{shape!r} has no body, or is a sensor: it would never rebound")
    if shape_of.space not in (None, space):
        raise ValueError(f"{shape!r} belongs to another space")
    if shape_of.collision_type not in (0, collision_type):  # a copied shape has the adapter's type
        remedy = "leave it 0 and make handlers for impacts.bead_type and impacts.plate_type"
        reason = f"the attachment needs its own for {shape!r}; {remedy}"
        raise ArgumentError("collision_type", shape_of.collision_type, reason)
    return body


def radius_of(circle: pymunk.Circle) -> float:
    """Radius of a bead, in metres."""
    radius = float(scalars(radius=circle.radius)[0][0])
    if radius > LARGEST:
        raise ArgumentError(
            "radius",
            radius,
            f"above {LARGEST:g} m; are these pixels? Space, gravity, speeds and shapes must be in "
            "metres and seconds; where you draw, pymunk.SpaceDebugDrawOptions has a transform",
        )
    return radius


def changed(bead: BeadShape, circle: pymunk.Circle) -> ValueError:
    """Make the error for a circle that is no longer what was registered."""
    return ArgumentError(
        "radius",
        None,
        f"{bead} was registered with {bead.radius!r} m and has {circle.radius!r} m now; "
        "remove_bead(circle) before unsafe_set_radius and add_bead(circle) after it, with the "
        "mass that belongs to the radius",
    )


def check_alone(circle: pymunk.Circle, body: pymunk.Body) -> None:
    """Refuse a circle that is a part of a rigid body."""
    solid = [shape for shape in body.shapes if not shape.sensor]
    if len(solid) > 1 or any(circle.offset) or any(body.center_of_gravity):
        raise ArgumentError(
            "circle.body",
            None,
            "has other shapes, or its centre of gravity is not that of the circle; a bead is a single sphere: give "
            "each circle a body of its own, or simulate clumps with LAMMPS's fix rigid/small",
        )


def check_mass(mass: float, radius: float, density: float | None, name: str) -> None:
    """Warn of a mass that is not the sphere's; to be called by `add_bead`."""
    if density is None:
        return
    sphere = sphere_mass(density, radius)
    if not sphere / MASS_RATIO <= mass <= sphere * MASS_RATIO:
        warnings.warn(
            f"body.mass: {mass:.4g} kg, but a sphere of {name} of radius {radius:.4g} m has "
            f"{sphere:.4g} kg, and the COR and the energies in the record are that sphere's; set "
            "body.mass = 4/3*pi*radius**3*density",
            stacklevel=3,
        )


def check_solid(circle: Any, radius: float, rough: Iterable[Any]) -> None:
    """Refuse a bead without a sphere's moment that may meet a plate with friction."""
    try:
        check_moment(circle.body, radius)
    except ValueError:
        if any(shape is not None and may_meet(circle, shape) for shape in rough):
            raise


def friction_of(friction: float, models: ModelsByBead, shape: Any, beads: Iterable[BeadShape]) -> float:
    """Coefficient of friction of a new plate, if its models and all beads are fit for it."""
    friction = float(scalars(friction=friction)[0][0])
    for model in models.values():
        if not knows(model, "oblique"):
            raise TypeError(
                f"friction: {model!r} knows none, it has no oblique(); leave friction=None, which "
                "is pymunk's own, or give an ImpactModel"
            )
    for bead in beads if friction else ():
        circle = bead.shape()
        if circle is not None:
            check_solid(circle, bead.radius, [shape])
    return friction


def unregistered(shape: Any) -> ValueError:
    """Make the error for a shape with the adapter's collision type that is not registered."""
    return ValueError(
        f"{shape!r} has the collision type of this attachment, but was never registered (a copy of "
        "a bead?): call add_bead or add_plate"
    )
