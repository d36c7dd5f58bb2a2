"""What Python, the C function and LAMMPS share: layouts, codes, and pointers to arrays."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from contactlaw._jit import kernel

carray: Any = numba.carray  # type: ignore[attr-defined]

# A bead's history is the code of an error, the bead's ID, and slots for the plates that it touches.
# (LAMMPS gives a new bead the row that another one has left behind: by the ID it is known.) A slot:
# the plate's number, counted from 1, negative if the bead is on the side from which the normal
# points away, 0 if the slot is empty; the state of the contact; the time since first touch [s],
# summed up (LAMMPS's clock has other bits when a run is cut into pieces, and can be reset);
# approach speed [m/s]; energy to the wave, and energy to plastic flow that is in the record already
# [J]; the overlap [m]; the work of the contact's force on the bead [J]; a force of this step alone,
# beside that of the state [N]; with friction, the three components of the tangential spring [m].
ERROR, OWNER, FIRST = range(3)
(PLATE, DISPLACEMENT, LARGEST, FORCE, MOBILITY, STIFFENING, DURATION, SPEED, WAVE, TOLD,
 OVERLAP, WORK, KICK, SPRING) = range(14)  # fmt: skip
_SLOTS = 3  # plates that a bead may touch at once; a corner has three

(STEP_TOO_LARGE, STARTS_INSIDE, CROSSED, TOO_MANY_PLATES, WRONG_MASS, TOO_MANY_RECORDS, TOO_FAST,
 NOT_FINITE) = range(1, 9)  # fmt: skip

# Integers up to "records" are addresses; "calls" counts those of the C function.
SHARED = np.dtype(
    [(name, "i8") for name in ("extract_atom", "get_thermo")]
    + [
        (name, "i8")
        for name in ("lammps", "v", "f", "radius", "rmass", "omega", "torque", "history")
    ]
    + [("elapsed", "i8")]
    + [(name, "i8") for name in ("dt", "atime", "atimestep", "plates", "records")]
    + [(name, "i8") for name in ("plate_count", "slots", "width", "columns", "calls")]
    + [(name, "i8") for name in ("record_capacity", "record_count")]
    + [(name, "i8") for name in ("error", "error_step", "error_bead", "error_plate")]
    + [(name, "f8") for name in ("error_value", "error_limit", "friction", "before")]
    + [("low", "f8", 3), ("high", "f8", 3)],
    align=True,
)


def history_shape(plates: int, friction: bool) -> tuple[int, int, int]:
    """Slots per bead, columns of a slot, and columns of the history."""
    slots, width = min(plates, _SLOTS), SPRING + 3 * friction
    return slots, width, FIRST + slots * width


@intrinsic
def _pointer(typing_context: Any, address: Any) -> Any:
    """Turn an address into a void pointer."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], context.get_value_type(types.voidptr))

    return types.voidptr(types.intp), generate


@intrinsic
def _call(typing_context: Any, address: Any, result: Any, first: Any, second: Any) -> Any:
    """Call a C function of two addresses whose result has the type of `result`."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kinds = [context.get_value_type(kind) for kind in signature.args]
        function = ir.FunctionType(kinds[1], kinds[2:]).as_pointer()
        pointer = builder.inttoptr(arguments[0], function)
        return builder.call(pointer, arguments[2:])

    return result(types.intp, result, types.intp, types.intp), generate


@kernel
def extract(shared: Any, name: int) -> Any:
    """Address of one of LAMMPS's arrays, by the address of its name."""
    return _call(shared.extract_atom, np.int64(0), shared.lammps, name)  # type: ignore[call-arg]


@kernel
def thermo(shared: Any, name: int) -> Any:
    """One of LAMMPS's numbers, by the address of its name."""
    return _call(shared.get_thermo, 0.0, shared.lammps, name)  # type: ignore[call-arg]


@kernel
def array_at(address: int, shape: Any, kind: Any) -> Any:
    """Array of this shape and kind that begins at an address."""
    return carray(_pointer(address), shape, kind)  # type: ignore[call-arg]


@kernel
def matrix_at(address: int, rows: int, columns: int) -> Any:
    """Array whose rows LAMMPS points to; they lie one behind the other."""
    return array_at(array_at(address, 1, np.intp)[0], (rows, columns), np.float64)


@kernel
def slot_of(row: Any, shared: Any, plate: int) -> Any:
    """First column of the plate's slot, else of an empty one, else 0."""
    empty = 0
    for k in range(shared.slots):
        at = FIRST + k * shared.width
        if abs(row[at]) == plate + 1:
            return at
        if row[at] == 0.0 and empty == 0:
            empty = at
    return empty


@kernel
def touches(row: Any, shared: Any) -> bool:
    """Whether a bead is in contact with any plate."""
    for k in range(shared.slots):
        if row[FIRST + k * shared.width] != 0.0:
            return True
    return False


@kernel
def complain(
    shared: Any, step: int, tag: int, row: Any, code: int, plate: int, value: float, limit: float
) -> None:
    """Keep the first error of a rank, and mark the bead, which stops the run on all ranks."""
    row[ERROR] = code
    if shared.error == 0:
        shared.error, shared.error_step, shared.error_bead = code, step, tag
        shared.error_plate, shared.error_value, shared.error_limit = plate, value, limit
