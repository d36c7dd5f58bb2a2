"""Tables on disk: one HDF5 file per law, which any HDF5 program reads.

The file begins with a user block, which HDF5 leaves to applications: one line with the SHA-256 of
all that follows. A reader checks it before HDF5 sees a byte, so a file that was cut short or
altered is refused with a sentence, whatever HDF5 would have made of it.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import io
import json
import os
import tempfile
from dataclasses import asdict
from importlib import resources
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw import laws, shapes
from contactlaw._version import VERSION
from contactlaw.table import FIELDS, Certificate, Settings, Table, axes, shape_axes

FORMAT = "contactlaw table"
SCHEMA = 2
_BLOCK = 512  # bytes; the smallest user block of HDF5


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
    law = laws.law(table.law)
    file.attrs.update(
        format=FORMAT,
        schema=SCHEMA,
        law=table.law,
        law_source=law.source,
        contactlaw_version=VERSION,
        **asdict(table.settings),
    )
    rows, *columns = shape_axes(law, table.settings)
    datasets = {
        "inelasticity": (table.inelasticity, "lambda of the rows of fields/ [-]"),
        "kinks": (law.kinks, "compressions at which the law is not smooth [d_Y]"),
        "elastic_inelasticity": (table.elastic_inelasticity, "lambda of elastic_compression [-]"),
        "elastic_compression": (table.elastic_compression, "w_m, of an elastic impact [V0 T_H]"),
        **{
            f"log_overload/{k}": (nodes, "ln chi of columns of fields/, from kink to kink [-]")
            for k, nodes in enumerate(table.segments)
        },
        **{f"fields/{name}": (table.fields[name], FIELDS[name]) for name in FIELDS},
        "shapes/inelasticity": (rows, "lambda of the rows of shapes/states [-]"),
        "shapes/log_overload": (np.concatenate(columns), "ln chi of its columns [-]"),
        "shapes/shares": (shapes.SHARES, "of the largest root compression, up and down again [-]"),
        "shapes/states": (table.states, "when it passes them: times [T_H], speeds [V0]"),
    }
    for name, (values, description) in datasets.items():
        file[name] = values
        file[name].attrs["description"] = description
    if table.certificate is not None:
        file.attrs["certificate"] = json.dumps(asdict(table.certificate))
    file.attrs["complete"] = True  # last: a file cut short opens without complaint


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
        table = _from_file(file)
    arrays: list[NDArray[Any]] = [*table.segments, *table.fields.values()]
    arrays += [table.elastic_compression, table.states]
    if not all(bool(np.isfinite(values).all()) for values in arrays):
        raise ValueError("it holds values that are not finite")
    if not ((table.fields["restitution"] >= 0.0) & (table.fields["restitution"] <= 1.0)).all():
        raise ValueError("it holds a COR outside 0 to 1")
    return table


def _from_file(file: h5py.File) -> Table:
    settings = Settings(**{k: type(v)(file.attrs[k]) for k, v in asdict(Settings()).items()})
    segments = tuple(file[f"log_overload/{k}"][()] for k in range(len(file["log_overload"])))
    fields = {name: file[f"fields/{name}"][()] for name in FIELDS}
    shape = (settings.inelasticity_nodes, sum(map(len, segments)))
    elastic = file["elastic_compression"][()]
    if {values.shape for values in fields.values()} != {shape}:
        raise ValueError(f"its fields do not have the shape {shape} of its axes")
    if elastic.shape != (settings.elastic_nodes,):
        raise ValueError(f"its elastic_compression has the shape {elastic.shape}")
    _compare_axes(file, settings, segments)
    states = file["shapes/states"][()]
    _compare_shapes(file, settings, states)
    certificate = file.attrs.get("certificate")
    return Table(
        law=str(file.attrs["law"]),
        settings=settings,
        segments=segments,
        elastic_compression=elastic,
        fields=fields,
        states=states,
        certificate=None if certificate is None else Certificate(**json.loads(certificate)),
    )


def _compare_axes(
    file: h5py.File, settings: Settings, segments: tuple[NDArray[np.float64], ...]
) -> None:
    """Refuse a table of another form of the law, or whose axes are not those of its settings."""
    law = laws.law(str(file.attrs["law"]))
    if not np.array_equal(file["kinks"][()], law.kinks):
        raise ValueError(f"its kinks {file['kinks'][()]} are not those of the law, {law.kinks}")
    expected = axes(law, settings)
    stored = (file["inelasticity"][()], *segments)
    if not all(np.array_equal(*pair) for pair in zip(stored, expected, strict=True)):
        raise ValueError("its axes are not those of its settings")


def _compare_shapes(file: h5py.File, settings: Settings, states: NDArray[np.float32]) -> None:
    """Refuse shapes on another grid than that of the settings and this version."""
    rows, *columns = shape_axes(laws.law(str(file.attrs["law"])), settings)
    if states.shape != (rows.size, sum(map(len, columns)), 2, shapes.SIZE):
        raise ValueError(f"its shapes/states has the shape {states.shape}")
    if not np.array_equal(file["shapes/shares"][()], shapes.SHARES):
        raise ValueError("its shapes/shares are not those of this version")


@functools.cache
def packaged(law: str) -> Table | None:
    """Read the table of a law that ships with the package; None for a law without one.

    Raises
    ------
    DamagedTableError
        If the installed file is damaged.
    """
    with resources.as_file(resources.files("contactlaw") / "data" / f"{law}.h5") as path:
        if not path.exists():
            return None
        try:
            return read(path)
        except DamagedTableError as error:
            raise DamagedTableError(
                f"the installed package is damaged, reinstall contactlaw: {error.__cause__}"
            ) from error
