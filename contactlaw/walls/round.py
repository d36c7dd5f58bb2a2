"""Round walls without facets: cylinders, cones, spheres, discs and rings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._errors import ArgumentError
from contactlaw.physical.arguments import number, scalars, warn_of_metres
from contactlaw.physical.plates import Foundation, Shell
from contactlaw.walls.edges import Rows, Sides, edges_of
from contactlaw.walls.motion import FARTHEST, Motion, check_motion, direction, floats, keep, vector
from contactlaw.walls.plate import Models, check_models, checked_sheet
from contactlaw.walls.profile import ARC, SEGMENT

Floats = NDArray[np.float64]
Vector = Sequence[float]

_CLOSED = 1e-12  # [length of the profile] distance from the axis from which a wall is open


class Profile(NamedTuple):
    """Line that turns about an axis, as `contactlaw.walls.profile` has it."""

    kind: int
    origin: Floats
    axis: Floats
    shape: Floats
    length: float


class Round:
    """A wall that is a surface of revolution: what those below share."""

    thickness: Any
    model: Models | None
    motion: Motion | None
    edges: Sides | None

    def __post_init__(self) -> None:
        """Check the arguments."""
        self.rim()
        names = {"start", "end", "centre", "normal", "axis", "polar"} & vars(self).keys()
        keep(self, **{name: floats(getattr(self, name)) for name in names})
        sheet, profile = checked_sheet(self.thickness), self.profile()
        if sheet is not self.thickness and not (profile.kind == SEGMENT and profile.shape[2] == 0.0):
            reason = "a round wall is a shell by itself, and none on a foundation is known: give the number alone"
            raise ArgumentError("thickness", self.thickness, reason)
        scalars(thickness=sheet)
        warn_of_metres("thickness", sheet, stacklevel=3)
        check_models(self.model)
        check_motion(self.motion)

    def profile(self) -> Profile:
        """Profile of the wall; of arguments that are none, an error."""
        raise NotImplementedError

    def rim(self) -> Rows:
        """Edges: circles in which the wall ends, each at a length along the profile.

        On the wall rolled out flat, a circle from which the wall widens is the rim of a hole. Its
        radius is that of the circle over the sine of the angle at which the wall widens.
        """
        profile = self.profile()
        rho, _ = places(profile, 2)
        widens = profile.shape[1] * np.array([1.0, -1.0])
        if profile.kind == ARC:
            widens = np.cos(profile.shape[1] + np.array([0.0, profile.length]) / profile.shape[0]) * [1.0, -1.0]
        ends = np.flatnonzero(rho > _CLOSED * profile.length)
        if self.edges and not ends.size:
            raise ArgumentError("edges", self.edges, "a whole sphere has none; leave it out")
        hole = np.where(widens > _CLOSED, rho / np.maximum(widens, _CLOSED), math.inf)[ends]
        starts = np.outer(profile.length * ends, [1.0, 0.0, 0.0])
        rows = edges_of(self.edges, starts, starts, np.zeros(len(ends), int), hole)
        rows["square"] = 1.0  # of their length, by which a share of it is divided
        return rows


def places(profile: Profile, count: int) -> tuple[Floats, Floats]:
    """Distance from the axis and height along it, evenly from the start of a profile to its end."""
    t, (one, two, three) = np.linspace(0.0, profile.length, count), profile.shape
    if profile.kind == SEGMENT:
        return one + t * two, t * three
    return one * np.sin(two + t / one), one * np.cos(two + t / one)


@dataclass(frozen=True)
class Cone(Round):
    """Wall of a cone or a truncated cone, open at both ends, as of a hopper.

    Beads touch it from inside or outside, at the exact distance; see `Cylinder`.

    Parameters
    ----------
    start, end : sequence of 3 floats
        Ends of the axis [m].
    start_radius, end_radius : float
        Radii at the ends [m], which differ; one may be 0.
    thickness, model, motion
        As in `Plate`.
    edges : {"free", "supported", "clamped"} or sequence, optional
        How the wall ends, at all ends or at each that is open, from `start`; None for one at which
        it goes on, as in another wall.

    Examples
    --------
    >>> hopper = Cone((0, 0, 0.1), (0, 0, 0), 0.1, 0.02, thickness=1e-3, edges=(None, "free"))
    >>> hopper.end_radius
    0.02
    """

    start: Vector
    end: Vector
    start_radius: float
    end_radius: float
    thickness: float
    model: Models | None = None
    motion: Motion | None = None
    edges: Sides | None = None

    def profile(self) -> Profile:
        """Segment between the ends."""
        if self.start_radius == self.end_radius:
            radii = self.start_radius, self.end_radius
            raise ArgumentError("start_radius, end_radius", radii, "must differ, or take a Cylinder")
        return between(self.start, self.end, self.start_radius, self.end_radius)


@dataclass(frozen=True)
class Cylinder(Round):
    """Wall of a cylinder, open at both ends: a drum, a pipe, a shaft.

    Beads touch it from inside or outside, at the exact distance and with the exact normal, so that
    one that rolls in it meets no facets. A bead inside has to be smaller than the wall. In the
    contact R* is made of the bead's radius R and the wall's a: 1/(1/R - 1/a) across the axis,
    inside (outside with +), and R along it, of which it is the geometric mean. By that, Hertz's
    force is 0.2 % too low for a of 4 R, 1 % for 2 R. The law takes R* for the bead's radius: by
    finite elements of cups and domes that adds an error of 0.012 to the COR where R* differs by 16
    %. From there on an impact has the flag `Validity.CURVED_WALL`. The wall swings back as a shell,
    as in `contactlaw.Shell`, but for impacts from whose edge a wave comes back: then that counts.

    Parameters
    ----------
    start, end : sequence of 3 floats
        Ends of the axis [m].
    radius : float
        Radius [m].
    thickness, model, motion
        As in `Plate`.
    edges : {"free", "supported", "clamped"} or sequence of 2, optional
        How the wall ends, at both ends or at each, from `start`; None for one at which it goes on,
        as in another wall.

    Raises
    ------
    TypeError, ValueError
        If the ends coincide, the radius is not positive, or as in `Plate`.

    Examples
    --------
    >>> drum = Cylinder((0, -0.05, 0), (0, 0.05, 0), radius=0.1, thickness=2e-3)
    >>> drum.radius
    0.1
    """

    start: Vector
    end: Vector
    radius: float
    thickness: float
    model: Models | None = None
    motion: Motion | None = None
    edges: Sides | None = None

    def profile(self) -> Profile:
        """Segment along the axis."""
        positive("radius", self.radius)
        return between(self.start, self.end, self.radius, self.radius)


@dataclass(frozen=True)
class Sphere(Round):
    """Wall of a sphere or of a part of one: a bowl, a dome, a ball.

    Beads touch it from inside or outside; see `Cylinder`.

    Parameters
    ----------
    centre : sequence of 3 floats
        Centre [m].
    radius : float
        Radius [m].
    thickness, model, motion
        As in `Plate`.
    edges : {"free", "supported", "clamped"} or sequence, optional
        How the wall ends, at all ends or at each that is open.
    axis : sequence of 3 floats, optional
        Direction from which polar angles count; of any length but zero.
    polar : tuple of 2 floats, optional
        Polar angles between which the wall is [rad], by default all of the sphere.

    Examples
    --------
    A bowl:

    >>> bowl = Sphere((0, 0, 0), 0.1, thickness=1e-3, axis=(0, 0, -1), polar=(0, math.pi / 2))
    >>> bowl.radius
    0.1
    """

    centre: Vector
    radius: float
    thickness: float
    model: Models | None = None
    motion: Motion | None = None
    edges: Sides | None = None
    axis: Vector = (0.0, 0.0, 1.0)
    polar: tuple[float, float] = (0.0, math.pi)

    def profile(self) -> Profile:
        """Arc of the polar angles."""
        centre, radius = vector("centre", self.centre), positive("radius", self.radius)
        angles = floats(self.polar)
        if angles.shape != (2,) or not 0.0 <= angles[0] < angles[1] <= math.pi:
            raise ArgumentError("polar", self.polar, "expected two angles [rad] that ascend from 0 to at most math.pi")
        shape = np.array([radius, angles[0], 0.0])
        return Profile(ARC, centre, direction("axis", self.axis), shape, radius * float(angles[1] - angles[0]))


@dataclass(frozen=True)
class Ring(Round):
    """Flat ring: a disc with a round hole.

    Parameters
    ----------
    centre, normal : sequence of 3 floats
        Centre of the ring [m], and a vector normal to it of any length but zero.
    inner_radius, outer_radius : float
        Radii of the hole and of the ring [m].
    thickness, model, motion
        As in `Plate`.
    edges : {"free", "supported", "clamped"} or sequence of 2, optional
        How the wall ends, at both circles or at each, the inner one first; None for one at which it
        goes on, as in another wall.
    """

    centre: Vector
    normal: Vector
    inner_radius: float
    outer_radius: float
    thickness: float | Foundation | Shell
    model: Models | None = None
    motion: Motion | None = None
    edges: Sides | None = None

    def profile(self) -> Profile:
        """Segment across the axis."""
        inner, outer = positive("inner_radius", self.inner_radius), positive("outer_radius", self.outer_radius)
        if not inner < outer:
            radii = self.inner_radius, self.outer_radius
            raise ArgumentError("inner_radius, outer_radius", radii, "the inner one must be the smaller one [m]")
        return _flat(self.centre, self.normal, inner, outer)


@dataclass(frozen=True)
class Disc(Round):
    """Flat disc: the end of a drum, a spinning plate.

    Parameters
    ----------
    centre, normal : sequence of 3 floats
        Centre of the disc [m], and a vector normal to it of any length but zero.
    radius : float
        Radius [m].
    thickness, model, motion
        As in `Plate`.
    edges : {"free", "supported", "clamped"}, optional
        How the disc ends at its rim.
    """

    centre: Vector
    normal: Vector
    radius: float
    thickness: float | Foundation | Shell
    model: Models | None = None
    motion: Motion | None = None
    edges: Sides | None = None

    def profile(self) -> Profile:
        """Segment across the axis, from the centre."""
        return _flat(self.centre, self.normal, 0.0, positive("radius", self.radius))


def positive(name: str, given: float) -> float:
    """Return a radius, or raise an error that names the argument."""
    found = number(name, given)
    if not 0.0 < found <= FARTHEST:
        raise ArgumentError(name, given, f"must be positive, at most {FARTHEST:g} [m]")
    return found


def _flat(centre: Vector, normal: Vector, inner: float, outer: float) -> Profile:
    shape = np.array([inner, 1.0, 0.0])
    return Profile(SEGMENT, vector("centre", centre), direction("normal", normal), shape, outer - inner)


def between(start: Vector, end: Vector, start_radius: float, end_radius: float) -> Profile:
    """Profile of a cone or a cylinder between two ends of its axis."""
    first, last = vector("start", start), vector("end", end)
    height = float(np.linalg.norm(last - first))
    radii = number("start_radius", start_radius), number("end_radius", end_radius)
    if not height > 0.0:
        raise ArgumentError("start, end", (start, end), "must differ")
    if not all(0.0 <= one <= FARTHEST for one in radii) or not any(radii):
        raise ArgumentError("start_radius, end_radius", radii, f"must be from 0 to {FARTHEST:g} [m], one above 0")
    length = math.hypot(height, radii[1] - radii[0])
    shape = np.array([radii[0], (radii[1] - radii[0]) / length, height / length])
    return Profile(SEGMENT, first, (last - first) / height, shape, length)
