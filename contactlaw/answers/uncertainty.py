"""How far a real impact may be from the answer, and which number makes it uncertain.

Each number that has an error is changed alone, by one standard error up and down. The logarithm of
an answer is a line on each side, and the changes of all numbers add up at random errors, which need
no integration. They do not add up in two cases. Where a body may or may not begin to yield, what
flow changes is a function of the overload, found by changing the strengths; the changes of the
overload add up. Which body yields depends on the strengths of both: these are also changed together.
"""

import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.answers.derivatives import Number, Variants
from contactlaw.answers.law_errors import law_errors
from contactlaw.physical.arguments import number, shaped, within
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.pair import Pair

_FIELDS = "restitution", "contact_time", "peak_force", "overload"
_BODIES = {("sphere",): "the bead", ("plate",): "the plate", ("sphere", "plate"): "both bodies"}
_STRENGTHS = "yield_strength", "hardness"
_FLOW: tuple[Number, ...] = ("sphere", "flow_stress"), ("plate", "flow_stress")
# Logarithms of factors on both strengths, in the order in which the overload rises.
_PROBES = 1.2, 0.6, 0.4, 0.2, 0.1, 0.05, 0.0, -0.05, -0.1, -0.2, -0.4, -0.6, -0.9, -1.2
_ENDS = -1.0, 1.0  # changes, in standard errors
_DRAWS = 2048
_QUANTILES = NormalDist().cdf(-1.0), NormalDist().cdf(1.0)  # 16 and 84 %
_LEAST = 1e-12  # of an answer: the lower end of a range that would reach below zero
Cause = tuple[tuple[Number, ...], float]  # numbers that err alike, and their relative standard error


@dataclass(frozen=True, eq=False)
class Band:
    """Range of one answer, in its unit: floats, or arrays of the shape of the impacts.

    Attributes
    ----------
    low, high
        Quantiles of 16 and 84 %: of three real impacts two are between them. They are -inf and
        inf for a law of your own, whose errors are not known.
    causes : dict of str to float or ndarray
        Half the width of the band that each cause alone makes: ``"yield strength of the bead"``,
        ``"thickness"``, ..., and ``"model"``, the law beside finite elements, which is inf for a
        law of your own.
    signs : dict of str to float or ndarray
        1 where more of a number raises the answer, -1 where it lowers it; without ``"model"``.
    """

    low: float | Array
    high: float | Array
    causes: dict[str, float | Array]
    signs: dict[str, float | Array]


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Ranges of the COR [-], the contact time [s] and the peak force [N] of impacts."""

    restitution: Band
    contact_time: Band
    peak_force: Band


def causes_of(pair: Pair, sizes: Mapping[str, float]) -> dict[str, Cause]:
    """Numbers that have an error, by the words for it; sizes have their relative standard errors."""
    causes: dict[str, Cause] = {}
    alike = pair.given[0] == pair.given[1]
    for roles, body in zip([("sphere", "plate")] if alike else [("sphere",), ("plate",)], pair.given, strict=False):
        for name, error in body.uncertainty.items():
            words = name.replace("youngs", "Young's").replace("poissons", "Poisson's").replace("_", " ")
            causes[f"{words} of {_BODIES[roles]}"] = tuple((role, name) for role in roles), error
    for name, error in sizes.items():
        known = number(f"{name}_error", error)
        remark = "(a relative standard error: 0.05 for 5 %)"
        within(f"{name}_error", np.array([known]), 0.0, 1.0, remark)
        causes[name] = (("impact", name),), known
    return {words: cause for words, cause in causes.items() if cause[1]}


def uncertainty(variants: Variants, impacts: Impacts, sizes: Mapping[str, float]) -> Uncertainty:
    """Bands of the answers of impacts by the errors of materials and sizes, and by the law."""
    causes = causes_of(variants.pair, sizes)
    hit = variants.answers(impacts, {})

    def logs(*moved: tuple[Cause, float]) -> Array:
        factors = {one: math.exp(z * error) for (numbers, error), z in moved for one in numbers}
        try:
            answers = variants.answers(impacts, factors)
        except ArgumentError as error:
            ((((_, name), *_), size), z), *_ = moved
            reason = f"{name} is too large, for {math.exp(z * size):.3g} times the value: {error}"
            raise ArgumentError("uncertainty", size, reason) from None
        return np.log(np.maximum([getattr(answers, name) for name in _FIELDS], 1e-300))

    base, known = logs(), list(causes.values())
    each = np.reshape([[logs((one, z)) for z in _ENDS] for one in known], (len(known), 2, *base.shape)) - base
    strengths = [n for n, (numbers, _) in enumerate(known) if numbers[0][1] in _STRENGTHS]
    both = None
    if len(strengths) == 2:
        first, second = (known[n] for n in strengths)
        both = np.array([[logs((first, a), (second, b)) for b in _ENDS] for a in _ENDS]) - base
    probes = _PROBES if causes and variants.law.yields else (0.0,)
    flow = np.array([logs(((_FLOW, 1.0), z)) for z in probes]) - base
    errors = law_errors(variants.law, variants.pair, hit, impacts.radius / impacts.thickness)
    bands = []
    for n, value in enumerate(np.exp(base[:3])):
        most = 1.0 if n == 0 else math.inf  # of a COR
        ends = np.minimum(value * np.exp(each[:, :, n]), most)
        widths = 0.5 * (np.maximum(ends.max(axis=1), value) - np.minimum(ends.min(axis=1), value))
        by_law = np.full_like(value, math.inf) if errors is None else errors[n]
        low, high = -by_law, by_law.copy()
        for i in range(value.size if errors is not None else 0):
            some = (..., [n, 3], i)
            moved = _moved(each[some], None if both is None else both[some], strengths, flow[some])
            drawn = np.minimum(value[i] * np.exp(moved), most) + by_law[i] * _deviates(len(each) + 1)[-1]
            low[i], high[i] = np.quantile(np.clip(drawn, _LEAST * value[i], most), _QUANTILES)
        signs = np.sign(each[:, 1, n] - each[:, 0, n])
        low, high, *columns = (shaped(one, impacts.shape) for one in (low, high, *widths, by_law, *signs))
        words = [*causes, "model"]
        parts = dict(zip(words, columns, strict=False)), dict(zip(causes, columns[len(words) :], strict=True))
        bands.append(Band(low, high, *parts))
    return Uncertainty(*bands)


def _moved(each: Array, both: Array | None, strengths: list[int], flow: Array) -> Array:
    """Add up changes of the logarithm of one answer at random errors.

    On the last axis changes have the logarithm of the answer and that of the overload.
    """
    weights = np.maximum(np.multiply.outer(_deviates(len(each) + 1)[:-1], _ENDS), 0.0)

    def by_flow(changed: Array) -> Array:
        return np.interp(changed, flow[:, 1], flow[:, 0])

    def summed(each: Array, both: Array | None) -> Array:
        total = np.einsum("ndz,nz->d", weights, each)
        if both is not None:
            (a, b), (x, y) = weights[strengths], each[strengths]
            total += np.einsum("dy,dz,yz->d", a, b, both - np.add.outer(x, y))
        return np.asarray(total)

    def of(pick: Callable[[Array], Array]) -> Array:
        return summed(pick(each), None if both is None else pick(both))

    overload = of(lambda one: one[..., 1])
    return of(lambda one: one[..., 0] - by_flow(one[..., 1])) + by_flow(overload)


@functools.lru_cache(maxsize=16)
def _deviates(count: int) -> Array:
    """Draw normal deviates (count, draws): for each number a permutation of the same quantiles."""
    known = [NormalDist().inv_cdf((n + 0.5) / _DRAWS) for n in range(_DRAWS)]
    return np.random.default_rng(0).permuted(np.tile(known, (count, 1)), axis=1)
