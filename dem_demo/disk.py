"""A file that HDF5 can always write to, also when the disk is full."""

from __future__ import annotations

import errno
import io
from pathlib import Path
from typing import BinaryIO

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def complaint(error: OSError) -> str:
    """Say what the disk said, and what would help if it is full.

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
    So it never hears of the error: `error` has it.

    Parameters
    ----------
    path : Path
        File to create.

    Attributes
    ----------
    error : OSError or None
        What the disk said; from then on the whole file is in memory and the one on disk empty.
    """

    def __init__(self, path: Path) -> None:
        self._file: BinaryIO | io.BytesIO = path.open("x+b", buffering=0)
        self.error: OSError | None = None

    def content(self) -> bytes:
        """All that has been written."""
        self._file.seek(0)
        return self._file.read()

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        """Go to a place."""
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        """Tell the place."""
        return self._file.tell()

    def read(self, size: int = -1) -> bytes:
        """Read from the place on."""
        return self._file.read(size)

    def write(self, data: memoryview) -> int:
        """Write all of it at the place, here or in memory."""
        place, written = self._file.tell(), 0
        try:
            while written < len(data):  # unbuffered: the last bytes of a disk are a part of it
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

    def flush(self) -> None:
        """Nothing is held back."""

    def close(self) -> None:
        """Close the file; what is in memory is gone."""
        self._file.close()

    def _leave(self, error: OSError) -> None:
        self.error = error
        memory = io.BytesIO(self.content())
        self._file.truncate(0)
        self._file.close()
        self._file = memory
