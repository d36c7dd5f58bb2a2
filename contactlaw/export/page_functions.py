"""What the page of a pair computes beside `contactlaw.export.functions`, as kernels; see there."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._jit import kernel
from contactlaw.answers.solver import RTOL
from contactlaw.equation import zener
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import History
from contactlaw.equation.tangential import POINT, SPRINGS, slide
from contactlaw.export import functions
from contactlaw.export.functions import NOTHING, Array, Bodies, Impact, fits, in_si, numbers_of
from contactlaw.physical.arguments import ROUGHEST
from contactlaw.physical.oblique import FASTEST, flows
from contactlaw.physical.validity import Limits, flags_of
from contactlaw.stepping import strength
from contactlaw.table.lookup import V_MAX, V_MIN

FOR_CURVES = 1e-5  # error allowed per step of impacts that are points of a curve
DEAD = 8.0  # lambda from which the restitution is below 2e-4
SAMPLES, SHOWN_SAMPLES = 801, 129  # of a contact over time: for its friction, and to draw it
SHOWN = 12.0  # Hertz's times, after which the tail of a long contact is not drawn


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
def beside(pair: Bodies, speed: float, radius: float) -> tuple[Array, Array, float]:
    """Laws between which an impact lies, and the share of the second."""
    if pair.levels is None:
        return pair.law, pair.law, 0.0
    place = strength.place_at(pair.levels, speed, pair.unit.scale * radius)
    low, high, share = strength.beside(pair.levels, place)
    return strength.law_at(pair.levels, low)[1], strength.law_at(pair.levels, high)[1], share


@kernel
def quick(law: Array, units: Numbers) -> Impact:
    """One impact; one that leaves hardly any speed is not followed to its end."""
    if units.inelasticity <= DEAD:
        return in_si(functions.solved(law, units, FOR_CURVES), units)
    none = np.empty((0, 0))
    lam, notes = units.inelasticity, zener.Notes(none, none, none, none, none)
    top = zener.follow_impact(
        zener.TO_THE_TOP, law, lam, units.yield_ratio, FOR_CURVES, notes, 0, None
    )
    return in_si(top, units)


@kernel
def for_curve(pair: Bodies, speed: float, radius: float, thickness: float) -> Impact:
    """One impact for a point of a curve: its COR is within 3e-4."""
    if not (V_MIN <= speed <= V_MAX and fits(radius, thickness)):
        return NOTHING
    units = numbers_of(pair, speed, radius, thickness)
    low, high, share = beside(pair, speed, radius)
    one = quick(low, units)
    return one if share == 0.0 else functions.moved(one, share, one, quick(high, units))


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
def history(law: Array, units: Numbers, end: float, samples: int) -> History:
    """Contact at even times from touch to an end, on Hertz's scale."""
    at, time, speed = np.empty((1, samples)), np.empty((1, samples)), np.empty((1, samples))
    force, compression = np.empty((1, samples)), np.empty((1, samples))
    for n in range(samples):
        at[0, n] = end * n / (samples - 1)
    lam, notes = units.inelasticity, zener.Notes(at, time, speed, force, compression)
    zener.follow_impact(zener.AT_TIMES, law, lam, units.yield_ratio, RTOL, notes, 0, None)
    for n in range(samples):
        speed[0, n] = 1.0 - speed[0, n]
    return History(at[0], force[0], compression[0], speed[0])


@kernel
def shown(pair: Bodies, hit: Impact, speed: float, radius: float, thickness: float) -> History:
    """Contact of an impact over time; for the impulse it has the displacement of the plate [m]."""
    units = numbers_of(pair, speed, radius, thickness)
    low, high, share = beside(pair, speed, radius)
    end = min(hit.contact_time / units.time, SHOWN)
    path = history(high if share > 0.5 else low, units, end, SHOWN_SAMPLES)
    for n in range(SHOWN_SAMPLES):
        path.time[n] *= units.time
        path.force[n] *= units.force
        path.compression[n] *= units.compression
        path.impulse[n] *= units.inelasticity * units.compression
    return path


@kernel
def slid(law: Array, units: Numbers, kappa: float, psi: float) -> float:
    """Change of the sliding speed psi [mu V0]."""
    path = history(law, units, functions.solved(law, units, RTOL).contact_time, SAMPLES)
    path.force[SAMPLES - 1] = 0.0
    after, stretch = np.empty(1), np.empty((SPRINGS, 1))
    after[0] = psi
    slide(law, units.yield_ratio, kappa, path, after, stretch)
    return float(psi - after[0])


@kernel
def collide(
    pair: Bodies, page: Page, bead: float, angle: float, radius: float, thickness: float,
    friction: float,
) -> Hit:  # fmt: skip
    """Impact of a bead without spin, at an angle [deg] to the normal of the plate."""
    tilt, change = angle * math.pi / 180.0, 0.0
    speed, size = bead * math.cos(tilt), bead * math.sin(tilt)
    hit, limit = functions.rebound(pair, speed, radius, thickness), friction * speed
    if not (hit.restitution >= 0.0 and 0.0 <= friction <= ROUGHEST):
        return REFUSED
    if limit > 0.0 and size > 0.0:
        units, psi = numbers_of(pair, speed, radius, thickness), min(size / limit, FASTEST)
        low, high, share = beside(pair, speed, radius)
        change = slid(low, units, pair.tangential_ratio, psi)
        if share > 0.0:
            change += share * (slid(high, units, pair.tangential_ratio, psi) - change)
        change *= limit
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
