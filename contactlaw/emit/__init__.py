"""Kernels as C and JavaScript: the one text of the physics, in Python, in other languages too.

`add` writes a kernel into a `Program`, with all that it calls; each function once for each tuple of
argument types, as numba does. Kernels are in an annotated subset of Python: numbers, NamedTuples,
tuples, arrays, rows of a dtype, loops, calls. Anything else is refused with file, line and remedy.
"""

from contactlaw.emit.function import add
from contactlaw.emit.languages import C, JavaScript
from contactlaw.emit.program import Program
from contactlaw.emit.types import DOUBLE, INT, LONG, NONE, Array, Known, Struct, Type

__all__ = ["DOUBLE", "INT", "LONG", "NONE", "Array", "C", "JavaScript", "Known", "Program", "Struct", "Type", "add"]
