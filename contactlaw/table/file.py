"""Tables on disk: one HDF5 file per law, which any HDF5 program reads.

The file begins with a user block, which HDF5 leaves to applications: one line with the SHA-256 of
all that follows. A reader checks it before HDF5 sees a byte, so a file that was cut short or
altered is refused with a sentence, whatever HDF5 would have made of it.
"""

from __future__ import annotations

import dataclasses
import errno
import functools
import hashlib
import io
import json
import math
import os
from dataclasses import asdict
from importlib import resources
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from contactlaw import _atomic
from contactlaw._version import VERSION
from contactlaw.equation import force
from contactlaw.equation.outcome import STORED
from contactlaw.laws import Law
from contactlaw.table import grid as grids
from contactlaw.table import guarded, shapes
from contactlaw.table.axes import SERIES, Axis, Grid, Segment, series_values
from contactlaw.table.certificate import BOUNDS, Certificate
from contactlaw.table.grid import Settings
from contactlaw.table.nodes import Table, shape_grid

FORMAT = "contactlaw table"
SCHEMA = 6
_BLOCK = 512  # bytes; the smallest user block of HDF5
LARGEST = 1 << 30  # bytes of a file, our choice: 700 times the packaged table, and a PC can hold it
_LARGEST_LAW = 1_000_000  # numbers in a law's data
_MOST_KINKS, _MOST_NODES = 1000, 1_000_000
_SEGMENT = {
    "start": "where it begins along its axis, over series_inelasticity [-]",
    "end": "where it ends [-]",
    "shares": "of the way from start to end in x = v/(v + stretch), v itself if inf, at nodes [-]",
}
# Limits of the stored numbers. w_m is (5/4)^(2/5) at lambda = 0 and falls with lambda; beyond the
# end of a law's range it may be larger.
_RANGES = {
    **{name: (stored.least, stored.largest) for name, stored in STORED.items()},
    "elastic_compression": (0.01, 1.3),
    "times of shapes/states": (0.0, 1e4),
    "speeds of shapes/states": (-1.0, 1.0),
}
_HEAD = {"format": FORMAT, "schema": SCHEMA, "complete": True}
_ENERGY = 1e-3  # COR^2 and wave share may sum up to 1 and this, since tables may be coarse


class DamagedTableError(ValueError):
    """A file that is no complete and unaltered table of this version."""


def write(table: Table, path: str | os.PathLike[str]) -> None:
    """Write a table; the file appears complete or not at all.

    Parameters
    ----------
    table : Table
        What `contactlaw.table.build` returned.
    path : path-like
        File to write; an existing one is replaced.

    Raises
    ------
    OSError
        If the folder does not exist, is not writable or full, or the table is larger than `read`
        accepts; nothing is left behind then.
    """
    content = _serialise(table)
    if len(content) > LARGEST:
        raise OSError(
            errno.EFBIG,
            f"table: it has {len(content)} bytes, above the limit of {LARGEST}: take coarser "
            "Settings",
        )
    _atomic.write(path, content)


def _serialise(table: Table) -> bytes:
    image = io.BytesIO()
    with h5py.File(image, "w", userblock_size=_BLOCK) as file:
        _fill(file, table)
    return _sign(image.getvalue()[_BLOCK:])


def _sign(content: bytes) -> bytes:
    digest = hashlib.sha256(content).hexdigest()
    return f"{FORMAT} sha256 {digest}\n".encode().ljust(_BLOCK, b"\0") + content


def _fill(file: h5py.File, table: Table) -> None:
    law, grid = table.law, table.grid
    file.attrs.update(
        format=FORMAT,
        schema=SCHEMA,
        law=law.family,
        law_source=law.source,
        yield_coefficient=math.nan if law.yield_coefficient is None else law.yield_coefficient,
        law_scale=math.nan if law.scale is None else law.scale,
        law_smallest=law.range[0],
        law_largest=law.range[1],
        contactlaw_version=VERSION,
        **asdict(table.settings),
    )
    datasets: dict[str, tuple[ArrayLike, str]] = {
        "law/data": (law.data, "force law, see contactlaw.equation.force [d_Y, F_Y]"),
        "law/loading_kinks": (law.loading_kinks, "of the loading curve [d_Y]"),
        "law/outcome_kinks": (law.outcome_kinks, "of the outcomes [d_Y]"),
        "law/waves": (law.waves or (), "of plates, see contactlaw.equation.waves; none: thin [-]"),
        "series_inelasticity": (series_values(grid.axes[0]), "lambda of what follows [-]"),
        "elastic_compression": (grid.elastic_compression, "w_m, of an elastic impact [V0 T_H]"),
        **{
            f"axes/{axis.name}/{k}/{name}": (getattr(segment, name), description)
            for axis in grid.axes
            for k, segment in enumerate(axis.segments)
            for name, description in _SEGMENT.items()
        },
        **{f"fields/{name}": (table.fields[name], STORED[name].description) for name in STORED},
    }
    if table.states is not None:
        nodes = dict(zip(grids.AXES, shape_grid(table).nodes(), strict=True))
        datasets |= {
            **{f"shapes/{name}": (values, "of the states [-]") for name, values in nodes.items()},
            "shapes/shares": (shapes.SHARES, "of the largest root compression, up and down [-]"),
            "shapes/states": (table.states, "when it passes them: times [T_H], speeds [V0]"),
        }
    for name, (values, description) in datasets.items():
        file[name] = np.asarray(values, dtype=getattr(values, "dtype", np.float64))
        file[name].attrs["description"] = description
    file.create_group("law/parameters", track_order=True).attrs.update(law.parameters)
    for axis in grid.axes:
        file[f"axes/{axis.name}"].attrs["stretch"] = axis.stretch
        for k, segment in enumerate(axis.segments):
            file[f"axes/{axis.name}/{k}"].attrs["graded"] = segment.graded
    if table.certificate is not None:
        file.attrs["certificate"] = json.dumps(asdict(table.certificate))
    file.attrs["complete"] = True  # last: a file cut short opens without complaint


def read(path: str | os.PathLike[str]) -> Table:
    """Read a table and verify it: size, checksum, schema, completeness, ranges.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    Table

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    OSError
        If it cannot be opened or read.
    DamagedTableError
        If the file is no table, was altered or cut short, has another schema or holds a value
        that no table has; the message says how to rebuild it.
    """
    path = Path(path)
    remedy = "Build it again with: contactlaw table build --law LAW --out FILE"
    try:
        content = guarded.content(path, LARGEST)
    except FileNotFoundError:
        raise FileNotFoundError(f"table: there is no file {path}. {remedy}") from None
    except ValueError as error:
        raise DamagedTableError(f"table: cannot use {path}: {error}. {remedy}") from error
    try:
        return _parse(content)
    except (OSError, KeyError, ValueError, TypeError, RuntimeError) as error:
        raise DamagedTableError(f"table: cannot use {path}: {error}. {remedy}") from error


def _parse(content: bytes) -> Table:
    head = content[:_BLOCK].rstrip(b"\0").decode("ascii", "replace").split()
    if head[:-1] != [*FORMAT.split(), "sha256"]:
        raise ValueError("it is not a table, or its first bytes were altered")
    if head[-1] != hashlib.sha256(memoryview(content)[_BLOCK:]).hexdigest():
        raise ValueError("its checksum does not fit: it was cut short or altered")
    with h5py.File(io.BytesIO(content), "r") as file:
        found = {
            key: guarded.attribute(file, key, type(value)) if key in file.attrs else None
            for key, value in _HEAD.items()
        }
        if found != _HEAD:
            raise ValueError(f"it is not a complete table of schema {SCHEMA}, but {found}")
        table = _from_file(file)
    _check_ranges(table)
    return table


def _from_file(file: h5py.File) -> Table:
    settings = Settings(
        **{k: guarded.attribute(file, k, type(v)) for k, v in asdict(Settings()).items()}
    )
    law = _law(file)
    table = Table(law, settings, _grid(file, settings, law), {}, certificate=_certificate(file))
    fields = {name: _values(file, f"fields/{name}", *table.grid.shape) for name in STORED}
    table = dataclasses.replace(table, fields=fields)
    if "shapes" not in file:
        return table
    # numpy's functions differ in the last digit between its versions and between processors
    shares = _values(file, "shapes/shares", shapes.STATES)
    if not np.allclose(shares, shapes.SHARES, rtol=1e-12, atol=1e-12):
        raise ValueError("its shapes/shares are not those of this version")
    shape = *shape_grid(table).shape, 2, shapes.SIZE
    states = _values(file, "shapes/states", *shape, kind=np.float32)
    return dataclasses.replace(table, states=states)


def _values(file: h5py.File, name: str, *shape: int, kind: DTypeLike = np.float64) -> NDArray[Any]:
    return guarded.values(guarded.member(file, name), shape, kind)


def _law(file: h5py.File) -> Law:
    """Read the law of a table; its data are checked, since kernels follow addresses in them."""
    numbers = _listed(file, "law/data", _LARGEST_LAW)
    force.check(numbers)
    parameters = guarded.member(file, "law/parameters")
    waves = _listed(file, "law/waves", 4).tolist()
    if len(waves) not in (0, 4):
        raise ValueError(f"its law/waves are {len(waves)} numbers, not 4 or none")
    coefficient, scale, smallest, largest = (
        guarded.attribute(file, name, float)
        for name in ("yield_coefficient", "law_scale", "law_smallest", "law_largest")
    )
    return Law(
        family=guarded.attribute(file, "law", str),
        parameters={name: guarded.attribute(parameters, name, float) for name in parameters.attrs},
        source=guarded.attribute(file, "law_source", str),
        yield_coefficient=None if math.isnan(coefficient) else coefficient,
        loading_kinks=tuple(_listed(file, "law/loading_kinks", _MOST_KINKS).tolist()),
        outcome_kinks=tuple(_listed(file, "law/outcome_kinks", _MOST_KINKS).tolist()),
        data=numbers,
        scale=None if math.isnan(scale) else scale,
        range=(smallest, largest),
        waves=tuple(waves) or None,
    )


def _listed(file: h5py.File, name: str, most: int) -> NDArray[Any]:
    """Read a dataset whose length is not known beforehand, up to a limit."""
    dataset = guarded.member(file, name)
    count = getattr(dataset, "shape", None)
    if not isinstance(count, tuple) or len(count) != 1 or not count[0] <= most:
        raise ValueError(f"its {name} has the shape {count}")
    return guarded.values(dataset, count, np.float64)


def _grid(file: h5py.File, settings: Settings, law: Law) -> Grid:
    """Read the nodes; refuse those of other settings or of another law."""
    axes = tuple(_axis(file, name) for name in grids.AXES)
    grids.check(axes, law, settings)
    return Grid(axes, _values(file, "elastic_compression", SERIES))


def _axis(file: h5py.File, name: str) -> Axis:
    group = guarded.member(file, f"axes/{name}")
    segments = []
    for k in range(len(group)):
        start, end = (_values(file, f"axes/{name}/{k}/{end}", SERIES) for end in ("start", "end"))
        shares = _listed(file, f"axes/{name}/{k}/shares", _MOST_NODES)
        graded = guarded.attribute(guarded.member(group, str(k)), "graded", bool)
        segments.append(Segment(start, end, shares, graded))
    return Axis(name, tuple(segments), guarded.attribute(group, "stretch", float))


def _certificate(file: h5py.File) -> Certificate | None:
    if "certificate" not in file.attrs:
        return None
    found = Certificate(**json.loads(guarded.attribute(file, "certificate", str)))
    numbers: list[float] = [found.points, found.seed]
    names = BOUNDS.keys() - (set() if "shapes" in file else {"force_history"})
    for errors in (found.median, found.percentile_99, found.largest):
        if not isinstance(errors, dict) or errors.keys() != names:
            raise ValueError("its certificate does not name the errors of each field")
        numbers += errors.values()
    if not all(type(number) in (int, float) and 0 <= number < math.inf for number in numbers):
        raise ValueError("its certificate holds what is no error")
    return found


def _check_ranges(table: Table) -> None:
    """Refuse numbers that no solver gave; NaN is outside of any range."""
    arrays: dict[str, NDArray[Any]] = {
        **table.fields,
        "elastic_compression": table.grid.elastic_compression,
    }
    if table.states is not None:
        arrays["times of shapes/states"] = table.states[:, :, 0]
        arrays["speeds of shapes/states"] = table.states[:, :, 1]
    for name, values in arrays.items():
        low, high = _RANGES[name]
        least, largest = values.min(), values.max()
        if not np.isfinite(least + largest):
            raise ValueError(f"its {name} has values that are not finite")
        if not low <= least <= largest <= high:
            raise ValueError(
                f"its {name} reach from {least:.6g} to {largest:.6g}, outside {low:g} to {high:g}"
            )
    waves = table.grid.rows[:, None] * table.fields["wave_rate"]
    if not (table.fields["restitution"] ** 2 + waves <= 1.0 + _ENERGY).all():
        raise ValueError("it holds impacts that gain energy")
    if table.states is not None and not (np.diff(table.states[:, :, 0]) > 0.0).all():
        raise ValueError("its shapes/states hold times that do not grow")


@functools.cache
def packaged(law: Law) -> Table | None:
    """Read the table of a law that ships with the package; None for a law without one.

    The last digits of a law's data depend on the machine that made them: the packaged table serves
    any law that agrees with its own to 1e-11.

    Raises
    ------
    DamagedTableError
        If the installed file is damaged.
    """
    with resources.as_file(resources.files("contactlaw") / "data" / f"{law.name}.h5") as path:
        if not path.exists():
            return None
        try:
            found = read(path)
        except DamagedTableError as error:
            raise DamagedTableError(
                f"the installed package is damaged, reinstall contactlaw: {error.__cause__}"
            ) from error
    return dataclasses.replace(found, law=law) if found.law.follows(law) else None
