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
from contactlaw.physical.vectors import cross, dot, plus, scaled, vector
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
    return plus(v, 2.0, plus(cross(u, once), w, once))


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
    q, less = row.turn, row.inverse_inertia
    w, turned = q[0], (q[1], q[2], q[3])
    back = scaled(-1.0, turned)
    f = _turned(w, back, force)
    p = plus(vector(row.arm), -s, _turned(w, back, n))
    spin = cross(p, f)
    more = cross((less[0] * spin[0], less[1] * spin[1], less[2] * spin[2]), p)
    return _turned(w, turned, plus(more, row.inverse_mass, f))


@kernel
def point_answer(body: Any, mass: float, force: Point, n: Point, s: float) -> Point:
    """As `answer`, or of a solid sphere of this mass [kg] that is no part of a body."""
    if body is not None and known(body):
        return answer(body, force, n, s)
    return scaled(1.0 / mass, plus(scaled(POINT, force), (1.0 - POINT) * dot(force, n), n))


@kernel
def turn(row: Any, omega: Point, dt: float) -> None:
    """Turn the axes of a body by a step of this angular velocity [rad/s]."""
    q, h = row.turn, 0.5 * dt
    w, u = q[0], (q[1], q[2], q[3])
    by = scaled(h, omega)
    w, u = w - dot(by, u), plus(plus(u, w, by), 1.0, cross(by, u))
    size = math.sqrt(w * w + dot(u, u))
    q[0] = w / size
    for k in range(3):
        q[k + 1] = u[k] / size
