"""The one place where numba's options are set."""

from __future__ import annotations

import functools

import numba

# error_model "numpy": a division by zero gives inf, which the callers' range tests refuse; the
# default raises, and a raise inside a parallel or nogil loop is slow or lost. fastmath stays off:
# under it isnan(nan) is False, and NaN would pass every test for it.
kernel = functools.partial(numba.njit, error_model="numpy", nogil=True)
