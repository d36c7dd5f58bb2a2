"""Random impacts by integration: each of them ends, with finite numbers.

Half are by the law fem, of random pairs as in `pairs`, half by the law myc, where the bead yields;
speeds span nine decades, R/H goes to 5.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator

import numpy as np
from hypothesis import strategies as st

import contactlaw as cl
from contactlaw.answers.backend import UnsolvedError
from contactlaw.answers.solver import RTOL, solved
from contactlaw.equation.numbers import Impact, Numbers
from contactlaw.laws import Law
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.law import law_of
from validation.hostile import SEEDS, log, pairs, simplest

FULL = 10_000_000

_BATCH = 10_000  # impacts per pair
_THINNEST = 30.0  # lambda; beyond, an impact takes thousands of time steps


@st.composite
def cases(draw: st.DrawFn) -> tuple[cl.Pair, Law, int]:
    """Draw a pair, one of two laws of it, and a seed of its impacts."""
    pair = draw(pairs.cases()).pair
    if draw(st.booleans()):
        return pair, law_of(pair, "fem"), draw(SEEDS)
    strength = 0.5 * pair.sphere.youngs_modulus / draw(log(1e1, 1e4))
    pair = cl.Pair(dataclasses.replace(pair.sphere, yield_strength=strength), pair.plate)
    return pair, law_of(pair, "myc"), draw(SEEDS)


def faults(count: int, seed: int) -> Iterator[str]:
    """Integrate random impacts; yield a sentence for each that fails."""
    each = min(count, _BATCH)

    def check(case: tuple[cl.Pair, Law, int]) -> Iterator[str]:
        pair, law, own = case
        return _unsolved(np.random.default_rng(own), pair, law, each)

    return simplest(cases(), check, -(-count // each), seed)


def _unsolved(generator: np.random.Generator, pair: cl.Pair, law: Law, count: int) -> Iterator[str]:
    """Integrate random impacts of one pair."""
    speed = np.exp(generator.uniform(math.log(1e-6), math.log(1e3), count))
    radius = np.full(count, 1e-3)
    thickness = radius / np.exp(generator.uniform(math.log(1e-3), math.log(5.0), count))
    units = SphereOnPlate(pair, law).numbers(Impact(speed, radius, thickness))
    known = units.inelasticity < _THINNEST
    units = Numbers(*(values[known] for values in units))
    while units.time.size:
        try:
            found = solved(law.data, units.inelasticity, units.yield_ratio, RTOL)
        except UnsolvedError as error:
            yield f"{error}: {pair.sphere!r}, {pair.plate!r}, law {law.name}"
            units = Numbers(*(np.delete(values, error.impact) for values in units))
            continue
        wrong = ~((found.restitution >= 0.0) & (found.restitution <= 1.0))
        wrong |= ~(np.isfinite(found.contact_time) & np.isfinite(found.compression_ratio))
        for n in np.flatnonzero(wrong):
            yield f"lambda {units.inelasticity[n]:.17g}, y {units.yield_ratio[n]:.17g}: no numbers"
        return
