"""The folder of the results: they appear there all at once, and a killed run leaves nothing.

An earlier run of the same scene is replaced; whatever else is in the folder is left.
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
_PARTIAL = "partial"  # folder in that of a complete run, which a partial one does not replace


@contextmanager
def workplace(folder: Path) -> Iterator[Path]:
    """Give a temporary folder on the file system of another, which may not exist yet.

    It is locked while its process lives, so that the next run can take away what a killed one left.
    A `NotADirectoryError` if `folder`, or what it shall be in, is a file.
    """
    nearest = folder.absolute()
    while not nearest.exists():
        nearest = nearest.parent
    if not nearest.is_dir():
        raise NotADirectoryError(f"out: {nearest} is a file, not a folder")
    for place in {nearest, folder.absolute().parent}:  # of a run before the folder was there
        for left in place.glob(f"{_UNFINISHED}*"):
            try:
                with FileLock(left / LOCK, timeout=0):
                    shutil.rmtree(left)
            except (Timeout, OSError):  # of a run that lives, or not ours to remove
                continue
    temporary = Path(tempfile.mkdtemp(prefix=_UNFINISHED, dir=nearest))
    try:
        with FileLock(temporary / LOCK):
            yield temporary
    finally:
        with noted():
            shutil.rmtree(temporary)


def move(temporary: Path, folder: Path) -> None:
    """Move all files of a workplace into a folder, made if need be."""
    with noted():
        folder.mkdir(parents=True, exist_ok=True)
        for name in entries(temporary):
            shutil.move(temporary / name, folder / name)


@contextmanager
def results(folder: Path) -> Iterator[Path]:
    """Give a temporary folder whose files move into the real one when all went well."""
    with workplace(folder) as temporary:
        yield temporary
        move(temporary, folder)


def entries(folder: Path) -> list[str]:
    """Names of what is in a folder, sorted; nothing if there is none."""
    found = folder.iterdir() if folder.is_dir() else ()
    return sorted(entry.name for entry in found if entry.name != LOCK)


class Place:
    """The folder for the results of a run, which need not exist.

    Attributes
    ----------
    earlier : bool
        Whether it holds an earlier run of this scene.

    Raises
    ------
    FileExistsError
        If it holds a file that this run would replace, and none of its kind has left it there.
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
        """Move all files of a workplace here, in the place of those of an earlier run.

        Returns the folder; of a partial run one within it, if it holds a complete one.
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
        """Read what the record in a folder says of its run; nothing if there is none."""
        try:
            with h5py.File(path / self._show.record, "r") as file:
                found = dict(file.attrs)
        except OSError:
            return {}
        return found if found.get("format") == FORMAT + self._show.name else {}

    def _owned(self, path: Path) -> set[str]:
        """Names of the files in a folder that a run of this kind has left there."""
        attributes = self._attributes(path)
        return (
            set(attributes.get("files", self._show.files)) & {*entries(path)}
            if attributes
            else set()
        )
