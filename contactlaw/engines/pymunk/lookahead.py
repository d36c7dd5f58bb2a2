"""Checks before every step of a pymunk space: finite numbers, and no bead jumps over a plate."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from contactlaw.engines.pymunk.registry import BeadShape, is_static, registered

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

    def __init__(self, *numbers: Any) -> None:
        super().__init__(*numbers)  # as given, for pickle
        self.bead, self.plate, self.time, self.speed, self.safe_step = numbers

    def __str__(self) -> str:
        what, remedy = "was pressed through", "use smaller steps, or more space.iterations"
        if self.safe_step is not None:
            what = "would pass unnoticed through"
            remedy = f"use steps below {self.safe_step:.3g} s"
        return (
            f"bead {self.bead} {what} plate {self.plate} in the step to t = {self.time:.9g} s, "
            f"at a normal speed of {self.speed:.6g} m/s: {remedy}"
        )


class Motion:
    """Positions and velocities of all bodies, read into one buffer, whose memory pymunk never frees."""

    def __init__(self, space: pymunk.Space) -> None:
        from pymunk.batch import BodyFields, Buffer, get_space_bodies

        self._buffer = Buffer()
        self._read = functools.partial(get_space_bodies, space, BodyFields.POSITION | BodyFields.VELOCITY, self._buffer)

    def is_slow(self, limit: float) -> bool:
        """Whether all numbers are finite and all speeds below a limit [m/s]."""
        self._buffer.clear()
        self._read()
        motion = np.frombuffer(self._buffer.float_buf()).reshape(-1, 4)
        fastest = math.sqrt(np.square(motion[:, 2:]).sum(axis=1).max(initial=0.0))
        return fastest < limit and math.isfinite(motion.sum())


def check(space: pymunk.Space, motion: Motion, mounts: Any, least: float, dt: float, time: float) -> None:
    """Raise if the step from `time` on would lose an impact, or starts from a NaN; `least`: smallest radius [m]."""
    fastest = max((mount.watch(body, dt) for body, mount in mounts.items()), default=0.0)
    if motion.is_slow(least / dt - fastest):
        return
    errors: list[TunnellingError] = []
    for shape, owner in registered(space.shapes):
        (x, y), (vx, vy) = shape.body.position, shape.body.velocity
        speed = math.hypot(vx, vy)
        if not math.isfinite(abs(x) + abs(y) + speed):
            raise ValueError(f"{owner}: not finite: position ({x}, {y}), velocity ({vx}, {vy})")
        far = (speed + fastest) * dt
        if isinstance(owner, BeadShape) and far >= owner.kind.radius and not shape.sensor:
            errors += _crossed(owner, shape, far, dt, time)
    if errors:
        raise min(errors, key=lambda error: error.safe_step or 0.0)


def _crossed(bead: BeadShape, circle: Any, far: float, dt: float, time: float) -> Iterator[TunnellingError]:
    """Errors for the plates, up to a distance [m], through which the centre of a bead would pass."""
    import pymunk

    start, radius = circle.body.position, bead.kind.radius
    for shape, plate in registered(circle.space.bb_query(pymunk.BB.newForCircle(start, far), circle.filter)):
        if isinstance(plate, BeadShape) or shape.sensor:
            continue
        velocity = circle.body.velocity
        if not is_static(shape.body):
            velocity -= shape.body.velocity_at_world_point(start)
        hit = shape.segment_query(start, start + velocity * dt) if velocity.length * dt >= radius else None
        if hit and hit.alpha:  # else it starts on the plate or in it
            speed = abs(velocity.dot(hit.normal))
            yield TunnellingError(bead.index, plate.index, time + dt, speed, min(radius / speed, hit.alpha * dt))
