"""Tables on disk: one HDF5 file per law, which any HDF5 program reads.

The file begins with a user block, which HDF5 leaves to applications: one line with the SHA-256 of
all that follows. A reader checks it before HDF5 sees a byte, so a file that was cut short or
altered is refused with a sentence, whatever HDF5 would have made of it. The checksum shows damage,
not intent: a file that fits it is checked for the datasets below and what kernels rely on, no more.
"""

import dataclasses
import functools
import hashlib
import io
import json
import math
import os
from collections.abc import Mapping
from dataclasses import asdict
from importlib import resources
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw import _atomic
from contactlaw._content import content_of
from contactlaw._version import VERSION
from contactlaw.equation import force
from contactlaw.equation.outcome import STORED
from contactlaw.laws import Law, Strengths
from contactlaw.table import grid as grids
from contactlaw.table import lookup, shapes
from contactlaw.table.axes import SERIES, Axis, Segment, TableGrid, series_values
from contactlaw.table.certificate import Certificate
from contactlaw.table.grid import Settings
from contactlaw.table.nodes import Table, shape_grid

FORMAT = "contactlaw table"
SCHEMA = 7
_BLOCK = 512  # bytes; the smallest user block of HDF5
LARGEST = 1 << 30  # bytes of a file, our choice: 700 times the packaged table, and a PC can hold it


class _Part(NamedTuple):
    """A dataset of numbers. They lie between two limits, so that none is NaN."""

    description: str
    shape: tuple[int, ...] = ()  # without one it is a row of any length
    least: float = -math.inf
    largest: float = math.inf
    kind: type = np.float64


# The datasets of each group by name, in the order in which they are written.
_LAW = {
    "data": _Part("force law, see contactlaw.equation.force [d_Y, F_Y]"),
    "loading_kinks": _Part("of the loading curve [d_Y]"),
    "outcome_kinks": _Part("of the outcomes [d_Y]"),
    "waves": _Part("of plates, see contactlaw.equation.corrections; none: thin [-]"),
}
_SERIES = {
    "series_inelasticity": _Part("lambda of what follows [-]", (SERIES,)),
    # w_m is (5/4)^(2/5) at lambda = 0 and falls with lambda; beyond a law's range it may be larger
    "elastic_compression": _Part("w_m, of an elastic impact [V0 T_H]", (SERIES,), 1e-4, 1.3),
}
_SEGMENT = {
    "start": _Part("where it begins along its axis, over series_inelasticity [-]", (SERIES,)),
    "end": _Part("where it ends [-]", (SERIES,)),
    "shares": _Part("of the way from start to end in x = v/(v + stretch), v itself if inf, at nodes [-]"),
}


_STRENGTHS = {
    "data": _Part("force laws at all strengths, see contactlaw.equation.force [d_Y, F_Y]"),
    "knots": _Part("ln of the strength, between which outcomes are smooth [-]"),
    "cells": _Part("between each two of them [-]", kind=np.int64, least=3, largest=1000),
}


def _fields(grid: TableGrid) -> dict[str, _Part]:
    return {name: _Part(one.description, grid.shape, one.least, one.largest) for name, one in STORED.items()}


def _by_strength(grid: TableGrid) -> dict[str, _Part]:
    shape = len(grid.axes[2].segments), lookup.ROWS, lookup.TERMS
    return {"by_strength": _Part("polynomials, see contactlaw.table.lookup [-]", shape, -1e3, 1e3)}


def _shapes(grid: TableGrid) -> dict[str, _Part]:
    return {
        "shares": _Part("of the largest root compression, up and down [-]", (shapes.STATES,)),
        "states": _Part(
            "when it passes them: times [T_H], speeds [V0]",
            shape=(*grid.shape, 2, shapes.SIZE),
            least=-1.0,
            largest=1e4,
            kind=np.float32,
        ),
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
        File to write; an existing one is replaced.

    Raises
    ------
    OSError
        If the folder does not exist, is not writable or full; nothing is left behind then.
    """
    _atomic.write(path, _serialise(table))


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
    _put(file, "law", _LAW, {**vars(law), "waves": law.waves or ()})
    series = series_values(grid.axes[0])
    _put(file, "", _SERIES, {**vars(grid), "series_inelasticity": series})
    if law.strengths is not None:
        _put(file, "strengths", _STRENGTHS, law.strengths._asdict())
        _put(file, "strengths", _by_strength(grid), vars(grid))
    for axis in grid.axes:
        for k, segment in enumerate(axis.segments):
            _put(file, f"axes/{axis.name}/{k}", _SEGMENT, segment._asdict())
            file[f"axes/{axis.name}/{k}"].attrs["graded"] = segment.graded
        file[f"axes/{axis.name}"].attrs["stretch"] = axis.stretch
    _put(file, "fields", _fields(grid), table.fields)
    if table.states is not None:
        states = {"shares": shapes.SHARES, "states": table.states}
        _put(file, "shapes", _shapes(shape_grid(table)), states)
    file.create_group("law/parameters", track_order=True).attrs.update(law.parameters)
    if table.certificate is not None:
        file.attrs["certificate"] = json.dumps(asdict(table.certificate))


def _put(file: h5py.File, group: str, parts: dict[str, _Part], values: Mapping[str, Any]) -> None:
    for name, part in parts.items():
        file[f"{group}/{name}"] = np.asarray(values[name], dtype=part.kind)
        file[f"{group}/{name}"].attrs["description"] = part.description


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
        content = content_of(path, LARGEST)
    except FileNotFoundError:
        raise FileNotFoundError(f"table: there is no file {path}. {remedy}") from None
    except ValueError as error:
        raise DamagedTableError(f"table: cannot use {path}: {error}. {remedy}") from error
    try:
        return _parse(content)
    except (OSError, LookupError, ValueError, TypeError, RuntimeError, AttributeError) as error:
        raise DamagedTableError(f"table: cannot use {path}: {error}. {remedy}") from error


def _parse(content: bytes) -> Table:
    head = content[:_BLOCK].rstrip(b"\0").decode("ascii", "replace").split()
    if head[:-1] != [*FORMAT.split(), "sha256"]:
        raise ValueError("it is not a table, or its first bytes were altered")
    if head[-1] != hashlib.sha256(memoryview(content)[_BLOCK:]).hexdigest():
        raise ValueError("its checksum does not fit: it was cut short or altered")
    with h5py.File(io.BytesIO(content), "r") as file:
        if (found := file.attrs.get("schema")) != SCHEMA:
            raise ValueError(f"it is a table of schema {found}, not {SCHEMA}")
        return _from_file(file)


def _from_file(file: h5py.File) -> Table:
    settings = Settings(**{k: type(v)(file.attrs[k]) for k, v in asdict(Settings()).items()})
    law = _law(file)
    axes = grids.axes_with(_overloads(file), law, settings)
    grid = TableGrid(axes, _take(file, "", _SERIES)["elastic_compression"])
    if law.strengths is not None:
        rows = _take(file, "strengths", _by_strength(grid))["by_strength"]
        grid = dataclasses.replace(grid, by_strength=rows)
    errors = file.attrs.get("certificate")
    certificate = None if errors is None else Certificate(**json.loads(errors))
    fields = _take(file, "fields", _fields(grid))
    table = Table(law, settings, grid, fields, certificate=certificate)
    if "shapes" not in file:
        return table
    found = _take(file, "shapes", _shapes(shape_grid(table)))
    # numpy's functions differ in the last digit between its versions and between processors
    if not np.allclose(found["shares"], shapes.SHARES, rtol=1e-12, atol=1e-12):
        raise ValueError("its shapes/shares are not those of this version")
    if not (np.diff(found["states"][..., 0, :]) > 0.0).all():
        raise ValueError("its shapes/states hold times that do not grow")
    return dataclasses.replace(table, states=found["states"])


def _take(file: h5py.Group, group: str, parts: dict[str, _Part]) -> dict[str, NDArray[Any]]:
    """Read the datasets of a group; refuse other shapes and types, and what no table holds."""
    found = {}
    for name, part in parts.items():
        dataset = file[f"{group}/{name}"]
        where = dataset.name.lstrip("/")
        shape, kind = part.shape or (dataset.size,), np.dtype(part.kind)
        if (dataset.shape, dataset.dtype.newbyteorder("=")) != (shape, kind):
            what = f"{dataset.dtype} of shape {dataset.shape}"
            raise ValueError(f"its {where} holds {what}, not {kind} of shape {shape}")
        if dataset.nbytes > LARGEST:  # a few bytes of a file may declare an array of any size
            raise ValueError(f"its {where} has {dataset.nbytes} bytes, above {LARGEST}")
        values = dataset[()].astype(kind, copy=False)
        outside = values[~((values >= part.least) & (values <= part.largest))]
        if outside.size:
            limits = f"{part.least:g} to {part.largest:g}"
            raise ValueError(f"its {where} holds {outside[0]:.6g}, outside {limits}")
        found[name] = values
    return found


def _law(file: h5py.File) -> Law:
    """Read the law of a table; its data are checked, since kernels follow addresses in them."""
    found = _take(file, "law", _LAW)
    force.check(found["data"])
    strengths = None
    if "strengths" in file:
        several = _take(file, "strengths", _STRENGTHS)
        force.check_strengths(several["data"])
        knots, cells = (tuple(several[name].tolist()) for name in ("knots", "cells"))
        strengths = Strengths(several["data"], knots, cells)
    coefficient, scale, smallest, largest = (
        float(file.attrs[name]) for name in ("yield_coefficient", "law_scale", "law_smallest", "law_largest")
    )
    return Law(
        family=file.attrs["law"],
        parameters={name: float(value) for name, value in file["law/parameters"].attrs.items()},
        source=file.attrs["law_source"],
        yield_coefficient=None if math.isnan(coefficient) else coefficient,
        loading_kinks=tuple(found["loading_kinks"].tolist()),
        outcome_kinks=tuple(found["outcome_kinks"].tolist()),
        data=found["data"],
        scale=None if math.isnan(scale) else scale,
        range=(smallest, largest),
        waves=tuple(found["waves"].tolist()) or None,
        strengths=strengths,
    )


def _overloads(file: h5py.File) -> Axis:
    """Read the axis of ln chi; the others follow from the law and the settings."""
    group = file["axes/log_overload"]
    segments = (
        Segment(**_take(group, k, _SEGMENT), graded=bool(group[k].attrs["graded"])) for k in map(str, range(len(group)))
    )
    return Axis(grids.AXES[1], tuple(segments), float(group.attrs["stretch"]))


@functools.lru_cache(maxsize=16)
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
