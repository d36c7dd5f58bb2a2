"""The direct solve, force histories, ranges of real impacts, and the table's build.

`solve` of fem was to take at most twice the time of myc, and takes 2.6 times; it took 5 times with
the five or six integrations that it once made for an impact, and makes one now.
"""

from __future__ import annotations

import dataclasses
import functools
import math
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import contactlaw as cl
from contactlaw import laws, table
from contactlaw.equation import outcome, zener
from contactlaw.table import file
from validation.bench.row import Row, seconds

N, SAMPLES = 2000, 256
RTOL = 1e-8
_ERRORS = {"yield_strength": 0.2, "youngs_modulus": 0.03, "density": 0.02}


def rows() -> Iterator[Row]:
    """Measure solver and table."""
    rng = np.random.default_rng(1)
    lam = rng.uniform(0.0, 1.0, N)
    y = (5 / 4) ** 0.4 * rng.uniform(0.1, 4.0, N) ** -0.8
    law = laws.law("myc").data

    def solve() -> None:
        status, _ = zener.solve_all(law, RTOL, outcome.at(lam, y))
        assert status == zener.OK

    one = seconds(solve) / N
    peer = seconds(lambda: [by_scipy(a) for a in lam[:50]], 2) / 50
    yield Row(
        "direct solve at 1e-8, one core",
        one * 1e6,
        "us",
        5,
        "solve_ivp(DOP853)",
        peer / one,
        500,
        "lambda 0 to 1, v 0.1 to 4; the peer's impacts are elastic",
    )
    yield from by_model()
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    hits = rng.uniform(0.5, 30.0, N), rng.uniform(0.3e-3, 1e-3, N), rng.uniform(0.5e-3, 3e-3, N)
    history = seconds(lambda: model.force_history(*hits, SAMPLES)) / N
    peer = seconds(lambda: by_scipy(0.3, np.linspace(0.0, 3.0, SAMPLES)), 5)
    yield Row("force history, 256 samples, table", history * 1e6, "us", 10, "solve_ivp(DOP853)", peer / history)
    steel, aluminium = map(cl.material, ("stainless-steel-304", "aluminium-6061-t6"))
    pair = cl.Pair(*(dataclasses.replace(one, uncertainty=_ERRORS) for one in (steel, aluminium)))
    real = cl.ImpactModel(pair)
    took = seconds(lambda: real.uncertainty(3.0, 1e-3, 5e-3))
    yield Row("range of real impacts, 6 errors", took * 1e3, "ms", 10)
    start = time.perf_counter()
    table.build(laws.law("myc"))
    yield Row("table build and certificate", time.perf_counter() - start, "s", 10)
    path = Path(cl.__file__).parent / "data" / "myc.h5"
    loading = seconds(lambda: file.read(path).packed)
    yield Row("table: read, verify, fit splines", loading * 1e3, "ms", 10)
    yield Row("table: size", path.stat().st_size / 1e6, "MB", 2)


def by_model() -> Iterator[Row]:
    """Time of `ImpactModel.solve` by a law of the paper, by `fem`, and for a pair with a rate."""
    metal = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal")
    rated = dataclasses.replace(metal, rate=(0.025, 1.0))
    rng, last = np.random.default_rng(2), math.nan
    given = rng.uniform(0.3, 10.0, N), 1e-3, 1e-3 / rng.uniform(0.1, 2.0, N)
    listed = (("myc", metal, None), ("fem", metal, 0.5), ("fem, a rate", rated, 1 / 3))
    for what, body, least in listed:
        model = cl.ImpactModel(cl.Pair(body, "glass"), what.partition(",")[0])
        took = seconds(functools.partial(model.solve, *given)) / N
        ratio = last / took if least else None
        yield Row(f"solve, {what}", took * 1e6, "us", None, "the row above", ratio, least)
        last = took


def by_scipy(lam: float, samples: np.ndarray | None = None) -> object:
    """Integrate one elastic impact with solve_ivp at the same tolerance: a lower bound for MYC."""

    def rates(t: float, s: np.ndarray) -> list[float]:
        f = max(s[0], 0.0) ** 1.5
        return [s[1] - lam * f, -f]

    def parted(t: float, s: np.ndarray) -> float:
        return float(s[0]) if t > 0 else 1.0

    parted.terminal, parted.direction = True, -1  # type: ignore[attr-defined]
    end = 1000.0 if samples is None else samples[-1]
    return solve_ivp(rates, [0, end], [0, 1], "DOP853", samples, rtol=RTOL, atol=RTOL, events=parted)
