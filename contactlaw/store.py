"""Tables on disk: one HDF5 file per law, readable without this package."""

from __future__ import annotations

import functools
import importlib.metadata
import os
import tempfile
from dataclasses import asdict
from importlib import resources
from pathlib import Path

import h5py
import numpy as np

from contactlaw import laws
from contactlaw.table import FIELDS, Settings, Table

FORMAT = "contactlaw table"
SCHEMA = 1


def write(table: Table, path: str | os.PathLike[str]) -> None:
    """Write a table; the file appears complete or not at all.

    Parameters
    ----------
    table : Table
        What `contactlaw.table.build` returned.
    path : path-like
        Where to; an existing file is replaced.
    """
    path = Path(path)
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
    os.close(handle)
    try:
        with h5py.File(name, "w") as file:
            _fill(file, table)
        os.chmod(name, 0o644)  # mkstemp makes it private; a table is for everyone
        os.replace(name, path)
    except BaseException:
        os.unlink(name)
        raise


def _fill(file: h5py.File, table: Table) -> None:
    law = laws.law(table.law)
    file.attrs.update(
        format=FORMAT,
        schema=SCHEMA,
        law=table.law,
        law_source=law.source,
        contactlaw_version=importlib.metadata.version("contactlaw"),
        **asdict(table.settings),
    )
    file["inelasticity"] = table.inelasticity
    file["inelasticity"].attrs["description"] = "lambda of the rows of fields/ [-]"
    file["kinks"] = law.kinks
    file["kinks"].attrs["description"] = "compressions at which the law is not smooth [d_Y]"
    for k, nodes in enumerate(table.segments):
        file[f"log_overload/{k}"] = nodes
    file["log_overload"].attrs["description"] = (
        "ln chi of the columns of fields/, one segment between two kinks after the other [-]"
    )
    file["elastic_compression"] = table.elastic_compression
    file["elastic_compression"].attrs["description"] = (
        "w_m at lambda = c x/(1 - x), c = stretch, x uniform, lambda from 0 to the largest [V0 T_H]"
    )
    for name, values in table.fields.items():
        file.create_dataset(f"fields/{name}", data=values, compression="gzip", shuffle=True)
        file[f"fields/{name}"].attrs["description"] = FIELDS[name]
    file.attrs["complete"] = True  # last: a file cut short opens without complaint


def read(path: str | os.PathLike[str]) -> Table:
    """Read a table.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is no table, is incomplete, has another schema or holds a value that is not
        finite; the message says how to rebuild it.
    """
    path = Path(path)
    remedy = "Build it again with: contactlaw table build --out FILE"
    if not path.exists():
        raise FileNotFoundError(f"table: no file {path}. {remedy}")
    try:
        with h5py.File(path, "r") as file:
            found = {key: file.attrs.get(key) for key in ("format", "schema", "complete")}
            if found != {"format": FORMAT, "schema": SCHEMA, "complete": True}:
                raise ValueError(f"not a complete table of schema {SCHEMA}: {found}")
            table = _parse(file)
    except (OSError, KeyError, ValueError) as error:
        raise ValueError(f"table: cannot use {path}: {error}. {remedy}") from error
    arrays = [*table.segments, table.elastic_compression, *table.fields.values()]
    if not all(np.isfinite(values).all() for values in arrays):
        raise ValueError(f"table: {path} holds values that are not finite. {remedy}")
    return table


def _parse(file: h5py.File) -> Table:
    defaults = asdict(Settings())
    settings = Settings(**{k: type(v)(file.attrs[k]) for k, v in defaults.items()})
    segments = tuple(file[f"log_overload/{k}"][()] for k in range(len(file["log_overload"])))
    fields = {name: file[f"fields/{name}"][()] for name in FIELDS}
    shape = (settings.inelasticity_nodes, sum(map(len, segments)))
    elastic = file["elastic_compression"][()]
    if {values.shape for values in fields.values()} != {shape}:
        raise ValueError(f"its fields do not have the shape {shape} of its axes")
    if elastic.shape != (settings.elastic_nodes,):
        raise ValueError(f"its elastic_compression has the shape {elastic.shape}")
    return Table(
        law=str(file.attrs["law"]),
        settings=settings,
        segments=segments,
        elastic_compression=elastic,
        fields=fields,
    )


@functools.cache
def packaged(law: str) -> Table:
    """Table of a law that ships with the package; built in memory for a law without one."""
    with resources.as_file(resources.files("contactlaw") / "data" / f"{law}.h5") as path:
        if path.exists():
            return read(path)
    from contactlaw.table import build

    return build(law)
