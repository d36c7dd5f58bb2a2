"""Vectors of three numbers, for kernels."""

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
