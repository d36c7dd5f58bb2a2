"""What runs in every time step: a C function made by numba, called by LAMMPS itself.

LAMMPS hands over positions and the array for the forces, this module fetches the other arrays
through LAMMPS's C interface. One row of history per bead (`history_columns`): first the code of an
error, then one slot per plate that is being touched, with `SLOT` numbers in each.

Legend: r radius, x overlap of the sphere with the undeformed plate, u speed towards the plate,
n normal from the plate to the bead.
"""

from __future__ import annotations

import ctypes
import functools
import math
from typing import Any

import numba
import numpy as np
from numba import carray, types
from numba.extending import intrinsic

from contactlaw import laws
from contactlaw._jit import kernel
from contactlaw.engines.lammps.plate import ROW
from contactlaw.softsphere import CONTACT_TIME, FEWEST_STEPS, Spring, State, advance, resized

# What a slot holds. The plate's number counts from 1 and is negative if the bead is on the side
# from which the normal points away; 0 is an empty slot. START counts steps, so that it has the same
# bits however a run is cut into pieces; LAMMPS's clock has not.
PLATE, U2, LARGEST, FORCE, START, SPEED, WAVE, TOLD, SPRING = range(9)
SLOT = 8  # columns without friction, which takes three more
SLOTS = 3  # plates that a bead may touch at once; a corner has three
# Codes of errors
(STEP_TOO_LARGE, STARTS_INSIDE, CROSSED, TOO_MANY_PLATES, WRONG_MASS, TOO_MANY_RECORDS, TOO_FAST,
 NOT_FINITE) = range(1, 9)  # fmt: skip

RECORD = ("time", "bead", "plate", "x", "y", "z", "approach_speed", "restitution", "contact_time",
          "peak_force", "plastic_energy", "wave_energy")  # fmt: skip

_DEEP = 0.1  # [r] of overlap at first touch: no step that is short enough gets there
_SOLID = 1e-6  # a bead's mass may differ so much, relatively, from that of a sphere of the model
_EVERY = 100  # steps between looks for beads that fly further than their radius in a step

# Memory that Python and the C function share; addresses are integers.
SHARED = np.dtype(
    [(name, "i8") for name in ("lammps", "v", "radius", "rmass", "omega", "torque", "history")]
    + [(name, "i8") for name in ("dt", "atime", "atimestep")]
    + [(name, "i8") for name in ("plates", "plate_count", "slots", "width", "columns", "last_step")]
    + [(name, "i8") for name in ("records", "capacity", "count")]
    + [(name, "i8") for name in ("error", "error_step", "error_bead", "error_plate")]
    + [(name, "f8") for name in ("error_value", "error_limit", "friction")]
    + [("low", "f8", 3), ("high", "f8", 3)],
    align=True,
)

SIGNATURE = types.void(
    types.voidptr,
    types.int64,
    types.int32,
    types.CPointer(types.int32),
    types.CPointer(types.CPointer(types.float64)),
    types.CPointer(types.CPointer(types.float64)),
)
_EXTRACT = ctypes.CFUNCTYPE(ctypes.c_ssize_t, ctypes.c_ssize_t, ctypes.c_ssize_t)  # addresses


@intrinsic
def _pointer(typing_context: Any, address: Any) -> Any:
    """Turn an address, an integer, into a void pointer."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], context.get_value_type(types.voidptr))

    return types.voidptr(types.intp), generate


@kernel
def _matrix(address: Any, rows: int, columns: int) -> Any:
    """Rows of a LAMMPS array of pointers; they lie one behind the other."""
    first = carray(_pointer(address), 1, np.intp)[0]
    return carray(_pointer(first), (rows, columns), np.float64)


@kernel
def _complain(
    shared: Any, row: Any, code: int, step: int, bead: int, plate: int, value: float, limit: float
) -> None:
    """Keep the first error of a rank, and mark the bead, which stops the run on all ranks."""
    row[0] = code
    if shared.error == 0:
        shared.error, shared.error_step, shared.error_bead = code, step, bead
        shared.error_plate, shared.error_value, shared.error_limit = plate, value, limit


@kernel
def _slot_of(row: Any, slots: int, width: int, plate: int) -> int:
    """First column of the plate's slot, else of an empty one, else 0."""
    empty = 0
    for k in range(slots):
        at = 1 + k * width
        if abs(row[at]) == plate + 1:
            return at
        if row[at] == 0.0 and empty == 0:
            empty = at
    return empty


def history_columns(plates: int, friction: bool) -> tuple[int, int, int]:
    """Slots per bead, columns of a slot, and columns of the history."""
    slots, width = min(plates, SLOTS), SLOT + 3 * friction
    return slots, width, 1 + slots * width


@functools.cache
def callback(law_name: str, extract_address: int) -> Any:
    """Compile the callback of ``fix external`` for a law; keep the result as long as it is used.

    Parameters
    ----------
    law_name : str
        Name of the normal force law.
    extract_address : int
        Of LAMMPS's function ``lammps_extract_atom``.
    """
    law = laws.law(law_name).functions
    extract = _EXTRACT(extract_address)

    @kernel
    def record(
        shared, row, at, step, ended, step_zero, dt, bead, plate, place, rebound, state, spring
    ):  # type: ignore[no-untyped-def]
        """Put a contact that has ended into the record."""
        unit = spring.stiffness * spring.scale * math.sqrt(spring.scale)  # F_Y
        dm = state.largest_compression / spring.scale
        lost = law.dissipation(dm) * unit * spring.scale if dm > 1.0 else 0.0
        if row[at + SPEED] > 0.0:
            if shared.count == shared.capacity:
                _complain(shared, row, TOO_MANY_RECORDS, step, bead, plate, 0.0, shared.capacity)
                return
            out = carray(_pointer(shared.records), (shared.capacity, len(RECORD)), np.float64)
            line = out[shared.count]
            line[0], line[1], line[2] = (row[at + START] - step_zero) * dt, bead, plate
            line[3], line[4], line[5] = place
            line[6], line[7] = row[at + SPEED], rebound / row[at + SPEED]
            line[8], line[9] = (ended - row[at + START]) * dt, law.loading(math.sqrt(dm)) * unit
            line[10], line[11] = lost - row[at + TOLD], row[at + WAVE]
            shared.count += 1
        row[at + TOLD] = lost

    @kernel
    def begin(shared, row, at, step, bead, plate, mass, x, u, dt, spring):  # type: ignore[no-untyped-def]
        """Start a contact, or the next one of a bead that comes back before it has parted."""
        row[at + START] = step - (x / (u * dt) if u > 0.0 and row[at + LARGEST] == 0.0 else 0.0)
        row[at + SPEED], row[at + WAVE] = u, 0.0
        if not abs(mass - spring.mass) <= _SOLID * spring.mass:
            _complain(shared, row, WRONG_MASS, step, bead, plate, mass, spring.mass)
        if u > 0.0:
            shortest = CONTACT_TIME * (spring.mass / (spring.stiffness * math.sqrt(u))) ** 0.4
            if dt * FEWEST_STEPS > shortest:
                _complain(shared, row, STEP_TOO_LARGE, step, bead, plate, u,
                          shortest / FEWEST_STEPS)  # fmt: skip

    @kernel
    def slide(
        shared, row, at, advancing, dt, v, omega, torque, r, stiffness, overlap, nx, ny, nz, f
    ):  # type: ignore[no-untyped-def]  # noqa: E501
        """Tangential spring with Coulomb's limit; its force follows from the spring alone."""
        spring = row[at + SPRING : at + SPRING + 3]
        k = stiffness * math.sqrt(r * max(overlap - row[at + U2], 0.0))
        if advancing:
            # velocity of the point of contact; the sphere's own is at -r n from its centre
            wx = v[0] - r * (omega[1] * nz - omega[2] * ny)
            wy = v[1] - r * (omega[2] * nx - omega[0] * nz)
            wz = v[2] - r * (omega[0] * ny - omega[1] * nx)
            gx, gy, gz = spring[0] + wx * dt, spring[1] + wy * dt, spring[2] + wz * dt
            out = gx * nx + gy * ny + gz * nz
            gx, gy, gz = gx - out * nx, gy - out * ny, gz - out * nz
            pull = k * math.sqrt(gx * gx + gy * gy + gz * gz)
            most = shared.friction * row[at + FORCE]
            if pull > most:
                gx, gy, gz = gx * most / pull, gy * most / pull, gz * most / pull
            spring[0], spring[1], spring[2] = gx, gy, gz
        tx, ty, tz = -k * spring[0], -k * spring[1], -k * spring[2]
        f[0] += tx
        f[1] += ty
        f[2] += tz
        torque[0] -= r * (ny * tz - nz * ty)
        torque[1] -= r * (nz * tx - nx * tz)
        torque[2] -= r * (nx * ty - ny * tx)

    @kernel
    def touch(
        shared,
        plates,
        p,
        step,
        step_zero,
        advancing,
        bead,
        dt,
        x,
        v,
        omega,
        torque,
        r,
        mass,
        row,
        f,
    ):  # type: ignore[no-untyped-def]  # noqa: E501
        """Bead i and plate p, which are near each other."""
        plate = plates[p]
        corner, a, b, normal = plate.corner, plate.a, plate.b, plate.normal
        px, py, pz = x[0] - corner[0], x[1] - corner[1], x[2] - corner[2]
        s = px * normal[0] + py * normal[1] + pz * normal[2]
        if not abs(s) < 2.0 * r:
            return
        along_a = px * a[0] + py * a[1] + pz * a[2]
        along_b = px * b[0] + py * b[1] + pz * b[2]
        at_a = min(max(along_a, 0.0), plate.length_a)
        at_b = min(max(along_b, 0.0), plate.length_b)
        face = at_a == along_a and at_b == along_b
        if face:
            distance, sign = abs(s), math.copysign(1.0, s)
            nx, ny, nz = sign * normal[0], sign * normal[1], sign * normal[2]
        else:  # the edge is nearest
            nx = px - at_a * a[0] - at_b * b[0]
            ny = py - at_a * a[1] - at_b * b[1]
            nz = pz - at_a * a[2] - at_b * b[2]
            distance = math.sqrt(nx * nx + ny * ny + nz * nz)
            nx, ny, nz = nx / distance, ny / distance, nz / distance
        if not distance < 2.0 * r:
            return
        overlap = r - distance
        at = _slot_of(row, shared.slots, shared.width, p)
        if at == 0:
            if overlap > 0.0:
                _complain(shared, row, TOO_MANY_PLATES, step, bead, p, 0.0, shared.slots)
            return
        old = State(row[at + U2], row[at + LARGEST], row[at + FORCE])
        fresh = row[at] == 0.0
        if fresh and (overlap <= 0.0 or not advancing):
            return
        spring = resized(
            Spring(plate.mass, plate.stiffness, plate.mobility, plate.scale, plate.relaxation), r
        )
        new = old
        if advancing:
            u = -(v[0] * nx + v[1] * ny + v[2] * nz)
            side = math.copysign(p + 1.0, s)
            if fresh and overlap > _DEEP * r:
                _complain(shared, row, STARTS_INSIDE, step, bead, p, overlap, _DEEP * r)
            if face and not fresh and side != row[at]:
                _complain(shared, row, CROSSED, step, bead, p, u, 0.0)
                return
            row[at] = side
            new = advance(law, spring, old, overlap, dt)
            if new.force > 0.0 and old.force == 0.0:
                begin(shared, row, at, step, bead, p, mass, overlap, u, dt, spring)
            square = old.force * old.force + new.force * new.force
            row[at + WAVE] += 0.5 * dt * spring.mobility * square
            if new.force == 0.0 and old.force > 0.0:
                left = law.residual(old.largest_compression / spring.scale) * spring.scale
                gap = left - (overlap - old.plate_displacement)
                ended = step - (min(max(gap / (-u * dt), 0.0), 1.0) if u < 0.0 else 0.0)
                place = (x[0] - distance * nx, x[1] - distance * ny, x[2] - distance * nz)
                record(shared, row, at, step, ended, step_zero, dt, bead, p, place, -u, old, spring)
            row[at + U2], row[at + LARGEST], row[at + FORCE] = new
            if overlap <= 0.0:
                row[at : at + shared.width] = 0.0
                return
        force = new.force
        f[0] += force * nx
        f[1] += force * ny
        f[2] += force * nz
        if shared.friction > 0.0:
            slide(shared, row, at, advancing, dt, v, omega, torque, r, plate.tangential,
                  overlap, nx, ny, nz, f)  # fmt: skip

    def each_step(pointer, step, n, tags, positions, forces):  # type: ignore[no-untyped-def]
        shared = carray(pointer, 1, SHARED)[0]
        # Anything else than the next step is a set-up, which asks for the same forces again.
        advancing = step == shared.last_step + 1
        shared.last_step = step
        if n == 0:
            return
        lammps = shared.lammps
        v = _matrix(extract(lammps, shared.v), n, 3)
        radius = carray(_pointer(extract(lammps, shared.radius)), n, np.float64)
        rmass = carray(_pointer(extract(lammps, shared.rmass)), n, np.float64)
        history = _matrix(extract(lammps, shared.history), n, shared.columns)
        omega, torque = v, v
        if shared.friction > 0.0:
            omega = _matrix(extract(lammps, shared.omega), n, 3)
            torque = _matrix(extract(lammps, shared.torque), n, 3)
        x = carray(positions[0], (n, 3))
        f = carray(forces[0], (n, 3))
        dt = carray(_pointer(shared.dt), 1, np.float64)[0]
        atime = carray(_pointer(shared.atime), 1, np.float64)[0]
        step_zero = carray(_pointer(shared.atimestep), 1, np.int64)[0] - atime / dt
        plates = carray(_pointer(shared.plates), shared.plate_count, ROW)
        # local numbers: the compiler cannot know that writing forces leaves `shared` as it is
        count = shared.plate_count
        x0, y0, z0 = shared.low[0], shared.low[1], shared.low[2]
        x1, y1, z1 = shared.high[0], shared.high[1], shared.high[2]
        if step % _EVERY == 0:
            for i in range(n):
                way = dt * math.sqrt(v[i, 0] ** 2 + v[i, 1] ** 2 + v[i, 2] ** 2)
                if not way < radius[i]:
                    code = TOO_FAST if way < math.inf else NOT_FINITE
                    _complain(shared, history[i], code, step, tags[i], -1, way / dt, radius[i])
        for i in range(n):
            f[i, 0] = f[i, 1] = f[i, 2] = 0.0
            reach = 2.0 * radius[i]
            if (
                x[i, 2] > z1 + reach
                or x[i, 2] < z0 - reach
                or x[i, 0] > x1 + reach
                or x[i, 0] < x0 - reach
                or x[i, 1] > y1 + reach
                or x[i, 1] < y0 - reach
            ):
                continue
            for p in range(count):
                touch(shared, plates, p, step, step_zero, advancing, tags[i], dt, x[i], v[i],
                      omega[i], torque[i], radius[i], rmass[i], history[i], f[i])  # fmt: skip

    return numba.cfunc(SIGNATURE, error_model="numpy")(each_step)
