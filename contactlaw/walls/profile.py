"""Walls that are surfaces of revolution, by their profile in the half-plane beside the axis.

All points of a circle around the axis are as far along the axis; the nearest one to any point of
space is at the same azimuth. So distances are those in the half-plane: to a segment for a cone,
a cylinder, a disc and a ring, to an arc for a part of a sphere.

Legend: rho distance from the axis, z height along it, t length along the profile from its start to
the nearest point, s signed distance from the line or circle that the profile is a part of.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from contactlaw._jit import kernel

# Kinds of facets. A facet of the first two kinds has the axis as `normal`, the end of z = 0 (the
# centre of a sphere) as `corner`, any unit vector across the axis as `a`, the length of the profile
# as `length_a`, and as `b`: of a segment, rho at its start and its direction in rho and z; of an
# arc, radius and polar angle of the start.
ARC, SEGMENT, TRIANGLE, RECTANGLE = 1, 2, 3, 4

# Curvature counts as long as the radius in a principal direction is within this factor of the
# sphere's. In the tip of a cone a sphere touches all around, and that radius would be infinite.
_MOST = 4.0
_TIP = 1e-9  # smallest distance from the axis beside other lengths


class OnProfile(NamedTuple):
    """Point of a profile that is nearest to a point of the half-plane."""

    t: float
    s: float
    distance: float
    out: float  # direction from the nearest point, in rho and z
    up: float
    face: bool  # whether the nearest point is no end of the profile


@kernel
def in_half_plane(facet: Any, p: tuple[float, float, float]) -> tuple[float, float, tuple[float, float, float]]:
    """Place of a point in the half-plane, rho and z, and the unit vector in which rho grows."""
    origin, axis, across = facet.corner, facet.normal, facet.a
    x, y, z = p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]
    along = x * axis[0] + y * axis[1] + z * axis[2]
    x, y, z = x - along * axis[0], y - along * axis[1], z - along * axis[2]
    rho = math.sqrt(x * x + y * y + z * z)
    if rho > _TIP * abs(along):  # else its direction is rounding
        return rho, along, (x / rho, y / rho, z / rho)
    return 0.0, along, (across[0], across[1], across[2])


@kernel
def direction_at(facet: Any, t: float) -> tuple[float, float]:
    """Direction of a profile's surface normal in rho and z, which is that of growing s."""
    shape = facet.b
    if facet.kind == SEGMENT:
        return shape[2], -shape[1]
    angle = shape[1] + t / shape[0]
    return math.sin(angle), math.cos(angle)


@kernel
def on_profile(facet: Any, rho: float, z: float) -> OnProfile:
    """Point of a profile that is nearest to a point of the half-plane."""
    shape = facet.b
    if facet.kind == SEGMENT:
        dx, dz = rho - shape[0], z
        t, s = dx * shape[1] + dz * shape[2], dx * shape[2] - dz * shape[1]
        at = min(max(t, 0.0), facet.length_a)
        dx, dz = dx - at * shape[1], dz - at * shape[2]
    else:
        far = math.sqrt(rho * rho + z * z)
        s, t = far - shape[0], shape[0] * (math.atan2(rho, z) - shape[1])
        at = min(max(t, 0.0), facet.length_a)
        dx, dz = (rho / far, z / far) if far > 0.0 else (0.0, 1.0)
        if at != t:
            out, up = direction_at(facet, at)
            dx, dz = rho - shape[0] * out, z - shape[0] * up
    if at == t:
        sign = math.copysign(1.0, s)
        out, up = (shape[2], -shape[1]) if facet.kind == SEGMENT else (dx, dz)
        return OnProfile(at, s, abs(s), sign * out, sign * up, True)
    distance = math.sqrt(dx * dx + dz * dz)
    return OnProfile(at, s, distance, dx / distance, dz / distance, False)


class Bend(NamedTuple):
    """How a wall is curved where a sphere touches it."""

    ratio: float  # R*/R; negative: the radius of a wall that the sphere is too large for [m]
    around: float  # curvature around the axis [1/m], negative where it is hollow
    along: float  # and along the profile


@kernel
def bending(facet: Any, p: tuple[float, float, float], size: float, r: float) -> Bend:
    """R*/R of a sphere of radius R [m] at a facet, and the curvatures of the wall there.

    `size` is the radius that has to fit, which of a parcel is larger than R.

    On a curved facet the radii in the two principal directions are 1/(1/R + k), with k the
    curvature of the wall, negative where it is hollow. R* is their geometric mean. Inside a
    cylinder or a sphere that is no larger than the sphere, that one's radius is returned, with a
    minus sign. At an end of the profile the curvatures are multiplied by the cosine between the
    contact's normal and the face's, so that nothing jumps where a sphere rolls around it.
    """
    shape = facet.b
    if facet.kind >= TRIANGLE or (facet.kind == SEGMENT and shape[2] == 0.0):  # flat
        return Bend(1.0, 0.0, 0.0)
    rho, z, _ = in_half_plane(facet, p)
    q = on_profile(facet, rho, z)
    cosine = math.copysign(1.0, q.s)
    out = cosine * q.out
    if not q.face:
        out, up = direction_at(facet, q.t)
        cosine = q.out * out + q.up * up
    if facet.kind == ARC:
        around = along = cosine / shape[0]
    else:
        around, along = cosine * out / max(shape[0] + q.t * shape[1], _TIP * r), 0.0
    if q.face and 1.0 + around * size <= 0.0 and (facet.kind == ARC or shape[1] == 0.0):
        return Bend(1.0 / around, around, along)
    return bent(around, along, r)


@kernel
def bent(around: float, along: float, r: float) -> Bend:
    """R*/R of a sphere on a surface of these curvatures."""
    one, two = 1.0 + around * r, 1.0 + along * r
    ratio = 1.0 / math.sqrt(min(max(one, 1.0 / _MOST), _MOST) * min(max(two, 1.0 / _MOST), _MOST))
    return Bend(ratio, around, along)
