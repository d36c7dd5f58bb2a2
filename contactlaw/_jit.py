"""The one place where numba's options are set."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import Any, TypeVar, overload

import numba
from numba.extending import intrinsic

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
        store = dispatcher._cache
        store.save_overload = functools.partial(_save, store.save_overload)


def _save(save: Callable[[Any, Any], None], signature: Any, data: Any) -> None:
    """Let an answer go before its machine code: numba raises if it cannot keep it."""
    try:
        save(signature, data)
    except OSError as error:
        _warn_once(str(error))


@functools.cache
def _warn_once(reason: str) -> None:
    warnings.warn(
        f"numba cannot keep compiled code on disk ({reason}), so each process compiles it anew; "
        "set NUMBA_CACHE_DIR to a writable folder with some megabytes left",
        stacklevel=2,
    )


@intrinsic
def uncached(typing_context: Any) -> Any:
    """Nonzero, and known only to this process: numba keeps no caller of it on disk.

    A kernel that holds a table as a constant looks the same to numba's cache whatever the table is,
    so a user's own ``@njit(cache=True)`` loop would go on with that of an earlier process.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointer = context.add_dynamic_addr(builder, 1, info="contactlaw: a table in memory")
        return builder.ptrtoint(pointer, context.get_value_type(numba.types.intp))

    return numba.types.intp(), generate


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
