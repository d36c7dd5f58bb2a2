"""Reading of files that others may have made: bounded in time and memory, whatever they are.

A checksum tells a file that was damaged, not one that somebody made to fit. So nothing is read
before its kind and size are known: no pipe or device, no link into another file, no array that is
declared larger than what the file holds.
"""

from __future__ import annotations

import errno
import os
import stat
from typing import Any

import h5py
import numpy as np
from numpy.typing import DTypeLike, NDArray

# Else `open` waits for a writer of a pipe, and a terminal becomes the controlling one.
_FLAGS = os.O_RDONLY
for _name in ("O_NONBLOCK", "O_NOCTTY", "O_BINARY"):
    _FLAGS |= getattr(os, _name, 0)  # not every platform has each


def content(path: str | os.PathLike[str], limit: int) -> bytes:
    """Bytes of a regular file, or of one that a link leads to.

    Raises
    ------
    OSError
        If it cannot be opened or read.
    ValueError
        If it is no regular file (a pipe, a device, a folder, a link to itself), or larger than the
        limit [bytes].
    """
    try:
        handle = os.open(path, _FLAGS)
    except OSError as error:
        if error.errno in (errno.ELOOP, errno.ENXIO):  # a link to itself, a socket
            raise ValueError(f"it is no regular file: {error.strerror}") from None
        raise
    try:
        # the status of the open file: nobody can put another one in its place any more
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            raise ValueError("it is no regular file")
        if status.st_size > limit:
            raise ValueError(f"it has {status.st_size} bytes, and no table more than {limit}")
        with os.fdopen(handle, "rb", closefd=False) as file:
            return file.read(status.st_size)  # no more, even if the file grows
    finally:
        os.close(handle)


def member(file: h5py.Group, name: str) -> Any:
    """Dataset or group of an HDF5 file; KeyError where there is none.

    Links are refused on the way to it: they may lead into another file, or to themselves.
    """
    found: Any = file
    for part in name.split("/"):
        if not isinstance(found, h5py.Group):
            raise ValueError(f"its {name} has no group to be in")
        if not isinstance(found.get(part, getlink=True), h5py.HardLink):
            raise ValueError(f"its {name} is missing, or a link")
        found = found[part]
    return found


def values(dataset: Any, shape: tuple[int, ...], kind: DTypeLike) -> NDArray[Any]:
    """Read a dataset that must have this shape and dtype, and be stored in its file as one block.

    This is checked before memory is allocated: a few bytes can declare an array of any size.
    """
    if not isinstance(dataset, h5py.Dataset):
        raise ValueError(f"its {dataset.name} is no dataset")
    name, kind = dataset.name.lstrip("/"), np.dtype(kind)
    if dataset.shape != shape:
        raise ValueError(f"its {name} has the shape {dataset.shape}, not {shape}")
    if dataset.dtype.newbyteorder("=") != kind:
        raise ValueError(f"its {name} holds {dataset.dtype}, not {kind}")
    layout = dataset.id.get_create_plist()
    if (
        layout.get_layout() != h5py.h5d.CONTIGUOUS  # chunks may be compressed a thousandfold
        or layout.get_external_count() != 0
        or dataset.id.get_storage_size() != dataset.nbytes
        or dataset.nbytes > dataset.file.id.get_filesize()
    ):
        raise ValueError(f"its {name} is not stored as one block of this file")
    found: NDArray[Any] = dataset[()].astype(kind, copy=False)
    return found


def attribute(file: h5py.Group, name: str, kind: type) -> Any:
    """Read an attribute that must be a single str, float, int or bool; KeyError without one."""
    header = file.attrs.get_id(name)
    text = h5py.check_string_dtype(header.dtype) is not None
    if header.shape != () or text != (kind is str) or header.dtype.kind not in "Ofiub":
        raise ValueError(f"its attribute {name} is no single {kind.__name__}")
    value = file.attrs[name]
    value = value if text else value.item()
    if type(value) is not kind:
        raise ValueError(f"its attribute {name} is no single {kind.__name__}, but {value!r}")
    return value
