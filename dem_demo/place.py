"""What becomes of a folder that is not empty: an earlier rain is replaced, the rest is left."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py

from dem_demo import figures, folder
from dem_demo.recorder import COMPLETE, FORMAT, RECORD

SUMMARY, PAGE, FILM = "summary.txt", "index.html", "rain.gif"
_PARTIAL = "partial"  # folder in that of a complete rain, which a partial one does not replace


def names() -> set[str]:
    """Names of all files that a rain leaves, but for those of an engine's own."""
    return {RECORD, SUMMARY, PAGE, FILM, *(f"{name}.png" for name in figures.names())}


class Place:
    """The folder for the results of a rain.

    Parameters
    ----------
    path : Path
        The folder, which need not exist.

    Attributes
    ----------
    earlier : bool
        Whether it holds an earlier rain.

    Raises
    ------
    FileExistsError
        If it holds a file that this rain would replace, and no rain has left it there.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        attributes = _attributes(path)
        self.earlier, self._complete = bool(attributes), attributes.get("state") == COMPLETE
        others = sorted(names() & _entries(path) - _owned(path))
        if others:
            raise FileExistsError(
                f"out: {path} holds {', '.join(others)}, which no rain has left there; name "
                "another folder"
            )

    def fill(self, temporary: Path, *, complete: bool) -> Path:
        """Move all files of a workplace here, in the place of those of an earlier rain.

        Returns
        -------
        Path
            The folder; of a partial rain one within it, if it holds a complete one.
        """
        target = self.path if complete or not self._complete else self.path / _PARTIAL
        for place in (target / _PARTIAL, target):
            owned = _owned(place)
            for name in owned:
                (place / name).unlink()
            if owned and place.name == _PARTIAL and not _entries(place):
                place.rmdir()
        folder.move(temporary, target)
        return target


def _entries(path: Path) -> set[str]:
    return {entry.name for entry in path.iterdir()} if path.is_dir() else set()


def _attributes(path: Path) -> Mapping[str, Any]:
    """Read what the record in a folder says of its rain; nothing if there is none."""
    try:
        with h5py.File(path / RECORD, "r") as file:
            found = dict(file.attrs)
    except OSError:
        return {}
    return found if found.get("format") == FORMAT else {}


def _owned(path: Path) -> set[str]:
    """Names of the files in a folder that a rain has left there."""
    attributes = _attributes(path)
    if not attributes:
        return set()
    return set(attributes.get("files", names())) & _entries(path)
