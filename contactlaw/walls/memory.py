"""Arrays by address: a row of numbers cannot hold arrays, but it can hold their addresses."""

from __future__ import annotations

from typing import Any

import numba
from numba import types
from numba.core import cgutils
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


def _borrowed(typing_context: Any, array: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        found = context.make_array(signature.args[0])(context, builder, arguments[0])
        found.meminfo = cgutils.get_null_value(found.meminfo.type)  # type: ignore[no-untyped-call]
        return found._getvalue()

    return array(array), generate


borrowed: Any = intrinsic(_borrowed)
"""Array that somebody else keeps alive, without a count of its users.

Numba counts whenever an array, or a tuple that has one, is passed to a kernel; with the dozen
arrays of a bead and its walls that took longer than their contact.
"""
