"""The one place where numba's options are set."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar, overload

import numba

_F = TypeVar("_F", bound=Callable[..., Any])
_cached: list[Any] = []


@overload
def kernel(function: _F) -> _F: ...
@overload
def kernel(*, cache: bool = False, inline: bool = False) -> Callable[[_F], _F]: ...
def kernel(
    function: _F | None = None, *, cache: bool = False, inline: bool = False
) -> _F | Callable[[_F], _F]:
    """Compile a function on its first call; to a type checker it stays what it was.

    `cache` keeps the machine code on disk. Numba notices an edit in the function's own file only,
    so every jitted callee has to be in that file too; functions passed as values cannot be cached.
    `inline` copies the function into its callers, where LLVM finds it too large to do so.
    """

    def compiled(python_function: _F) -> _F:
        # error_model "numpy": a division by zero gives inf, which the callers' range tests refuse;
        # the default raises, and a raise in nogil code is costly. Of fastmath only "contract",
        # which fuses a product with a sum: under all of it isnan(nan) is False.
        dispatcher: Any = numba.njit(
            error_model="numpy",
            nogil=True,
            fastmath={"contract"},
            inline="always" if inline else "never",
        )(python_function)
        if cache:
            _cached.append(dispatcher)
        return dispatcher  # type: ignore[no-any-return]

    return compiled if function is None else compiled(function)


@functools.cache
def enable_caching() -> None:
    """Let the kernels that asked for it use numba's disk cache, from now on.

    Not when they are defined: numba then makes a cache folder, and raises where it finds none that
    is writable; an import should do neither.
    """
    for dispatcher in _cached:
        try:
            dispatcher.enable_caching()
        except RuntimeError:  # no writable folder anywhere: compile in every process
            return


def direct(function: Callable[..., Any], signature: str) -> Callable[..., Any]:
    """Compile a kernel for one signature and return its bare entry, as numba's dispatcher calls it.

    It skips the dispatcher's look at the types of the arguments, a third of the time of a call
    that takes half a microsecond: every argument has to be what the signature says.
    """
    enable_caching()
    dispatcher: Any = function
    dispatcher.compile(signature)
    types, _ = numba.core.sigutils.normalize_signature(signature)  # type: ignore[no-untyped-call]
    entry: Callable[..., Any] = dispatcher.overloads[types].entry_point
    return entry
