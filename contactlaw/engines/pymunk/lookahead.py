"""Checks before every step of a pymunk space: finite numbers, and no bead jumps over a plate."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw.engines.pymunk.registry import BeadShape, Mount, PlateShape, ends, may_meet

if TYPE_CHECKING:
    import pymunk
    import pymunk.batch

    from contactlaw.engines.pymunk.registry import Face

Array = NDArray[np.float64]


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


class Line(NamedTuple):
    """Centre line of a plate in the plane, and its rigid motion."""

    start: tuple[float, float]  # ends [m]
    end: tuple[float, float]
    pivot: tuple[float, float]  # centre of rotation [m]
    velocity: tuple[float, float]  # velocity of the pivot [m/s]
    spin: float  # [rad/s]


class LookAhead:
    """Checks of one space; the caller sets `reach`, the radius of the smallest bead [m]."""

    def __init__(
        self, space: pymunk.Space, beads: dict[int, BeadShape], plates: dict[int, PlateShape], mounts: dict[int, Mount]
    ) -> None:
        from pymunk.batch import BodyFields, Buffer

        self.reach = math.inf
        self._space = space
        self._beads = beads  # by id of the body
        self._plates = plates
        self._mounts = mounts
        self._buffer = Buffer()
        self._motion = BodyFields.POSITION | BodyFields.VELOCITY
        self._body_id = BodyFields.BODY_ID

    def check(self, dt: float, time: float) -> None:
        """Raise if the step from `time` on would lose an impact, or starts from a NaN."""
        plate_speed = max((mount.watch(dt) for mount in self._mounts.values()), default=0.0)
        reach = self.reach - plate_speed * dt
        self._read(self._motion)
        motion = np.frombuffer(self._buffer.float_buf()).reshape(-1, 4)
        if not len(motion):
            return
        # No speed exceeds sqrt(2) times the largest component. With a NaN this is false.
        if math.sqrt(2) * dt * max(motion.max(), -motion.min()) < reach:
            return
        travel = (np.hypot(motion[:, 2], motion[:, 3]) + plate_speed) * dt
        finite = np.isfinite(motion)
        if finite.all() and travel.max() < self.reach:
            return
        motion = motion.copy()  # the next line reuses the buffer
        self._read(self._body_id)
        ids = np.frombuffer(self._buffer.int_buf(), np.uintp).tolist()
        for n in np.flatnonzero(~finite.all(axis=1)):
            self._refuse(ids[n], motion[n])
        fast = [n for n in np.flatnonzero(travel >= self.reach) if ids[n] in self._beads]
        if fast:
            self._cross([self._beads[ids[n]] for n in fast], motion[fast], dt, time)

    def _read(self, fields: pymunk.batch.BodyFields) -> None:
        from pymunk.batch import get_space_bodies

        self._buffer.clear()
        get_space_bodies(self._space, fields, self._buffer)

    def _refuse(self, key: int, motion: Array) -> None:
        """Raise if a body whose position or velocity is not finite carries a bead or plate."""
        names = []
        for plate in self._plates.values():
            shape = plate.shape()
            if shape is not None and shape.body is not None and shape.body.id == key:
                names.append(f"plate {plate.index}")
        names += [str(self._beads[key])] if key in self._beads else []
        if names:
            x, y, vx, vy = motion.tolist()
            raise ValueError(f"{names[0]}: not finite: position ({x}, {y}), velocity ({vx}, {vy})")

    def _cross(self, beads: list[BeadShape], motion: Array, dt: float, time: float) -> None:
        """Raise if beads would cross plates, for the bead that needs the smallest step."""
        found = []
        for plate in self._plates.values():
            shape = plate.shape()
            if shape is None or shape.body is None or shape.space is not self._space:
                continue
            for line in _lines(shape, shape.body):
                distance, speed = approach(motion[:, :2], motion[:, 2:], line, dt)
                for n in np.flatnonzero(speed):
                    circle = beads[n].shape()
                    if circle is not None and may_meet(circle, shape):
                        reach = beads[n].radius + shape.radius
                        safe_step = min(reach, distance[n]) / speed[n]
                        found.append((safe_step, beads[n].index, plate.index, speed[n]))
        if found:
            safe_step, bead, plate_index, velocity = min(found)
            raise TunnellingError(bead, plate_index, time + dt, float(velocity), float(safe_step))


def _lines(shape: Face, body: pymunk.Body) -> Iterator[Line]:
    """Sides of a plate: one of a segment, of a polygon as many as it has corners."""
    import pymunk

    still = body.body_type == pymunk.Body.STATIC  # the engine never moves it, whatever its speed
    pivot = body.local_to_world(body.center_of_gravity)
    velocity, spin = ((0.0, 0.0), 0.0) if still else (body.velocity, body.angular_velocity)
    corners = [body.local_to_world(end) for end in ends(shape)]
    for start, end in pairwise(corners if len(corners) == 2 else [*corners, corners[0]]):
        yield Line(start, end, pivot, velocity, spin)


def approach(positions: Array, velocities: Array, line: Line, dt: float) -> tuple[Array, Array]:
    """Distance and speed of beads that cross a plate's centre line within a step of length dt [s].

    Positions [m] and the line are those at the start of the step, and so is the distance [m]. The
    speed is the mean normal one in the step [m/s]; 0 for beads that do not cross the line between
    its two ends.
    """
    (ax, ay), (bx, by), (px, py), (vx, vy), spin = line
    length = math.hypot(bx - ax, by - ay)
    tx, ty = (bx - ax) / length, (by - ay) / length
    x, y = positions.T
    before = tx * (y - ay) - ty * (x - ax)  # signed distance: positive on the left
    # Seen from the plate only the bead moves: its end point with the plate's motion undone.
    dx, dy = x + (velocities[:, 0] - vx) * dt - px, y + (velocities[:, 1] - vy) * dt - py
    c, s = math.cos(spin * dt), math.sin(spin * dt)
    end_x, end_y = px + c * dx + s * dy, py - s * dx + c * dy
    after = tx * (end_y - ay) - ty * (end_x - ax)
    crosses = (before != 0.0) & (before * after <= 0.0)
    if crosses.any():
        share = before / np.where(crosses, before - after, 1.0)
        place = tx * (x + share * (end_x - x) - ax) + ty * (y + share * (end_y - y) - ay)
        crosses &= (place >= 0.0) & (place <= length)
    return np.abs(before), np.where(crosses, np.abs(before - after) / dt, 0.0)
