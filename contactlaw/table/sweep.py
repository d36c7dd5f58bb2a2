"""The solver at many points, on all cores."""

import itertools
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

import numpy as np

from contactlaw._arrays import Array
from contactlaw.equation import outcome, zener
from contactlaw.equation.outcome import Outcome
from contactlaw.laws import Law

Progress = Callable[[Iterator[Any], int], Iterable[Any]]
_T = TypeVar("_T")


def no_progress(parts: Iterator[Any], total: int) -> Iterable[Any]:
    """Show nothing."""
    return parts


def in_parts(function: Callable[[slice], _T], count: int, parts: int, progress: Progress) -> Sequence[_T]:
    """Apply a function that releases the GIL to slices of `count` points, on all cores."""
    edges = np.linspace(0, count, min(parts, count) + 1).astype(int).tolist()
    slices = [slice(low, high) for low, high in zip(edges[:-1], edges[1:], strict=True)]
    pool = ThreadPoolExecutor(os.cpu_count())
    try:
        # compile the function once, before the threads call it
        first = (function(slices[0]),)
        found = itertools.chain(first, pool.map(function, slices[1:]))
        return list(progress(found, len(slices)))
    finally:  # on Ctrl-C, wait for the parts that run and start no others
        pool.shutdown(cancel_futures=True)


def solve_overloads(
    law: Law, lam: Array, chi: Array, strength: Array, rtol: float, parts: int, progress: Progress = no_progress
) -> Outcome:
    """Solve impacts at many points; those with the same lambda have to lie side by side.

    Raises
    ------
    RuntimeError
        If one does not solve; the message names it.
    """
    out = outcome.at(lam, np.empty(lam.size), strength)

    def solve(part: slice) -> None:
        status, n = zener.solve_overloads(law.at_any_strength, rtol, chi[part], outcome.part(out, part))
        if status != zener.OK:
            raise failure("node", law, lam[part], chi[part], status, n)

    in_parts(solve, lam.size, parts, progress)
    return out


def failure(what: str, law: Law, lam: Array, chi: Array, status: int, n: int) -> RuntimeError:
    """Say which of several points did not solve."""
    return RuntimeError(
        f"table for law {law.name!r}: the {what} lambda = {lam[n]:.6g}, chi = {chi[n]:.6g} did not "
        f"solve: {zener.MESSAGES[status]}"
    )
