"""Cubic B-splines in compiled code: their weights, and the sum over a block of coefficients.

A block has 4 x 4 coefficients. Loops over them take twice as long as the four vectors that a processor
multiplies at once, and numba's compiler does not find these vectors by itself.
"""

import functools
from typing import Any

import numba
from llvmlite import ir
from numba.extending import lower_builtin, type_callable

from contactlaw._arrays import Array
from contactlaw._jit import kernel

_FOUR = ir.VectorType(ir.DoubleType(), 4)
_UNSET, _INDEX = ir.Constant(_FOUR, ir.Undefined), ir.IntType(32)
# Weights times 6 in powers of t, from t^3 down (de Boor 1978, chapter IX).
_WEIGHTS = (-1.0, 3.0, -3.0, 1.0), (3.0, -6.0, 3.0, 0.0), (-3.0, 0.0, 3.0, 0.0), (1.0, 4.0, 1.0, 0.0)


@kernel(inline=True)
def weights(t: float) -> tuple[float, float, float, float]:
    """Cubic B-splines at t in [0, 1], times 6 (de Boor 1978, chapter IX)."""
    left, square = 1.0 - t, t * t
    first, last = left * left * left, square * t
    second = 4.0 + square * (3.0 * t - 6.0)
    return first, second, 6.0 - (first + second + last), last


def spline_value(table: Array, at: int, stride: int, u: float, v: float) -> float:
    """Sum of the coefficients of a block, which begins at `at`, with the weights of u for rows and v for columns."""
    a, b, total = weights(u), weights(v), 0.0
    for k in range(4):
        p = at + k * stride
        total += a[k] * (b[0] * table[p] + b[1] * table[p + 1] + b[2] * table[p + 2] + b[3] * table[p + 3])
    return total / 36.0


@type_callable(spline_value)
def _type_of_value(_: Any) -> Any:
    return lambda table, at, stride, u, v: numba.types.float64


@lower_builtin(spline_value, *5 * [numba.types.Any])  # type: ignore[no-untyped-call]
def _code_of_value(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    def times_plus(a: Any, b: Any, c: Any) -> Any:
        return builder.fadd(builder.fmul(a, b, flags=["contract"]), c, flags=["contract"])

    def spread(vector: Any, k: int) -> Any:
        return builder.shuffle_vector(vector, _UNSET, ir.Constant(ir.VectorType(_INDEX, 4), 4 * [k]))

    def weights_of(t: Any) -> Any:
        t, found = spread(builder.insert_element(_UNSET, t, _INDEX(0)), 0), ir.Constant(_FOUR, _WEIGHTS[0])
        for coefficients in _WEIGHTS[1:]:
            found = times_plus(found, t, ir.Constant(_FOUR, coefficients))
        return found

    data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
    (at, stride), (a, b) = arguments[1:3], map(weights_of, arguments[3:])
    total = ir.Constant(_FOUR, 4 * [0.0])
    for k in range(4):
        row = builder.load(builder.bitcast(builder.gep(data, [at]), _FOUR.as_pointer()), align=8)
        total, at = times_plus(spread(a, k), row, total), builder.add(at, stride)
    weighed = builder.fmul(total, b)
    whole = functools.reduce(builder.fadd, (builder.extract_element(weighed, _INDEX(k)) for k in range(4)))
    return builder.fmul(whole, ir.Constant(ir.DoubleType(), 1.0 / 36.0))
