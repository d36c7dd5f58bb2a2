"""Memory that Python, the C function and LAMMPS share, error codes, and calls of LAMMPS."""

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from contactlaw._jit import kernel
from contactlaw.stepping.contact import CONTACT, Trouble
from contactlaw.stepping.friction import FRICTION
from contactlaw.stepping.loads import NUMBERS
from contactlaw.walls.memory import array_at

# A bead's history, in float64 as LAMMPS keeps it: this row, then the CONTACT rows, then, with
# friction, the FRICTION rows. LAMMPS gives a new bead the row of a removed one without emptying it:
# `owner` shows whose row it is.
HEAD = np.dtype(
    [
        ("error", "f8"),  # error code, which stops the run on all ranks; 0 without one
        ("owner", "f8"),  # ID of the bead
        ("columns", "f8"),  # number of columns: a restart file may have another layout
        # the bead as it was when it began to touch walls; a radius of 0: it touches none
        ("radius", "f8"),  # [m]
        ("mass", "f8"),  # [kg]
        ("kind", "f8"),  # atom type, from 0
        ("softening", "f8"),  # of the attachment then, and its parcels
        ("parcel", "f8"),
    ]
)
ERROR, OWNER, COLUMNS, RADIUS = range(4)
SOFTENING = 6
FIRST, WIDTH, SLIDING = (kind.itemsize // 8 for kind in (HEAD, CONTACT, FRICTION))

# Errors of the adapter, numbered on from those of `contactlaw.stepping.Trouble`. An error whose
# number is STARTS_INSIDE or larger empties the bead's contacts, and no wall acts on the bead until
# the run has ended, so that none of these contacts gets into the record.
_MILD = max(code for code in Trouble if code < Trouble.STARTS_INSIDE)
TOO_FAST, NOT_FINITE, NO_STEPS = range(_MILD + 1, _MILD + 4)
assert NO_STEPS < Trouble.STARTS_INSIDE
RESIZED, REWEIGHED, RETYPED = range(max(Trouble) + 1, max(Trouble) + 4)

MINIMIZING = 2  # result of `lammps_is_running` in a minimization; 1 in a run

# Integers up to "status" are addresses. "calls" counts the calls of the C function, "step" is the
# time step of the last one. Walls move by a clock of their own: `ticks` steps of length `tick`
# since `base`. LAMMPS's clock rounds differently if a run is cut into pieces, and can be reset.
SHARED = np.dtype(
    [(name, "i8") for name in ("extract_atom", "get_thermo", "is_running", "set_vector", "lammps")]
    + [(name, "i8") for name in ("v", "f", "radius", "rmass", "type", "mask", "omega", "torque")]
    + [(name, "i8") for name in ("history", "last", "body", "look", "elapsed", "dt", "atime", "atimestep")]
    + [(name, "i8") for name in ("plate_rows", "frames", "facets", "found", "impacts", "status", "loads", "pressed")]
    + [(name, "i8") for name in ("allreduce", "double", "sum", "comm", "force_fix", "shown")]
    + [(name, "i8") for name in ("types", "plate_row_count", "frame_count", "facet_count", "walls", "group")]
    + [(name, "i8") for name in ("capacity", "places", "columns", "calls", "step", "ticks")]
    + [(name, "i8") for name in ("error", "error_step", "error_bead", "error_plate")]
    + [(name, "f8") for name in "error_value error_limit friction softening parcel base tick before".split()]
    + [(name, "f8") for name in ("length", "time", "mass")]  # LAMMPS's units, in SI
    + [("since", "f8")]  # time from which on `shown` has the walls' loads
    + [("bead_loads", "f8", (2, 3))],  # force and torque of a bead
    align=True,
)


@intrinsic
def _call(typing_context: Any, address: Any, result: Any, given: Any) -> Any:
    """Call a C function with a tuple of addresses; its result has the type of `result`."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        values = [builder.extract_value(arguments[2], n) for n in range(len(signature.args[2]))]
        kind = context.get_value_type(signature.args[1])
        function = ir.FunctionType(kind, [value.type for value in values]).as_pointer()
        return builder.call(builder.inttoptr(arguments[0], function), values)

    return result(types.intp, result, given), generate


@kernel
def extract(shared: Any, name: int) -> Any:
    """Address of one of LAMMPS's arrays, from the address of its name."""
    return _call(shared.extract_atom, np.int64(0), (shared.lammps, name))  # type: ignore[call-arg]


@kernel
def thermo(shared: Any, name: int) -> Any:
    """One of LAMMPS's thermo numbers, from the address of its name."""
    return _call(shared.get_thermo, 0.0, (shared.lammps, name))  # type: ignore[call-arg]


@kernel
def running(shared: Any) -> Any:
    """Return LAMMPS's state: 0 for idle, 1 in a run, MINIMIZING."""
    return _call(shared.is_running, np.int32(0), (shared.lammps,))  # type: ignore[call-arg]


@kernel
def look(shared: Any) -> None:
    """Look at the rigid bodies, in Python."""
    _call(shared.look, np.int32(0), ())  # type: ignore[call-arg]


@kernel
def show(shared: Any, loads: Any, now: float) -> None:
    """Put the means of what walls bear since the last call, on all ranks, in the fix's vector."""
    n = loads.size * NUMBERS
    before = array_at(shared.shown, (3, n), np.float64)
    sums, duration = array_at(int(loads.ctypes.data), n, np.float64), now - shared.since
    if not duration > 0.0:
        return
    for i in range(n):
        before[1, i], before[0, i] = (sums[i] - before[0, i]) / duration, sums[i]
    send, receive = shared.shown + 8 * n, shared.shown + 16 * n
    given = send, receive, np.int32(n), shared.double, shared.sum, shared.comm
    _call(shared.allreduce, np.int32(0), given)  # type: ignore[call-arg]
    force = shared.mass * shared.length / shared.time**2
    for i in range(n):
        unit = force * shared.length if i % NUMBERS > 2 else force
        unit /= shared.time if i % NUMBERS == NUMBERS - 1 else 1.0
        one = shared.lammps, shared.force_fix, np.int32(i + 1), before[2, i] / unit
        _call(shared.set_vector, np.int32(0), one)
    shared.since = now


@kernel
def matrix_at(address: int, rows: int, columns: int) -> Any:
    """Matrix of LAMMPS, whose rows are contiguous, from the address of its row pointers."""
    return array_at(array_at(address, 1, np.intp)[0], (rows, columns), np.float64)


@kernel
def mark_error(shared: Any, step: int, tag: int, head: Any, code: int, plate: int, value: float, limit: float) -> None:
    """Record an error of a bead, and mark the bead, which stops the run on all ranks."""
    head.error = max(head.error, code)
    record_error(shared, step, tag, code, plate, value, limit)


@kernel
def record_error(shared: Any, step: int, tag: int, code: int, plate: int, value: float, limit: float) -> None:
    """Record an error if it is the first on this rank; -1 means no bead or no plate."""
    if shared.error == 0:
        shared.error, shared.error_step, shared.error_bead = code, step, tag
        shared.error_plate, shared.error_value, shared.error_limit = plate, value, limit
