"""What becomes of a folder that is not empty: an earlier run is replaced, the rest is left."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import h5py

from dem_demo import folder
from dem_demo.recorder import COMPLETE

SUMMARY, PAGE = "summary.txt", "index.html"
_PARTIAL = "partial"  # folder in that of a complete run, which a partial one does not replace


class Kind(NamedTuple):
    """What a command leaves in its folder."""

    name: str
    """Of the command."""
    record: str
    """Name of the file that says which files belong to the run."""
    format: str
    """Its attribute of that name."""
    files: frozenset[str]
    """Names of all files, but for those of an engine's own."""


class Place:
    """The folder for the results of a run.

    Parameters
    ----------
    path : Path
        The folder, which need not exist.
    kind : Kind
        What the run leaves there.

    Attributes
    ----------
    earlier : bool
        Whether it holds an earlier run of this kind.

    Raises
    ------
    FileExistsError
        If it holds a file that this run would replace, and none of its kind has left it there.
    """

    def __init__(self, path: Path, kind: Kind) -> None:
        self.path, self._kind = path, kind
        attributes = self._attributes(path)
        self.earlier, self._complete = bool(attributes), attributes.get("state") == COMPLETE
        others = sorted(kind.files & _entries(path) - self._owned(path))
        if others:
            raise FileExistsError(
                f"out: {path} holds {', '.join(others)}, which no {kind.name} has left there; name "
                "another folder"
            )

    def fill(self, temporary: Path, *, complete: bool) -> Path:
        """Move all files of a workplace here, in the place of those of an earlier run.

        Returns
        -------
        Path
            The folder; of a partial run one within it, if it holds a complete one.
        """
        target = self.path if complete or not self._complete else self.path / _PARTIAL
        for place in (target / _PARTIAL, target):
            owned = self._owned(place)
            for name in owned:
                (place / name).unlink()
            if owned and place.name == _PARTIAL and not _entries(place):
                place.rmdir()
        folder.move(temporary, target)
        return target

    def _attributes(self, path: Path) -> Mapping[str, Any]:
        """Read what the record in a folder says of its run; nothing if there is none."""
        try:
            with h5py.File(path / self._kind.record, "r") as file:
                found = dict(file.attrs)
        except OSError:
            return {}
        return found if found.get("format") == self._kind.format else {}

    def _owned(self, path: Path) -> set[str]:
        """Names of the files in a folder that a run of this kind has left there."""
        attributes = self._attributes(path)
        if not attributes:
            return set()
        return set(attributes.get("files", self._kind.files)) & _entries(path)


def _entries(path: Path) -> set[str]:
    return {entry.name for entry in path.iterdir()} if path.is_dir() else set()
