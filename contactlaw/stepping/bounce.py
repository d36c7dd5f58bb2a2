"""The true impact of a bead, carried out at its first touch for a softened contact.

A softened contact (`contactlaw.stepping.softened`) has neither the time nor the force of the true
one. What the bead keeps of its motion comes from here: the contact of `spring`, `energy` and
`friction` under velocity Verlet, in short steps of its own and against a flat wall. So a softened
contact has all that a true one has: laws, rates, losses, edges, masses.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation.corrections import CONTACT_TIME
from contactlaw.equation.force import room_for
from contactlaw.equation.tangential import POINT
from contactlaw.stepping import energy
from contactlaw.stepping.edge import EdgeEcho
from contactlaw.stepping.friction import clear_friction, tangential_force
from contactlaw.stepping.spring import PARTED, Spring, at_largest, impact

Array = NDArray[np.float64]

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
    impulse_ratio: float  # tangential impulse over the normal one; against the sliding
    recedes: float  # 1.0 if the plate does so before the bead, and will strike it again


@kernel
def bounce(
    law: Array,
    spring: Spring,
    speed: float,
    near: EdgeEcho | None,
    sliding: float,
    friction: float,
    kappa: float,
    rows: Any,
) -> Bounce:
    """Impact at these speeds [m/s]; `rows` are the FRICTION rows to use, none without friction."""
    m, expected, room = spring.mass, impact(law, spring, speed), room_for(law)
    h = CONTACT_TIME * expected.time / STEPS
    state, x, u, s, wave, steps = PARTED, 0.0, speed, sliding, 0.0, 0
    n = 0.0, 0.0, 1.0
    for steps in range(1, LONGEST * STEPS):
        x += h * u
        last = state
        state, extra = energy.step(law, spring, last, x, u, h, h, near)
        wave += energy.wave_energy(spring, last, state, h, near)
        if state.force == 0.0 and steps > 1:
            state = last
            break
        if len(rows) > 0:
            drag = tangential_force(
                rows[0],
                friction,
                kappa,
                law,
                spring,
                state,
                last.largest_compression,
                x,
                speed,
                n,
                (s, 0.0, 0.0),
                h,
                extra,
                room,
            )
            s += POINT * h / m * drag[0]
        u -= h * (state.force + extra) / m
    if len(rows) > 0:
        clear_friction(rows[0])
    ended, came = at_largest(law, spring, state), 0.5 * m * speed * speed
    gone, other = ended.lost * ended.unit * ended.scale, ended.other * ended.unit * ended.scale
    # The steps' energies are more precise where little is lost, the speed where nearly all is.
    lost, by_speed = gone + wave, max(-u / speed, 0.0)
    left = max(1.0 - lost / came, 0.0) if u < 0.0 else 0.0
    restitution = by_speed + left * (math.sqrt(left) - by_speed)
    ratio = (sliding - s) / (POINT * (1.0 + restitution) * speed)
    gap = ended.residual * ended.scale + state.plate_displacement - x
    since = min(max(gap / -u, 0.0), h) if u < 0.0 else 0.0  # since the end of the contact
    return Bounce(
        restitution,
        steps * h - since,
        ended.peak * ended.unit,
        state.largest_compression,
        (gone - other) / lost if lost > 0.0 else 0.0,
        wave / lost if lost > 0.0 else 0.0,
        ratio,
        1.0 if u >= 0.0 and near is not None and near.rate > 0.0 else 0.0,
    )
