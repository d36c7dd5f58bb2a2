"""Checks before every step of a pymunk space: finite numbers, and no bead jumps over a plate."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contactlaw.engines.pymunk.registry import MARK, BeadShape, Mount, PlateShape

if TYPE_CHECKING:
    import pymunk

Array = NDArray[np.float64]
Pair = tuple[BeadShape, Any, Any]  # a bead, its circle, and a shape that it may pass through


class TunnellingError(RuntimeError):
    """A bead would pass, or has passed, through a plate without an impact.

    Attributes
    ----------
    bead, plate : int
        Indices in the record of impacts.
    time : float
        Time at the end of the step in question [s].
    speed : float
        Normal speed of the bead relative to the plate [m/s].
    safe_step : float or None
        Steps below this would have been safe [s]. None if the bead was pressed through the plate
        bit by bit, because of overlaps or too few iterations.
    """

    def __init__(self, bead: int, plate: int, time: float, speed: float, safe_step: float | None) -> None:
        super().__init__(bead, plate, time, speed, safe_step)  # the arguments as given, for pickle
        self.bead, self.plate, self.time = bead, plate, time
        self.speed, self.safe_step = speed, safe_step

    def __str__(self) -> str:
        what, remedy = "was pressed through", "use smaller steps, or more space.iterations"
        if self.safe_step is not None:
            what = "would pass unnoticed through"
            remedy = f"use steps below {self.safe_step:.3g} s"
        return (
            f"bead {self.bead} {what} plate {self.plate} in the step to t = {self.time:.9g} s, "
            f"at a normal speed of {self.speed:.6g} m/s: {remedy}"
        )


class LookAhead:
    """Checks of one space; the caller sets `reach`, the radius of the smallest bead [m]."""

    def __init__(
        self,
        space: pymunk.Space,
        beads: Mapping[int, BeadShape],
        plates: Mapping[int, PlateShape],
        mounts: Mapping[pymunk.Body, Mount],
    ) -> None:
        from pymunk.batch import BodyFields, Buffer

        self.reach = math.inf
        self._space, self._beads, self._plates, self._mounts = space, beads, plates, mounts
        self._buffer = Buffer()
        self._fields = BodyFields.BODY_ID | BodyFields.POSITION | BodyFields.VELOCITY

    def check(self, dt: float, time: float) -> None:
        """Raise if the step from `time` on would lose an impact, or starts from a NaN."""
        from pymunk.batch import get_space_bodies

        mounts = [(mount.watch(dt) * dt, mount) for mount in self._mounts.values()]
        self._buffer.clear()
        get_space_bodies(self._space, self._fields, self._buffer)
        motion = np.frombuffer(self._buffer.float_buf()).reshape(-1, 4)
        # No speed exceeds sqrt(2) times the largest component. With a NaN this is false.
        most = max((travel for travel, _ in mounts), default=0.0)
        if not len(motion) or math.sqrt(2) * dt * max(motion.max(), -motion.min()) + most < self.reach:
            return
        ids = np.frombuffer(self._buffer.int_buf(), np.uintp).tolist()
        for n in np.flatnonzero(~np.isfinite(motion).all(axis=1)):
            self._refuse(ids[n], motion[n])
        paths = np.hypot(motion[:, 2], motion[:, 3]) * dt
        pairs: list[Pair] = []
        for far, mount in ((travel + paths.max(), mount) for travel, mount in mounts if travel):
            if far >= self.reach:
                pairs += self._swept(mount, far)
        for n in np.flatnonzero(paths >= self.reach):
            bead = self._beads.get(ids[n])
            circle = bead and bead.shape()
            if bead and circle and circle.space:
                start, path = circle.body.position, circle.body.velocity * dt
                hits = self._space.segment_query(start, start + path, 0.0, circle.filter)
                pairs += [(bead, circle, hit.shape) for hit in hits]
        found = [error for pair in pairs if (error := self._crossing(*pair, dt, time))]
        if found:
            raise min(found, key=lambda error: error.safe_step or 0.0)

    def _refuse(self, key: int, motion: Array) -> None:
        """Raise if a body whose position or velocity is not finite carries a bead or plate."""
        for shape in [*self._beads.values(), *self._plates.values()]:
            owner = shape.shape()
            if owner is not None and owner.body is not None and owner.body.id == key:
                x, y, vx, vy = motion.tolist()
                raise ValueError(f"{shape}: not finite: position ({x}, {y}), velocity ({vx}, {vy})")

    def _swept(self, mount: Mount, far: float) -> Iterator[Pair]:
        """Beads that are not farther from the plates of a moving body [m]."""
        import pymunk

        for plate in self._plates.values():
            shape: Any = plate.shape()
            if plate.mount is mount and shape is not None and shape.space is self._space:
                left, bottom, right, top = shape.bb
                box = pymunk.BB(left - far, bottom - far, right + far, top + far)
                for circle in self._space.bb_query(box, shape.filter):
                    bead = self._beads.get(circle.body.id) if circle.body else None
                    if bead and bead.shape() is circle:
                        yield bead, circle, shape

    def _crossing(self, bead: BeadShape, circle: Any, shape: Any, dt: float, time: float) -> TunnellingError | None:
        """Error for a bead whose centre would pass through a plate in a step, else None."""
        import pymunk

        plate = getattr(shape, MARK, None)
        if not isinstance(plate, PlateShape) or shape.sensor or circle.sensor:
            return None
        start, velocity = circle.body.position, circle.body.velocity
        if shape.body.body_type != pymunk.Body.STATIC:  # the engine never moves a static one, whatever its speed
            velocity -= shape.body.velocity_at_world_point(start)
        if velocity.length * dt < bead.kind.radius:
            return None
        hit = shape.segment_query(start, start + velocity * dt)
        if hit is None or not hit.alpha:  # it starts on the plate or in it
            return None
        speed = abs(velocity.dot(hit.normal))
        return TunnellingError(bead.index, plate.index, time + dt, speed, min(bead.kind.radius / speed, hit.alpha * dt))
