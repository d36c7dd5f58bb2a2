"""Tables on disk: one HDF5 file per law, which any HDF5 program reads.

The file begins with a user block, which HDF5 leaves to applications: one line with the SHA-256 of
all that follows. A reader checks it before HDF5 sees a byte, so a file that was cut short or
altered is refused with a sentence, whatever HDF5 would have made of it.
"""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import hashlib
import io
import json
import math
import os
import tempfile
from dataclasses import asdict
from importlib import resources
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw._version import VERSION
from contactlaw.equation.outcome import STORED
from contactlaw.laws import Law
from contactlaw.table import grid as grids
from contactlaw.table import shapes
from contactlaw.table.certificate import Certificate
from contactlaw.table.grid import Grid, Segment, Settings
from contactlaw.table.nodes import Table, shape_grid

FORMAT = "contactlaw table"
SCHEMA = 3
_BLOCK = 512  # bytes; the smallest user block of HDF5
_LARGEST_LAW = 1_000_000  # numbers
_MOST_COLUMNS = 1_000_000
_LONGEST = 1e9  # contact time [T_H] of a plate that is far too thin
_SEGMENT = {
    "start": "ln chi of the kink at which it begins, over series_inelasticity [-]",
    "end": "ln chi of the kink at which it ends [-]",
    "shares": "of the way from start to end, of the columns of fields/ [-]",
}
_RANGES = {
    "restitution": (0.0, 1.0),
    "contact_time": (1e-6, _LONGEST),
    "wave_rate": (0.0, 1e6),
    "compression_ratio": (1e-6, 1e6),
}


class DamagedTableError(ValueError):
    """A file that is no complete and unaltered table of this version."""


def write(table: Table, path: str | os.PathLike[str]) -> None:
    """Write a table; the file appears complete or not at all.

    Parameters
    ----------
    table : Table
        What `contactlaw.table.build` returned.
    path : path-like
        Where to; an existing file is replaced.

    Raises
    ------
    OSError
        If the folder does not exist, is not writable or full; nothing is left behind then.
    """
    path = Path(path)
    content = _serialise(table)
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())  # or a power cut could leave the name without the content
        os.chmod(name, 0o644)  # mkstemp makes it private; a table is for everyone
        os.replace(name, path)
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(name)
        raise


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
        law=law.name,
        law_source=law.source,
        contactlaw_version=VERSION,
        **asdict(table.settings),
    )
    file["law"] = law.data
    file["law"].attrs.update(_law_attributes(law))
    datasets = {
        "inelasticity": (grid.inelasticity, "lambda of the rows of fields/ [-]"),
        "series_inelasticity": (grid.series_inelasticity(), "lambda of what follows [-]"),
        "elastic_compression": (grid.elastic_compression, "w_m, of an elastic impact [V0 T_H]"),
        **{
            f"segments/{k}/{name}": (getattr(segment, name), description)
            for k, segment in enumerate(grid.segments)
            for name, description in _SEGMENT.items()
        },
        **{f"fields/{name}": (table.fields[name], STORED[name]) for name in STORED},
    }
    if table.states is not None:
        shape_nodes = shape_grid(table)
        datasets |= {
            "shapes/inelasticity": (shape_nodes.inelasticity, "lambda of the rows of states [-]"),
            "shapes/log_overload": (shape_nodes.log_overload(), "ln chi of the states [-]"),
            "shapes/shares": (shapes.SHARES, "of the largest root compression, up and down [-]"),
            "shapes/states": (table.states, "when it passes them: times [T_H], speeds [V0]"),
        }
    for name, (values, description) in datasets.items():
        file[name] = values
        file[name].attrs["description"] = description
    for k, segment in enumerate(grid.segments):
        file[f"segments/{k}"].attrs["graded"] = segment.graded
    if table.certificate is not None:
        file.attrs["certificate"] = json.dumps(asdict(table.certificate))
    file.attrs["complete"] = True  # last: a file cut short opens without complaint


def _law_attributes(law: Law) -> dict[str, Any]:
    return {
        "description": "force law, see contactlaw.equation.force [d_Y, F_Y]",
        "loading_kinks": law.loading_kinks,
        "outcome_kinks": law.outcome_kinks,
        "yield_coefficient": law.yield_coefficient,
        "yield_strains": law.yield_strains,
    }


def read(path: str | os.PathLike[str]) -> Table:
    """Read a table and verify it: checksum, schema, completeness, finiteness.

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
    DamagedTableError
        If the file is no table, was altered or cut short, has another schema or holds a value
        that is not finite; the message says how to rebuild it.
    """
    path = Path(path)
    remedy = "Build it again with: contactlaw table build --out FILE"
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise FileNotFoundError(f"table: there is no file {path}. {remedy}") from None
    try:
        return _parse(content)
    except (OSError, KeyError, ValueError, TypeError) as error:
        raise DamagedTableError(f"table: cannot use {path}: {error}. {remedy}") from error


def _parse(content: bytes) -> Table:
    head = content[:_BLOCK].rstrip(b"\0").decode("ascii", "replace").split()
    if head[:-1] != [*FORMAT.split(), "sha256"]:
        raise ValueError("it is not a table, or its first bytes were altered")
    if head[-1] != hashlib.sha256(content[_BLOCK:]).hexdigest():
        raise ValueError("its checksum does not fit: it was cut short or altered")
    with h5py.File(io.BytesIO(content), "r") as file:
        found = {key: file.attrs.get(key) for key in ("format", "schema", "complete")}
        if found != {"format": FORMAT, "schema": SCHEMA, "complete": True}:
            raise ValueError(f"it is not a complete table of schema {SCHEMA}, but {found}")
        return _from_file(file)


def _from_file(file: h5py.File) -> Table:
    """Table of an open file: shapes and kinds first, then the numbers, then their ranges."""
    settings = Settings(**{k: type(v)(file.attrs[k]) for k, v in asdict(Settings()).items()})
    law = _law(file)
    certificate = file.attrs.get("certificate")
    table = Table(
        law=law,
        settings=settings,
        grid=_grid(file, settings, law),
        fields={},
        certificate=None if certificate is None else Certificate(**json.loads(certificate)),
    )
    rows = table.grid.inelasticity.size
    fields = {
        name: _numbers(file, f"fields/{name}", (rows, table.grid.columns), *limits)
        for name, limits in _RANGES.items()
    }
    table = dataclasses.replace(table, fields=fields)
    if "shapes" not in file:
        return table
    shares = _numbers(file, "shapes/shares", shapes.SHARES.shape, 0.0, 1.0)
    if not np.array_equal(shares, shapes.SHARES):
        raise ValueError("its shapes/shares are not those of this version")
    nodes = shape_grid(table)
    shape = (nodes.inelasticity.size, nodes.columns, 2, shapes.SIZE)
    states = _numbers(file, "shapes/states", shape, -2.0, _LONGEST, "f4")
    return dataclasses.replace(table, states=states)


def _law(file: h5py.File) -> Law:
    data, attributes = file["law"], file["law"].attrs
    if data.ndim != 1 or not 0 < data.size <= _LARGEST_LAW:
        raise ValueError(f"its law has the shape {data.shape}")
    least, largest = attributes["yield_strains"]
    return Law(
        name=str(file.attrs["law"]),
        source=str(file.attrs["law_source"]),
        yield_coefficient=float(attributes["yield_coefficient"]),
        loading_kinks=tuple(float(kink) for kink in attributes["loading_kinks"]),
        outcome_kinks=tuple(float(kink) for kink in attributes["outcome_kinks"]),
        data=_numbers(file, "law", data.shape, -math.inf, math.inf),
        yield_strains=(float(least), float(largest)),
    )


def _grid(file: h5py.File, settings: Settings, law: Law) -> Grid:
    """Nodes, which have to be those of the settings and of the law."""
    rows, end = settings.inelasticity_nodes, math.log(settings.largest_overload)
    inelasticity = _numbers(file, "inelasticity", (rows,), 0.0, settings.largest_inelasticity)
    expected = grids.row_inelasticity(rows, settings.stretch, settings.largest_inelasticity)
    if not np.array_equal(inelasticity, expected):
        raise ValueError("its rows, the axes along lambda, are not those of its settings")
    elastic = _numbers(file, "elastic_compression", (grids.SERIES,), 1e-6, 2.0)
    segments = []
    for k in range(len(file["segments"])):
        group = file[f"segments/{k}"]
        start, stop = (
            _numbers(group, name, (grids.SERIES,), 0.0, end) for name in ("start", "end")
        )
        count = group["shares"].size
        if not 0 < count <= _MOST_COLUMNS:
            raise ValueError(f"its segment {k} has {count} columns")
        shares = _numbers(group, "shares", (count,), 0.0, 1.0)
        segments.append(Segment(start, stop, shares, bool(group.attrs["graded"])))
    grids.check(segments, law, end)
    return Grid(
        settings.stretch, settings.largest_inelasticity, elastic, inelasticity, tuple(segments)
    )


def _numbers(
    group: h5py.Group, name: str, shape: tuple[int, ...], low: float, high: float, kind: str = "f8"
) -> NDArray[Any]:
    """Numbers of a dataset: its shape, kind and place before a byte of it, then their range."""
    data = group[name]
    if not isinstance(data, h5py.Dataset) or data.shape != shape or data.dtype != np.dtype(kind):
        raise ValueError(f"its {name} is {data}, not {kind} of the shape {shape} of its axes")
    if data.external or data.is_virtual:
        raise ValueError(f"its {name} is stored in another file")
    values: NDArray[Any] = data[()]
    if np.isnan(values).any():
        raise ValueError(f"its {name} holds values that are not finite")
    if not ((values >= low) & (values <= high)).all():
        raise ValueError(f"its {name} holds values outside {low:g} to {high:g}")
    return values


@functools.cache
def packaged(law: Law) -> Table | None:
    """Read the table of a law that ships with the package; None for a law without one.

    The last digits of a law's data depend on the machine that made them, so that the packaged
    table serves a law that agrees with its own to 1e-11.

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
