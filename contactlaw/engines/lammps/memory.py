"""What Python, the C function and LAMMPS share: layouts, codes, and pointers to arrays."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from contactlaw._jit import kernel

carray: Any = numba.carray  # type: ignore[attr-defined]

# A bead's history is the code of an error, the bead's ID, radius [m], mass [kg] and atom type (from
# 0) when it began to touch walls, and slots for its contacts. The radius is 0 if it touches none.
# (LAMMPS gives a new bead the row that another one has left behind: by the ID it is known.) A slot:
# the facet's number, counted from 1, negative if the bead is on the side from which the normal
# points away, 0 if the slot is empty; the state of the contact; the time since first touch [s],
# summed up (LAMMPS's clock has other bits when a run is cut into pieces, and can be reset);
# approach speed [m/s]; energy to the wave, and energy to plastic flow that is in the record already
# [J]; the overlap [m]; work of the contact's force on the bead, in the wall's frame, and of the
# wall that moves [J]; a force of this step alone, beside that of the state [N]; whether it was
# alone on one smooth surface, went across a kink or had company, or has shared its force with
# another contact; power of the wall's motion by the normal force [W]; the force on the bead without
# friction [N]; with friction, the three components of the tangential spring [m].
ERROR, OWNER, RADIUS, MASS, KIND, FIRST = range(6)
(FACET, DISPLACEMENT, LARGEST, FORCE, MOBILITY, STIFFENING, DURATION, SPEED, WAVE, TOLD, OVERLAP,
 WORK, WALL_WORK, KICK, TIED, POWER, PUSH) = range(17)  # fmt: skip
SPRING = PUSH + 3
_SLOTS = 8  # contacts that a bead may have at once: a corner has three, a hole as many as edges

# From STARTS_INSIDE on the bead's contacts mean nothing any more: they are forgotten, and it feels
# no wall until the run has ended, so that none of them gets into the record.
(STEP_TOO_LARGE, TOO_MANY_RECORDS, TOO_FAST, NOT_FINITE, NO_MODEL, NO_STEPS, STARTS_INSIDE, CROSSED,
 WRONG_MASS, RESIZED, REWEIGHED, RETYPED, TOO_THIN, FOIL) = range(1, 15)  # fmt: skip

ALONE, UNEVEN, SHARING = 0.0, 1.0, 2.0  # of TIED

MINIMIZING = 2  # of LAMMPS's states; 1 is time steps

# Integers up to "overlaps" are addresses; "calls" counts those of the C function, the last of them
# in "step". Walls move by a clock of their own: `ticks` steps of length `tick` since `base`.
# LAMMPS's has other bits when a run is cut into pieces, and can be reset.
SHARED = np.dtype(
    [(name, "i8") for name in ("extract_atom", "get_thermo", "is_running", "lammps")]
    + [(name, "i8") for name in ("v", "f", "radius", "rmass", "type", "omega", "torque")]
    + [(name, "i8") for name in ("history", "last", "elapsed", "dt", "atime", "atimestep")]
    + [(name, "i8") for name in ("sheets", "frames", "facets", "records", "overlaps")]
    + [(name, "i8") for name in ("types", "sheet_count", "frame_count", "facet_count")]
    + [(name, "i8") for name in ("slots", "width", "columns", "calls", "step")]
    + [(name, "i8") for name in ("record_capacity", "record_count", "unserved", "ticks")]
    + [(name, "i8") for name in ("error", "error_step", "error_bead", "error_plate")]
    + [
        (name, "f8")
        for name in ("error_value", "error_limit", "friction", "base", "tick", "before")
    ]
    + [(name, "f8") for name in ("length", "time", "mass")],  # LAMMPS's units, in SI
    align=True,
)


def history_shape(facets: int, friction: bool) -> tuple[int, int, int]:
    """Slots per bead, columns of a slot, and columns of the history."""
    slots, width = min(facets, _SLOTS), SPRING + 3 * friction
    return slots, width, FIRST + slots * width


@intrinsic
def _pointer(typing_context: Any, address: Any) -> Any:
    """Turn an address into a void pointer."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], context.get_value_type(types.voidptr))

    return types.voidptr(types.intp), generate


@intrinsic
def _call(typing_context: Any, address: Any, result: Any, given: Any) -> Any:
    """Call a C function with a tuple of addresses; its result has the type of `result`."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        values = cgutils.unpack_tuple(builder, arguments[2])  # type: ignore[no-untyped-call]
        kind = context.get_value_type(signature.args[1])
        function = ir.FunctionType(kind, [value.type for value in values]).as_pointer()
        return builder.call(builder.inttoptr(arguments[0], function), values)

    return result(types.intp, result, given), generate


@kernel
def extract(shared: Any, name: int) -> Any:
    """Address of one of LAMMPS's arrays, by the address of its name."""
    return _call(shared.extract_atom, np.int64(0), (shared.lammps, name))  # type: ignore[call-arg]


@kernel
def thermo(shared: Any, name: int) -> Any:
    """One of LAMMPS's numbers, by the address of its name."""
    return _call(shared.get_thermo, 0.0, (shared.lammps, name))  # type: ignore[call-arg]


@kernel
def running(shared: Any) -> Any:
    """Tell what LAMMPS is doing."""
    return _call(shared.is_running, np.int32(0), (shared.lammps,))  # type: ignore[call-arg]


@kernel
def array_at(address: int, shape: Any, kind: Any) -> Any:
    """Array of this shape and kind that begins at an address."""
    return carray(_pointer(address), shape, kind)  # type: ignore[call-arg]


@kernel
def matrix_at(address: int, rows: int, columns: int) -> Any:
    """Array whose rows LAMMPS points to; they lie one behind the other."""
    return array_at(array_at(address, 1, np.intp)[0], (rows, columns), np.float64)


@kernel
def slot_of(row: Any, shared: Any, facet: int) -> int:
    """First column of a facet's slot, else 0; of an empty one for facet -1."""
    for k in range(shared.slots):
        at = FIRST + k * shared.width
        if abs(row[at]) == facet + 1:
            return int(at)
    return 0


@kernel
def touches(row: Any, shared: Any) -> bool:
    """Whether a bead has a contact."""
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
    keep(shared, step, tag, code, plate, value, limit)


@kernel
def keep(
    shared: Any, step: int, tag: int, code: int, plate: int, value: float, limit: float
) -> None:
    """Keep the first error of a rank; a bead or plate of -1 is none."""
    if shared.error == 0:
        shared.error, shared.error_step, shared.error_bead = code, step, tag
        shared.error_plate, shared.error_value, shared.error_limit = plate, value, limit
