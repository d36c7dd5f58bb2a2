"""The record of a run: its rows, and which bodies, law and walls they are about.

A file of HDF5 has all of it. Each dataset has a unit and a description:

    /impacts    the columns of `contactlaw.record.columns`, and `bodies`, the number of a pair
    /bodies/N   the law of a pair, and its materials /bodies/N/sphere and /bodies/N/plate
    /surface    the walls as triangles, and where on them each row is

Groups of other names belong to whoever has added them, such as the frames of `dem_demo`.
"""

from __future__ import annotations

import datetime
import io
import json
import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import h5py
import numpy as np

from contactlaw import _atomic
from contactlaw._arrays import Array, Integers, Mask, Rows
from contactlaw._content import content_of
from contactlaw._errors import ArgumentError
from contactlaw._version import VERSION
from contactlaw.physical.kind import only_impacts
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.scaling import wave_path
from contactlaw.physical.validity import Validity
from contactlaw.record import hdf5
from contactlaw.record.columns import COLUMNS, NAMES, typed

if TYPE_CHECKING:
    from contactlaw import Spectrum

FORMAT, SCHEMA = "contactlaw record", 1
HDF5 = ".h5", ".hdf5"
_BODIES = "sphere", "plate"
_OF_MATERIAL = "Pa (moduli, strength, hardness), kg/m3"
_UNITS = "SI: metres, seconds, kilograms, newtons, joules; each dataset names its own"
# Points of the walls at the start of a run, in columns that end in _x, _y and _z.
_PLACES = {"corner": "corners, three by triangle", "point": "where on the wall each row is"}
# To find impacts on a plate that still moves from another bead's: rows in place and time that are
# looked at, the row itself included; square of the distance over b t up to which a wave has come in
# the time t; least motion of the plate by the other bead over that by the own one. By superposition
# on a thin plate, of 500 pairs those beyond these have a COR within 0.04 of that of one bead.
_NEAREST, _REACH, _MOVED = 9, 16.0, 0.1


class Bodies(NamedTuple):
    """Materials and law of some impacts.

    Attributes
    ----------
    pair : Pair
        Materials of bead and wall, or of two beads.
    law : str
        Name of the law, for `ImpactModel`; empty where it is unknown.
    """

    pair: Pair
    law: str

    @property
    def materials(self) -> tuple[Material, Material]:
        """Material of the bead, and of what it has hit."""
        return self.pair.bodies


def bodies_of(model: Any) -> Bodies:
    """Materials and law of a model; the family's name where the pair gives the law's numbers."""
    law = getattr(model, "force_law", None)
    return Bodies(model.pair, "" if law is None else law.family if law.from_pair else law.name)


class Surface(NamedTuple):
    """Walls as triangles in their places at the start, and where impacts hit them.

    Attributes
    ----------
    corners
        Corners of the triangles, shape (m, 3, 3) [m].
    wall
        Number of the wall of each triangle, shape (m,).
    triangle
        Number of the triangle for each row of a record, shape (n,); -1: on none of them.
    point
        The contact point on it, shape (n, 3) [m]; None if unknown, as on walls that move.
    names
        Name of each wall, empty where it has none.
    """

    corners: Array
    wall: Integers
    triangle: Integers
    point: Array | None
    names: Sequence[str] = ()


@dataclass(frozen=True, eq=False)
class Record:
    """The contacts of a run with walls and with each other, and what they were between.

    Parameters
    ----------
    rows : structured array (n,)
        Contacts by time, with columns of `contactlaw.engines.record.IMPACT`.
    bodies : sequence of Bodies
        Pairs of materials with their laws; empty where they are unknown.
    which : array of int (n,), optional
        Number in `bodies` of each row, -1 where it is unknown; by default 0 if there is one pair.
    surface : Surface, optional
        The walls as triangles, and where the rows hit them.
    made : mapping
        What else is known: engine, versions, friction; texts and numbers.

    Examples
    --------
    >>> import contactlaw as cl
    >>> from contactlaw.engines.record import IMPACT
    >>> record = cl.Record(np.zeros(2, IMPACT), [cl.Bodies(cl.Pair("glass", "glass"), "fem")])
    >>> record.impacts.size, record.lacks
    (2, 'the surface of the walls')
    """

    rows: Rows
    bodies: Sequence[Bodies] = ()
    which: Integers = field(default_factory=lambda: np.empty(0, np.int64))
    surface: Surface | None = None
    made: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.which.size != self.rows.size:
            known = 0 if len(self.bodies) == 1 else -1
            object.__setattr__(self, "which", np.full(self.rows.size, known))

    @property
    def _columns(self) -> tuple[str, ...]:
        return self.rows.dtype.names or ()

    @cached_property
    def impact(self) -> Mask:
        """Whether each row is an impact: of other contacts COR and speed mean nothing."""
        return self._only_impacts[0]

    @property
    def impacts(self) -> Rows:
        """Rows that are impacts."""
        return self.part(self.impact).rows

    @property
    def left_out(self) -> str:
        """Which rows are no impacts, and how many; empty if all are."""
        return self._only_impacts[1]

    @cached_property
    def _only_impacts(self) -> tuple[Mask, str]:
        known = "kind" in self._columns  # else a table of an older version
        return only_impacts(self.rows["kind"] if known else np.zeros(self.rows.size))

    @property
    def lacks(self) -> str:
        """What the record does not say; empty for a complete one."""
        missing = [name for name in NAMES if name not in self._columns]
        parts = [f"the column{'s' * (len(missing) > 1)} {', '.join(missing)}"] if missing else []
        parts += [] if self.bodies else ["materials and law"]
        return "; ".join(parts + ([] if self.surface else ["the surface of the walls"]))

    @property
    def points(self) -> Array:
        """Contact points, shape (n, 3) [m]."""
        return np.stack([self.rows[name] for name in "xyz"], axis=1)

    def spectrum(self, duration: float | None = None) -> Spectrum:
        """Power that the impacts feed into each wall, and the spectrum of their forces.

        Parameters
        ----------
        duration : float, optional
            Time over which the power is a mean [s]; by default from the first contact on a wall to the last.

        Returns
        -------
        Spectrum
            Power and force in third octaves, and the share of the waves' energy whose force
            histories are not known.

        Raises
        ------
        ValueError
            If the record lacks materials or a column, or no impact on a wall has a force history;
            without a duration if all contacts are at one time.

        Examples
        --------
        >>> import contactlaw as cl
        >>> from contactlaw.engines.record import IMPACT, fill
        >>> pair = cl.Pair("glass", "glass")
        >>> rows = np.zeros(1, IMPACT)
        >>> rows["approach_speed"], rows["radius"], rows["thickness"], rows["mass"] = 2.0, 1e-3, 1e-3, 1.05e-5
        >>> fill(rows, cl.ImpactModel(pair).lookup([2.0], 1e-3, 1e-3), np.array([2.1e-5]))
        >>> spectrum = cl.Record(rows, [cl.Bodies(pair, "fem")]).spectrum(duration=0.01)
        >>> f"{1e3 * spectrum.power[0].sum():.2f} mW, most at {spectrum.frequency[spectrum.power[0].argmax()]:.0f} Hz"
        '1.00 mW, most at 100000 Hz'
        """
        from contactlaw import Spectrum

        return Spectrum.of(self.part(self.rows["plate"] >= 0), duration)

    def part(self, some: Any) -> Record:
        """Return the rows of a mask or of indices."""
        on = self.surface
        if on is not None:
            point = None if on.point is None else on.point[some]
            on = on._replace(triangle=on.triangle[some], point=point)
        return replace(self, rows=self.rows[some], which=self.which[some], surface=on)

    def content(self, more: Any = None) -> bytes:
        """Return the file's content; `more(file)` adds groups of its own to the open file."""
        image = io.BytesIO()
        with h5py.File(image, "w", libver="v110") as file:
            file.attrs.update(
                {
                    "format": FORMAT,
                    "schema": SCHEMA,
                    "units": _UNITS,
                    "created": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
                    "version_contactlaw": VERSION,
                    **self.made,
                }
            )
            table = file.create_group("impacts")
            for name, _, unit, text in COLUMNS:
                if name in self._columns:
                    write(table, name, self.rows[name], unit, text)
            write(table, "bodies", self.which, "1", "number of the group in /bodies, -1: unknown")
            for n, one in enumerate(self.bodies):
                file.create_group(f"bodies/{n}").attrs["law"] = one.law
                for name, material in zip(_BODIES, one.materials, strict=True):
                    words = {"uncertainty": json.dumps(dict(material.uncertainty)), "units": _OF_MATERIAL}
                    values = {key: value for key, value in asdict(material).items() if value is not None}
                    file.create_group(f"bodies/{n}/{name}").attrs.update(values | words)
            if self.surface is not None:
                _write_surface(file.create_group("surface"), self.surface)
            if more is not None:
                more(file)
        return image.getvalue()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a file of HDF5, which appears complete or not at all.

        Raises
        ------
        ValueError
            If the name does not end in ``.h5`` or ``.hdf5``.
        OSError
            If the file cannot be written.
        """
        if Path(path).suffix.lower() not in HDF5:
            raise ArgumentError("path", os.fspath(path), f"must end in {' or '.join(HDF5)}")
        _atomic.write(path, self.content())


def flagged(record: Record) -> Record:
    """Set `Validity.SHARED_PLATE` in a record that knows the bodies of all rows, and return it."""
    path = np.array([wave_path(one.pair.plate) for one in record.bodies])[record.which] * record.rows["thickness"]
    some = np.flatnonzero(only_impacts(record.rows["kind"])[0] & (path < np.inf))
    rows, path, point = record.rows[some], path[some], record.points[some]
    time, long, force, plate = (rows[name] for name in ("time", "contact_time", "peak_force", "plate"))
    share = rows["wave_energy"] / (0.5 * rows["mass"] * rows["approach_speed"] ** 2)
    if some.size > 1:
        from scipy.spatial import cKDTree

        at = np.column_stack((point / np.sqrt(_REACH * np.median(path * long)), time / np.median(long), 1e12 * plate))
        near = cKDTree(at).query(at, min(_NEAREST, some.size))[1].T
        after = np.maximum(time - time[near], 0.0)
        within = np.maximum(after, long)
        moved = share * force[near] * np.minimum(long[near], within) / (force * within)
        square = ((point - point[near]) ** 2).sum(axis=2)
        shared = (time[near] < time + long) & (square < _REACH * path * (after + long)) & (moved > _MOVED)
        shared &= (plate == plate[near]) & (near != np.arange(some.size))
        record.rows["flags"][some[shared.any(axis=0)]] |= Validity.SHARED_PLATE
    return record


def read_record(*paths: str | os.PathLike[str]) -> Record:
    """Read the record of a run; several files of one run are put together by time.

    Parameters
    ----------
    *paths : path-like
        Files of `Record.save` (``.h5``), or rows that ``np.save`` has written (``.npy``): these
        know neither materials nor law, see `Record.lacks`. Rows that two files have are taken once.
        A run that goes on from a restart file replaces the rows of the run before from there on.

    Returns
    -------
    Record
        All rows by time.

    Raises
    ------
    TypeError
        Without a path.
    ValueError
        If a file is damaged, of another kind, of a run with other walls than those before, or of a
        second run that begins at the same time, as files that an earlier run has left.
    OSError
        If a file cannot be read.

    Examples
    --------
    >>> import contactlaw as cl
    >>> import tempfile
    >>> from contactlaw.engines.record import IMPACT
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     cl.Record(np.zeros(2, IMPACT)).save(f"{folder}/run.h5")
    ...     cl.read_record(f"{folder}/run.h5").rows.size
    2
    """
    if not paths:
        raise TypeError("read_record: expected the path of a file, or several")
    whole, *others = files = [_read(Path(path)) for path in paths]
    runs: dict[float, tuple[int, str]] = {}  # that begin at each time
    for path, one in zip(paths, files, strict=True):
        for start, run in set(one.rows[["run_start", "run"]].tolist()):
            other = runs.setdefault(start, own := (run, os.fspath(path)))
            if other[0] != run:  # none goes on from the other
                reason = f"{other[1]} is of another run, which begins at {start:g} s, too"
                raise ValueError(f"{path}: {reason}: leave out the files of the earlier one, as {min(own, other)[1]}")
        whole = whole if one is whole else _joined(whole, one, path)
    starts = sorted(runs)
    until = np.append(starts, np.inf)[np.searchsorted(starts, whole.rows["run_start"], "right")]
    again = whole.rows["time"] > until * (1.0 + 1e-12)  # an impact within the step of the restart ends there
    if again.any():
        what = f"{again.sum()} rows are left out: the run that goes on from a restart has their times again"
        warnings.warn(what, stacklevel=2)
        whole = whole.part(~again)
    if others:  # a run that went on after a save has the rows of before in both files
        if "flags" in whole._columns:  # one of them alone may know of a shared plate
            whole = whole.part(np.argsort(-whole.rows["flags"], kind="stable"))
        key = whole.rows.copy()
        key[[name for name in whole._columns if name in ("run", "run_start", "flags")]] = 0
        whole = whole.part(np.unique(key.view(f"V{key.itemsize}"), return_index=True)[1])
    keys = [whole.rows[name] for name in ("bead", "time") if name in whole._columns]
    return whole.part(np.lexsort(keys))


def read_from(file: h5py.File) -> Record:
    """Read the record of an open file.

    Raises
    ------
    ValueError
        If the file has another format, or lacks a part, or has one that cannot be read.
    """
    form, schema = (str(file.attrs.get(name)) for name in ("format", "schema"))
    if (form, schema) != (FORMAT, str(SCHEMA)):
        raise ValueError(f"no {FORMAT} of schema {SCHEMA}, but format {form}, schema {schema}: run it again")
    group = hdf5.group(file, "impacts")
    size = hdf5.numbers(group, "time").size
    rows = typed({name: hdf5.numbers(group, name, size) for name in NAMES if name in group})
    pairs = hdf5.group(file, "bodies") if "bodies" in file else {}
    bodies = list[Bodies]()
    for n in range(len(pairs)):
        one = hdf5.group(file, f"bodies/{n}")
        bodies.append(Bodies(Pair(*(_material(hdf5.group(one, body)) for body in _BODIES)), str(one.attrs["law"])))
    which = hdf5.indices(group, "bodies", len(bodies), size)
    surface = _read_surface(hdf5.group(file, "surface"), size) if "surface" in file else None
    return Record(rows, bodies, which, surface, dict(file.attrs))


def write(group: h5py.Group, name: str, values: object, units: str, description: str) -> None:
    """Write an array with its unit and description."""
    data = np.asarray(values)
    checked = {"compression": "gzip", "fletcher32": True} if data.size else {}
    dataset = group.create_dataset(name, data=data, **checked)
    dataset.attrs.update({"units": units, "description": description})


def _read(path: Path) -> Record:
    try:
        content = content_of(path)
        if path.suffix.lower() == ".npy":
            rows = _saved(content)
            return Record(typed({name: rows[name] for name in rows.dtype.names or ()}))
        with hdf5.opened(content) as file:
            return read_from(file)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _saved(content: bytes) -> Rows:
    """Read rows with named columns from the content of a file of ``np.save``."""
    if not content.startswith(b"\x93NUMPY"):
        raise ValueError("no file of np.save")
    try:
        rows: Rows = np.load(io.BytesIO(content), allow_pickle=False)
    except Exception as error:  # a damaged head is evaluated as Python
        raise ValueError(f"a damaged file of np.save, or one of objects: {error}") from None
    if rows.ndim != 1 or "time" not in (rows.dtype.names or ()):
        raise ValueError(
            f"an array of shape {rows.shape} and type {rows.dtype}, expected rows with named "
            "columns, one of them time, as the record of an engine has"
        )
    return rows


def _joined(one: Record, two: Record, path: str | os.PathLike[str]) -> Record:
    """Put the rows of two records of one run together."""
    if not (one.rows.size and two.rows.size):
        return one if one.rows.size else two
    if one.lacks != two.lacks:
        before, here = (each.lacks or "nothing" for each in (one, two))
        raise ValueError(f"{path}: it lacks {here}, but the file before it lacks {before}")
    surface = one.surface
    if surface is not None and two.surface is not None:
        if not np.array_equal(surface.corners, two.surface.corners):
            raise ValueError(f"{path}: is of another run: its walls are others")
        triangle = np.concatenate([surface.triangle, two.surface.triangle])
        known = [each for each in (surface.point, two.surface.point) if each is not None]
        point = np.concatenate(known) if len(known) > 1 else None
        surface = surface._replace(triangle=triangle, point=point)
    bodies = [*one.bodies, *(each for each in two.bodies if each not in one.bodies)]
    number = np.array([*(bodies.index(each) for each in two.bodies), -1])
    rows = np.concatenate([one.rows, two.rows])
    return Record(rows, bodies, np.r_[one.which, number[two.which]], surface, one.made)


def _material(group: h5py.Group) -> Material:
    names = [name for name in Material.__dataclass_fields__ if name in group.attrs]
    stored: dict[str, Any] = {name: np.asarray(group.attrs[name]).tolist() for name in names}
    errors = json.loads(stored.pop("uncertainty", "{}")).items()
    # 0.3 stored inf and negative numbers for specified minima, whose errors are not stated.
    return Material(**stored, uncertainty={name: error for name, error in errors if 0.0 <= error <= 1.0})


def _write_surface(group: h5py.Group, surface: Surface) -> None:
    write(group, "wall", surface.wall, "1", "number of the wall of each triangle")
    write(group, "triangle", surface.triangle, "1", "number of the triangle of each row, -1: none")
    group.attrs["names"] = list(surface.names)
    for name, points in zip(_PLACES, (surface.corners.reshape(-1, 3), surface.point), strict=True):
        for axis, values in zip("xyz", () if points is None else points.T, strict=points is not None):
            write(group, f"{name}_{axis}", values, "m", f"{_PLACES[name]}, at the start of the run")


def _read_surface(group: h5py.Group, size: int) -> Surface:
    wall = hdf5.numbers(group, "wall").astype(np.int64)
    triangle = hdf5.indices(group, "triangle", wall.size, size)
    corners = _points(group, "corner", 3 * wall.size).reshape(-1, 3, 3)
    point = _points(group, "point", size) if "point_x" in group else None
    names = [str(name) for name in group.attrs.get("names", ())]
    return Surface(corners, wall, triangle, point, names)


def _points(group: h5py.Group, name: str, size: int) -> Array:
    return np.stack([hdf5.numbers(group, f"{name}_{axis}", size) for axis in "xyz"], axis=1)
