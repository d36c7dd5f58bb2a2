"""Bisection of a condition over many numbers at once."""

from collections.abc import Callable
from typing import Any

import numpy as np


def bisect(above: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Find where a condition ends that holds at `low` and not at `high`; numbers or arrays."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        holds = above(middle)
        if np.ndim(holds):
            low, high = np.where(holds, middle, low), np.where(holds, high, middle)
        else:  # ten times as fast
            low, high = (middle, high) if holds else (low, middle)
    return low
