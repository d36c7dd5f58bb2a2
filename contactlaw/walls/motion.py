"""Rigid motions of walls, given as data, and the position of a wall at a time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._errors import ArgumentError
from contactlaw._jit import kernel
from contactlaw.physical.arguments import number
from contactlaw.walls.memory import array_at

Vector = Sequence[float]
Floats = NDArray[np.float64]

FARTHEST = 1e6  # largest coordinate [m]; a double resolves 1e-10 m there, less than an overlap

# A motion as the kernel reads it: the sum of all kinds of motion. Each kind fills its own part.
MOTION: list[tuple[Any, ...]] = [
    ("moves", "i8"),
    ("velocity", "f8", 3),  # of a translation
    ("axis", "f8", 3),
    ("spin", "f8"),
    ("hub", "f8", 3),  # spin [rad/s]
    ("amplitude", "f8", 3),
    ("frequency", "f8"),
    ("phase", "f8"),  # [rad/s], [rad]
    ("times", "i8"),
    ("displacements", "i8"),
    ("count", "i8"),  # addresses of a table, its rows
]


def floats(value: Any) -> Floats:
    """Copy numbers into an array, which is empty if they are none."""
    try:
        return np.array(value, dtype=float, order="C")
    except (TypeError, ValueError):
        return np.empty(0)


def vector(name: str, value: Any, unit: str = "m") -> Floats:
    """Three numbers of at most FARTHEST as an array, or an error that names the argument."""
    found = floats(value)
    if found.shape != (3,) or not (abs(found) <= FARTHEST).all():
        reason = f"expected three numbers [{unit}], none beyond {FARTHEST:g}"
        raise ArgumentError(name, value, reason)
    return found


def direction(name: str, value: Any) -> Floats:
    """Make a unit vector of a direction, or raise an error that names the argument."""
    found = vector(name, value, "-")
    size = float(np.linalg.norm(found))
    if not size > 0.0:
        raise ArgumentError(name, value, "must have a direction")
    return found / size


@dataclass(frozen=True)
class Translation:
    """A wall that moves at a constant velocity: an endless belt, a plate in a lift.

    Parameters
    ----------
    velocity : sequence of 3 floats
        Velocity of the wall [m/s].

    Raises
    ------
    ValueError
        If the velocity is not three finite numbers.

    Examples
    --------
    >>> Translation((0, 0, 0.5)).velocity
    (0.0, 0.0, 0.5)
    """

    velocity: Vector

    def __post_init__(self) -> None:
        """Refuse what is no velocity."""
        keep(self, velocity=vector("velocity", self.velocity, "m/s"))

    def fill(self, row: Any) -> None:
        """Write the motion into a row of the kernel's memory."""
        row["moves"], row["velocity"] = 1, self.velocity


@dataclass(frozen=True)
class Rotation:
    """A wall that turns about an axis at a constant speed: a drum, a screw, a mixer.

    Parameters
    ----------
    axis : sequence of 3 floats
        Direction of the axis; of any length but zero.
    speed : float
        Angular speed, right-handed about the axis [rad/s].
    centre : sequence of 3 floats, optional
        A point of the axis [m].

    Raises
    ------
    ValueError
        If the axis has no direction, or the speed or the centre is not finite.

    Examples
    --------
    A drum at 30 revolutions per minute:

    >>> drum = Rotation(axis=(0, 1, 0), speed=30 * 2 * math.pi / 60)
    >>> f"{drum.speed:.3f} rad/s"
    '3.142 rad/s'
    """

    axis: Vector
    speed: float
    centre: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        """Refuse what is no rotation."""
        direction("axis", self.axis)
        keep(self, axis=vector("axis", self.axis, "-"), centre=vector("centre", self.centre))
        _keep_number(self, "speed", self.speed, "rad/s")

    def fill(self, row: Any) -> None:
        """Write the motion into a row of the kernel's memory."""
        row["moves"], row["spin"], row["hub"] = 1, self.speed, self.centre
        row["axis"] = np.asarray(self.axis) / np.linalg.norm(self.axis)


@dataclass(frozen=True)
class Vibration:
    """A wall that vibrates harmonically about its given position: a sieve, a feeder.

    Parameters
    ----------
    amplitude : sequence of 3 floats
        Largest displacement and its direction [m].
    frequency : float
        Frequency [Hz].
    phase : float, optional
        Phase at time zero [rad]: the displacement is amplitude sin(2 pi frequency t + phase).

    Raises
    ------
    ValueError
        If the amplitude or the phase is not finite, or the frequency not positive and finite.

    Examples
    --------
    >>> deck = Vibration(amplitude=(1e-3, 0, 2e-3), frequency=50)
    >>> deck.frequency
    50.0
    """

    amplitude: Vector
    frequency: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what is no vibration."""
        keep(self, amplitude=vector("amplitude", self.amplitude))
        _keep_number(self, "frequency", self.frequency, "Hz")
        _keep_number(self, "phase", self.phase, "rad")
        if not self.frequency > 0.0:
            raise ArgumentError("frequency", self.frequency, "must be positive [Hz]")

    def fill(self, row: Any) -> None:
        """Write the motion into a row of the kernel's memory."""
        row["moves"], row["amplitude"] = 1, self.amplitude
        row["frequency"], row["phase"] = 2.0 * math.pi * self.frequency, self.phase


@dataclass(frozen=True, eq=False)
class Tabulated:
    """A wall whose displacement is a table over time.

    Parameters
    ----------
    times : sequence of n floats
        Ascending times [s], at least two. Between them the wall moves at a constant velocity;
        before the first and after the last it stands still.
    displacements : array_like, shape (n, 3)
        Displacement of the wall from its given position at these times [m]. Those of times to come
        may be changed in place between runs, as a controller does: the attribute is the table that
        the simulation reads, in which every number has to stay finite.

    Raises
    ------
    ValueError
        If the shapes do not fit together, a value is not finite, or the times do not ascend.

    Examples
    --------
    A gate that opens within a tenth of a second:

    >>> gate = Tabulated([0.5, 0.6], [[0, 0, 0], [0, 0, 0.08]])
    >>> gate.displacements[-1].tolist()
    [0.0, 0.0, 0.08]
    """

    times: Any
    displacements: Any

    def __post_init__(self) -> None:
        """Refuse what is no table."""
        times, places = floats(self.times), floats(self.displacements)
        n = times.size
        if times.shape != (n,) or n < 2 or places.shape != (n, 3):
            reason = "expected shapes (n,) and (n, 3) with n of 2 or more"
            raise ArgumentError("times, displacements", (times.shape, places.shape), reason)
        if not (np.isfinite(times).all() and (np.diff(times) > 0.0).all()):
            raise ArgumentError("times", self.times, "must be finite and ascend [s]")
        if not (abs(places) <= FARTHEST).all():
            reason = f"must be finite [m], none beyond {FARTHEST:g}"
            raise ArgumentError("displacements", None, reason)
        times.setflags(write=False)  # because a simulation reads them in every step
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "displacements", places)

    def fill(self, row: Any) -> None:
        """Write the motion into a row of the kernel's memory."""
        row["moves"], row["count"] = 1, self.times.size
        row["times"] = self.times.ctypes.data
        row["displacements"] = self.displacements.ctypes.data


Motion = Translation | Rotation | Vibration | Tabulated


def keep(given: Any, **vectors: Floats) -> None:
    """Replace attributes of a frozen object by tuples, which the caller cannot change."""
    for name, value in vectors.items():
        object.__setattr__(given, name, tuple(value.tolist()))


def _keep_number(motion: Any, name: str, value: Any, unit: str) -> None:
    found = number(name, value)
    if not math.isfinite(found):
        raise ArgumentError(name, value, f"must be finite [{unit}]")
    object.__setattr__(motion, name, found)


def check_motion(motion: Any) -> None:
    """Refuse what is no motion."""
    if motion is not None and not isinstance(motion, Motion):
        raise TypeError(
            f"motion: expected a Translation, Rotation, Vibration or Tabulated of contactlaw.walls, got {motion!r}"
        )


# Position of a moving wall: its point p is at hub + shift + turn (p - hub).
POSE: list[tuple[Any, ...]] = [
    ("turn", "f8", 9),  # row by row
    ("shift", "f8", 3),
    # Mean velocity of the shift over the last step, and over the last and the next one [m/s]. They
    # go with Verlet's velocities, which are those at mid-step, so that energies add up.
    ("half_rate", "f8", 3),
    ("rate", "f8", 3),
]


@kernel
def _interval(times: Any, count: int, time: float) -> int:
    """Index of the table's last time that has passed; -1 before the first."""
    low, high = -1, count
    while high - low > 1:
        middle = (low + high) // 2
        if times[middle] <= time:
            low = middle
        else:
            high = middle
    return low


@kernel
def _displacement(row: Any, time: float) -> tuple[float, float, float]:
    """Displacement of a wall by its vibration and its table at a time [m]."""
    out, a = math.sin(row.frequency * time + row.phase), row.amplitude
    x, y, z = a[0] * out, a[1] * out, a[2] * out
    if row.count == 0:
        return x, y, z
    times = array_at(row.times, row.count, np.float64)
    places = array_at(row.displacements, (row.count, 3), np.float64)
    n = _interval(times, row.count, time)
    m, share = min(n + 1, row.count - 1), 0.0
    n = max(n, 0)
    if m > n:
        share = (time - times[n]) / (times[m] - times[n])
    p, q = places[n], places[m]
    return (x + p[0] + share * (q[0] - p[0]), y + p[1] + share * (q[1] - p[1]), z + p[2] + share * (q[2] - p[2]))


@kernel(entry=True)
def move_one(row: Any, time: float, dt: float) -> None:
    """Set a wall's position and velocity at a time, the end of a step of length dt [s]."""
    last, here, then = (_displacement(row, time - dt), _displacement(row, time), _displacement(row, time + dt))
    for k in range(3):
        row.shift[k] = row.velocity[k] * time + here[k]
        row.half_rate[k] = row.velocity[k] + (here[k] - last[k]) / dt
        row.rate[k] = row.velocity[k] + (then[k] - last[k]) / (2.0 * dt)
    angle = row.spin * time
    c, s = math.cos(angle), math.sin(angle)
    x, y, z, w = row.axis[0], row.axis[1], row.axis[2], 1.0 - c
    turn = row.turn
    turn[0], turn[1], turn[2] = c + x * x * w, x * y * w - z * s, x * z * w + y * s
    turn[3], turn[4], turn[5] = x * y * w + z * s, c + y * y * w, y * z * w - x * s
    turn[6], turn[7], turn[8] = x * z * w - y * s, y * z * w + x * s, c + z * z * w


@kernel(entry=True)
def move(frames: Any, time: float, dt: float) -> None:
    """Move all walls to their positions at a time, the end of a step of length dt [s]."""
    for f in range(len(frames)):
        if frames[f].moves != 0:
            move_one(frames[f], time, dt)
