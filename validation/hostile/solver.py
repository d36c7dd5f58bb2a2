"""Random impacts by integration: each of them ends, with finite numbers.

Half are by the law fem, of random pairs as in `pairs`, half by the law myc, where the bead yields;
speeds span nine decades, R/H goes to 5.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator

import numpy as np

import contactlaw as cl
from contactlaw.answers.backend import UnsolvedError
from contactlaw.answers.solver import RTOL, solved
from contactlaw.equation.numbers import Impact, Numbers
from contactlaw.laws import Law
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.law import law_of
from validation.hostile.pairs import draw

FULL = 10_000_000

_BATCH = 10_000  # impacts per pair
_THINNEST = 30.0  # lambda; beyond, an impact takes thousands of time steps


def faults(count: int, seed: int) -> Iterator[str]:
    """Integrate random impacts; yield a sentence for each that fails."""
    generator = np.random.default_rng(seed)
    for start in range(0, count, _BATCH):
        pair, _, _ = draw(generator)
        law = law_of(pair, "fem")
        if start // _BATCH % 2:
            weak = dataclasses.replace(
                pair.sphere,
                yield_strength=0.5 * pair.sphere.youngs_modulus / 10.0 ** generator.uniform(1, 4),
            )
            pair = cl.Pair(weak, pair.plate)
            law = law_of(pair, "myc")
        yield from _unsolved(generator, pair, law, min(_BATCH, count - start))


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
