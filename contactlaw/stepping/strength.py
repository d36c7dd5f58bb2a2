"""Laws of a pair whose strength depends on the rate of strain: one strength for each contact.

The factor by which an impact strengthens the pair (`contactlaw.physical.rate`) is known when its
speed is, in the second step of a contact, and then stays. Laws are made at a few levels, evenly
spaced in the factor's logarithm. A contact lies at a *place* between two of them, as 1.25, and its
law is the mean of theirs: force while loading, residual compression and exponent of unloading.

A pair's levels are one array: a header, and for each level its yield compression over that of the
first level, c, and its law. Without a rate it is None, for which kernels are compiled by
themselves, and the law is the pair's own.

Legend: compressions in d_Y of the first level, forces in its F_Y = K d_Y^1.5, works in F_Y d_Y.
"""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.force import UnloadingCurve
from contactlaw.laws import Law
from contactlaw.physical.pair import Pair
from contactlaw.physical.rate import SHARE, flows, largest_factor, rated, strengthened
from contactlaw.physical.scaling import law_of

Array = NDArray[np.float64]

# Largest step of ln(factor) between two levels: the COR is within 3e-4 of itself of that of a law
# made for the factor, measured for E*/sigma_Y 70 to 2700; within 4e-4 for bodies with two rate0.
_STEP = 0.07
# A header, then the levels: number of levels, room of each, C, representative rate over rate0 of an
# impact at one d_Y per second, step of ln(factor).
COUNT, ROOM, COEFFICIENT, PER_SPEED, STEP, LEVELS = range(6)
# A contact's place is kept in the whole part of `State.stiffening` over _STRIDE, so that a contact
# needs no more memory than that of a pair without a rate. A stiffening is a small number; it is
# above _STRIDE, and then cut, on foils alone that are far too thin for the model.
_STRIDE, _FINE = 4096.0, 4096.0


@functools.lru_cache(maxsize=16)
def levels_of(pair: Pair, law: Law, step: float = _STEP) -> Array | None:
    """Levels for kernels, strengths at most a step of ln apart; None for a pair without a rate."""
    flow = rated(pair, law)
    if flow is None:
        return None
    most = math.log(largest_factor(flow))
    # the second of two strengths grows fastest where it begins to; that corner is to be a level
    starts = [(one.rate / flow.rate, flow.factor(one.rate0)) for one in flows(pair)]
    least = math.ceil(most / step * max(share * factor for share, factor in starts))
    counts = np.arange(least, 2 * least + 1)[:, None]
    places = counts * [math.log(factor) / most for _, factor in starts]
    steps = least + int(np.argmin(np.abs(places - np.round(places)).max(axis=1)))
    pairs = [strengthened(pair, math.exp(n / steps * most)) for n in range(steps + 1)]
    made = [law_of(one, law.family) for one in pairs]
    scales = [one.scale or 1.0 for one in made]
    room = 1 + max(one.data.size for one in made)
    found = np.zeros(LEVELS + len(made) * room)
    found[:LEVELS] = len(made), room, flow.rate, SHARE / flow.rate0 * scales[0], most / steps
    for n, one in enumerate(made):
        at = LEVELS + n * room
        found[at] = scales[n] / scales[0]
        found[at + 1 : at + 1 + one.data.size] = one.data
    return found


@kernel
def place_at(levels: Array, speed: float, scale: float) -> float:
    """Place of an impact at this speed, from d_Y of the first level."""
    rate = levels[PER_SPEED] * speed / scale
    if not rate > 1.0:
        return 0.0
    place = math.log(1.0 + levels[COEFFICIENT] * math.log(rate)) / levels[STEP]
    whole: int = math.floor(_FINE * min(place, levels[COUNT] - 1.0) + 0.5)
    return whole / _FINE


@kernel
def with_place(stiffening: float, place: float) -> float:
    """Hold a contact's stiffening and place in one number."""
    return min(stiffening, _STRIDE - 1.0) + _STRIDE * (_FINE * place)


@kernel
def split(held: float) -> tuple[float, float]:
    """Stiffening and place of a contact, from the number that holds both."""
    whole = math.floor(held / _STRIDE)
    return held - _STRIDE * whole, whole / _FINE


@kernel
def beside(levels: Array, place: float) -> tuple[int, int, float]:
    """Where the two levels beside a place begin, and the share of the upper one."""
    n = min(int(place), int(levels[COUNT]) - 2)
    room = int(levels[ROOM])
    at = LEVELS + n * room
    return at, at + room, place - n


@kernel
def yield_growth(levels: Array, place: float) -> float:
    """Yield compression at a place, over that of the first level.

    It is not quite the square of the strength: bodies that harden have hardened by more where they
    yield later.
    """
    low, high, share = beside(levels, place)
    return math.pow(levels[low], 1.0 - share) * math.pow(levels[high], share)


@kernel
def law_at(levels: Array, at: int) -> tuple[float, Array]:
    """Yield compression over that of the first level, and law, of the level that begins there."""
    return levels[at], levels[at + 1 : at + int(levels[ROOM])]


@kernel
def nearest(levels: Array, place: float) -> tuple[Array, float]:
    """Law of the nearest level, and its yield compression over that of the first level."""
    low, high, share = beside(levels, place)
    c, law = law_at(levels, low if share < 0.5 else high)
    return law, c


@kernel
def _loading(levels: Array, at: int, q: float) -> float:
    c, law = law_at(levels, at)
    root = math.sqrt(c)
    return c * root * force.loading(law, q / root)


@kernel
def loading(law: Array, levels: Array | None, place: float, q: float) -> float:
    """Force while the compression q^2 grows."""
    if levels is None:
        return force.loading(law, q)
    low, high, share = beside(levels, place)
    return (1.0 - share) * _loading(levels, low, q) + share * _loading(levels, high, q)


@kernel
def lossless(law: Array, levels: Array | None) -> float:
    """Largest compression from which a contact unloads without a loss."""
    if levels is None:
        return force.lossless(law)
    return force.lossless(law_at(levels, LEVELS)[1])


@kernel
def unloading(law: Array, levels: Array | None, place: float, dm: float) -> UnloadingCurve:
    """Find the unloading curve from dm."""
    if levels is None:
        return force.unloading(law, dm)
    low, high, share = beside(levels, place)
    one, other = _unloading(levels, low, dm), _unloading(levels, high, dm)
    left = (1.0 - share) * one.residual + share * other.residual
    exponent = (1.0 - share) * one.exponent + share * other.exponent
    reach = math.pow(dm - left, 0.5 * exponent)
    peak = loading(law, levels, place, math.sqrt(dm))
    return UnloadingCurve(left, peak / reach, exponent, 0.0, 0.0)


@kernel
def _unloading(levels: Array, at: int, dm: float) -> UnloadingCurve:
    c, law = law_at(levels, at)
    curve = force.unloading(law, dm / c)
    return UnloadingCurve(c * curve.residual, 0.0, curve.exponent, 0.0, 0.0)


@kernel
def losses(law: Array, levels: Array | None, place: float, dm: float) -> tuple[float, float]:
    """Loss of a contact that was loaded to dm, and the part of it that is not plastic work."""
    if levels is None:
        return force.loss(law, dm), force.other_loss(law, dm)
    low, high, share = beside(levels, place)
    one, other = _works(levels, low, dm), _works(levels, high, dm)
    curve = unloading(law, levels, place, dm)
    peak = loading(law, levels, place, math.sqrt(dm))
    back = peak * (dm - curve.residual) / (0.5 * curve.exponent + 1.0)
    return (
        (1.0 - share) * one[0] + share * other[0] - back,
        (1.0 - share) * one[1] + share * other[1],
    )


@kernel
def _works(levels: Array, at: int, dm: float) -> tuple[float, float]:
    """Work of loading to dm at a level, and the loss that is not plastic work."""
    c, law = law_at(levels, at)
    d, unit = dm / c, c * c * math.sqrt(c)
    curve = force.unloading(law, d)
    back = force.loading(law, math.sqrt(d)) * (d - curve.residual) / (0.5 * curve.exponent + 1.0)
    return unit * (force.loss(law, d) + back), unit * force.other_loss(law, d)
