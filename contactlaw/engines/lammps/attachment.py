"""The attachment of plates to a LAMMPS object: commands, shared memory, errors and records."""

from __future__ import annotations

import ctypes
import functools
import math
import os
import pickle
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from numbers import Integral
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from contactlaw._errors import ArgumentError
from contactlaw.engines.lammps.bodies import COLUMN, Bodies
from contactlaw.engines.lammps.callback import callback
from contactlaw.engines.lammps.memory import FUNCTIONS, POINTERS, SHARED
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import number, warn_of_metres
from contactlaw.record.columns import IMPACT
from contactlaw.record.file import Record
from contactlaw.reporting.files import report
from contactlaw.stepping import Trouble, WallContacts
from contactlaw.stepping.loads import NUMBERS, Loads, means
from contactlaw.stepping.step import FIRST, HEAD, LAYOUT, ROWS, RUN, SLIDING, WIDTH
from contactlaw.stepping.trouble import explain
from contactlaw.walls.frame import Wall
from contactlaw.walls.plate import Models, by_type, check_models

if TYPE_CHECKING:
    from lammps import lammps

_T = TypeVar("_T")
HISTORY = "contactlaw"  # the column of fix property/atom is d2_contactlaw
_LAST = f"{HISTORY}_restitution"  # d_contactlaw_restitution
_FORCE = f"{HISTORY}_force"
# LAMMPS's units of length, time and mass, in SI
_UNITS = {"si": (1.0, 1.0, 1.0), "cgs": (1e-2, 1.0, 1e-3), "micro": (1e-6, 1e-6, 1e-15)}
_ROUNDED = 6  # decimals of the time steps by which LAMMPS's clock differs from a whole number of them
_HALT_EVERY = 100  # steps between looks at errors, in the steps in which the C function shows them
_WRAPPED = ("command", "commands_list", "commands_string", "file")
# Parts of an attachment in LAMMPS, in the order in which they are made: kind, name, settings. The
# number of the force's vector is above 0 once a rank has an error.
_PARTS = (
    ("fix", HISTORY, f"all property/atom d2_{HISTORY} {{columns}} d_{_LAST} ghost no"),
    ("group", HISTORY, "empty"),
    ("fix", _FORCE, f"{HISTORY} external pf/callback 1 1"),
    ("variable", f"{HISTORY}_error", f"equal f_{_FORCE}[1]"),
    ("fix", f"{HISTORY}_halt", f"all halt {_HALT_EVERY} v_{HISTORY}_error > 0 error continue message no"),
    ("compute", f"{HISTORY}_group", "{group} ke"),  # because LAMMPS refuses to delete a group that a compute has
)
_ERROR = "bead", "wall", "value", "limit", "error"  # of RUN
_REMOVED = {"fix": "unfix {}", "compute": "uncompute {}", "group": "group {} delete", "variable": "variable {} delete"}


def attach(
    lmp: lammps,
    model: Models,
    plates: Sequence[Wall] | Mapping[str, Wall],
    *,
    friction: float = 0.0,
    records: int = 1_000_000,
    softening: float = 1.0,
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
    softening : float, optional
        Number by which the modulus of the contacts is divided, for time steps that are longer by
        its power of 0.4; beads leave as from the true contact.
        `contactlaw.softsphere.most_softening` gives the largest one. See docs/softening.md.
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
    if start is not None and not math.isfinite(number("start", start)):
        raise ArgumentError("start", start, "must be finite [s]")
    _check_simulation(lmp)
    groups = [*filter(None, lmp.available_ids("group"))]  # None where one was deleted
    if group not in groups:
        raise ArgumentError("group", group, f"LAMMPS has none of this name, but {', '.join(groups)}")
    contact = {"friction": friction, "softening": softening, "parcel": parcel}
    contacts = _contacts(lmp, model, plates, _record_memory(records), _bit_of(lmp, group), contact)
    return LammpsPlates(lmp, contacts, group, rigid, start)


def _contacts(
    lmp: lammps, models: Any, plates: Any, records: NDArray[np.void], bit: int, contact: dict[str, Any]
) -> WallContacts:
    """Contacts of the beads that LAMMPS has, after a look at the walls."""
    types, comm = lmp.extract_setting("ntypes"), lmp.get_mpi_comm()
    own, largest = _checked(plates, models, types), float(_beads(lmp, "radius", bit).max(initial=0.0))
    radius = max(comm.allgather(largest)) * _UNITS[lmp.extract_global("units")][0]
    with warnings.catch_warnings():
        if comm.rank > 0:
            warnings.simplefilter("ignore")  # the first rank warns of large beads, and walls that cross
        warn_of_metres("radius", radius, stacklevel=3)
        return WallContacts(plates, own, radius, records, types=types, **contact)


def _bit_of(lmp: lammps, group: str) -> int:
    """Bit by which LAMMPS marks the beads of a group."""
    return 1 << int(lmp.available_ids("group").index(group))  # in the order of the bits, None where one was deleted


def _beads(lmp: lammps, name: str, bit: int = 1) -> NDArray[Any]:
    """Read a number of each bead on this rank, in LAMMPS's units; `bit` is that of a group."""
    if not (n := lmp.extract_setting("nlocal")):  # LAMMPS may have no array for no bead
        return np.zeros(0, int)
    found, mask = (np.asarray(lmp.numpy.extract_atom(one)[:n]) for one in (name, "mask"))
    own: NDArray[Any] = found[mask & bit != 0]
    return own


def _checked(plates: Any, models: Any, types: int) -> dict[int, ImpactModel | None]:
    """Refuse walls for other beads than those of the models; return the models by type."""
    check_models(models)
    own = by_type(models, types)
    if not any(own.values()):
        raise ArgumentError("model", None, "has none for any atom type")
    walls = [*plates.values()] if isinstance(plates, Mapping) else plates
    if not (isinstance(walls, Sequence) and walls and all(isinstance(wall, Wall) for wall in walls)):
        raise TypeError(
            f"plates: expected a list or dict of walls of contactlaw.engines.lammps, such as Plate, got {plates!r}"
        )
    for wall in walls:
        for kind, model in by_type(wall.model, types).items():
            beads = own.get(kind)
            if model and not (beads and _beads_of(model) == _beads_of(beads)):
                reason = f"attach() needs a model of this law and these beads for atom type {kind}, and has {beads!r}"
                raise ArgumentError("plates", model, reason)
    return own


def _beads_of(model: ImpactModel) -> tuple[Any, Any]:
    return model.force_law.family, model.pair.sphere


def _record_memory(records: Any) -> NDArray[np.void]:
    """Empty rows for a number of impacts, which take memory only when they are written."""
    if not isinstance(records, Integral) or isinstance(records, bool) or not 1 <= int(records) <= 1e9:
        raise ArgumentError("records", records, "must be a whole number from 1 to 1e9")
    return np.empty(int(records) + ROWS, IMPACT)


def _check_simulation(lmp: lammps) -> None:
    """Refuse a simulation whose units, dimension, atoms or parts the adapter cannot work with."""
    units, dimension = lmp.extract_global("units"), lmp.extract_setting("dimension")
    spheres = lmp.extract_setting("radius_flag") and lmp.extract_setting("rmass_flag")
    for suits, reason in (
        (lmp.extract_setting("box_exist"), "has no simulation box yet: create_box or read_data first"),
        (units in _UNITS, f"needs 'units si', 'cgs' or 'micro', has {units!r}"),
        (dimension == 3, f"needs three dimensions, has {dimension}"),
        (spheres, "its atoms have no radius and mass; needs 'atom_style sphere'"),
        (lmp.get_mpi_comm(), "built without MPI: pip install contactlaw[lammps], and import mpi4py first"),
    ):
        if not suits:
            raise ArgumentError("lmp", None, reason)
    _check_run_style(lmp)
    for kind, name, _ in _PARTS:
        # a restart brings an empty group
        if lmp.has_id(kind, name) and (kind != "group" or _beads(lmp, "id", _bit_of(lmp, name)).size):
            remedy = "detach() the plates that it belongs to, or give yours another name"
            raise RuntimeError(f"lmp: has a {kind} {name!r} already: {remedy}")


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
    for kind, name, _ in reversed([*_PARTS, ("fix", COLUMN, ""), ("compute", COLUMN, "")]):
        if lmp.has_id(kind, name):
            lmp.command(_REMOVED[kind].format(name))


def _address(lmp: lammps, name: str) -> Any:
    """Address of a function of LAMMPS's C interface."""
    return ctypes.cast(getattr(lmp.lib, name), ctypes.c_void_p).value


def _called(lmp: lammps, name: str, *given: Any) -> Any:
    """Call a function of LAMMPS's C interface that takes and returns addresses."""
    function = ctypes.CFUNCTYPE(ctypes.c_void_p, *[ctypes.c_void_p] * (1 + len(given)))(_address(lmp, name))
    return function(ctypes.cast(lmp.lmp, ctypes.c_void_p), *given)


class LammpsPlates:
    """The plates of one simulation and the impacts on them; made by `attach`.

    Attributes
    ----------
    softening, parcel : float
        As given to `attach`.
    start : float
        Time at which walls that move are where they were given, by `time` [s].
    """

    def __init__(self, lmp: lammps, contacts: WallContacts, group: str, rigid: str | None, start: float | None) -> None:
        self._lmp, self._comm, self._attached, self._contacts = lmp, lmp.get_mpi_comm(), True, contacts
        self._parts: list[NDArray[np.void]] = []
        self.softening, self.parcel = contacts.scene.softening, contacts.scene.parcel
        length, _, mass = self._units = _UNITS[lmp.extract_global("units")]
        self._bodies = Bodies(lmp, (length, mass), rigid)
        try:
            self._bodies.follow()
            self._install(group, start)
        except BaseException:
            _remove(lmp)
            raise
        self._replaced = {name: vars(lmp)[name] for name in _WRAPPED if name in vars(lmp)}
        for name in _WRAPPED:
            setattr(lmp, name, self._wrapped(getattr(lmp, name)))

    def _install(self, group: str, start: float | None) -> None:
        """Make the adapter's parts in LAMMPS; a restart file may have left contacts there."""
        scene, places = self._contacts.scene, self._contacts.places
        columns = FIRST + places * (WIDTH + SLIDING * (scene.friction > 0.0))
        self._shown = np.zeros(2)  # the error code of this rank, and the sum over all ranks
        for kind, name, settings in _PARTS:
            self._lmp.command(f"{kind} {name} {settings.format(columns=columns, group=group)}")
        self._lmp.fix_external_set_vector_length(_FORCE, 1)
        self._lmp.fix_external_set_vector(_FORCE, 1, 0.0)  # LAMMPS leaves what was in memory
        before = self._check_memory(columns)
        self._start_clock(_bit_of(self._lmp, group))
        self._shared = self._share(columns)
        self._callback = callback()
        fix, function = _FORCE.encode(), self._callback.address
        _called(self._lmp, "lammps_set_fix_external_callback", fix, function, self._shared.ctypes.data)
        self.start = float(start if start is not None else self.time if before is None else before)
        self._lasting["start"] = self.start
        self._run = self._comm.bcast(time.time_ns() // 1000), self.time
        self._borne: tuple[float, Any] = self.time, 0.0

    def _share(self, columns: int) -> NDArray[np.void]:
        """Fill the memory that the C function reads."""
        from mpi4py import MPI

        scene, lmp, shared = self._contacts.scene, self._lmp, np.zeros(1, SHARED)
        names = {name: name for name in "x v f radius rmass type mask omega torque elapsed".split()}
        names |= {"history": f"d2_{HISTORY}", "last": f"d_{_LAST}", "body": f"d2_{COLUMN}", "force_fix": _FORCE}
        self._names = {k: ctypes.create_string_buffer(name.encode()) for k, name in names.items()}
        for name, buffer in self._names.items():
            shared[name] = ctypes.addressof(buffer)
        for name in FUNCTIONS:
            shared[name] = _address(lmp, name)
        for name in POINTERS:
            shared[name] = _called(lmp, "lammps_extract_global", name.encode())
        for name, part in ("double", MPI.DOUBLE), ("sum", MPI.SUM), ("comm", self._comm):
            shared[name] = ctypes.c_int64(MPI._handleof(part)).value  # MPICH's may be below 0
        for name, part in {**scene._asdict(), "run": self._lasting, "shown": self._shown}.items():
            shared[name] = (part.ctypes.data, part.size) if isinstance(part, np.ndarray) else part
        shared["lammps"] = ctypes.cast(lmp.lmp, ctypes.c_void_p).value
        shared["types"], shared["places"], shared["columns"] = len(scene.plate_rows), self._contacts.places, columns
        shared["look"] = self._bodies.look
        return shared

    def _start_clock(self, bit: int) -> None:
        """Start the walls' clock at LAMMPS's time, so that walls go on moving after a restart."""
        names = "dt", "atime", "atimestep", "ntimestep"
        tick, now, since, step = (self._lmp.extract_global(name) for name in names)
        time, unit = now + (step - since) * tick, self._units[1]
        ticks, self._lasting = round(time / tick), np.zeros(1, RUN)
        run = self._lasting
        run[["length", "time", "mass"]] = self._units
        run["group"], run["tick"], run["ticks"] = bit, tick * unit, ticks
        run["base"] = round(time / tick - ticks, _ROUNDED) * tick * unit

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

    def _wrapped(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap a method of the LAMMPS object: collect impacts, and raise errors, after its commands."""
        from lammps.core import MPIAbortException

        @functools.wraps(function)
        def run(*arguments: Any, **keywords: Any) -> Any:
            calls = int(self._shared["calls"][0])
            self._tidy_rows()
            result = lammps_error = None
            try:
                result = function(*arguments, **keywords)
            except MPIAbortException:  # the error is on this rank alone
                raise
            except Exception as error:
                lammps_error = error
            self._after_command(self._shared["calls"][0] != calls, lammps_error)
            if lammps_error:
                raise lammps_error
            return result

        return run

    def _after_command(self, stepped: bool, lammps_error: Exception | None) -> None:
        """Raise what went wrong in a command; `lammps_error` is what LAMMPS raised itself."""
        if stepped:
            self._bodies.check()
            self._after_steps(lammps_error)
        else:
            self._tidy_rows(renumber=True)
        left = [(kind, name) for kind, name, _ in _PARTS if self._lmp.has_id(kind, name)]
        if len(left) < len(_PARTS):
            self.detach()
            if "fix" not in dict(left):  # by `clear`; a restart file may restore the group
                return
            names = ", ".join(f"{kind} {name!r}" for kind, name, _ in _PARTS if (kind, name) not in left)
            raise RuntimeError(
                f"{names}: taken out by a command, and all plates with it; LammpsPlates.detach() is the way to do it"
            ) from lammps_error
        self._bodies.follow()
        self._shared["look"] = self._bodies.look
        _check_run_style(self._lmp)

    def _after_steps(self, lammps_error: Exception | None) -> None:
        """Collect the impacts and raise the errors of time steps; all ranks have to call it."""
        scene, run = self._contacts.scene, self._lasting[0]
        rows = scene.impacts[: scene.status["impacts"][0]].copy()
        rows["run"], rows["run_start"] = self._run
        self._parts += [rows] if rows.size else []
        scene.status["impacts"] = 0
        self._contacts.warn_of_overlap(stacklevel=5)
        own = self._shared["error_step"][0].item(), *(run[name].item() for name in _ERROR)
        errors = [error for error in self._comm.allgather(own) if error[-1]]
        self._lasting["error"] = self._history()[1]["error"] = 0.0
        if errors:
            step, bead, wall, value, limit, code = min(errors)
            raise RuntimeError(explain(code, int(wall), value, limit, int(bead), step)) from lammps_error

    def _history(self) -> tuple[NDArray[np.float64], NDArray[np.void], NDArray[np.int32]]:
        """Return the contact state of this rank's beads, with the spare rows, their HEAD rows, and their IDs."""
        spare = self._lmp.extract_setting("nmax")
        history = self._lmp.numpy.extract_atom(f"d2_{HISTORY}", nelem=spare) if spare else None
        history = np.zeros((0, FIRST)) if history is None else history
        ids = _beads(self._lmp, "id")[: len(history)]
        return history, np.ndarray(len(ids), HEAD, history, 0, history.strides[:1]), ids

    def _tidy_rows(self, renumber: bool = False) -> None:
        """Empty the rows of removed beads, which LAMMPS may give to new ones.

        A command without steps may have changed IDs: with `renumber`, the rows get those of their beads.
        """
        history, heads, ids = self._history()
        owner = heads["owner"]
        if renumber:
            owner[owner != 0.0] = ids[owner != 0.0]
        history[: len(ids)][(owner != 0.0) & (owner != ids)] = 0.0
        history[len(ids) :] = 0.0

    def _check_memory(self, columns: int) -> float | None:
        """Start of the walls in a restart file, if it has any; refuse contacts of other walls; all ranks call it."""
        history, heads, ids = self._history()
        own, layout = history[: len(ids)], heads["layout"]
        heads["error"] = 0.0
        touching = (heads["owner"] == ids) & (heads["radius"] != 0.0)
        facets = own[touching, FIRST : FIRST + self._contacts.places * WIDTH : WIDTH]
        old = bool(((layout != 0.0) & (layout < LAYOUT)).any())
        other = layout != LAYOUT + columns
        wrong = bool(other[touching].any() or (abs(facets) > len(self._contacts.scene.facets)).any())
        gathered = self._comm.allgather((old, wrong, heads["start"][layout >= LAYOUT][:1].tolist()))
        own[other] = 0.0
        olds, wrongs, starts = zip(*gathered, strict=True)
        if any(olds):
            reason = "the restart file is of contactlaw 0.3, which kept no start of the walls: finish that run with it"
            raise ArgumentError("lmp", None, reason)
        if any(wrongs):
            raise ArgumentError(
                "plates, friction",
                None,
                "beads are in contact with other plates, as a restart file has it; attach the "
                "same plates in the same order, and friction or none as before",
            )
        return max(sum(starts, []), default=None)

    def loads(self) -> Loads:
        """Average what each wall has borne since the last call, or since the walls were attached.

        Every rank has to call it.

        Raises
        ------
        ValueError, RuntimeError
            If no step was simulated; the walls were detached.
        """
        self._together(self._check_attached, self._attached)
        now, (then, before) = self.time, self._borne
        sums = self._comm.allreduce(self._contacts.scene.loads.view(np.float64).reshape(-1, NUMBERS))
        found = means(sums - before, now - then)
        self._borne = now, sums
        return found

    def _check_attached(self, attached: bool) -> None:
        if not attached:
            raise RuntimeError("loads: the walls were detached, and bear nothing; ask before detach()")

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
        if (parts := self._comm.gather(self._together(lambda _: self.collisions(), ()))) is None:
            return None
        whole: NDArray[np.void] = np.concatenate(parts)
        return whole[np.lexsort((whole["bead"], whole["time"]))]

    def record(self) -> Record | None:
        """Record of all ranks, with the materials, law and walls: on rank 0, None on the others.

        Every rank has to call it.
        """
        made = {"engine": "LAMMPS", "version_engine": self._lmp.version()}
        return self._together(lambda rows: self._contacts.record(rows, **made), self.gather())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the record of all ranks to a file, see `contactlaw.Record.save`.

        Every rank has to call it; rank 0 writes.
        """
        self._together(lambda record: record.save(path), self.record())

    def report(self, out: str | os.PathLike[str]) -> Path:
        """Write a page about the impacts of all ranks into a folder, see `contactlaw.report`.

        Every rank has to call it; rank 0 writes. The walls are in the energy map.
        """
        self._together(lambda record: report(record, out), self.record())
        return Path(out) / "index.html"

    def _together(self, do: Callable[[Any], _T], given: Any) -> _T | None:
        """Call a function on each rank that has its argument, and raise an error of one rank on all ranks."""
        result = own = None
        try:
            result = None if given is None else do(given)
        except Exception as error:  # the other ranks wait to hear of it
            own = error
            try:
                pickle.loads(pickle.dumps(error))
            except Exception:
                own = RuntimeError(repr(error))
        for other in filter(None, self._comm.allgather(own)):
            raise own or other
        return result

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
            _remove(self._lmp)
