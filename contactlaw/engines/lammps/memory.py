"""Memory that Python, the C function and LAMMPS share, and calls of LAMMPS."""

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from contactlaw._jit import kernel
from contactlaw.walls.memory import array_at

# LAMMPS's C functions by their symbols, and the names of the global numbers to which it gives addresses
FUNCTIONS = "lammps_extract_atom lammps_get_thermo lammps_is_running lammps_fix_external_set_vector".split()
FUNCTIONS += ["MPI_Allreduce"]
POINTERS = "dt atime atimestep boxlo boxhi periodicity".split()
# "calls" counts the calls of the C function, "step" is the time step of the last one.
SHARED = np.dtype(
    # addresses of functions, of global numbers, of the names of arrays
    [(name, "i8") for name in [*FUNCTIONS, *POINTERS, "lammps", "look"]]
    + [(name, "i8") for name in "x v f radius rmass type mask omega torque history last body elapsed force_fix".split()]
    + [(name, "i8") for name in "double sum comm types places columns calls step error_step".split()]
    # addresses of arrays and their sizes
    + [(name, "i8", 2) for name in "plate_rows frames facets found impacts status loads run shown".split()]
    + [(name, "f8") for name in "friction softening parcel".split()],
    align=True,
)


@intrinsic
def call(typing_context: Any, address: Any, result: Any, given: Any) -> Any:
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
    return call(shared.lammps_extract_atom, np.int64(0), (shared.lammps, name))  # type: ignore[call-arg]


@kernel
def matrix(shared: Any, name: int, n: int) -> Any:
    """One of LAMMPS's arrays of three numbers for each of n beads."""
    return array_at(rows_at(extract(shared, name), n), (n, 3), np.float64)


@kernel
def show(shared: Any, run: Any) -> None:
    """Put the sum of all ranks' error codes into the fix's vector."""
    codes = array_at(shared.shown[0], 2, np.float64)
    codes[0] = run.error
    given = shared.shown[0], shared.shown[0] + 8, np.int32(1), shared.double, shared.sum, shared.comm
    call(shared.MPI_Allreduce, np.int32(0), given)  # type: ignore[call-arg]
    call(shared.lammps_fix_external_set_vector, np.int32(0), (shared.lammps, shared.force_fix, np.int32(1), codes[1]))


@kernel
def rows_at(address: int, n: int) -> Any:
    """Address of the first row of one of LAMMPS's matrices, whose rows are contiguous."""
    return array_at(address, 1, np.intp)[0] if n > 0 else 0
