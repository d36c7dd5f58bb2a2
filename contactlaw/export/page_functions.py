"""Kernels of the page with sliders, beside those of `contactlaw.export.functions`."""

import math
from typing import NamedTuple

import numpy as np

from contactlaw._jit import kernel
from contactlaw.answers.solver import RTOL
from contactlaw.equation.notes import TO_THE_END, TO_THE_TOP, Notes
from contactlaw.equation.numbers import Impact
from contactlaw.equation.outcome import History
from contactlaw.equation.tangential import POINT, SPRINGS
from contactlaw.export import functions
from contactlaw.export.functions import NOTHING, Answer, Bodies, followed, is_valid, numbers_of
from contactlaw.physical.arguments import ROUGHEST
from contactlaw.physical.oblique import flows

FOR_CURVES = 1e-5  # error allowed per step of impacts that are points of a curve
DEAD = 8.0  # lambda from which the restitution is below 2e-4
SAMPLES, SHOWN = 801, 129  # of a contact over time: for its friction, and to draw it
LONGEST = 12.0  # Hertz's times, after which the tail of a long contact is not drawn


class Page(NamedTuple):
    """Numbers of a pair of materials that `Bodies` does not have."""

    modulus: float  # E* [Pa]
    strength: float  # of the weaker body [Pa]
    flag: int  # SLIDING_FLOW


class Hit(NamedTuple):
    """An oblique impact."""

    impact: Answer
    flags: int
    speed: float  # normal to the plate before [m/s]
    sliding_speed: float  # of the contact point afterwards [m/s]
    along: float  # of the centre along the plate afterwards [m/s]
    spin: float  # afterwards [rad/s]
    normal_share: float  # of the energy before that is in the normal motion
    friction_share: float  # of it that friction takes


REFUSED = Hit(NOTHING, -1, *[math.nan] * 6)


@kernel
def for_curve(pair: Bodies, impact: Impact) -> Answer:
    """Solve the impact of a point of a curve; its COR is within 3e-4.

    An impact that leaves hardly any speed is followed only to its largest compression.
    """
    if not is_valid(impact):
        return NOTHING
    if numbers_of(pair, impact).inelasticity <= DEAD:
        return followed(pair, impact, TO_THE_END, FOR_CURVES)
    return followed(pair, impact, TO_THE_TOP, FOR_CURVES)


@kernel
def shown(pair: Bodies, hit: Answer, impact: Impact) -> History:
    """Force [N] of an impact over time [s]; the other columns have no units."""
    at, time, velocity = np.empty((1, SHOWN)), np.empty((1, SHOWN)), np.empty((1, SHOWN))
    force, compression = np.empty((1, SHOWN)), np.empty((1, SHOWN))
    units = numbers_of(pair, impact)
    end = min(hit.contact_time / units.time, LONGEST)
    notes = Notes(at, time, velocity, force, compression)
    path = functions.history(pair, units, end, notes)
    for n in range(SHOWN):
        path.time[n] *= units.time
        path.force[n] *= units.force
    return path


@kernel
def collide(pair: Bodies, page: Page, given: Impact, angle: float, friction: float) -> Hit:
    """Solve the impact of a bead without spin, at an angle [deg] to the normal of the plate.

    The speed is that of the bead along its path.
    """
    tilt = angle * math.pi / 180.0
    speed, size = given.speed * math.cos(tilt), given.speed * math.sin(tilt)
    impact = Impact(speed, given.radius, given.thickness, given.mass)
    hit = followed(pair, impact, TO_THE_END, RTOL)
    if not (hit.restitution >= 0.0 and 0.0 <= friction <= ROUGHEST):
        return REFUSED
    change = functions.rubbed(pair, impact, size, friction, SAMPLES, SPRINGS)
    after, found = size - change, functions.exceeded(pair, hit, impact)
    if flows(page.strength, page.modulus, hit, friction, size, after):
        found |= page.flag
    return Hit(
        hit,
        found,
        speed,
        after,
        size - change / POINT,
        (1.0 - 1.0 / POINT) * change / impact.radius,
        math.cos(tilt) ** 2,
        change * (size + after) / (POINT * given.speed * given.speed),
    )
