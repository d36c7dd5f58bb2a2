"""The solver at many points, on all cores."""

import itertools
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

import numpy as np

from contactlaw._arrays import Array
from contactlaw.equation import outcome, zener
from contactlaw.equation.outcome import Outcome
from contactlaw.laws import Law
from contactlaw.table.grid import Grid

_T = TypeVar("_T")
_PART = 250  # points that a thread solves at a time


def in_parts(function: Callable[[slice], _T], count: int) -> Sequence[_T]:
    """Apply a function that releases the GIL to slices of `count` points, on all cores.

    A bar appears on a terminal once it has taken a second.
    """
    from tqdm import tqdm

    slices = [slice(low, min(low + _PART, count)) for low in range(0, count, _PART)]
    pool = ThreadPoolExecutor(os.cpu_count())
    try:
        # compile the function once, before the threads call it
        found = itertools.chain([function(slices[0])], pool.map(function, slices[1:]))
        return list(tqdm(found, "contactlaw: solving", len(slices), delay=1, disable=None))
    finally:  # on Ctrl-C, wait for the parts that run and start no others
        pool.shutdown(cancel_futures=True)


def solved(law: Law, lam: Array, y: Array, strength: Array, rtol: float) -> Outcome:
    """Solve impacts at many points.

    Raises
    ------
    RuntimeError
        If one does not solve; the message names it.
    """
    out = outcome.at(lam, y, strength)
    in_parts(lambda part: _solve(law, rtol, outcome.part(out, part)), lam.size)
    return out


def at_nodes(law: Law, grid: Grid, rtol: float, values: Callable[[Outcome], Array]) -> Array:
    """Solve impacts at all nodes of a grid, and pack splines of the values that follow from them (impacts, fields)."""
    out = outcome.at(*(one.ravel() for one in grid.nodes()))

    def solve(part: slice) -> Array:
        _solve(law, rtol, outcome.part(out, part))
        return values(outcome.part(out, part))

    return grid.packed(np.concatenate(in_parts(solve, out.strength.size)))


def _solve(law: Law, rtol: float, out: Outcome) -> None:
    status, n = zener.solve_all(law.at_any_strength, rtol, out)
    if status != zener.OK:
        raise RuntimeError(
            f"table for law {law.name!r}: the node lambda = {out.inelasticity[n]:.6g}, d_Y/(V0 T_H) = "
            f"{out.yield_ratio[n]:.6g} did not solve: {zener.MESSAGES[status]}"
        )
