"""Memory that Python, the C function and LAMMPS share, and calls of LAMMPS."""

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from contactlaw._jit import kernel
from contactlaw.stepping.loads import NUMBERS
from contactlaw.walls.memory import array_at

MINIMIZING = 2  # result of `lammps_is_running` in a minimization; 1 in a run

# Integers up to "periodicity" are addresses. "calls" counts the calls of the C function, "step" is the
# time step of the last one.
SHARED = np.dtype(
    [(name, "i8") for name in ("extract_atom", "get_thermo", "is_running", "set_vector", "lammps")]
    + [(name, "i8") for name in ("x", "v", "f", "radius", "rmass", "type", "mask", "omega", "torque")]
    + [(name, "i8") for name in ("history", "last", "body", "look", "elapsed", "dt", "atime", "atimestep")]
    + [(name, "i8") for name in ("plate_rows", "frames", "facets", "found", "impacts", "status", "loads", "pressed")]
    + [(name, "i8") for name in ("run", "allreduce", "double", "sum", "comm", "force_fix", "shown")]
    + [(name, "i8") for name in ("boxlo", "boxhi", "periodicity")]
    + [(name, "i8") for name in ("types", "plate_row_count", "frame_count", "facet_count", "walls")]
    + [(name, "i8") for name in ("capacity", "places", "columns", "calls", "step", "error_step")]
    + [(name, "f8") for name in ("friction", "softening", "parcel")]
    + [("since", "f8")],  # time from which on `shown` has the walls' loads
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
def show(shared: Any, run: Any, loads: Any) -> None:
    """Put the means of what walls bear since the last call, on all ranks, in the fix's vector."""
    now = run.base + run.ticks * run.tick
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
    force = run.mass * run.length / run.time**2
    for i in range(n):
        unit = force * run.length if i % NUMBERS > 2 else force
        unit /= run.time if i % NUMBERS == NUMBERS - 1 else 1.0
        one = shared.lammps, shared.force_fix, np.int32(i + 1), before[2, i] / unit
        _call(shared.set_vector, np.int32(0), one)
    shared.since = now


@kernel
def rows_at(address: int, n: int) -> Any:
    """Address of the first row of one of LAMMPS's matrices, whose rows are contiguous."""
    return array_at(address, 1, np.intp)[0] if n > 0 else 0
