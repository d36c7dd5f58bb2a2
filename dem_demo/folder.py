"""Results appear all at once at the end, and a killed run leaves nothing for ever."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from dem_demo.signals import unstoppable

_UNFINISHED, _LOCK = ".unfinished-", ".lock"


@contextmanager
def workplace(folder: Path) -> Iterator[Path]:
    """Give a temporary folder on the file system of another, which may not exist yet.

    It is locked while its process lives, so that the next run can take away what a killed one left.

    Parameters
    ----------
    folder : Path
        Where the results shall be.

    Yields
    ------
    Path
        The temporary folder, which is removed whatever happens.

    Raises
    ------
    NotADirectoryError
        If `folder`, or what it shall be in, is a file.
    """
    nearest = folder.absolute()
    while not nearest.exists():
        nearest = nearest.parent
    if not nearest.is_dir():
        raise NotADirectoryError(f"out: {nearest} is a file, not a folder")
    for place in {nearest, folder.absolute().parent}:  # of a run before the folder was there
        _remove_stale(place)
    temporary = Path(tempfile.mkdtemp(prefix=_UNFINISHED, dir=nearest))
    try:
        with FileLock(temporary / _LOCK):
            yield temporary
    finally:
        with unstoppable():
            shutil.rmtree(temporary)


def files(temporary: Path) -> list[Path]:
    """Files that are in a workplace so far, sorted."""
    return sorted(file for file in temporary.iterdir() if file.name != _LOCK)


def move(temporary: Path, folder: Path) -> None:
    """Move all files of a workplace into a folder, made if need be."""
    with unstoppable():
        folder.mkdir(parents=True, exist_ok=True)
        for file in files(temporary):
            shutil.move(file, folder / file.name)


@contextmanager
def results(folder: Path) -> Iterator[Path]:
    """Give a temporary folder whose files move into the real one when all went well.

    Parameters
    ----------
    folder : Path
        Where the results shall be; made with its parents if need be, at the end.

    Yields
    ------
    Path
        The temporary folder.
    """
    with workplace(folder) as temporary:
        yield temporary
        move(temporary, folder)


def _remove_stale(place: Path) -> None:
    for left in place.glob(f"{_UNFINISHED}*"):
        try:
            with FileLock(left / _LOCK, timeout=0):
                shutil.rmtree(left)
        except (Timeout, OSError):  # of a run that lives, or not ours to remove
            continue
