"""The folder of the results: all files appear there at once, and a killed run leaves none.

An earlier run of the same scene is replaced; other files in the folder are left alone.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
from filelock import FileLock, Timeout

from contactlaw.engines.layout import FORMAT
from dem_demo.kit.recorder import COMPLETE
from dem_demo.kit.signals import noted

if TYPE_CHECKING:
    from dem_demo.kit.session import Show

LOCK = ".lock"
_UNFINISHED = ".unfinished-"
_PARTIAL = "partial"  # subfolder for a partial run where the folder holds a complete one


@contextmanager
def workplace(folder: Path) -> Iterator[Path]:
    """Give a temporary folder on the file system of `folder`, which need not exist yet.

    It is locked while its process lives, so that the next run can remove what a killed run left.
    Raises `NotADirectoryError` if `folder`, or a parent of it, is a file.
    """
    nearest = folder.absolute()
    while not nearest.exists():
        nearest = nearest.parent
    if not nearest.is_dir():
        raise NotADirectoryError(f"out: {nearest} is a file, not a folder")
    for place in {nearest, folder.absolute().parent}:  # earlier runs may predate `folder`
        for left in place.glob(f"{_UNFINISHED}*"):
            try:
                with FileLock(left / LOCK, timeout=0):
                    shutil.rmtree(left)
            except (Timeout, OSError):  # another process uses it, or owns it
                continue
    temporary = Path(tempfile.mkdtemp(prefix=_UNFINISHED, dir=nearest))
    try:
        with FileLock(temporary / LOCK):
            yield temporary
    finally:
        with noted():
            shutil.rmtree(temporary)


def move(temporary: Path, folder: Path) -> None:
    """Move all files of a workplace into a folder, which is made if it is missing."""
    with noted():
        folder.mkdir(parents=True, exist_ok=True)
        for name in entries(temporary):
            shutil.move(temporary / name, folder / name)


@contextmanager
def results(folder: Path) -> Iterator[Path]:
    """Give a temporary folder whose files move into `folder` if the block raises nothing."""
    with workplace(folder) as temporary:
        yield temporary
        move(temporary, folder)


def entries(folder: Path) -> list[str]:
    """Sorted names of all entries of a folder; empty if it does not exist."""
    found = folder.iterdir() if folder.is_dir() else ()
    return sorted(entry.name for entry in found if entry.name != LOCK)


class Place:
    """The folder for the results of a run, which need not exist.

    Attributes
    ----------
    earlier : bool
        Whether the folder holds an earlier run of this scene.

    Raises
    ------
    FileExistsError
        If this run would replace a file that no earlier run of the scene has written.
    """

    def __init__(self, path: Path, show: Show) -> None:
        self.path, self._show = path, show
        attributes = self._attributes(path)
        self.earlier, self._complete = bool(attributes), attributes.get("state") == COMPLETE
        others = sorted(show.files & {*entries(path)} - self._owned(path))
        if others:
            raise FileExistsError(
                f"out: {path} holds {', '.join(others)}, which no {show.name} has left there; name "
                "another folder"
            )

    def fill(self, temporary: Path, *, complete: bool) -> Path:
        """Move all files of a workplace here, and remove those of an earlier run.

        Returns the folder; a partial run goes into a subfolder if the folder holds a complete run.
        """
        target = self.path if complete or not self._complete else self.path / _PARTIAL
        for place in (target / _PARTIAL, target):
            owned = self._owned(place)
            for name in owned:
                (place / name).unlink()
            if owned and place.name == _PARTIAL and not entries(place):
                place.rmdir()
        move(temporary, target)
        return target

    def _attributes(self, path: Path) -> Mapping[str, Any]:
        """Read the attributes of the record in a folder; empty if it holds no record."""
        try:
            with h5py.File(path / self._show.record, "r") as file:
                found = dict(file.attrs)
        except OSError:
            return {}
        return found if found.get("format") == FORMAT + self._show.name else {}

    def _owned(self, path: Path) -> set[str]:
        """Names of the files in a folder that an earlier run of the scene has written."""
        attributes = self._attributes(path)
        return (
            set(attributes.get("files", self._show.files)) & {*entries(path)}
            if attributes
            else set()
        )
