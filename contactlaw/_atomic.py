"""Files that appear complete or not at all."""

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
        _replace({Path(os.path.realpath(path)): content})
    else:
        with open(path, "wb") as file:
            file.write(content)


@contextmanager
def folder(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary folder whose files move into `path`, all or none, if nothing is raised.

    A new folder is made, in one that exists; other files in it are left alone. An OSError names the
    file that could not be replaced.
    """
    to = Path(os.path.realpath(path))  # the temporary folder has to be on its file system
    if to.exists() and not to.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "is a file, not a folder: name another", str(path))
    _check_folder(to.parent)
    with _naming(to):
        temporary = tempfile.TemporaryDirectory(prefix=f".{to.name}.", dir=to.parent)
    with temporary as made:
        with _naming(to, made):
            yield Path(made)
            contents = {Path(os.path.realpath(to / file.name)): file.read_bytes() for file in Path(made).iterdir()}
        made_here = not to.exists()
        to.mkdir(exist_ok=True)
        try:
            _replace(contents)
        except BaseException:
            if made_here:
                to.rmdir()
            raise


def _check_folder(path: Path) -> None:
    if not path.is_dir():
        raise FileNotFoundError(errno.ENOENT, "there is no such folder", str(path))


def _replace(files: dict[Path, bytes]) -> None:
    """Replace files by their new contents; none of them if one cannot be written."""
    with contextlib.ExitStack() as done:
        staged = {}
        for path, content in files.items():
            with _naming(path):
                staged[path] = _staged(path, content, done)
        for path, new in staged.items():
            with _naming(path):
                os.replace(new, path)


@contextmanager
def _naming(path: Path, temporary: str = "") -> Iterator[None]:
    """Let an OSError name what is written in place of a temporary file or folder."""
    try:
        yield
    except OSError as error:
        if str(error.filename or temporary).startswith(temporary):
            raise type(error)(error.errno, error.strerror, str(path)) from None
        raise


def _staged(path: Path, content: bytes, done: contextlib.ExitStack) -> Path:
    """Write the new content of a file under a temporary name beside it."""
    _check_folder(path.parent)
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if path.exists() and not path.is_file():  # a device: the system would lose it
        raise FileExistsError(errno.EEXIST, "is no file that can be replaced")
    mode = stat.S_IMODE(path.stat().st_mode) if path.exists() else 0o644
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
    done.callback(Path(name).unlink, missing_ok=True)
    with os.fdopen(handle, "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())  # or a power cut could leave the name without the content
    os.chmod(name, mode)  # mkstemp makes it private; a new result is for everyone
    return Path(name)
