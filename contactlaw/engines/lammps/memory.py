"""What Python, the C function and LAMMPS share: layouts, codes, and calls of LAMMPS's interface."""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from contactlaw._jit import kernel
from contactlaw.stepping.contact import CONTACT, Trouble
from contactlaw.stepping.friction import FRICTION
from contactlaw.walls.memory import array_at

# A bead's history, in float64 as LAMMPS keeps it: this row, then those of its contacts, then, with
# friction, those of their friction. LAMMPS gives a new bead the row that another one has left
# behind: it is known by its owner.
HEAD = np.dtype(
    [
        ("error", "f8"),  # code, which stops the run on all ranks; 0 without one
        ("owner", "f8"),  # ID of the bead
        ("columns", "f8"),  # of the history: a restart file may have another layout
        # when it began to touch walls; a radius of 0: it touches none
        ("radius", "f8"),  # [m]
        ("mass", "f8"),  # [kg]
        ("kind", "f8"),  # atom type, from 0
    ]
)
ERROR, OWNER, COLUMNS, RADIUS = range(4)
FIRST, WIDTH, SLIDING = (kind.itemsize // 8 for kind in (HEAD, CONTACT, FRICTION))

# Errors beside those of `contactlaw.stepping.Trouble`, whose numbers they go on from. From
# STARTS_INSIDE on, these included, they empty the bead's contacts, and it feels no wall until the
# run has ended, so that none of them gets into the record.
_MILD = max(code for code in Trouble if code < Trouble.STARTS_INSIDE)
TOO_FAST, NOT_FINITE, NO_STEPS = range(_MILD + 1, _MILD + 4)
assert NO_STEPS < Trouble.STARTS_INSIDE
RESIZED, REWEIGHED, RETYPED = range(max(Trouble) + 1, max(Trouble) + 4)

MINIMIZING = 2  # of LAMMPS's states; 1 is time steps

# Integers up to "status" are addresses; "calls" counts those of the C function, the last of them in
# "step". Walls move by a clock of their own: `ticks` steps of length `tick` since `base`. LAMMPS's
# has other bits when a run is cut into pieces, and can be reset.
SHARED = np.dtype(
    [(name, "i8") for name in ("extract_atom", "get_thermo", "is_running", "lammps")]
    + [(name, "i8") for name in ("v", "f", "radius", "rmass", "type", "omega", "torque")]
    + [(name, "i8") for name in ("history", "last", "elapsed", "dt", "atime", "atimestep")]
    + [(name, "i8") for name in ("sheets", "frames", "facets", "found", "impacts", "status")]
    + [(name, "i8") for name in ("types", "sheet_count", "frame_count", "facet_count")]
    + [(name, "i8") for name in ("capacity", "places", "columns", "calls", "step", "ticks")]
    + [(name, "i8") for name in ("error", "error_step", "error_bead", "error_plate")]
    + [
        (name, "f8")
        for name in ("error_value", "error_limit", "friction", "base", "tick", "before")
    ]
    + [(name, "f8") for name in ("length", "time", "mass")],  # LAMMPS's units, in SI
    align=True,
)


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
def matrix_at(address: int, rows: int, columns: int) -> Any:
    """Array whose rows LAMMPS points to; they lie one behind the other."""
    return array_at(array_at(address, 1, np.intp)[0], (rows, columns), np.float64)


@kernel
def complain(
    shared: Any, step: int, tag: int, head: Any, code: int, plate: int, value: float, limit: float
) -> None:
    """Keep the first error of a rank, and mark the bead, which stops the run on all ranks."""
    head.error = max(head.error, code)
    keep(shared, step, tag, code, plate, value, limit)


@kernel
def keep(
    shared: Any, step: int, tag: int, code: int, plate: int, value: float, limit: float
) -> None:
    """Keep the first error of a rank; a bead or plate of -1 is none."""
    if shared.error == 0:
        shared.error, shared.error_step, shared.error_bead = code, step, tag
        shared.error_plate, shared.error_value, shared.error_limit = plate, value, limit
