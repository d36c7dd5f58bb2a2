"""The scalar lookup as others call it: from Python, from numba, from C."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from contactlaw import _jit
from contactlaw._jit import direct, kernel, uncached
from contactlaw.table import lookup

_OFF = _jit.switched_off()
Cor = Callable[[float, float, float], float]


@functools.cache
def entries() -> tuple[Callable[..., float], Callable[..., float]]:
    """Entries of the kernels on a plate and at one speed, for Python; each argument a float."""
    return (
        direct(lookup.restitution_on_plate, "float64(float64[::1], f8, f8, f8, f8, f8)"),
        direct(lookup.restitution, "float64(float64[::1], f8, f8, f8, f8)"),
    )


def jitted(table: NDArray[np.float64], c_lam: float, c_chi: float) -> Cor:
    """COR as a jitted function of speed, radius and thickness, with the table as a constant."""
    on_plate = lookup.restitution_on_plate

    @kernel(entry=True)
    def cor(speed: float, radius: float, thickness: float) -> float:
        if not _OFF and uncached() == 0:  # type: ignore[call-arg]  # never so, but the call has to be there
            return math.nan
        return on_plate(table, c_lam, c_chi, speed, radius, thickness)

    return cor


def c_function(cor: Cor) -> Any:
    """Compile a jitted function of three floats for C; its address lives as long as the result."""
    signature = numba.float64(numba.float64, numba.float64, numba.float64)
    return _jit.c_function(signature, getattr(cor, "py_func", cor))
