"""The rain in pymunk: two dimensions, each impact resolved in one step."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np
import pymunk

from contactlaw.engines import pymunk as adapter
from dem_demo.kit import signals
from dem_demo.kit.run import Frame
from dem_demo.kit.scene import FLYING, GONE, GRAVITY, WAITING
from dem_demo.rain.scene import Shower

if TYPE_CHECKING:
    from contactlaw import ImpactModel, Record


class Rain:
    """A scene in a pymunk space: the bodies in it, and the current frame.

    Parameters
    ----------
    scene : Shower
        Beads and plates.
    model : ImpactModel
        Where each collision's COR comes from.
    """

    def __init__(self, scene: Shower, model: ImpactModel) -> None:
        self.scene = scene
        self.space = pymunk.Space()
        self.space.gravity = (0.0, -GRAVITY)
        self.space.collision_slop = 0.01 * float(scene.radius.min())
        # For fast small beads far apart a step takes 0.1 ms with the hash, 0.5 ms with the tree.
        cell, cells = 4.0 * float(scene.radius.max()), 10 * scene.radius.size
        self.space.use_spatial_hash(cell, cells)
        self.impacts = adapter.attach(self.space, model)
        for (left, right), thickness in zip(scene.ends.tolist(), scene.plates, strict=True):
            segment = pymunk.Segment(self.space.static_body, (left, 0.0), (right, 0.0), radius=0.0)
            self.space.add(segment)
            self.impacts.add_plate(segment, thickness, friction=scene.friction or None, edge="free")
        self.mass = scene.mass
        # First step of each bead: the one that begins after its emission.
        self.first_step = np.ceil(scene.emission_time / scene.time_step).astype(int).tolist()
        self.flying: dict[int, tuple[pymunk.Body, pymunk.Circle]] = {}
        self.steps = 0
        self.emitted = 0
        n, self.began = scene.radius.size, time.perf_counter()
        status = np.full(n, WAITING, np.uint8)
        self.now = Frame(scene.position.copy(), scene.velocity.copy(), np.zeros((n, 1)), status, 0.0)

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
        scene = self.scene
        mass, radius = float(self.mass[n]), float(scene.radius[n])
        body = pymunk.Body(mass, 0.4 * mass * radius**2)  # moment of inertia of a solid sphere
        body.position = tuple(scene.position[n].tolist())
        body.velocity = tuple(scene.velocity[n].tolist())
        circle = pymunk.Circle(body, radius)
        self.space.add(body, circle)
        # Registered in the order of emission, beads have the same index in adapter and scene.
        self.impacts.add_bead(circle)
        self.flying[n] = body, circle
        self.now.status[n] = FLYING

    def look(self) -> Frame:
        """Read the bodies, and take those below the floor out of the space."""
        for n, (body, circle) in list(self.flying.items()):
            if body.position.y < self.scene.floor:
                self.now.status[n] = GONE
                self.space.remove(circle, body)
                del self.flying[n]
                continue
            self.now.position[n] = body.position
            self.now.velocity[n] = body.velocity
            if self.scene.friction:  # without it, the spin is rounding
                self.now.spin[n] = body.angular_velocity
        return self.now._replace(elapsed=time.perf_counter() - self.began)

    def record(self) -> Record:
        """All impacts so far."""
        return self.impacts.record()
