"""The COR of a model as compiled functions: for loops of numba, for C."""

import math
from collections.abc import Callable
from typing import Any

import numba

from contactlaw import _jit
from contactlaw._jit import in_memory, kernel
from contactlaw.answers.tabulated import TableLookup
from contactlaw.equation.numbers import share_of_solid
from contactlaw.table import lookup


def kernel_of(tabulated: TableLookup) -> Callable[..., float]:
    """COR as a jitted function of speed, radius, thickness and mass, which belongs to one table."""
    on_plate, packed = lookup.restitution_on_plate, in_memory(tabulated.packed)
    density = tabulated.bodies.constants.mass

    @kernel(entry=True)
    def cor(speed: float, radius: float, thickness: float, mass: float = math.inf) -> float:
        share = share_of_solid(density, radius, mass)
        return on_plate(packed(), speed, radius, thickness, share)

    return cor


def c_function(tabulated: TableLookup) -> Any:
    """COR as a C function of speed, radius and thickness, which belongs to one table."""
    signature = numba.float64(numba.float64, numba.float64, numba.float64)
    on_plate, packed = lookup.restitution_on_plate, in_memory(tabulated.packed)
    return _jit.c_function(signature, lambda v, r, h: on_plate(packed(), v, r, h, 1.0))
