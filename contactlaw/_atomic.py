"""Files that appear complete or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
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


@contextmanager
def folder(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary folder whose files move into `path` if the block raises nothing.

    A new folder is made, in one that exists; other files in it are left alone.
    """
    to = Path(os.path.realpath(path))  # the temporary folder has to be on its file system
    if to.exists() and not to.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "is a file, not a folder: name another", str(path))
    _check_folder(to.parent)
    with tempfile.TemporaryDirectory(prefix=f".{to.name}.", dir=to.parent) as made:
        yield Path(made)
        to.mkdir(exist_ok=True)
        for file in Path(made).iterdir():
            write(to / file.name, file.read_bytes())


def _check_folder(path: Path) -> None:
    if not path.is_dir():
        raise FileNotFoundError(errno.ENOENT, "there is no such folder", str(path))


def _replace(path: Path, content: bytes) -> None:
    _check_folder(path.parent)
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
