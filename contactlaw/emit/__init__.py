"""Kernels as C and JavaScript: the one text of the physics, in Python, in other languages too.

`Program` takes kernels and the types of their arguments, and writes them with all that they call.
A function is made once for each tuple of argument types, as numba does. Kernels are in an annotated
subset of Python: numbers, NamedTuples, tuples, arrays, rows of a dtype, loops, calls. Anything else
is refused with file, line and remedy.
"""

from contactlaw.emit.c import C
from contactlaw.emit.program import Program
from contactlaw.emit.types import DOUBLE, INT, NONE, Array, Known, Row, Type

__all__ = ["DOUBLE", "INT", "NONE", "Array", "C", "Known", "Program", "Row", "Type"]
