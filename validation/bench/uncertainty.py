"""How far a real impact may be from the answer, beside pairs drawn at random."""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Iterator

import numpy as np

import contactlaw as cl
from validation.bench.row import Row, seconds

DRAWS = 2000
IMPACT = 3.0, 1e-3, 5e-3  # [m/s, m, m]
_ERRORS = {"yield_strength": 0.2, "youngs_modulus": 0.03, "density": 0.02}


def rows() -> Iterator[Row]:
    """Measure a range of a warm model, and compare it with that of random pairs."""
    pair = cl.Pair(
        *(
            dataclasses.replace(cl.material(name), uncertainty=_ERRORS)
            for name in ("stainless-steel-304", "aluminium-6061-t6")
        )
    )
    model = cl.ImpactModel(pair)
    cl.ImpactModel(cl.Pair("glass", "glass")).uncertainty(*IMPACT)  # compiles the integrator
    start = time.perf_counter()
    found = model.uncertainty(*IMPACT).restitution
    first = time.perf_counter() - start
    one = seconds(lambda: model.uncertainty(*IMPACT))
    start = time.perf_counter()
    low, high = ends = quantiles(model, float(np.asarray(found.causes["model"])))
    peer = time.perf_counter() - start
    ours = [float(np.asarray(end)) for end in (found.low, found.high)]
    off = np.abs(np.subtract(ours, ends)).max() / (0.5 * (high - low))
    yield Row(
        "range of real impacts, 6 errors", one * 1e3, "ms", 10, f"{DRAWS} random pairs", peer / one,
        note=f"ends within {off:.1%} of half the width; the first {first:.2f} s",
    )  # fmt: skip


def quantiles(model: cl.ImpactModel, by_law: float) -> tuple[float, float]:
    """Quantiles of 16 and 84 % of the COR of random pairs, with the law's error beside them."""
    rng = np.random.default_rng(0)
    cor = []
    for _ in range(DRAWS):
        bodies = (
            dataclasses.replace(
                body,
                **{
                    name: getattr(body, name) * math.exp(error * rng.standard_normal())
                    for name, error in body.uncertainty.items()
                },
            )
            for body in (model.pair.sphere, model.pair.plate)
        )
        cor.append(float(cl.ImpactModel(cl.Pair(*bodies)).solve(*IMPACT).restitution))
    low, high = np.quantile(np.add(cor, by_law * rng.standard_normal(DRAWS)), [0.1587, 0.8413])
    return float(low), float(high)
