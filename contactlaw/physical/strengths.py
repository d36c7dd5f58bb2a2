"""The laws of a pair that grows stronger with the rate of an impact, as one array for kernels.

They stand on a ladder: a law at each corner of the pair's law, and at strengths in between. Kernels
blend the two around the strength of an impact, see `contactlaw.equation.force`.
"""

import dataclasses
import functools
import itertools
import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._bisect import bisect
from contactlaw.equation import force
from contactlaw.laws import Law, Strengths, fem
from contactlaw.laws._expansion import Resolution, expanded, packed
from contactlaw.laws.fem import ALONE, RATIOS
from contactlaw.physical import rate
from contactlaw.physical.law import pair_numbers
from contactlaw.physical.pair import Pair

_DEEPEST = (23.0, 40.0)  # E*/sigma_Y at which the reach of law fem changes its formula
_TRIED = 0.01  # in ln k: distance of the places between which corners are looked for
_NARROWEST = 1e-3  # in ln k: narrower ranges of strengths are widened
_CLOSE = 1e-6  # in ln k: how closely the strength is found at which no body yields


class Fineness(NamedTuple):
    """How finely laws are resolved."""

    vanished: float  # terms of a law that count as zero, relatively
    widest: float  # pieces of a law: ratio of their ends
    apart: float  # largest distance of two rungs in ln k
    fastest: float  # (V0/R)(V_Y/V0)^0.3 [1/s] up to which they reach
    near: float  # in ln k: nearer to each other, corners count as one
    slowest: float = 0.0  # the same from which on they are asked for


# The COR is within 7e-5 of that of a law made for its strength, up to the law's end.
USUAL = Fineness(1e-10, 3.0, 0.03, rate.REACH, 1e-4)
# For steps and for exports, whose laws have fewer numbers: within 1e-4.
COARSE = Fineness(1e-7, 4.0, 0.04, rate.FASTEST, 5e-3)


def with_strengths(pair: Pair, law: Law) -> Law:
    """Law with those of a pair that is as strong as at the rates of a table's impacts."""
    if rate.flow_with_rate(pair, law) is None or not law.yields:
        return law
    laws = by_strength(pair, law)
    known, last = force.rungs(laws)[:, force.STRENGTH], knots(pair, USUAL.apart, rate.FASTEST, USUAL.near)[0][-1]
    return dataclasses.replace(law, strengths=Strengths(laws, (*known[known < last - _CLOSE].tolist(), float(last))))


@functools.lru_cache(maxsize=64)
def by_strength(pair: Pair, law: Law, fineness: Fineness = USUAL) -> Array:
    """Ladder of the laws of a pair at any strength; that of a pair without a rate as it is."""
    if rate.flow_with_rate(pair, law) is None or not law.yields:
        return law.data
    strengths, most = knots(pair, fineness.apart, *fineness[3:])
    known = [formulas_at(pair, one) for one in strengths]
    ends = np.array([one["range"][1] for one in known])
    # of two neighbours the stronger one ends at fewer d_Y: their blend reaches as far as the other
    reach = np.maximum(ends, np.append(0.0, ends[:-1]))
    laws = [law_array(one, end, fineness) for one, end in zip(known, reach.tolist(), strict=True)]
    if strengths[-1] < most:  # nothing yields at higher strengths
        elastic = formulas_at(pair, most)
        strengths, known = [*strengths, strengths[-1], most], [*known, elastic, elastic]
        laws += 2 * [law_array(elastic, elastic["range"][1], fineness)]
    begins = np.cumsum([1 + len(strengths) * force.RUNG, *(one.size for one in laws)])
    rows: list[float] = []
    for strength, begin, data, one in zip(strengths, begins, laws, known, strict=False):
        scales = one["scale"] / law.scale, (one["onset"] or one["scale"]) / law.scale
        rows += [strength, begin, data.size, *map(math.log, scales), one["range"][1]]
    return np.concatenate([[-len(strengths)], rows, *laws])


def law_array(formulas: dict[str, Any], end: float, fineness: Fineness = USUAL) -> Array:
    """Law of `formulas_at`, as kernels take it, which follows them up to a compression [d_Y]."""
    pieces = Resolution(*fineness[:2])
    return packed(*expanded(formulas["name"], formulas["loading"], formulas["unloading"], end, pieces))


def without_curves(pair: Pair, law: Law, log_factor: float = 0.0) -> Law:
    """Law of a pair that is stronger by a factor, but for its array, which is that of `law`."""
    known = formulas_at(pair, log_factor)
    names = ("scale", "onset", "range", "yield_coefficient")
    return dataclasses.replace(law, **{name: known[name] for name in names})


def formulas_at(pair: Pair, log_factor: float) -> dict[str, Any]:
    """Formulas of the law of a pair that is stronger by a factor."""
    return fem.formulas(_given(pair, log_factor), fem.fitted())


def _given(pair: Pair, log_factor: float) -> fem.Given:
    """Numbers of the law at a factor: only the strengths change, and hardening is relative to them."""
    slow, flow = _slow(pair), rate.leading(pair)
    at = rate.rate_at(flow, math.exp(log_factor)) if flow else 0.0
    factors = [body.flow.factor(at) if body.flow else 1.0 for body in pair.bodies]
    return slow._replace(sphere_ratio=slow.sphere_ratio / factors[0], plate_ratio=slow.plate_ratio / factors[1])


@functools.lru_cache(maxsize=4)
def _slow(pair: Pair) -> fem.Given:
    return fem.Given(**pair_numbers(pair, "fem"))


@functools.lru_cache(maxsize=4)
def knots(
    pair: Pair, widest: float, fastest: float, near: float = 5e-3, slowest: float = 0.0
) -> tuple[list[float], float]:
    """Find the ends of the pieces in ln k, in which the law is a smooth function of k.

    It is not where the bodies' strengths are alike, where the stronger one begins to yield, where a
    formula of the law's has a corner, and where the second of two strengths begins to grow. Pieces
    are narrower where one strength grows faster than k, and is no straight line in ln k, and where
    two that share the flow grow apart. The last number is ln k of the fastest impacts; the pieces
    end before it where nothing yields any more, and there are none if that is so in the slowest.
    """
    flow = rate.leading(pair)
    assert flow is not None
    least, most = (math.log(rate.largest_factor(flow, one)) for one in (slowest, fastest))
    most = last = max(most, least + _NARROWEST)
    if not _yields(pair, last):  # up to where does one?
        last = bisect(lambda one: _yields(pair, one), least, last)
    logs = np.linspace(least, last, 2 + int((last - least) / _TRIED))
    inner: list[float] = []
    values = np.array([_corners(pair, one) for one in logs])
    for n, k in np.argwhere(values[:-1] * values[1:] < 0.0):
        before = functools.partial(_same_sign, pair, k, values[n, k])
        inner.append(bisect(before, logs[n], logs[n + 1]))
    flows = rate.flows(pair)
    starts = {round(math.log(flow.factor(one.rate0)), 9) for one in flows}
    ends = [least, last, *(one for one in starts if least + _CLOSE < one < last - _CLOSE)]
    for one in sorted(inner):
        if min(abs(one - end) for end in ends) > near:
            ends.append(one)
    rates = [rate.rate_at(flow, math.exp(one)) for one in logs]
    grown = np.log([[one.strength * one.factor(at) for one in flows] for at in rates])
    steps = np.diff(grown, axis=0)
    step = logs[1] - logs[0]
    width = np.maximum(step, 2.0 * steps.max(axis=1) - step)
    both = np.ptp(grown[1:], axis=1) < -math.log(ALONE)  # how they share the flow changes
    run = np.append(0.0, np.cumsum(width + 0.5 * both * np.ptp(steps, axis=1)))
    found = [least]
    for low, high in itertools.pairwise(sorted({*ends})):
        first, final = np.interp((low, high), logs, run)
        inside = np.linspace(first, final, math.ceil((final - first) / widest) + 1)[1:-1]
        found += [*np.interp(inside, run, logs).tolist(), high]
    return found, most


def _yields(pair: Pair, log_factor: float) -> bool:
    return formulas_at(pair, log_factor)["yield_coefficient"] is not None


def _same_sign(pair: Pair, k: int, value: float, log_factor: float) -> bool:
    return _corners(pair, log_factor)[k] * value > 0.0


def _corners(pair: Pair, log_factor: float) -> list[float]:
    """Numbers that change their signs at corners of the law."""
    given = fem.flowing(_given(pair, log_factor), fem.fitted())
    found = [fem.RelativeStrength(given, fem.fitted()).corner] if given.hardens else []
    for one in fem.comparable(given):
        found += [math.log(one.ratio / at) for at in (*RATIOS, *_DEEPEST)]
        if min(one[:2]) > 0.0:
            found += [math.log(one[0] / one[1] / z) for z in (ALONE, 1.0, 1.0 / ALONE)]
    return found
