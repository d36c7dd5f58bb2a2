"""Unloading of a sphere that its plate hardly throws off, by a series instead of time steps.

Where the force falls as q^b, with k its slope over d and beta the mobility of the plate, the force
follows the speed of the sphere with the time constant 1/(beta k), and the speed decays with the
time constant beta. If their ratio delta = 1/(beta^2 k) is small, explicit steps, which are no
longer than the shorter of the two, are needed by the hundred thousand. From du/dt = -f and
df/dt = k (u - beta f) follows, in powers of delta, which goes as u^-p with p = 1 - 2/b,

    beta f = u/(1 - delta),    dt = -(1 - delta) beta du/u

with errors of delta^2. It holds from the largest compression on, where u = beta f.

Legend, as in `contactlaw.equation.motion`: d compression, q root compression, u speed, t time,
f force.
"""

from __future__ import annotations

import math

from contactlaw._jit import kernel
from contactlaw.equation import force, losses, motion
from contactlaw.equation.legs import Leg
from contactlaw.equation.motion import ScaledContact, ScaledState

SLOW = 1e-4  # delta, below which the series is used


@kernel
def rebound_speed_squared(leg: Leg, state: ScaledState) -> float:
    """Square of the speed with which the sphere would rebound if the plate were held from now on.

    The work of a force that falls as q^b is 2 f q^2/(b + 2).
    """
    return state.u * state.u + 4.0 * state.f * state.q * state.q / (leg.exponent + 2.0)


@kernel
def creep(
    contact: ScaledContact, leg: Leg, state: ScaledState, level: float, until: float, least: float
) -> ScaledState:
    """Follow the series while it holds.

    It ends when `rebound_speed_squared` is `least`, or just before a level or a time.
    """
    beta, b, q, u = contact.plate.mobility, leg.exponent, state.q, state.u
    delta = 2.0 * q * q / (b * beta * beta * state.f)
    if not (delta < SLOW and abs(state.dq) < SLOW * u):
        return state
    p = 1.0 - 2.0 / b
    x = math.log(u / math.sqrt(least))  # ln of the ratio by which the speed falls
    x += b / (b + 2.0) * delta * math.exp(p * x)
    if p > 0.0:
        x = min(x, math.log(SLOW / delta) / p)
    short = 10.0 * delta
    x = min(x, (until - state.t) / beta - short)
    if level > 0.0:
        x = min(x, math.log(u / (beta * force.power_force(leg.c3, b, level))) - short)
    if not x > 0.0:
        return state
    u *= math.exp(-x)
    last = delta * math.exp(p * x)
    q *= math.pow(u / ((1.0 - last) * beta * state.f), 1.0 / b)
    time = x - delta * (math.expm1(p * x) / p if p != 0.0 else x)
    there = motion.start(contact, leg, q, u, state.t + beta * time, state.work, state.memory)
    spent = rebound_speed_squared(leg, state) - rebound_speed_squared(leg, there)
    wave = state.work.wave + spent / (2.0 * beta)
    return ScaledState(
        q, u, there.t, losses.Work(wave), there.dq, there.du, there.f, there.memory, there.dmemory
    )
