"""The path of a contact, cut into legs on each of which the force is one smooth function of q.

Loading goes up the loading curve from kink to kink, then the contact goes down the unloading curve,
or down the loading curve if nothing has been lost.

Legend: d compression, dr residual compression, dm largest compression, q root compression,
sqrt(d - dr).
"""

import math
from typing import NamedTuple

from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.force import BlendedLaw, UnloadingCurve

CUBIC, PIECES, POWER = range(3)  # how a leg's force is given
FIRST = 0  # index of the first piece of a loading curve
NO_CURVE = UnloadingCurve(0.0, 0.0, 3.0)
"""Placeholder of the unloading curve while a contact loads."""


class Leg(NamedTuple):
    """Part of a contact's path on which the force is one smooth function of q."""

    level: float  # root compression at which it ends; 0 if it unloads
    residual: float  # d = residual + q^2
    kind: int  # CUBIC, PIECES or POWER
    first: int  # first and last piece of the loading curve
    last: int
    c0: float  # coefficients of a cubic
    c1: float
    c2: float
    c3: float
    exponent: float  # of the unloading curve, whose stiffness is c3; 0 on the loading curve


@kernel(inline=True)
def is_loading(leg: Leg) -> bool:
    """Whether the contact loads on a leg."""
    return leg.level > 0.0


@kernel(inline=True)
def force_on(leg: Leg, kind: int, law: BlendedLaw, q: float) -> float:
    """Force on a leg; its kind is an argument so that the compiler knows it."""
    if kind == CUBIC:  # Hertz's law, the linear branch of MYC, most unloading
        return (leg.c0 + leg.c1 * q) + (q * q) * (leg.c2 + leg.c3 * q)
    if kind == POWER:
        return force.power_force(leg.c3, leg.exponent, q)
    if q * q > law.end:
        return force.loading(law, q)
    # a trial step may pass the end of a loading leg: the next piece of the law goes on there
    k, last = leg.first, int(law.low[force.PIECES]) - 1 if is_loading(leg) else leg.last
    while k < last and q >= force.start_of(law.low, k + 1):
        k += 1
    f = force.piece_force(law.low, k, q)
    return f + law.share * (force.loading_of(law.high, q) - f) if law.share > 0.0 else f


@kernel
def _along_loading(law: BlendedLaw, first: int, last: int, level: float) -> Leg:
    """Leg on pieces of the loading curve."""
    c, row = law.low, force.row_of(law.low, first)
    plain = law.share == 0.0 and c[row + force.SCALE] == 1.0 and c[row + force.OFFSET] == 0.0
    if plain and last == first and c[row + force.DEGREE] <= 3.0:
        at = int(c[row + force.AT])
        return Leg(level, 0.0, CUBIC, first, last, c[at], c[at + 1], c[at + 2], c[at + 3], 0.0)
    return Leg(level, 0.0, PIECES, first, last, 0.0, 0.0, 0.0, 0.0, 0.0)


@kernel
def up(law: BlendedLaw, first: int) -> Leg:
    """Leg of loading from a kink to the next; `first` is the piece that begins at the kink."""
    following = int(law.low[force.row_of(law.low, first) + force.NEXT])
    return _along_loading(law, first, following - 1, force.start_of(law.low, following))


@kernel
def down(law: BlendedLaw, dm: float) -> Leg:
    """Leg of unloading from dm, with which the contact ends."""
    curve = force.unloading(law, dm)
    if curve.stiffness > 0.0:
        kind = CUBIC if curve.exponent == 3.0 else POWER
        return Leg(0.0, curve.residual, kind, 0, 0, 0.0, 0.0, 0.0, curve.stiffness, curve.exponent)
    k, q = FIRST, math.sqrt(dm)
    while force.start_of(law.low, k + 1) < q:
        k += 1
    return _along_loading(law, FIRST, k, 0.0)
