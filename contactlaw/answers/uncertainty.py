"""How far a real impact may be from the answer, and which number makes it uncertain.

Each number that has an error is changed alone, by one standard error up and down. The logarithm of
an answer is a line on each side, and the changes of all numbers add up at random errors, which need
no integration. They do not add up in two cases. Where a body may or may not begin to yield, what
flow changes is a function of the overload, found by changing the strengths; the changes of the
overload add up. Which body yields depends on the strengths of both: these are also changed together.
"""

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from contactlaw._arrays import Array
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
_QUANTILES = 0.15865525, 0.84134475  # those of a normal deviate of -1 and 1
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
    from scipy.special import ndtri

    causes = causes_of(variants.pair, sizes)

    def logs(*moved: tuple[tuple[Number, ...], float]) -> Array:
        """Logarithms of the answers with some numbers multiplied by exp(size)."""
        factors = {one: math.exp(size) for numbers, size in moved for one in numbers}
        answers = variants.answers(impacts, factors)
        return np.log(np.maximum([getattr(answers, name) for name in _FIELDS], 1e-300))

    # of normal deviates each number has a permutation of the same quantiles; the last are those of the law
    shares = np.tile((np.arange(_DRAWS) + 0.5) / _DRAWS, (len(causes) + 1, 1))
    *deviates, by_chance = ndtri(np.random.default_rng(0).permuted(shares, axis=1))
    base, ends = logs(), [(numbers, z * error) for numbers, error in causes.values() for z in _ENDS]
    states = [logs(end) for end in ends]
    weights = np.reshape([np.maximum(z * deviate, 0.0) for deviate in deviates for z in _ENDS], (-1, _DRAWS))
    strengths = [n for n, (numbers, _) in enumerate(ends) if numbers[0][1] in _STRENGTHS]
    if len(strengths) == 4:
        states += [logs(ends[n], ends[m]) for n in strengths[:2] for m in strengths[2:]]
        a, b = np.split(weights[strengths], 2)
        weights[strengths] *= 1.0 - np.repeat([b.sum(axis=0), a.sum(axis=0)], 2, axis=0)
        weights = np.vstack([weights, *(one * b for one in a)])
    changes = np.reshape(states, (len(states), *base.shape)) - base
    each = changes[: len(ends)].reshape(len(causes), 2, *base.shape)
    probes = _PROBES if causes and variants.law.yields else (0.0,)
    flow = np.array([logs((_FLOW, z)) for z in probes]) - base
    hit = variants.answers(impacts, {})
    errors = law_errors(variants.law, variants.pair, hit, impacts.radius / impacts.thickness)
    bands = []
    for n, value in enumerate(np.exp(base[:3])):
        most = 1.0 if n == 0 else math.inf  # of a COR
        reached = np.minimum(value * np.exp(each[:, :, n]), most)
        widths = 0.5 * (np.maximum(reached.max(axis=1), value) - np.minimum(reached.min(axis=1), value))
        by_law = np.full_like(value, math.inf) if errors is None else errors[n]
        low, high = -by_law, by_law.copy()
        for i in range(value.size if errors is not None else 0):
            by_flow = functools.partial(np.interp, xp=flow[:, 3, i], fp=flow[:, n, i])
            overload = changes[:, 3, i]
            moved = (changes[:, n, i] - by_flow(overload)) @ weights + by_flow(overload @ weights)
            drawn = np.minimum(value[i] * np.exp(moved), most) + by_law[i] * by_chance
            low[i], high[i] = np.quantile(np.clip(drawn, 0.0, most), _QUANTILES)
        signs = np.sign(each[:, 1, n] - each[:, 0, n])
        low, high, *columns = (shaped(one, impacts.shape) for one in (low, high, *widths, by_law, *signs))
        words, ups = [*causes, "model"], columns[len(causes) + 1 :]
        bands.append(Band(low, high, dict(zip(words, columns, strict=False)), dict(zip(causes, ups, strict=True))))
    return Uncertainty(*bands)
