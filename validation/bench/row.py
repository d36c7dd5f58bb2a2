"""A row of the benchmark's output, and how times are taken."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass
class Row:
    """One target: what was measured, in which unit, and what it is compared with."""

    name: str
    measured: float
    unit: str
    target: float | None = None
    peer: str = ""
    ratio: float | None = None  # peer's time over ours
    least_ratio: float | None = None
    note: str = ""

    @property
    def met(self) -> bool:
        """Whether target and ratio, where there are any, hold."""
        fast = self.target is None or self.measured <= self.target
        return fast and (self.least_ratio is None or (self.ratio or 0.0) >= self.least_ratio)


def seconds(function: Callable[[], object], repeat: int = 7) -> float:
    """Least time of some calls after a first one, which may compile [s]."""
    function()
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def per_call(function: Callable[[], object], calls: int = 20_000) -> float:
    """Time of one of many calls from a Python loop, the loop included [s]."""

    def loop() -> None:
        for _ in range(calls):
            function()

    return seconds(loop, repeat=5) / calls
