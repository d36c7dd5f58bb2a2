"""Arrays by address: a row of numbers cannot hold arrays, but it can hold their addresses."""

from __future__ import annotations

from typing import Any

import numba
from numba import types
from numba.extending import intrinsic
from numba.np import arrayobj

carray: Any = numba.carray  # type: ignore[attr-defined]
_cfarray: Any = arrayobj.np_cfarray


def _array_at(typing_context: Any, address: Any, shape: Any, kind: Any) -> Any:
    dimensions = len(shape) if isinstance(shape, types.BaseTuple) else 1
    array = types.Array(kind.dtype, dimensions, "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        start, size, _ = arguments
        pointer = builder.inttoptr(start, context.get_value_type(types.voidptr))
        return _cfarray(context, builder, array(types.voidptr, shape), (pointer, size))

    return array(types.intp, shape, kind), generate


array_at: Any = intrinsic(_array_at)
"""Array at an address, from its shape and the type of its elements.

Numba's carray does the same, but compiles two functions for each type of elements and of shape.
"""
