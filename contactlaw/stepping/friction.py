"""Tangential force of a contact in one time step: springs that slide, in two directions.

The method is that of `contactlaw.equation.tangential`, in SI units and with few springs. They lie
in a plane that turns with the contact: their first direction is kept in space and projected onto
the tangents of the present normal.

At touch the springs are made so wide that they cover the contact of an impact with this speed. If
the contact becomes stiffer than that, neighbours are joined in pairs, which keeps their force. In a
contact that has become small, as under a bead at rest, the innermost spring is all that is left; it
is as wide as the contact, so that friction holds up to mu F whatever the load.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._jit import kernel
from contactlaw.equation import force as forces
from contactlaw.equation.force import BlendedLaw, at_strength, growth_at
from contactlaw.equation.tangential import Stiffness, kept, part_of, share_within, stiffness_at
from contactlaw.physical.arguments import number
from contactlaw.physical.vectors import cross, divided, dot, norm, plus, put, scaled, vector
from contactlaw.stepping.spring import Spring, State, impact
from contactlaw.walls.facet import Point

SPRINGS = 8  # the sliding speed is within 0.012 mu V0 at 50 steps a contact, 0.008 at 100

# State of a contact's friction between two steps.
FRICTION = np.dtype(
    [
        ("stretch", "f8", 2 * SPRINGS),  # elongation of the springs in both directions [m]
        ("along", "f8", 3),  # the first direction; 0 before the first step
        ("width", "f8"),  # of a spring, as a part of the normal stiffness [N/m]
        ("stiffness", "f8"),  # of the normal contact in the last step, k = dF/dd [N/m]
        ("force", "f8", 3),  # on the bead in the last step [N]
        ("normal", "f8"),  # normal force in the last step [N]
        ("work", "f8"),  # done on the bead so far, in the frame of the wall [J]
    ]
)
_NO_DIRECTION = 1e-6  # least share of a vector along the wall; below, rounding decides
_LEAST_SPEED = 1e-30  # [m/s] far below it the stiffness of an impact is 0 in floating point
DEEPEST = 1.25**0.4  # largest compression of Hertz's impact [V0 T_H]


def check_friction(friction: Any) -> None:
    """Refuse a coefficient of friction that is no finite number of 0 or more."""
    if not 0.0 <= number("friction", friction) < math.inf:
        raise ArgumentError("friction", friction, "must be finite and not negative")


@kernel
def clear_friction(row: Any) -> None:
    """Begin anew."""
    for n in range(2 * SPRINGS):
        row.stretch[n] = 0.0
    for n in range(3):
        row.along[n] = row.force[n] = 0.0
    row.width = row.stiffness = row.normal = row.work = 0.0


@kernel
def _width(law: Array, own: BlendedLaw, spring: Spring, scale: float, speed: float, k: float) -> float:
    """Width of springs for an impact with this speed; for a bead that was put down, of those at k.

    Beyond yield the compression follows from the energy, since F d is 2.0 to 2.5 times the work.
    The impact's own law has yield compressions of `scale`.
    """
    if not speed > _LEAST_SPEED:
        return k / SPRINGS
    d = DEEPEST * impact(law, spring, speed).compression / scale
    unit = spring.stiffness * scale * math.sqrt(scale)  # F_Y
    if d > forces.lossless(own):
        energy = 0.5 * spring.mass * speed * speed / (unit * scale)
        for _ in range(4):
            d *= math.sqrt(energy / (0.45 * forces.loading(own, math.sqrt(d)) * d))
    f = unit * forces.loading(own, math.sqrt(d))
    d *= scale
    return stiffness_at(own, scale, spring.stiffness, d, d, f).normal / SPRINGS


@kernel
def _tangent(given: Point, n: Point) -> tuple[Point, float]:
    """Part of a vector along the wall, and its size."""
    a = plus(given, -dot(given, n), n)
    return a, norm(a)


@kernel
def _directions(row: Any, n: Point, slip: Point) -> tuple[Point, Point]:
    """Two tangents at right angles, the first as near as can be to that of the last step."""
    # without a direction so far, that of sliding; any one will do for a bead that does not slide
    given = vector(row.along)
    a, size = _tangent(given, n)
    if not size > _NO_DIRECTION * norm(given):
        given = slip
        a, size = _tangent(given, n)
    if not size > _NO_DIRECTION * norm(given):
        a, size = _tangent((1.0, 0.0, 0.0) if abs(n[0]) < 0.6 else (0.0, 1.0, 0.0), n)
    a = divided(a, size)
    put(row.along, a)
    return a, cross(n, a)


@kernel
def _join(row: Any) -> None:
    """Join neighbouring springs in pairs; their force stays, and no energy is made."""
    half = SPRINGS // 2
    for n in range(half):
        for side in range(2):
            at = 2 * n + side * SPRINGS
            row.stretch[n + side * SPRINGS] = 0.5 * (row.stretch[at] + row.stretch[at + 1])
    for n in range(half, SPRINGS):
        row.stretch[n] = row.stretch[n + SPRINGS] = 0.0
    row.width *= 2.0


@kernel
def _pull(
    row: Any, friction: float, kappa: float, now: Stiffness, f: float, x: float, y: float, left: float
) -> tuple[float, float]:
    """Move the springs, of whose stretch a share is left, along both directions; their force."""
    fx = fy = within = 0.0
    k, before, width = now.normal, row.stiffness, row.width
    for n in range(SPRINGS):
        wide = part_of(n, SPRINGS, width, k)
        if wide == 0.0:
            row.stretch[n] = row.stretch[n + SPRINGS] = 0.0
            continue
        held = min(part_of(n, SPRINGS, width, before), wide)
        share = share_within((n * width + wide) / k, now.power)
        most = friction * f * (share - within)
        within = share
        old, new = kappa * held * left, 0.25 * kappa * (1.0 + left) * (wide + held)
        px, py = old * row.stretch[n] + new * x, old * row.stretch[n + SPRINGS] + new * y
        square = px * px + py * py
        if square > most * most:
            less = most / math.sqrt(square)
            px, py = px * less, py * less
        row.stretch[n], row.stretch[n + SPRINGS] = px / (kappa * wide), py / (kappa * wide)
        fx += px
        fy += py
    row.stiffness = k
    return fx, fy


@kernel
def tangential_force(
    row: Any,
    friction: float,
    kappa: float,
    law: Array,
    spring: Spring,
    state: State,
    before: float,
    overlap: float,
    speed: float,
    n: Point,
    slip: Point,
    dt: float,
    extra: float,
) -> Point:
    """Tangential force on a bead [N], from the velocity of its surface relative to the wall.

    `before` is the largest compression before this step, `speed` the approach speed and `extra` the
    correction of the normal force in this step; a contact with `extra` alone has just ended. A step
    dt of 0 gives the last step's force again.
    """
    f, last = state.force, vector(row.force)
    if dt == 0.0:
        return last
    if f == 0.0:  # a contact that has just ended slides as it did before
        force = scaled(extra / row.normal if row.normal > 0.0 else 0.0, last)
    else:
        a, b = _directions(row, n, slip)
        d = overlap - state.plate_displacement
        hertz = spring.stiffness * (state.stiffening if state.stiffening > 0.0 else 1.0)
        own = at_strength(law, state.strength)
        scale = spring.scale * growth_at(law, state.strength)
        now = stiffness_at(own, scale, hertz, state.largest_compression, d, f)
        if not now.normal > 0.0:  # at the end of a contact its force may outlive its compression
            now = Stiffness(max(row.stiffness, f / scale), now.power)
        if row.width == 0.0:
            row.width = _width(law, own, spring, scale, speed, now.normal)
        while now.normal > 1.5 * SPRINGS * row.width:
            _join(row)
        left = kept(scale, before, state.largest_compression)
        x, y = _pull(row, friction, kappa, now, f, dt * dot(slip, a), dt * dot(slip, b), left)
        more = -(1.0 + extra / f)
        force = plus(scaled(more * x, a), more * y, b)
    put(row.force, force)
    row.normal = f + extra
    return force
