"""Checks before every step of a pymunk space: finite numbers, and no bead jumps over a plate."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from contactlaw.engines.pymunk.registry import MARK, BeadShape, Mount, PlateShape

if TYPE_CHECKING:
    import pymunk


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

        fastest = max((mount.watch(dt) for mount in self._mounts.values()), default=0.0)
        reach = self.reach - fastest * dt
        self._buffer.clear()
        get_space_bodies(self._space, self._fields, self._buffer)
        motion = np.frombuffer(self._buffer.float_buf()).reshape(-1, 4)
        # No speed exceeds sqrt(2) times the largest component. With a NaN this is false.
        if not len(motion) or math.sqrt(2) * dt * max(motion.max(), -motion.min()) < reach:
            return
        if not np.isfinite(motion).all():
            self._refuse()
        found: list[TunnellingError] = []
        speeds, ids = np.hypot(motion[:, 2], motion[:, 3]), np.frombuffer(self._buffer.int_buf(), np.uintp)
        for n in np.flatnonzero(speeds * dt >= reach):
            bead = self._beads.get(int(ids[n]))
            if bead is not None:
                found += self._crossed(bead, (speeds[n] + fastest) * dt, dt, time)
        if found:
            raise min(found, key=lambda error: error.safe_step or 0.0)

    def _refuse(self) -> None:
        """Raise if the position or velocity of a bead or plate is not finite."""
        owners: list[BeadShape | PlateShape] = [*self._beads.values(), *self._plates.values()]
        for owner in owners:
            shape = owner.shape()
            if shape is not None and shape.space is self._space and shape.body is not None:
                (x, y), (vx, vy) = shape.body.position, shape.body.velocity
                if not math.isfinite(abs(x) + abs(y) + abs(vx) + abs(vy)):
                    raise ValueError(f"{owner}: not finite: position ({x}, {y}), velocity ({vx}, {vy})")

    def _crossed(self, bead: BeadShape, far: float, dt: float, time: float) -> Iterator[TunnellingError]:
        """Errors for the plates, up to a distance [m], through which the centre of a bead would pass."""
        import pymunk

        circle: Any = bead.shape()
        if circle is None or circle.space is None or circle.sensor:
            return
        start, radius = circle.body.position, bead.kind.radius
        shape: Any
        for shape in self._space.bb_query(pymunk.BB.newForCircle(start, far), circle.filter):
            plate, velocity = getattr(shape, MARK, None), circle.body.velocity
            if not isinstance(plate, PlateShape) or shape.sensor:
                continue
            if not plate.mount.static:
                velocity -= shape.body.velocity_at_world_point(start)
            hit = shape.segment_query(start, start + velocity * dt) if velocity.length * dt >= radius else None
            if hit and hit.alpha:  # else it starts on the plate or in it
                speed = abs(velocity.dot(hit.normal))
                yield TunnellingError(bead.index, plate.index, time + dt, speed, min(radius / speed, hit.alpha * dt))
