"""Files that are whole or missing, and words for a full disk."""

from __future__ import annotations

import errno
from pathlib import Path

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def write(path: Path, content: bytes) -> None:
    """Write a file; if that fails, no part of it stays."""
    try:
        path.write_bytes(content)
    except BaseException:
        path.unlink(missing_ok=True)
        raise


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
