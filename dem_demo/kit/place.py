"""The folder of the results: all files appear there at once, and a killed run leaves none.

An earlier run of the same scene is replaced; other files in the folder are left alone.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import h5py
from filelock import FileLock, Timeout

from dem_demo.kit.recorder import COMPLETE
from dem_demo.kit.signals import held

LOCK = ".lock"
_UNFINISHED = ".unfinished-"
PARTIAL = "partial"  # subfolder for a partial run where the folder holds a complete one


@contextmanager
def workplace(folder: Path) -> Iterator[Path]:
    """Give a temporary folder on the file system of `folder`, which need not exist yet.

    It is locked while its process lives, so that the next run can remove what a killed run left.
    Raises `NotADirectoryError` if `folder`, or a parent of it, is a file.
    """
    whole = folder.absolute()
    nearest = next(place for place in (whole, *whole.parents) if place.exists())
    if not nearest.is_dir():
        raise NotADirectoryError(
            f"--out: {nearest} is a file, not a folder; name a folder, which may be new"
        )
    for place in {nearest, whole.parent}:  # earlier runs may predate `folder`
        for left in place.glob(f"{_UNFINISHED}*"):
            # Another process may use it, or own it.
            with suppress(Timeout, OSError), FileLock(left / LOCK, timeout=0):
                shutil.rmtree(left)
    temporary = Path(tempfile.mkdtemp(prefix=_UNFINISHED, dir=nearest))
    try:
        with FileLock(temporary / LOCK):
            yield temporary
    finally:
        with held():
            shutil.rmtree(temporary)


@contextmanager
def results(folder: Path) -> Iterator[Path]:
    """Give a temporary folder whose files move into `folder` if the block raises nothing."""
    with workplace(folder) as temporary:
        yield temporary
        with held():
            _move(temporary, folder)


def entries(folder: Path) -> list[str]:
    """Sorted names of all entries of a folder; empty if it does not exist."""
    found = folder.iterdir() if folder.is_dir() else ()
    return sorted(entry.name for entry in found if entry.name != LOCK)


def earlier(folder: Path, scene: str) -> tuple[set[str], bool]:
    """Names of the files that an earlier run of a scene left, and whether it was complete."""
    with suppress(OSError), h5py.File(folder / f"{scene}.h5", "r") as file:
        if file.attrs.get("scene") == scene:
            files = {*file.attrs.get("files", ())} & {*entries(folder)}
            return files, file.attrs.get("state") == COMPLETE
    return set(), False


def replace(temporary: Path, target: Path, scene: str) -> None:
    """Move all files of a workplace into a folder, and remove those of an earlier run there."""
    with held():
        for place in (target / PARTIAL, target):
            for name in earlier(place, scene)[0]:
                (place / name).unlink()
        with suppress(OSError):  # it is missing, or has other files
            (target / PARTIAL).rmdir()
        _move(temporary, target)


def _move(temporary: Path, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name in entries(temporary):
        shutil.move(temporary / name, folder / name)
