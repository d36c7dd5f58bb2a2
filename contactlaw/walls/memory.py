"""Arrays by address: a row of numbers cannot hold arrays, but it can hold their addresses."""

from __future__ import annotations

from typing import Any

import numba
from numba import types
from numba.extending import intrinsic

from contactlaw._jit import private

carray: Any = numba.carray  # type: ignore[attr-defined]


def _carray(pointer: Any, shape: Any) -> Any:
    return carray(pointer, shape)


def _array_at(typing_context: Any, address: Any, shape: Any, kind: Any) -> Any:
    dimensions = len(shape) if isinstance(shape, types.BaseTuple) else 1
    array = types.Array(kind.dtype, dimensions, "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        start, size, _ = arguments
        to = types.CPointer(kind.dtype)  # type: ignore[no-untyped-call]
        pointer = builder.inttoptr(start, context.get_value_type(to))
        made = array(to, shape), (pointer, size)
        if private:
            return private.np_cfarray(context, builder, *made)
        return context.compile_internal(builder, _carray, *made)

    return array(types.intp, shape, kind), generate


array_at: Any = intrinsic(_array_at)
"""Array at an address, from its shape and the type of its elements.

Numba's public carray does the same, but compiles two functions for each type of elements and of
shape: 2 s of the 32 s of LAMMPS's first process.
"""
