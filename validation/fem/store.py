"""Files of results: HDF5, each with what made it."""

from __future__ import annotations

import os
from datetime import date
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw._version import VERSION

FOLDER = Path(__file__).parent.parent / "data"


class Result(NamedTuple):
    """Arrays of a file by name, and its attributes: what made them."""

    data: dict[str, NDArray[Any]]
    attributes: dict[str, Any]


def path(name: str) -> Path:
    """Path of the file of a result."""
    return FOLDER / f"fem_{name}.h5"


def write(name: str, about: str, data: dict[str, NDArray[Any]], units: dict[str, str], **settings: Any) -> None:
    """Keep a result; it replaces an older one when all of it is on disk.

    Parameters
    ----------
    name : str
        Name of the study.
    about : str
        What the file holds, for a reader who has nothing else.
    data : dict
        Arrays by name.
    units : dict
        Unit of each array of floats; "-" for a number.
    **settings
        Mesh and whatever else made it.

    Raises
    ------
    ValueError
        If a value is not finite, or has no unit.
    """
    FOLDER.mkdir(exist_ok=True)
    for key, values in data.items():
        if np.asarray(values).dtype.kind != "f":
            continue
        if not np.isfinite(values).all():
            raise ValueError(f"{key}: a result of study {name!r} is not finite")
        if key not in units:
            raise ValueError(f"{key}: a result of study {name!r} has no unit; a number has '-'")
    unfinished = path(name).with_suffix(".part")
    try:
        with h5py.File(unfinished, "w") as file:
            file.attrs.update(
                about=about,
                command=f"python -m validation.fem {name}",
                date=date.today().isoformat(),
                contactlaw_version=VERSION,
                **settings,
            )
            for key, values in data.items():
                array = np.asarray(values)
                if array.dtype.kind == "U":
                    file.create_dataset(key, data=array.astype(h5py.string_dtype()))
                    continue
                packed = {"compression": "gzip", "shuffle": True} if array.size > 200 else {}
                file.create_dataset(key, data=array, **packed)
                if key in units:
                    file[key].attrs["unit"] = units[key]
        os.replace(unfinished, path(name))
    finally:
        unfinished.unlink(missing_ok=True)


def read(name: str) -> Result:
    """Read a result.

    Raises
    ------
    FileNotFoundError
        If it has not been computed.

    Examples
    --------
    >>> result = read("matrix")
    >>> result.data["restitution"].size >= 64, result.attributes["command"]
    (True, 'python -m validation.fem matrix')
    """
    if not path(name).exists():
        raise FileNotFoundError(f"{path(name)}: run python -m validation.fem {name}")
    with h5py.File(path(name)) as file:
        data = {
            key: item.asstr()[()] if h5py.check_string_dtype(item.dtype) else item[()] for key, item in file.items()
        }
        return Result(data, dict(file.attrs))
