"""Loops as users write them, whose machine code is kept beside that of what they call."""

import numba

from contactlaw import _jit


def loop(function):
    """Compile a loop that calls contactlaw alone: the folder's name is a hash of its sources."""
    made = numba.njit(function)
    _jit.keep(made)
    return made
