"""The direct solve and the table's build."""

from __future__ import annotations

import dataclasses
import functools
import importlib
import math
import os
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import contactlaw as cl
from contactlaw import laws, table
from contactlaw.equation import outcome, zener
from contactlaw.laws import jackson_green, stronge
from contactlaw.table import file
from validation.bench.row import Row, seconds

N = 20_000
_SOLVED = 2000
RTOL = 1e-8


def rows() -> Iterator[Row]:
    """Measure solver and table."""
    rng = np.random.default_rng(1)
    lam = rng.uniform(0.0, 1.0, N)
    y = (5 / 4) ** 0.4 * rng.uniform(0.1, 4.0, N) ** -0.8
    law = laws.law("myc").data

    def solve(part: slice) -> None:
        status, _ = zener.solve_all(law, RTOL, outcome.at(lam[part], y[part]))
        assert status == zener.OK

    one_core = seconds(lambda: solve(slice(None))) / N
    peer = scipy_solve(lam[:50], y[:50])
    yield Row(
        "direct solve at 1e-8, one core", one_core * 1e6, "us", 5, "solve_ivp(DOP853)",
        peer / one_core, 500, "lambda 0 to 1, v 0.1 to 4; with w_m where d_P is passed",
    )  # fmt: skip
    cores = os.cpu_count() or 1
    parts = [slice(k, None, cores) for k in range(cores)]
    with ThreadPoolExecutor(cores) as pool:
        together = seconds(lambda: list(pool.map(solve, parts))) / N
    yield Row(
        f"direct solve, batch over {cores} cores", together * 1e6, "us", None, "one core",
        one_core / together,
    )  # fmt: skip
    yield from by_model()
    # jackson_green.law is cached: call what it wraps. stronge is made at import, and takes longest.
    one = seconds(lambda: jackson_green.law.__wrapped__(23.1922, 0.21))
    longest = seconds(lambda: importlib.reload(stronge))
    yield Row(
        "a law made from its formulas", longest * 1e3, "ms", 10,
        note=f"stronge, whose cap is found by bisection; jackson_green {one * 1e3:.1f} ms",
    )  # fmt: skip
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
    given = rng.uniform(0.3, 10.0, _SOLVED), 1e-3, 1e-3 / rng.uniform(0.1, 2.0, _SOLVED)
    listed = (("myc", metal, None), ("fem", metal, 0.5), ("fem, a rate", rated, 1 / 3))
    for what, body, most in listed:
        law = what.partition(",")[0]
        model = cl.ImpactModel(cl.Pair(body, "glass"), law)
        took = seconds(functools.partial(model.solve, *given)) / _SOLVED
        row = Row(f"solve, {what}", took * 1e6, "us")
        if most:
            row.peer, row.ratio, row.least_ratio = "the row above", last / took, most
        yield row
        last = took


def scipy_solve(lam: np.ndarray, y: np.ndarray) -> float:
    """Time of one elastic impact with solve_ivp at the same tolerance: a lower bound for MYC."""

    def impact(a: float) -> object:
        def rates(t: float, s: np.ndarray) -> list[float]:
            f = max(s[0], 0.0) ** 1.5
            return [s[1] - a * f, -f]

        def parted(t: float, s: np.ndarray) -> float:
            return float(s[0]) if t > 0 else 1.0

        parted.terminal, parted.direction = True, -1  # type: ignore[attr-defined]
        return solve_ivp(rates, [0, 1000], [0, 1], "DOP853", rtol=RTOL, atol=RTOL, events=parted)

    return seconds(lambda: [impact(a) for a in lam], 2) / lam.size
