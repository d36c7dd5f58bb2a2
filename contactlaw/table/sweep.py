"""The solver at many points, on all cores."""

import os
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from contactlaw._arrays import Array
from contactlaw.equation import outcome, zener
from contactlaw.equation.outcome import Outcome
from contactlaw.laws import Law
from contactlaw.table.grid import Grid

_T = TypeVar("_T")
_PART = 250  # points that a thread solves at a time


def solve(law: Law, out: Outcome, rtol: float, values: Callable[[Outcome], _T]) -> list[_T]:
    """Solve impacts at many points; return what follows from each part of them.

    A bar appears on a terminal once it has taken a second.

    Raises
    ------
    RuntimeError
        If one does not solve; the message names it.
    """
    from tqdm.contrib.concurrent import thread_map

    def of_part(first: int) -> _T:
        part = outcome.part(out, slice(first, first + _PART))
        status, n = zener.solve_all(law.at_any_strength, rtol, part)
        if status != zener.OK:
            raise RuntimeError(
                f"table for law {law.name!r}: the node lambda = {part.inelasticity[n]:.6g}, d_Y/(V0 T_H) = "
                f"{part.yield_ratio[n]:.6g} did not solve: {zener.MESSAGES[status]}"
            )
        return values(part)

    parts = range(0, out.strength.size, _PART)
    solved: list[_T] = thread_map(
        of_part, parts, max_workers=os.cpu_count(), desc="contactlaw: solving", delay=1, disable=None
    )
    return solved


def at_nodes(law: Law, grid: Grid, rtol: float, values: Callable[[Outcome], Array]) -> Array:
    """Solve impacts at all nodes of a grid, and pack splines of the values that follow from them (impacts, fields)."""
    out = outcome.at(*(one.ravel() for one in grid.nodes()))
    return grid.packed(np.concatenate(solve(law, out, rtol, values)))
