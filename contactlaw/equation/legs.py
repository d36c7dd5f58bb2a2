"""The path of a contact, cut into legs on each of which the force is one smooth function of q.

Loading goes up the loading curve from kink to kink, then the contact goes down the unloading curve.
With a capped law it goes down in up to three parts: the unloading curve, the loading curve from
kink to kink, the unloading curve again.

Legend: d compression, dr residual compression, dm largest compression, q root compression,
sqrt(d - dr).
"""

import math
from typing import NamedTuple

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.force import UnloadingCurve

CUBIC, PIECES, POWER = range(3)  # how a leg's force is given
# loading; unloading above, along and below the cap
_LOADING, _ABOVE_CAP, _ALONG_CAP, _BELOW_CAP = range(4)
FIRST = 0  # index of the first piece of a loading curve
NO_CURVE = UnloadingCurve(0.0, 0.0, 3.0, 0.0, 0.0)
"""Placeholder of the unloading curve while a contact loads."""


class Leg(NamedTuple):
    """Part of a contact's path on which the force is one smooth function of q."""

    part: int  # _LOADING, _ABOVE_CAP, _ALONG_CAP or _BELOW_CAP
    level: float  # root compression at which it ends
    residual: float  # d = residual + q^2
    kind: int  # CUBIC, PIECES or POWER
    first: int  # first and last piece of the loading curve
    last: int
    c0: float  # coefficients of a cubic
    c1: float
    c2: float
    c3: float
    exponent: float  # exponent of a power, whose stiffness is c3


@kernel(inline=True)
def is_loading(leg: Leg) -> bool:
    """Whether the contact loads on a leg."""
    return leg.part == _LOADING


@kernel(inline=True)
def is_last(leg: Leg) -> bool:
    """Whether a contact ends with a leg."""
    return leg.part != _LOADING and leg.level == 0.0


@kernel(inline=True)
def unloads(leg: Leg) -> bool:
    """Whether a leg is the part of the unloading curve that a contact ends with."""
    return leg.part == _BELOW_CAP


@kernel(inline=True)
def force_on(leg: Leg, kind: int, law: Array, q: float) -> float:
    """Force on a leg; its kind is an argument so that the compiler knows it."""
    if kind == CUBIC:  # Hertz's law, the linear branch of MYC, most unloading
        return (leg.c0 + leg.c1 * q) + (q * q) * (leg.c2 + leg.c3 * q)
    if kind == POWER:
        return force.power_force(leg.c3, leg.exponent, q)
    # a trial step may pass the end of a loading leg: the next piece of the law goes on there
    k, last = leg.first, int(law[force.PIECES]) - 1 if leg.part == _LOADING else leg.last
    while k < last and q >= force.start_of(law, k + 1):
        k += 1
    return force.piece_force(law, k, q)


@kernel
def _along_loading(law: Array, part: int, first: int, last: int, level: float) -> Leg:
    """Leg on pieces of the loading curve."""
    row = force.row_of(law, first)
    degree, at = int(law[row + force.DEGREE]), int(law[row + force.AT])
    if last == first and degree <= 3 and law[row + force.SCALE] == 1.0 and law[row + force.OFFSET] == 0.0:
        c1 = law[at + 1] if degree > 0 else 0.0
        c2 = law[at + 2] if degree > 1 else 0.0
        c3 = law[at + 3] if degree > 2 else 0.0
        return Leg(part, level, 0.0, CUBIC, first, last, law[at], c1, c2, c3, 3.0)
    return Leg(part, level, 0.0, PIECES, first, last, 0.0, 0.0, 0.0, 0.0, 3.0)


@kernel
def _on_unloading_curve(part: int, curve: UnloadingCurve, level: float) -> Leg:
    """Leg on the unloading curve."""
    kind = CUBIC if curve.exponent == 3.0 else POWER
    return Leg(part, level, curve.residual, kind, 0, 0, 0.0, 0.0, 0.0, curve.stiffness, curve.exponent)


@kernel
def up(law: Array, first: int) -> Leg:
    """Leg of loading from a kink to the next; `first` is the piece that begins at the kink."""
    following = int(law[force.row_of(law, first) + force.NEXT])
    level = force.start_of(law, following)
    return _along_loading(law, _LOADING, first, following - 1, level)


@kernel
def up_again(law: Array, q: float) -> Leg:
    """Leg of loading that goes on from a root compression."""
    return up(law, int(law[force.row_of(law, force.piece_at(law, q)) + force.FIRST]))


@kernel
def _down(law: Array, curve: UnloadingCurve, below: float) -> Leg:
    """Leg of unloading along the loading curve, from below a root compression to a kink or cap."""
    k = 0
    while force.start_of(law, k + 1) < below:
        k += 1
    first = int(law[force.row_of(law, k) + force.FIRST])
    low = 0.0 if curve.stiffness == 0.0 else math.sqrt(curve.cap_low)
    level = max(low, force.start_of(law, first))
    return _along_loading(law, _ALONG_CAP, first, k, level)


@kernel
def first_down(law: Array, curve: UnloadingCurve, dm: float) -> Leg:
    """Leg on which unloading from dm begins."""
    if curve.stiffness > 0.0 and curve.cap_low >= curve.cap_high:
        return _on_unloading_curve(_BELOW_CAP, curve, 0.0)
    if curve.stiffness > 0.0 and curve.cap_high < dm:
        level = math.sqrt(curve.cap_high - curve.residual)
        return _on_unloading_curve(_ABOVE_CAP, curve, level)
    return _down(law, curve, math.sqrt(dm))


@kernel
def following(law: Array, curve: UnloadingCurve, leg: Leg) -> Leg:
    """Leg after one that has ended at its level; the last leg of a contact ends at level 0."""
    if leg.part == _LOADING:
        return up(law, leg.last + 1)
    if leg.part == _ABOVE_CAP:
        return _down(law, curve, math.sqrt(curve.cap_high))
    if curve.stiffness > 0.0 and leg.level <= math.sqrt(curve.cap_low):
        return _on_unloading_curve(_BELOW_CAP, curve, 0.0)
    return _down(law, curve, leg.level)
