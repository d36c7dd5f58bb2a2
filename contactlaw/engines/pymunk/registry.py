"""Registered beads and plates of the pymunk adapter, and checks of shapes to be registered."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from contactlaw._errors import ArgumentError
from contactlaw.engines.pymunk.models import Answers, name_of
from contactlaw.physical.materials import sphere_mass

if TYPE_CHECKING:
    import pymunk

Vector = tuple[float, float]
# Attribute of a registered shape with its `BeadShape` or `PlateShape`. The shape alone keeps them alive, because
# otherwise all beads that have ever been in a space would stay in memory. pymunk copies no attributes with _.
MARK = "_contactlaw"
LARGEST = 1.0  # radius [m] of a boulder; a larger one was given in pixels
# Allows for porosity and for a density that is not quite the material's. A disc, a mass of 1 or a
# diameter taken for the radius are far outside.
MASS_RATIO = 1.5


@dataclass(slots=True, eq=False, weakref_slot=True)
class BeadKind:
    """Beads that rebound alike."""

    radius: float  # [m]
    material: int  # number in the models
    answers: dict[int, Answers] = field(default_factory=dict)  # by index of the plate


@dataclass(slots=True, eq=False)
class BeadShape:
    """A registered sphere, which hits plates and other spheres."""

    index: int
    kind: BeadKind

    def __str__(self) -> str:
        return f"bead {self.index}"


@dataclass(slots=True, eq=False)
class PlateShape:
    """A registered plate."""

    index: int
    shape: Any
    mount: Mount
    wall: Any  # the thickness [m], or what swings back
    material: int  # number in the models
    friction: float | None = None  # None: the engine's own
    edge: str | None = None  # None: endless
    joints: list[tuple[pymunk.Vec2d, PlateShape]] = field(default_factory=list)  # shared ends, and with whom
    # Straight pieces in coordinates of the body, measured at the first impact: the start, the direction, the length,
    # and at either end the kind of the edge beyond it and how far from there that is.
    sides: list[Any] = field(default_factory=list)

    def __str__(self) -> str:
        return f"plate {self.index}"


@dataclass(slots=True)
class Mount:
    """The motion in the present step of a rigid body that carries plates."""

    extent: float = 0.0  # largest distance of a plate's corner from its centre of gravity [m]
    # To ask pymunk for the velocity of a point takes a tenth of the time of a collision.
    still: bool = True  # whether it has no velocity
    free: bool = False  # whether impacts move it
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)  # at the last step [m/s], [rad/s]
    change: float = 0.0  # change of that velocity in the last step [m/s]
    shake: float = 0.0  # the change per step of a body that keeps changing, else about 0 [m/s]

    def watch(self, body: pymunk.Body, dt: float) -> float:
        """Prepare for a step; return the speed of the fastest point of its plates [m/s]."""
        (vx, vy), spin = body.velocity, body.angular_velocity
        self.still = not (vx or vy or spin)
        static = is_static(body)
        self.free = body.body_type == body.DYNAMIC
        old_vx, old_vy, old_spin = self.velocity
        turning = self.extent * (abs(spin - old_spin) + spin**2 * dt)
        # The change of a free body is the impacts' work.
        change = 0.0 if static or self.free else math.hypot(vx - old_vx, vy - old_vy) + turning
        # The smaller change of two steps: a plate that jumps to its speed does not shake.
        self.shake = min(change, self.change)
        self.velocity, self.change = (vx, vy, spin), change
        return 0.0 if static else math.hypot(vx, vy) + abs(spin) * self.extent


def is_static(body: pymunk.Body) -> bool:
    """Whether the engine never moves a body."""
    return body.body_type == body.STATIC


def registered(shapes: Iterable[Any]) -> Iterator[tuple[Any, BeadShape | PlateShape]]:
    """Find the registered ones of some shapes."""
    for shape in shapes:
        if (mark := getattr(shape, MARK, None)) is not None:
            yield shape, mark


def ends(shape: Any) -> list[pymunk.Vec2d]:
    """Corners of a plate [m], in coordinates of its body; those of a polygon in order."""
    return [shape.a, shape.b] if hasattr(shape, "a") else shape.get_vertices()


def check_bead(circle: pymunk.Circle, body: pymunk.Body, radius: float) -> None:
    """Refuse a circle that is no single sphere, or is measured in pixels."""
    if radius > LARGEST:
        raise ArgumentError(
            "radius",
            radius,
            f"above {LARGEST:g} m; are these pixels? Space, gravity, speeds and shapes must be in "
            "metres and seconds; where you draw, pymunk.SpaceDebugDrawOptions has a transform",
        )
    if body.body_type != body.DYNAMIC:
        raise ArgumentError("circle.body", body, "a bead needs a dynamic body")
    solid = [shape for shape in body.shapes if not shape.sensor]
    if len(solid) > 1 or any(circle.offset) or any(body.center_of_gravity):
        raise ArgumentError(
            "circle.body",
            None,
            "has other shapes, or its centre of gravity is not that of the circle; a bead is a single sphere: give "
            "each circle a body of its own, or simulate clumps with LAMMPS's fix rigid/small",
        )


def check_mass(mass: float, radius: float, material: Any) -> None:
    """Warn of a mass that is not the sphere's; to be called by `add_bead`."""
    if not hasattr(material, "density"):
        return
    sphere = sphere_mass(material.density, radius)
    if not sphere / MASS_RATIO <= mass <= sphere * MASS_RATIO:
        warnings.warn(
            f"body.mass: {mass:.4g} kg, but a sphere of {name_of(material)} of radius {radius:.4g} m has "
            f"{sphere:.4g} kg, and the COR and the energies in the record are that sphere's; set "
            "body.mass = 4/3*pi*radius**3*density",
            stacklevel=3,
        )
