"""The true impact of a bead, carried out at its first touch for a softened contact.

A softened contact (`contactlaw.stepping.softened`) has neither the time nor the force of the true
one. What the bead keeps of its motion comes from here: the contact of `spring`, `energy` and
`friction` under velocity Verlet, in short steps of its own and against a flat wall. So a softened
contact has all that a true one has: laws, rates, losses, edges, masses.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation.corrections import CONTACT_TIME
from contactlaw.physical.vectors import divided, dot, plus
from contactlaw.stepping import energy
from contactlaw.stepping.edge import EdgeEcho
from contactlaw.stepping.friction import clear_friction, tangential_force
from contactlaw.stepping.rigid import known, point_answer
from contactlaw.stepping.spring import PARTED, Spring, at_largest, impact
from contactlaw.walls.facet import Point

STEPS = 40  # of an elastic contact: the COR is within 1e-4 of smaller steps
# [contact times of an elastic bead]; of plates so thin that it takes longer the COR is below 1e-4,
# and the contact time is that of an impact that is cut off
LONGEST = 200


class Bounce(NamedTuple):
    """What the true impact is like."""

    restitution: float
    contact_time: float  # [s]
    peak_force: float  # [N]
    compression: float  # the largest [m]
    plastic_share: float  # of the energy that is lost
    wave_share: float  # of the energy that is lost
    drag: Point  # tangential impulse on the bead over the normal one
    recedes: float  # 1.0 if the plate does so before the bead, and will strike it again


@kernel
def bounce(
    law: Array,
    spring: Spring,
    came: Point,
    n: Point,
    near: EdgeEcho | None,
    friction: float,
    kappa: float,
    rows: Any = None,
    body: Any = None,
    s: float = 0.0,
) -> Bounce:
    """Impact of a point with this velocity [m/s] at the distance s [m] from the bead's centre.

    `rows` are the FRICTION rows to use, None or no rows without friction. The bead is a part of `body`
    or a solid sphere.
    """
    speed = -dot(came, n)
    m, expected = spring.mass, impact(law, spring, speed)
    h = CONTACT_TIME * expected.time / STEPS
    state, x, v, wave, steps = PARTED, 0.0, came, 0.0, 0
    pushed, dragged = 0.0, (0.0, 0.0, 0.0)
    while steps < LONGEST * STEPS:
        steps += 1
        u = -dot(v, n)
        x += h * u
        last = state
        state, extra = energy.step(law, spring, last, x, u, h, h, near)
        wave += energy.wave_energy(spring, last, state, h, near)
        if state.force == 0.0 and steps > 1:
            state = last
            break
        drag = 0.0, 0.0, 0.0
        if rows is not None and len(rows) > 0:
            slip = plus(v, u, n)
            drag = tangential_force(
                rows[0], friction, kappa, law, spring, state, last.largest_compression, x, speed, n, slip, h, extra
            )
        force = state.force + extra
        dragged = plus(dragged, h, drag)
        v = plus(v, h, point_answer(body, m, plus(drag, force, n), n, s))
        pushed += h * force
    if rows is not None and len(rows) > 0:
        clear_friction(rows[0])
    ended, put, u = at_largest(law, spring, state), 0.5 * m * speed * speed, -dot(v, n)
    gone, other = ended.lost * ended.unit * ended.scale, ended.other * ended.unit * ended.scale
    # The steps' energies are more precise where little is lost, the speed where nearly all is.
    # Friction on a body changes its normal motion, so that these energies do not say the speed.
    lost, restitution = gone + wave, min(max(-u / speed, 0.0), 1.0)
    if rows is None or body is None or not (known(body) and len(rows) > 0):
        left = min(max(1.0 - lost / put, 0.0), 1.0) if u < 0.0 else 0.0
        restitution += left * (math.sqrt(left) - restitution)
    gap = ended.residual * ended.scale + state.plate_displacement - x
    since = min(max(gap / -u, 0.0), h) if u < 0.0 else 0.0  # since the end of the contact
    return Bounce(
        restitution,
        steps * h - since,
        ended.peak * ended.unit,
        state.largest_compression,
        (gone - other) / lost if lost > 0.0 else 0.0,
        wave / lost if lost > 0.0 else 0.0,
        divided(dragged, pushed),
        1.0 if u >= 0.0 and near is not None and near.rate > 0.0 else 0.0,
    )
