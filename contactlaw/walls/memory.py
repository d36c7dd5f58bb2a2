"""Arrays by their addresses, which a row of numbers can hold and an array of arrays cannot."""

from __future__ import annotations

from typing import Any

import numba
from numba import types
from numba.extending import intrinsic

from contactlaw._jit import kernel

carray: Any = numba.carray  # type: ignore[attr-defined]


@intrinsic
def _pointer(typing_context: Any, address: Any) -> Any:
    """Turn an address into a void pointer."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], context.get_value_type(types.voidptr))

    return types.voidptr(types.intp), generate


@kernel
def array_at(address: int, shape: Any, kind: Any) -> Any:
    """Array of this shape and kind that begins at an address."""
    return carray(_pointer(address), shape, kind)  # type: ignore[call-arg]
