"""What the page of a pair computes beside `contactlaw.export.functions`, as kernels; see there."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._jit import kernel
from contactlaw.equation import zener
from contactlaw.equation.outcome import History
from contactlaw.equation.tangential import POINT, SPRINGS
from contactlaw.export import functions
from contactlaw.export.functions import (
    NOTHING,
    Bodies,
    Impact,
    Strength,
    beside,
    fits,
    history,
    in_si,
    numbers_of,
    rubbed,
)
from contactlaw.physical.arguments import ROUGHEST
from contactlaw.physical.oblique import flows
from contactlaw.physical.validity import Limits, flags_of
from contactlaw.stepping import strength
from contactlaw.table.lookup import V_MAX, V_MIN

FOR_CURVES = 1e-5  # error allowed per step of impacts that are points of a curve
DEAD = 8.0  # lambda from which the restitution is below 2e-4
SAMPLES, SHOWN = 801, 129  # of a contact over time: for its friction, and to draw it
LONGEST = 12.0  # Hertz's times, after which the tail of a long contact is not drawn


class Page(NamedTuple):
    """What a pair of materials fixes beside `Bodies`."""

    limits: Any  # numbers of `Limits`, a row for each level of strength
    modulus: float  # E* [Pa]
    strength: float  # of the weaker body [Pa]
    flag: int  # SLIDING_FLOW


class Hit(NamedTuple):
    """An oblique impact."""

    impact: Impact
    flags: int
    speed: float  # normal to the plate before [m/s]
    size: float  # along it before [m/s]
    sliding_speed: float  # of the contact point afterwards [m/s]
    along: float  # of the centre along the plate afterwards [m/s]
    spin: float  # afterwards [rad/s]
    normal_share: float  # of the energy before that is in the normal motion
    friction_share: float  # of it that friction takes


REFUSED = Hit(NOTHING, -1, *[math.nan] * 7)


@kernel
def quick(at: Strength) -> Impact:
    """One impact; one that leaves hardly any speed is not followed to its end."""
    units = at.units
    if units.inelasticity <= DEAD:
        return in_si(functions.solved(at, FOR_CURVES), units)
    return in_si(functions.solved(at, FOR_CURVES, zener.TO_THE_TOP), units)


@kernel
def for_curve(pair: Bodies, speed: float, radius: float, thickness: float) -> Impact:
    """One impact for a point of a curve: its COR is within 3e-4."""
    if not (V_MIN <= speed <= V_MAX and fits(radius, thickness)):
        return NOTHING
    units = numbers_of(pair, speed, radius, thickness)
    low, high, share = beside(pair, units, speed, radius)
    one = quick(low)
    return one if share == 0.0 else functions.moved(one, share, quick(high))


@kernel
def flags(
    pair: Bodies, page: Page, hit: Impact, speed: float, radius: float, thickness: float
) -> int:
    """Limits of the model that an impact exceeds, at its own strength."""
    limits, units = pair.limits, numbers_of(pair, speed, radius, thickness)
    if pair.levels is not None:
        place = strength.place_at(pair.levels, speed, pair.unit.scale * radius)
        n = min(int(place), page.limits.shape[0] - 2)
        a, b, s = page.limits[n], page.limits[n + 1], place - n
        near = b if s > 0.5 else a
        # of two that are inf the limit is NaN, which is not exceeded either
        share, deepest = a[7] + s * (b[7] - a[7]), a[8] + s * (b[8] - a[8])
        limits = Limits(
            near[0], near[1], int(near[2]), int(near[3]), near[4], near[5], near[6], share,
            deepest, a[9] + s * (b[9] - a[9]), near[10], int(near[11]),
        )  # fmt: skip
    return flags_of(
        limits, radius, thickness, units.compression, hit.contact_time, hit.peak_compression,
        hit.peak_force,
    )  # fmt: skip


@kernel
def shown(pair: Bodies, hit: Impact, speed: float, radius: float, thickness: float) -> History:
    """Contact of an impact over time; for the impulse it has the displacement of the plate [m]."""
    at, time, velocity = np.empty((1, SHOWN)), np.empty((1, SHOWN)), np.empty((1, SHOWN))
    force, compression = np.empty((1, SHOWN)), np.empty((1, SHOWN))
    units = numbers_of(pair, speed, radius, thickness)
    low, high, share = beside(pair, units, speed, radius)
    end = min(hit.contact_time / units.time, LONGEST)
    notes = zener.Notes(at, time, velocity, force, compression)
    path = history(high if share > 0.5 else low, end, notes)
    for n in range(SHOWN):
        path.time[n] *= units.time
        path.force[n] *= units.force
        path.compression[n] *= units.compression
        path.impulse[n] *= units.inelasticity * units.compression
    return path


@kernel
def collide(
    pair: Bodies, page: Page, bead: float, angle: float, radius: float, thickness: float,
    friction: float,
) -> Hit:  # fmt: skip
    """Impact of a bead without spin, at an angle [deg] to the normal of the plate."""
    tilt = angle * math.pi / 180.0
    speed, size = bead * math.cos(tilt), bead * math.sin(tilt)
    hit = functions.rebound(pair, speed, radius, thickness)
    if not (hit.restitution >= 0.0 and 0.0 <= friction <= ROUGHEST):
        return REFUSED
    change = rubbed(pair, speed, size, radius, thickness, friction, SAMPLES, SPRINGS)
    after, found = size - change, flags(pair, page, hit, speed, radius, thickness)
    if flows(
        page.strength, page.modulus, hit.peak_force, hit.peak_compression,
        hit.residual_compression, hit.contact_time, friction, size, after,
    ):  # fmt: skip
        found |= page.flag
    return Hit(
        hit, found, speed, size, after, size - change / POINT,
        (1.0 - 1.0 / POINT) * change / radius, math.cos(tilt) ** 2,
        change * (size + after) / (POINT * bead * bead),
    )  # fmt: skip
