"""How a rigid body answers at a point: the mass at a contact of a bead that is a part of one.

A force f on a body of mass M and inertia I gives the point at the arm p from its centre of mass the
acceleration f/M + (I^-1 (p x f)) x p. Its part along the normal n of the contact is c . f, with

    c = n/M + (I^-1 (p x n)) x p.

Under a normal force the point answers as a free mass of 1/(c . n); the tangential part of c is what
friction adds to the normal motion. A free sphere has none.
"""

import math
from typing import Any

import numpy as np

from contactlaw._jit import kernel
from contactlaw.equation.tangential import POINT
from contactlaw.physical.vectors import cross, dot
from contactlaw.walls.facet import Point

# The body that a bead is a part of. Arm and inertia are along the body's principal axes, which the
# quaternion turns into space; a body of no inverse mass is unknown.
BODY = np.dtype(
    [
        ("inverse_mass", "f8"),  # [1/kg]
        ("arm", "f8", 3),  # from the body's centre of mass to the bead's centre [m]
        ("inverse_inertia", "f8", 3),  # [1/(kg m^2)]
        ("turn", "f8", 4),  # real part first
        ("coupled", "f8"),  # energy that friction has given to the normal motion in this contact [J]
    ]
)


@kernel
def _turned(w: float, u: Point, v: Point) -> Point:
    """Vector v turned by the quaternion (w, u)."""
    once = cross(u, v)
    twice = cross(u, once)
    return (
        v[0] + 2.0 * (w * once[0] + twice[0]),
        v[1] + 2.0 * (w * once[1] + twice[1]),
        v[2] + 2.0 * (w * once[2] + twice[2]),
    )


@kernel
def known(body: Any) -> bool:
    """Whether a bead is a part of a body of known mass."""
    if body is None:
        return False
    return len(body) > 0 and body[0].inverse_mass > 0.0


@kernel
def answer(body: Any, force: Point, n: Point, s: float) -> Point:
    """Acceleration [m/s2] of the contact at the distance s [m] from a bead's centre under a force there.

    Zero for a bead that is no part of a known body.
    """
    if body is None or not known(body):
        return 0.0, 0.0, 0.0
    row = body[0]
    q, less, per = row.turn, row.inverse_inertia, row.inverse_mass
    w, back, turned = q[0], (-q[1], -q[2], -q[3]), (q[1], q[2], q[3])
    m, f = _turned(w, back, n), _turned(w, back, force)
    p = row.arm[0] - s * m[0], row.arm[1] - s * m[1], row.arm[2] - s * m[2]
    spin = cross(p, f)
    more = cross((less[0] * spin[0], less[1] * spin[1], less[2] * spin[2]), p)
    return _turned(w, turned, (per * f[0] + more[0], per * f[1] + more[1], per * f[2] + more[2]))


@kernel
def point_answer(body: Any, mass: float, force: Point, n: Point, s: float) -> Point:
    """As `answer`, or of a solid sphere of this mass [kg] that is no part of a body."""
    if known(body):
        return answer(body, force, n, s)
    up, per = (1.0 - POINT) * dot(force, n), 1.0 / mass
    return (
        per * (POINT * force[0] + up * n[0]),
        per * (POINT * force[1] + up * n[1]),
        per * (POINT * force[2] + up * n[2]),
    )


@kernel
def turn(row: Any, omega: Point, dt: float) -> None:
    """Turn the axes of a body by a step of this angular velocity [rad/s]."""
    q, h = row.turn, 0.5 * dt
    w, u = q[0], (q[1], q[2], q[3])
    by = h * omega[0], h * omega[1], h * omega[2]
    more = cross(by, u)
    q[0] = w - by[0] * u[0] - by[1] * u[1] - by[2] * u[2]
    for k in range(3):
        q[k + 1] = u[k] + w * by[k] + more[k]
    size = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    for k in range(4):
        q[k] /= size
