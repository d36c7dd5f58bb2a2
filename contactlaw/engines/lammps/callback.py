"""The C function that LAMMPS calls in every time step, compiled by numba.

LAMMPS's arrays are fetched through its C interface in every step, because LAMMPS may move them.
Forces are added to LAMMPS's own array, and only for beads that touch a wall: the array that ``fix
external`` offers would be written, read and added for all beads in every step, which takes longer
than all the rest.
"""

import functools
from typing import Any

import numpy as np
from numba import types

from contactlaw._jit import c_function
from contactlaw.engines.lammps.memory import SHARED, call, extract, matrix, rows_at, show
from contactlaw.record.columns import IMPACT
from contactlaw.stepping import Clock, Trouble
from contactlaw.stepping.contact import STATUS, WallScene
from contactlaw.stepping.loads import LOAD
from contactlaw.stepping.plate_rows import PLATE_ROW
from contactlaw.stepping.rigid import BODY, turn
from contactlaw.stepping.step import BODY_BYTES, HEAD, ROWS, RUN, Beads, begin, enclose, fail
from contactlaw.stepping.step import step as step_all
from contactlaw.walls.facet import FACET
from contactlaw.walls.frame import FRAME
from contactlaw.walls.memory import array_at, carray
from contactlaw.walls.surface import OVERLAP, ROOM

_EVERY = 100  # steps between looks at all beads, which happen in the first step of a run, too
_MINIMIZING = 2  # for `lammps_is_running`; 1 is a run

_pointer: Any = types.CPointer
_SIGNATURE = types.void(
    types.voidptr,  # memory of the attachment
    types.int64,  # time step
    types.int32,  # beads of this rank
    _pointer(types.int32),  # their IDs
    _pointer(_pointer(types.float64)),  # positions, which may be no array if there is no bead
    _pointer(_pointer(types.float64)),  # forces that the fix would add; its group is empty
)


def _each_step(memory: Any, step: int, n: int, tags: Any, positions: Any, forces: Any) -> None:
    """Add the force of the walls to all beads of this rank."""
    shared = carray(memory, 1, SHARED)[0]
    runs = array_at(shared.run[0], 1, RUN)
    run = runs[0]
    shared.calls += 1
    if run.error == 0.0:
        shared.error_step = step
    # At a set-up, no step of the run has elapsed. The step number may be reset, so it is not used.
    advancing = call(shared.lammps_get_thermo, 0.0, (shared.lammps, shared.elapsed)) > 0.0  # type: ignore[call-arg]
    follows, shared.step = step == shared.step + 1, step
    state = call(shared.lammps_is_running, np.int32(0), (shared.lammps,))
    if state == _MINIMIZING or (advancing and not follows):
        if run.error == 0.0:
            run.error, run.bead, run.wall = Trouble.NO_STEPS.value, -1.0, -1.0
        return
    dt = array_at(shared.dt, 1, np.float64)[0] * run.time
    time = array_at(shared.atime, 1, np.float64)[0] * run.time
    before = run.before if run.before > 0.0 else dt
    if advancing:
        run.before = dt
    clock = Clock(time + (step - array_at(shared.atimestep, 1, np.int64)[0]) * dt, dt, before, advancing)
    scene = WallScene(
        array_at(shared.plate_rows[0], (shared.types, shared.plate_rows[1] // shared.types), PLATE_ROW),
        array_at(shared.frames[0], shared.frames[1], FRAME),
        array_at(shared.facets[0], shared.facets[1], FACET),
        array_at(shared.found[0], ROOM, OVERLAP),
        array_at(shared.impacts[0], shared.impacts[1], IMPACT),
        array_at(shared.status[0], 1, STATUS),
        array_at(shared.loads[0], shared.loads[1], LOAD),
        shared.friction,
        shared.softening,
        shared.parcel,
    )
    looks = step % _EVERY == 0 or not advancing
    if advancing and looks:  # on all ranks, also without beads
        show(shared, run)
    if shared.look != 0 and looks:  # on all ranks, too
        call(shared.look, np.int32(0), ())
    history = extract(shared, shared.history)
    if history == 0:  # a command has removed the fix of the history
        return
    low, high = array_at(shared.boxlo, 3, np.float64), array_at(shared.boxhi, 3, np.float64)
    enclose(run, clock, low, high, array_at(shared.periodicity, 3, np.int32))
    omega, bodies = matrix(shared, shared.omega, n), 0
    if shared.look != 0:
        bodies = rows_at(extract(shared, shared.body), n)
        for i in range(n):
            body = array_at(bodies + BODY_BYTES * i, 1, BODY)[0]
            if body.inverse_mass != 0.0 and not looks:  # a look has the axes of this step
                turn(body, (omega[i, 0] / run.time, omega[i, 1] / run.time, omega[i, 2] / run.time), dt)
    beads = Beads(
        n,
        carray(tags, n),
        array_at(extract(shared, shared.type), n, np.int32),
        array_at(extract(shared, shared.mask), n, np.int32),
        matrix(shared, shared.x, n),
        matrix(shared, shared.v, n),
        omega,
        array_at(extract(shared, shared.radius), n, np.float64),
        array_at(extract(shared, shared.rmass), n, np.float64),
        matrix(shared, shared.f, n),
        matrix(shared, shared.torque, n),
        array_at(extract(shared, shared.last), n, np.float64),
        rows_at(history, n),
        8 * shared.columns,
        shared.places,
        bodies,
    )
    begin(scene, runs, clock, beads, looks)
    first, status, most = 0, scene.status[0], len(scene.impacts) - ROWS
    while first < n:
        first = step_all(scene, runs, clock, beads, first)
        if status.impacts > most:  # the later ones are not recorded, and the run ends
            status.impacts = most
            fail(run, array_at(beads.history, 1, HEAD)[0], -1.0, Trouble.TOO_MANY_IMPACTS.value, -1, 0.0, most)


@functools.cache
def callback() -> Any:
    """Return the C function for ``fix external``, compiled or from the disk cache."""
    return c_function(_SIGNATURE, _each_step, cache=True)
