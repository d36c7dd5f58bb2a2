"""The solver at many points, on all cores."""

import itertools
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

from contactlaw._arrays import Array
from contactlaw.equation import outcome, zener
from contactlaw.equation.outcome import Outcome
from contactlaw.laws import Law

Progress = Callable[[Iterator[Any], int], Iterable[Any]]
_T = TypeVar("_T")
_PART = 250  # points that a thread solves at a time


def no_progress(parts: Iterator[Any], total: int) -> Iterable[Any]:
    """Show nothing."""
    return parts


def in_parts(function: Callable[[slice], _T], count: int, progress: Progress = no_progress) -> Sequence[_T]:
    """Apply a function that releases the GIL to slices of `count` points, on all cores."""
    slices = [slice(low, min(low + _PART, count)) for low in range(0, count, _PART)]
    pool = ThreadPoolExecutor(os.cpu_count())
    try:
        # compile the function once, before the threads call it
        found = itertools.chain([function(slices[0])], pool.map(function, slices[1:]))
        return list(progress(found, len(slices)))
    finally:  # on Ctrl-C, wait for the parts that run and start no others
        pool.shutdown(cancel_futures=True)


def solved(law: Law, lam: Array, y: Array, strength: Array, rtol: float, progress: Progress = no_progress) -> Outcome:
    """Solve impacts at many points.

    Raises
    ------
    RuntimeError
        If one does not solve; the message names it.
    """
    out = outcome.at(lam, y, strength)

    def solve(part: slice) -> None:
        status, n = zener.solve_all(law.at_any_strength, rtol, outcome.part(out, part))
        if status != zener.OK:
            raise failure("node", law, lam[part], y[part], status, n)

    in_parts(solve, lam.size, progress)
    return out


def failure(what: str, law: Law, lam: Array, y: Array, status: int, n: int) -> RuntimeError:
    """Say which of several points did not solve."""
    return RuntimeError(
        f"table for law {law.name!r}: the {what} lambda = {lam[n]:.6g}, d_Y/(V0 T_H) = {y[n]:.6g} did not "
        f"solve: {zener.MESSAGES[status]}"
    )
