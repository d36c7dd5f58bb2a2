"""Oblique impacts of solid spheres in SI units: tangential rebound and spin.

Legend: R radius, m mass, n unit normal from the plate to the sphere, s velocity of the contact
point along the plate (of the centre, and from spin), J_n and J_t impulses, e restitution, mu
coefficient of friction, I = 2/5 m R^2. A tangential impulse changes s by 7/2 J_t/m, of which the
centre has 2/7 and the spin the rest.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw._jit import kernel
from contactlaw.equation.numbers import Impact
from contactlaw.equation.tangential import POINT
from contactlaw.physical.arguments import ROUGHEST, shaped
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts, check_finite
from contactlaw.physical.rebound import Rebound, shaped_flags
from contactlaw.physical.validity import Validity
from contactlaw.physical.vectors import Vector, cross, divided, dot, plus, put, vector
from contactlaw.table import lookup
from contactlaw.table.slides import change

# Limits of `Validity.SLIDING_FLOW`.
_TRACTION = 0.5  # mu p/sigma_Y
_SLIDE = 0.3  # of the contact's radius
_PRODUCT = 0.02
_UNLOADING = 1.4  # exponent of unloading, 1.35 to 1.5 where a body has flowed
_AT_REST = 1e-300  # [m/s]

FASTEST = 1e9  # psi from which the digits of a sliding speed no longer matter


@dataclass(frozen=True, eq=False)
class ObliqueRebound(Rebound):
    """Outcome of an oblique impact, or of many: the fields of `Rebound` and those of friction.

    The shares of the energy are those of the normal motion.

    Attributes
    ----------
    sliding_speed
        Speed of the contact point along the plate afterwards, negative if it has turned round
        [m/s].
    tangential_restitution
        v_t'/v_t of the centre of a bead that came without spin [-]; NaN without sliding.
    rotational_restitution
        beta = -v_s'/v_s of the contact point (Walton 1993) [-]; NaN without sliding.
    impulse_ratio
        J_t/J_n [-]; below the coefficient of friction it did not slide all the time.
    friction_energy
        What friction took: (1/7) m (v_s^2 - v_s'^2) [J].
    """

    sliding_speed: float | Array
    tangential_restitution: float | Array
    rotational_restitution: float | Array
    impulse_ratio: float | Array
    friction_energy: float | Array


class Sliding(NamedTuple):
    """How a bead approaches a plate."""

    speed: float  # normal approach speed [m/s]
    size: float  # sliding speed [m/s]
    along: Vector  # s [m/s]


@kernel
def unit(n: Vector) -> Vector:
    """Direction of a vector, whose squares may be beyond the largest or least number."""
    most = max(abs(n[0]), abs(n[1]), abs(n[2]))
    n = divided(n, most)
    return divided(n, np.sqrt(dot(n, n)))


@kernel
def surface_velocity(v: Vector, omega: Vector, r: float, n: Vector) -> Vector:
    """Velocity of a sphere's surface at -r n from its centre [m/s]."""
    return plus(v, -r, cross(omega, n))


@kernel
def sliding(v: Vector, omega: Vector, n: Vector, w: Vector, radius: float) -> Sliding:
    """Speeds of a bead towards and along a plate that moves with w; n has the length 1."""
    surface = surface_velocity(plus(v, -1.0, w), omega, radius, n)
    u = dot(surface, n)
    s = plus(surface, -u, n)
    return Sliding(-u, np.sqrt(dot(s, s)), s)


@kernel
def rebound_of(
    v: Vector, omega: Vector, n: Vector, came: Sliding, radius: float, e: float, changed: float
) -> tuple[Vector, Vector]:
    """Velocity and spin afterwards, from the restitution and the change of the sliding speed."""
    part = changed / np.maximum(came.size, _AT_REST)
    leaves = plus(plus(v, (1.0 + e) * came.speed, n), -part / POINT, came.along)
    return leaves, plus(omega, (1.0 - 1.0 / POINT) * part / radius, cross(n, came.along))


@kernel
def tangential(table: Array, slides: Array, impact: Impact, friction: float, size: float) -> tuple[float, float]:
    """COR and change of the sliding speed [m/s]; NaN for bad input or outside the table."""
    speed, radius, thickness, share = impact
    limit = friction * speed
    if not (lookup.is_valid(speed, radius, thickness) and 0.0 <= friction <= ROUGHEST):
        return math.nan, math.nan
    if not size <= lookup.V_MAX:
        return math.nan, math.nan
    psi = min(size / limit, FASTEST) if limit > 0.0 else 0.0
    head = lookup.head_of(table)
    at, on = lookup.place_of(table, head, speed, radius, thickness, share)
    e = lookup.cor_of(table, head.axes, at, on)
    if not e >= 0.0:
        return math.nan, math.nan
    x, head = at.row * (head.axes.x_max / head.axes.rows), lookup.head_of(slides)
    rung = lookup.rung_of(slides, head.axes, on.k)
    near = lookup.on_grid(head, rung, x, at.p / at.w, math.nan, True, True)
    return e, limit * change(slides, head.axes, near, rung, e, psi)


@kernel
def collide(
    table: Array,
    slides: Array,
    v: Vector,
    omega: Vector,
    n: Vector,
    radius: float,
    thickness: float,
    share: float,
    friction: float,
    w: Vector,
) -> tuple[Vector, Vector]:
    """Velocity and spin after an impact, as they were if the bead recedes; NaN as `tangential`."""
    n = unit(n)
    came = sliding(v, omega, n, w, radius)
    if came.speed < lookup.V_MIN:
        return v, omega
    impact = Impact(came.speed, radius, thickness, share)
    e, changed = tangential(table, slides, impact, friction, came.size)
    return rebound_of(v, omega, n, came, radius, e, changed)


@kernel(cache=True)
def approach_all(
    velocity: Array, spin: Array, normal: Array, wall: Array, radius: Array, speed: Array, size: Array
) -> None:
    """Speeds of beads towards plates and along them; vectors are rows, and normals get the length 1."""
    for k in range(speed.size):
        n = unit(vector(normal[k]))
        put(normal[k], n)
        speed[k], size[k], _ = sliding(vector(velocity[k]), vector(spin[k]), n, vector(wall[k]), radius[k])


@kernel(cache=True)
def rebound_all(
    velocity: Array, spin: Array, normal: Array, wall: Array, radius: Array, e: Array, changed: Array
) -> None:
    """Replace velocities and spins by those afterwards, where a bead does not recede."""
    for k in range(e.size):
        v, omega, n = vector(velocity[k]), vector(spin[k]), vector(normal[k])
        came = sliding(v, omega, n, vector(wall[k]), radius[k])
        if came.speed >= lookup.V_MIN:
            v, omega = rebound_of(v, omega, n, came, radius[k], e[k], changed[k])
            put(velocity[k], v)
            put(spin[k], omega)


def flows(strength: Any, modulus: float, hit: Any, friction: Any, size: Any, after: Any) -> Any:
    """Whether friction makes a body flow along the surface; numbers, or arrays of them.

    `hit` is the answer of the normal impact, `size` and `after` the sliding speeds [m/s].
    Finite elements in three dimensions: the loss of COR is some 0.5 of the product of the two
    ratios, so it is below 1 % up to 0.02.
    """
    # F ~ d^1.4 of unloading, with the slope 2 E* a
    force, left = hit.peak_force, hit.residual_compression
    contact = _UNLOADING * force / (hit.peak_compression - left) / (2.0 * modulus)
    sliding = np.maximum(abs(size) + abs(after), _AT_REST)
    slide = 0.5 * (size * size + after * after) / sliding * hit.contact_time / contact
    traction = friction * force / (math.pi * contact * contact) / strength
    beyond = (traction >= _TRACTION) | (slide > _SLIDE) | (traction * slide > _PRODUCT)
    return beyond & (left > 0.0)


def of(
    bodies: SphereOnPlate, normal: Rebound, impacts: Impacts, friction: Array, size: Array, changed: Array
) -> ObliqueRebound:
    """Complete an answer: normal part, sliding speed before it and the change of that [m/s]."""
    pair, mass = bodies.pair, bodies.mass(impacts)
    with np.errstate(invalid="ignore", divide="ignore"):
        part = changed / size  # NaN without sliding
    flat, after = Rebound(*map(np.ravel, vars(normal).values())), size - changed
    found: dict[str, Any] = {
        "sliding_speed": after,
        "tangential_restitution": 1.0 - part / POINT,
        "rotational_restitution": part - 1.0,
        "impulse_ratio": changed / POINT / ((1.0 + flat.restitution) * impacts.speed),
        "friction_energy": mass / (2.0 * POINT) * changed * (size + after),
    }
    check_finite(pair, impacts, found["impulse_ratio"], found["friction_energy"])
    found = {name: shaped(values, impacts.shape) for name, values in found.items()}
    strength = min(body.strength or math.inf for body in pair.bodies)
    flow = flows(strength, pair.effective_modulus, flat, friction, size, after)
    beyond: Integers = np.where(flow, int(Validity.SLIDING_FLOW), 0)
    flags = flat.flags | beyond
    found["flags"] = shaped_flags(flags, impacts.shape)
    return ObliqueRebound(**vars(normal) | found)
