"""Tables on disk: one HDF5 file per table, which any HDF5 program reads.

The file begins with a user block, which HDF5 leaves to applications: one line with the SHA-256 of
all that follows. A reader checks it before HDF5 sees a byte, so a file that was cut short or
altered is refused with a sentence, whatever HDF5 would have made of it. The checksum shows damage,
not intent: a file that fits it is checked for what kernels rely on, no more.
"""

import dataclasses
import functools
import hashlib
import io
import json
import os
from collections.abc import Mapping
from dataclasses import asdict
from importlib import resources
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from contactlaw import _atomic
from contactlaw._arrays import Array
from contactlaw._content import content_of
from contactlaw._version import VERSION
from contactlaw.equation import force
from contactlaw.equation.outcome import STORED
from contactlaw.laws import Law, Strengths
from contactlaw.table import grid, shapes
from contactlaw.table.certificate import Certificate
from contactlaw.table.grid import Settings
from contactlaw.table.table import Table

FORMAT = "contactlaw table"
SCHEMA = 9
_BLOCK = 512  # bytes; the smallest user block of HDF5
LARGEST = 1 << 30  # bytes of a file, our choice: a PC can hold it
_DATASETS = {
    "law": "force law, see contactlaw.equation.force [d_Y, F_Y]",
    "strengths": "force laws at all strengths, see contactlaw.equation.force [d_Y, F_Y]",
    "table": f"grid and splines, see contactlaw.table.lookup, of: {'; '.join(STORED)}",
    "histories": "grid and splines, see contactlaw.table.shapes, of times [T_H], speeds [V0], forces [m V0/T_H]",
    "shapes": "the same, in a file of its own",
    "slides": "grid and splines, see contactlaw.table.slides, of changes of the sliding speed [-]",
}
# Of a law, beside its data.
_OF_LAW = ["family", "source", "yield_coefficient", "parameters", "scale", "range", "waves", "loading_kinks"]


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
    law, arrays = table.law, {"table": table.packed, "law": table.law.data}
    about: dict[str, Any] = {"law": {name: getattr(law, name) for name in _OF_LAW}, "settings": asdict(table.settings)}
    if law.strengths is not None:
        arrays["strengths"], about["knots"] = law.strengths
    if table.histories is not None:
        arrays["histories"] = table.histories
    if table.certificate is not None:
        about["certificate"] = asdict(table.certificate)
    store(path, arrays, about)


def store(path: str | os.PathLike[str], arrays: Mapping[str, Array], about: Mapping[str, Any]) -> None:
    """Write arrays, and what is known about them, as one file with a checksum."""
    image = io.BytesIO()
    with h5py.File(image, "w", userblock_size=_BLOCK) as file:
        file.attrs.update(format=FORMAT, schema=SCHEMA, contactlaw_version=VERSION, about=json.dumps(about))
        for name in sorted(arrays):
            file[name] = arrays[name]
            file[name].attrs["description"] = _DATASETS[name]
    content = image.getvalue()[_BLOCK:]
    _atomic.write(path, _signature(content) + content)


def _signature(content: Any) -> bytes:
    """Return the user block before a content."""
    return f"{FORMAT} sha256 {hashlib.sha256(content).hexdigest()}\n".encode().ljust(_BLOCK, b"\0")


def read(path: str | os.PathLike[str]) -> Table:
    """Read a table and verify it: size, checksum, schema, completeness.

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
    remedy = "Build it again with: contactlaw table build --law LAW --out FILE"
    try:
        arrays, about = load(path)
        force.check(arrays["law"])  # kernels follow addresses in it
        numbers: dict[str, Any] = {
            name: tuple(one) if isinstance(one, list) else one for name, one in about["law"].items()
        }
        if "strengths" in arrays:
            force.check_strengths(arrays["strengths"])
            numbers["strengths"] = Strengths(arrays["strengths"], tuple(about["knots"]))
        grid.check(arrays["table"], len(STORED))
        if "histories" in arrays:
            grid.check(arrays["histories"], shapes.FIELDS)
        certificate = Certificate(**about["certificate"]) if "certificate" in about else None
        law, settings = Law(data=arrays["law"], **numbers), Settings(**about["settings"])
        return Table(law, settings, arrays["table"], arrays.get("histories"), certificate)
    except FileNotFoundError:
        raise FileNotFoundError(f"table: there is no file {path}. {remedy}") from None
    except (OSError, LookupError, ValueError, TypeError, RuntimeError, AttributeError) as error:
        raise DamagedTableError(f"table: cannot use {path}: {error}. {remedy}") from error


def load(path: str | os.PathLike[str]) -> tuple[dict[str, Array], dict[str, Any]]:
    """Read arrays, and what is known about them, from a file whose checksum fits."""
    content = content_of(Path(path), LARGEST)
    if not content.startswith(f"{FORMAT} sha256 ".encode()):
        raise ValueError("it is not a table, or its first bytes were altered")
    if content[:_BLOCK] != _signature(memoryview(content)[_BLOCK:]):
        raise ValueError("its checksum does not fit: it was cut short or altered")
    with h5py.File(io.BytesIO(content), "r") as file:
        if (found := file.attrs.get("schema")) != SCHEMA:
            raise ValueError(f"it is a table of schema {found}, not {SCHEMA}: another version of contactlaw made it")
        arrays = {name: _numbers(file[name]) for name in _DATASETS if name in file}
        return arrays, json.loads(file.attrs["about"])


def _numbers(dataset: h5py.Dataset) -> Array:
    """Read a row of numbers; refuse other types, and what no file holds."""
    name = dataset.name.lstrip("/")
    if dataset.ndim != 1 or dataset.dtype != np.float64:
        raise ValueError(f"its {name} holds {dataset.dtype} of shape {dataset.shape}, not a row of float64")
    if dataset.nbytes > LARGEST:  # a few bytes of a file may declare an array of any size
        raise ValueError(f"its {name} has {dataset.nbytes} bytes, above {LARGEST}")
    values: Array = dataset[()]
    if np.isnan(values).any():
        raise ValueError(f"its {name} holds nan")
    return values


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
