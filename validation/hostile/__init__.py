"""Campaigns of random inputs that try to make contactlaw crash, or answer wrongly with confidence.

``python -m validation.hostile [NAME ...] [--count N]``. A campaign is a file of this folder. It has

    FULL                     how many cases the whole campaign tries
    faults(count, seed)      try that many; yield one sentence per fault found, with all its inputs

The tests run a coarse part of each campaign; none may find a fault.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

from hypothesis import HealthCheck, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st

Case = TypeVar("Case")

SEEDS = st.integers(0, 2**32 - 1)  # of the many impacts of a case


def log(low: float, high: float) -> st.SearchStrategy[float]:
    """Draw numbers that are even in their logarithm."""
    return st.floats(math.log(low), math.log(high)).map(math.exp)


def simplest(
    cases: st.SearchStrategy[Case], check: Callable[[Case], Iterable[str]], count: int, seed: int
) -> Iterator[str]:
    """Try cases until one has faults; yield those of the simplest such case that there is."""
    found: list[str] = []

    @seeded(seed)
    @settings(
        max_examples=count,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        report_multiple_bugs=False,
    )
    @given(cases)
    def attempt(case: Case) -> None:
        found[:] = check(case)
        assert not found

    try:
        attempt()
    except AssertionError:  # hypothesis has tried the simplest one last
        yield from found
