"""Files that appear complete or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import tempfile
from pathlib import Path


def write(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file under a temporary name and rename it; an existing one is replaced.

    A link stays, and the file that it leads to is replaced. A device, a terminal or a named pipe
    cannot be replaced by a regular file: the content is written into it.

    Raises
    ------
    OSError
        If the folder does not exist, is not writable or full; no part of a file is left behind.
    """
    try:
        replaceable = stat.S_ISREG(os.stat(path).st_mode)
    except FileNotFoundError:  # no file yet, or a link that leads to nothing
        replaceable = True
    if replaceable:
        _replace(Path(os.path.realpath(path)), content)
    else:
        with open(path, "wb") as file:
            file.write(content)


def _replace(path: Path, content: bytes) -> None:
    if not path.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "there is no such folder", str(path.parent))
    mode = stat.S_IMODE(path.stat().st_mode) if path.exists() else 0o644
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())  # or a power cut could leave the name without the content
        os.chmod(name, mode)  # mkstemp makes it private; a new result is for everyone
        os.replace(name, path)
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(name)
        raise
