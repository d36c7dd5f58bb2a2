"""A file that HDF5 can always write to, also when the disk is full."""

from __future__ import annotations

import errno
import io
from pathlib import Path
from typing import Any, BinaryIO

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def complaint(error: OSError) -> str:
    """Message of an error of the disk, with a remedy if the disk is full.

    Examples
    --------
    >>> complaint(OSError(errno.ENOSPC, "No space left on device"))
    'the disk is full (No space left on device): free some of it, or name another --out'
    """
    if error.errno not in _FULL:
        return str(error)
    return f"the disk is full ({error.strerror}): free some of it, or name another --out"


class Disk:
    """A file on disk that goes on in memory when the disk refuses more; for ``h5py.File``.

    HDF5 cannot close a file that it could not write, and takes the process down with it at the end.
    So the error is not raised but kept in the attribute `error`, which is None before. After it the
    whole file is in memory, and the one on disk is empty.
    """

    def __init__(self, path: Path) -> None:
        self._file: BinaryIO | io.BytesIO = path.open("x+b", buffering=0)
        self.error: OSError | None = None

    def __getattr__(self, name: str) -> Any:
        """Forward read, seek, tell, flush and close to the file."""
        return getattr(self._file, name)

    def content(self) -> bytes:
        """All that has been written."""
        self._file.seek(0)
        return self._file.read()

    def write(self, data: memoryview) -> int:
        """Write all data at the current position, on disk or in memory."""
        place, written = self._file.tell(), 0
        try:
            while written < len(data):  # an unbuffered write may be partial when space runs out
                written += self._file.write(data[written:])
        except OSError as error:
            self._leave(error)
            self._file.seek(place)
            self._file.write(data)
        return len(data)

    def truncate(self, size: int) -> int:
        """Cut or extend the file."""
        try:
            return self._file.truncate(size)
        except OSError as error:
            self._leave(error)
            return self._file.truncate(size)

    def _leave(self, error: OSError) -> None:
        self.error = error
        memory = io.BytesIO(self.content())
        self._file.truncate(0)
        self._file.close()
        self._file = memory
