"""Vectors of three numbers, for kernels."""

import math
from typing import Any

from contactlaw._jit import kernel

Vector = tuple[float, float, float]


@kernel
def dot(a: Vector, b: Vector) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def cross(a: Vector, b: Vector) -> Vector:
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel
def plus(a: Vector, factor: float, b: Vector) -> Vector:
    """Sum of a vector and a multiple of another one."""
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


@kernel
def scaled(factor: float, a: Vector) -> Vector:
    """Multiple of a vector."""
    return factor * a[0], factor * a[1], factor * a[2]


@kernel
def norm(a: Vector) -> float:
    """Length of a vector."""
    return math.sqrt(dot(a, a))


@kernel
def vector(array: Any) -> Vector:
    """Vector of the first three numbers of an array."""
    return array[0], array[1], array[2]


@kernel
def put(array: Any, a: Vector) -> None:
    """Write a vector to the first three numbers of an array."""
    array[0], array[1], array[2] = a


@kernel
def divided(a: Vector, by: float) -> Vector:
    """Vector over a number."""
    return a[0] / by, a[1] / by, a[2] / by
