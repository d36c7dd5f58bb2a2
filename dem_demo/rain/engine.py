"""The rain in pymunk: two dimensions, each impact resolved in one step."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pymunk
from numpy.typing import NDArray

from contactlaw.engines import pymunk as adapter
from dem_demo.kit import signals
from dem_demo.kit.beads import FLYING, GONE, GRAVITY, WAITING, Floats
from dem_demo.rain.scene import Scene

if TYPE_CHECKING:
    from contactlaw import ImpactModel, Record


class Frame(NamedTuple):
    """One instant of every bead.

    Position (N, 2) [m], velocity (N, 2) [m/s], status (N,), and spin (N,) [rad/s],
    counterclockwise in the figures.
    """

    position: Floats
    velocity: Floats
    status: NDArray[np.uint8]
    spin: Floats


class Rain:
    """A scene in a pymunk space: the bodies in it, and the current frame.

    Parameters
    ----------
    scene : Scene
        Beads and plates.
    model : ImpactModel
        Where each collision's COR comes from.
    """

    def __init__(self, scene: Scene, model: ImpactModel) -> None:
        self.scene = scene
        self.space = pymunk.Space()
        self.space.gravity = (0.0, -GRAVITY)
        self.space.collision_slop = 0.01 * float(scene.beads.radius.min())
        # For fast small beads far apart a step takes 0.1 ms with the hash, 0.5 ms with the tree.
        cell, cells = 4.0 * float(scene.beads.radius.max()), 10 * scene.beads.radius.size
        self.space.use_spatial_hash(cell, cells)
        self.impacts = adapter.attach(self.space, model)
        for plate in scene.plates:
            ends = (plate.x0, plate.y), (plate.x1, plate.y)
            segment = pymunk.Segment(self.space.static_body, *ends, radius=0.0)
            self.space.add(segment)
            friction = scene.friction or None
            self.impacts.add_plate(segment, plate.thickness, friction=friction, edge="free")
        self.mass = scene.beads.mass(scene.sphere_material.density)
        # First step of each bead: the one that begins after its emission.
        self.first_step = np.ceil(scene.beads.emission_time / scene.time_step).astype(int).tolist()
        self.flying: dict[int, tuple[pymunk.Body, pymunk.Circle]] = {}
        self.steps = 0
        self.emitted = 0
        n = scene.beads.radius.size
        self.now = Frame(
            scene.beads.position.copy(), scene.beads.velocity.copy(), np.full(n, WAITING, np.uint8), np.zeros(n)
        )

    def advance(self) -> None:
        """Simulate one frame, emitting beads when their time has come."""
        signals.check()
        dt, first, space = self.scene.time_step, self.first_step, self.space
        for _ in range(self.scene.steps_per_frame):
            while self.emitted < len(first) and first[self.emitted] <= self.steps:
                self._emit(self.emitted)
                self.emitted += 1
            space.step(dt)
            self.steps += 1

    def _emit(self, n: int) -> None:
        beads = self.scene.beads
        mass, radius = float(self.mass[n]), float(beads.radius[n])
        body = pymunk.Body(mass, 0.4 * mass * radius**2)  # moment of inertia of a solid sphere
        body.position = tuple(beads.position[n].tolist())
        body.velocity = tuple(beads.velocity[n].tolist())
        circle = pymunk.Circle(body, radius)
        self.space.add(body, circle)
        # Registered in the order of emission, beads have the same index in adapter and scene.
        self.impacts.add_bead(circle)
        self.flying[n] = body, circle
        self.now.status[n] = FLYING

    def look(self) -> Frame:
        """Read the bodies, and take those below the floor out of the space."""
        for n, (body, circle) in list(self.flying.items()):
            self.now.position[n] = body.position
            self.now.velocity[n] = body.velocity
            self.now.spin[n] = body.angular_velocity
            if self.now.position[n, 1] < self.scene.floor:
                self.now.status[n] = GONE
                self.now.velocity[n] = self.now.spin[n] = 0.0
                self.space.remove(circle, body)
                del self.flying[n]
        return self.now

    def record(self) -> Record:
        """All impacts so far."""
        return self.impacts.record()
