"""Force histories: from the table, by integration, and by scipy."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.integrate import solve_ivp

import contactlaw as cl
from validation.bench.row import Row, seconds

N, SAMPLES = 2000, 256


def rows() -> Iterator[Row]:
    """Measure whole histories, in batches."""
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    rng = np.random.default_rng(2)
    impacts = rng.uniform(0.5, 30.0, N), rng.uniform(0.3e-3, 1e-3, N), rng.uniform(0.5e-3, 3e-3, N)
    table = seconds(lambda: model.force_history(*impacts, SAMPLES)) / N
    speed, radius, thickness = (values[:100] for values in impacts)
    solve = (
        seconds(lambda: model.force_history(speed, radius, thickness, SAMPLES, "solve"), 3)
        / speed.size
    )
    peer = scipy_history()
    yield Row(
        "force history, 256 samples, table", table * 1e6, "us", 10, "solve_ivp(DOP853)",
        peer / table, note="time, force, compression, impulse, displacement of the plate",
    )  # fmt: skip
    yield Row(
        "the same by integration", solve * 1e6, "us", None, "solve_ivp(DOP853)", peer / solve,
        note="each sample landed on to 1e-9",
    )  # fmt: skip


def scipy_history() -> float:
    """Time of one elastic contact with solve_ivp to 1e-8: a lower bound for MYC."""
    time = np.linspace(0.0, 3.0, SAMPLES)  # the contact lasts 3.2, longer than the samples

    def rates(t: float, s: np.ndarray) -> list[float]:
        f = max(s[0], 0.0) ** 1.5
        return [s[1] - 0.3 * f, -f]

    return seconds(
        lambda: solve_ivp(rates, [0, 3], [0, 1], "DOP853", time, rtol=1e-8, atol=1e-8), 5
    )
