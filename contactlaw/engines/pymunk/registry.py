"""Registered beads and plates of the pymunk adapter, and checks of shapes to be registered."""

from __future__ import annotations

import math
import warnings
import weakref
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from contactlaw._errors import ArgumentError
from contactlaw.engines.needs import CorBySpeed
from contactlaw.engines.pymunk.models import Answers, Models, ModelsByBead
from contactlaw.physical.arguments import scalars
from contactlaw.physical.materials import sphere_mass

if TYPE_CHECKING:
    import pymunk

    Face = pymunk.Segment | pymunk.Poly

Vector = tuple[float, float]
Edges = tuple[str | None, str | None]  # kinds of a plate's edges, at its start and its end
# a shared end [m], in the body's coordinates, and the other plate
Joint = tuple[float, float, "PlateShape"]
# Attribute of a registered shape with its `BeadShape` or `PlateShape`. The shape alone keeps them alive, because
# otherwise all beads that have ever been in a space would stay in memory. pymunk copies no attributes with _.
MARK = "_contactlaw"
LARGEST = 1.0  # radius [m] of a boulder; a larger one was given in pixels
# Allows for porosity and for a density that is not quite the material's. A disc, a mass of 1 or a
# diameter taken for the radius are far outside.
MASS_RATIO = 1.5


class BeadKind:
    """Beads that rebound alike."""

    def __init__(self, radius: float, material: int) -> None:
        self.radius, self.material = radius, material  # [m]; number in the models
        self.answers: dict[int, Answers] = {}  # by index of the plate


@dataclass(slots=True, eq=False, weakref_slot=True)
class BeadShape:
    """A registered sphere, which hits plates and other spheres."""

    index: int
    shape: weakref.ref[pymunk.Circle]
    kind: BeadKind
    models: Models
    shake: ClassVar[float] = 0.0  # nothing drives a bead; see `Mount`

    def __str__(self) -> str:
        return f"bead {self.index}"

    def velocity_at(self, circle: Any, at: Vector, normal: Vector) -> Vector:
        """Velocity of its surface [m/s] where a bead with this normal touches it."""
        (ux, uy), (nx, ny), speed = circle.body.velocity, normal, self.kind.radius * circle.body.angular_velocity
        return ux + speed * ny, uy - speed * nx

    def curve(self, bead: BeadShape) -> CorBySpeed:
        """COR by speed of a bead on this one."""
        return self.models.sphere_curve(*sorted((kind.radius, kind.material) for kind in (bead.kind, self.kind)))

    def check(self, circle: pymunk.Circle) -> None:
        """Refuse a circle that is no longer what was registered."""
        if circle.radius != self.kind.radius:
            raise ArgumentError(
                "radius",
                None,
                f"{self} was registered with {self.kind.radius!r} m and has {circle.radius!r} m now; "
                "remove_bead(circle) before unsafe_set_radius and add_bead(circle) after it, with the "
                "mass that belongs to the radius",
            )


@dataclass(slots=True, eq=False, weakref_slot=True)
class PlateShape:
    """A registered plate."""

    index: int
    shape: weakref.ref[Face]
    mount: Mount
    wall: Any  # the thickness [m], or what swings back
    models: ModelsByBead
    friction: float | None = None  # None: the engine's own
    edge: Edges | None = None  # None: endless
    joints: list[Joint] = field(default_factory=list)  # ends shared with other plates
    sides: list[Side] = field(default_factory=list)  # measured at the first impact

    def __str__(self) -> str:
        return f"plate {self.index}"

    @property
    def shake(self) -> float:
        """Change of its speed in each step [m/s]."""
        return self.mount.shake

    def answers(self, bead: BeadShape) -> Answers:
        """Answers for beads of this kind; made once."""
        kind = bead.kind
        if self.index not in kind.answers:
            model = self.models[kind.material]
            kind.answers[self.index] = Answers(model, kind.radius, self.wall, self.friction)
        return kind.answers[self.index]

    def curve(self, bead: BeadShape) -> CorBySpeed:
        """COR by speed of a bead on this plate, far from its edges."""
        return self.answers(bead).cor

    def velocity_at(self, shape: Any, at: Vector, normal: Vector) -> Vector:
        """Velocity of the plate [m/s] where a bead touches it."""
        if self.mount.still:
            return 0.0, 0.0
        velocity: Vector = shape.body.velocity_at_world_point(at)
        return velocity


class Side(NamedTuple):
    """A straight piece of a plate, in coordinates of its body [m]."""

    start: Vector
    along: Vector  # of length 1, from the start
    length: float
    # Kinds of the edges beyond the start and the end, and how far from there they are.
    edges: tuple[tuple[str, float], tuple[str, float]]


@dataclass(slots=True, eq=False)
class Mount:
    """A rigid body that carries plates, with its motion in the present step."""

    body: weakref.ref[pymunk.Body]
    extent: float = 0.0  # largest distance of a plate's corner from its centre of gravity [m]
    # To ask pymunk for the velocity of a point takes a tenth of the time of a collision.
    still: bool = True  # whether it has no velocity
    static: bool = True  # whether the engine never moves it
    free: bool = False  # whether impacts move it
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)  # at the last step [m/s], [rad/s]
    change: float = 0.0  # change of that velocity in the last step [m/s]
    shake: float = 0.0  # the change per step of a body that keeps changing, else about 0 [m/s]

    def watch(self, dt: float) -> float:
        """Prepare for a step; return the speed of the fastest point of its plates [m/s]."""
        import pymunk

        body: Any = self.body()
        if body is None:
            return 0.0
        (vx, vy), spin = body.velocity, body.angular_velocity
        self.still = not (vx or vy or spin)
        self.static = body.body_type == pymunk.Body.STATIC
        self.free = body.body_type == pymunk.Body.DYNAMIC  # its change is the impacts' work
        old_vx, old_vy, old_spin = self.velocity
        turning = self.extent * (abs(spin - old_spin) + spin**2 * dt)
        change = 0.0 if self.static or self.free else math.hypot(vx - old_vx, vy - old_vy) + turning
        # The smaller change of two steps: a plate that jumps to its speed does not shake.
        self.shake = min(change, self.change)
        self.velocity, self.change = (vx, vy, spin), change
        return 0.0 if self.static else math.hypot(vx, vy) + abs(spin) * self.extent

    def local(self, x: float, y: float) -> Vector:
        """Point in coordinates of the body [m]."""
        body: Any = self.body()
        point: Vector = body.world_to_local((x, y))
        return point


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


def body_of(shape: Any, kinds: tuple[type, ...], space: pymunk.Space, collision_types: tuple[int, int]) -> Any:
    """Body of a shape that may be registered."""
    if not isinstance(shape, kinds):
        expected = " or ".join(f"pymunk.{kind.__name__}" for kind in kinds)
        raise TypeError(f"expected a {expected}, got {shape!r}")
    shape_of: Any = shape
    if shape_of.collision_type in collision_types and hasattr(shape, MARK):
        raise ValueError(f"{shape!r} is registered already")
    if shape_of.body is None or shape_of.sensor:
        raise ValueError(f"{shape!r} has no body, or is a sensor: it would never rebound")
    if shape_of.space not in (None, space):
        raise ValueError(f"{shape!r} belongs to another space")
    if shape_of.collision_type not in (0, *collision_types):  # a copied shape has the adapter's type
        remedy = "leave it 0 and make handlers for impacts.bead_type and impacts.plate_type"
        reason = f"the attachment needs its own for {shape!r}; {remedy}"
        raise ArgumentError("collision_type", shape_of.collision_type, reason)
    return shape_of.body


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


def forget(shape: Any) -> None:
    """Make a registered shape an ordinary one again."""
    delattr(shape, MARK)
    shape.collision_type = 0


def unregistered(shape: Any) -> ValueError:
    """Make the error for a shape with the adapter's collision type that is not registered."""
    return ValueError(
        f"{shape!r} has the collision type of this attachment, but was never registered (a copy of "
        "a bead?): call add_bead or add_plate"
    )
