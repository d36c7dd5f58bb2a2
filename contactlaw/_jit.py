"""The one place where numba's options are set."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, overload

import numba

_F = TypeVar("_F", bound=Callable[..., Any])


@overload
def kernel(function: _F) -> _F: ...
@overload
def kernel(*, cache: bool) -> Callable[[_F], _F]: ...
def kernel(function: _F | None = None, *, cache: bool = False) -> _F | Callable[[_F], _F]:
    """Compile a function on its first call; to a type checker it stays what it was.

    `cache` keeps the machine code on disk. Numba notices an edit in the function's own file only,
    so every jitted callee has to be in that file too; functions passed as values cannot be cached.
    """
    # error_model "numpy": a division by zero gives inf, which the callers' range tests refuse; the
    # default raises, and a raise in nogil code is costly. Of fastmath only "contract", which fuses
    # a product with a sum: under all of it isnan(nan) is False, and NaN would pass every test.
    compiled: Any = numba.njit(error_model="numpy", nogil=True, cache=cache, fastmath={"contract"})
    return compiled if function is None else compiled(function)  # type: ignore[no-any-return]
