"""Tables that do not ship with the package: built once, kept in the user's cache folder.

A table is identified by the data of its law, not by the law's name: laws that differ only in their
yield compression share one. Shapes of force histories are added when a first history is needed.
"""

import contextlib
import dataclasses
import functools
import hashlib
import json
import os
import re
import time
import warnings
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any, TypeVar

from contactlaw import table as tables
from contactlaw._arrays import Array
from contactlaw._folder import folder
from contactlaw._kept import fingerprint
from contactlaw.laws import Law
from contactlaw.table import file, slides
from contactlaw.table.grid import Settings, on_demand
from contactlaw.table.table import Table

_T = TypeVar("_T")
# [s]; the lock ends with its process. The slowest table known takes 15 s of CPU, which may be
# minutes where many processes share a core: one that holds a lock for longer hangs.
_PATIENCE = 600.0
# How many tables stay in memory without a model that uses them, of 1 to 3 MB; 7 MB with shapes.
_TABLES, _TABLES_WITH_SHAPES = 16, 4
_UNUSED = 90 * 86400.0  # [s] after which a file that no process reads is deleted
_OUR_NAMES = re.compile(r"\.?(table|slides)-[0-9a-f]{24}\.(h5|lock|bin)(\.\w+\.part)?")


def file_name(law: Law, settings: Settings) -> str:
    """Name of a table's file, with a hash of all that its content depends on.

    Examples
    --------
    >>> from contactlaw import laws
    >>> from contactlaw.table.cache import file_name
    >>> from contactlaw.table import Settings
    >>> myc = laws.law("myc")
    >>> file_name(myc, Settings()) == file_name(myc, Settings(rtol=1e-11))
    False
    """
    ingredients = {"law": law.key, "settings": asdict(settings), "schema": file.SCHEMA, "sources": fingerprint()}
    digest = hashlib.sha256(json.dumps(ingredients, sort_keys=True).encode()).hexdigest()
    return f"table-{digest[:24]}.h5"


@functools.lru_cache(_TABLES)
def cached(law: Law, settings: Settings | None = None) -> Table:
    """Table of a law from the cache; built, and kept there, if it is missing or damaged.

    Whatever is wrong with the folder, a table is returned; a warning says that it was not kept.
    """
    settings = settings or on_demand(law)

    def make(found: Table | None) -> Table:
        return found or tables.build(law, settings, progress=progress_bar)

    return _kept(law, settings, make, lambda found: True)


@functools.lru_cache(_TABLES_WITH_SHAPES)
def cached_shapes(table: Table) -> Table:
    """Return the table with shapes of force histories, from the cache or built as in `cached`."""
    if table.histories is not None:
        return table

    def make(found: Table | None) -> Table:
        return tables.with_shapes(found or table, progress=progress_bar)

    return _kept(table.law, table.settings, make, lambda found: found.histories is not None)


def _kept(
    law: Law, settings: Settings, make: Callable[[Table | None], Table], is_whole: Callable[[Table], bool]
) -> Table:
    """Read a table from the cache; if it is missing or not whole, make it and keep it."""

    def read(path: Path) -> Table:
        found = file.read(path)
        if found.law.key != law.key or found.settings != settings:
            raise file.DamagedTableError("") from ValueError("it is the table of another law or of other settings")
        return dataclasses.replace(found, law=law)

    return _in_folder(file_name(law, settings), law, read, make, is_whole, file.write)


def cached_slides(table: Table, kappa: float) -> Array:
    """Tangential rebounds of a pair as kernels read them, from the cache or built as in `cached`."""
    ingredients = table.packed.tobytes() + f"{kappa!r} {fingerprint()}".encode()
    name = f"slides-{hashlib.sha256(ingredients).hexdigest()[:24]}.h5"
    return _in_folder(
        name,
        table.law,
        lambda path: file.load(path)[0]["slides"],
        lambda found: slides.build(table, kappa),
        lambda found: True,
        lambda made, path: file.store(path, {"slides": made}, {"law": table.law.family, "kappa": kappa}),
    )


def _in_folder(
    name: str,
    law: Law,
    read: Callable[[Path], _T],
    make: Callable[[_T | None], _T],
    is_whole: Callable[[_T], bool],
    write: Callable[[_T, Path], None],
) -> _T:
    """Read a file of the cache; if it is missing or not whole, make what belongs there and keep it."""
    try:
        place = folder()
    except RuntimeError as error:
        place = None
        _warn_not_kept(law, "a folder of this user", error)
    if place is None:
        return make(None)
    path, made = place / name, None
    try:
        found, _ = _usable(path, read)
        if found is not None and is_whole(found):
            return found
        place.mkdir(0o700, parents=True, exist_ok=True)
        with _locked(path):
            # another process may have built it while this one waited
            found, fault = _usable(path, read)
            if found is not None and is_whole(found):
                return found
            made = make(found)
            _clear(path)
            write(made, path)
            _delete_unused(place)
        if fault:
            warnings.warn(
                f"the table of law {law.family!r} in the cache was damaged and has been built anew "
                f"({path}: {fault}); if this comes again, something alters its files: set "
                "CONTACTLAW_CACHE_DIR to another folder",
                stacklevel=2,
            )
    except OSError as error:  # read-only, full, over quota, a file in its place, locked for ever
        _warn_not_kept(law, place, error)
    return make(None) if made is None else made


def _warn_not_kept(law: Law, place: Path | str, reason: Exception) -> None:
    warnings.warn(
        f"the table of law {law.family!r} cannot be kept in {place} ({reason}), so each process "
        "builds it anew; set CONTACTLAW_CACHE_DIR to a writable folder, or CONTACTLAW_NO_CACHE=1",
        stacklevel=3,
    )


def progress_bar(rows: Iterator[Any], total: int) -> Iterable[Any]:
    """Show a bar once a build has taken a second; nothing where stderr is no terminal."""
    from tqdm import tqdm

    bar: Iterable[Any] = tqdm(rows, "contactlaw: solving", total, delay=1, disable=None)
    return bar


def _usable(path: Path, read: Callable[[Path], _T]) -> tuple[_T | None, str]:
    """Content of a cache file, or what is wrong with it; neither where there is no file."""
    try:
        found = read(path)
    except FileNotFoundError:
        return None, ""
    except (ValueError, LookupError) as error:
        return None, str(error.__cause__ or error)
    _mark_used(path)
    return found, ""


def _mark_used(path: Path) -> None:
    with contextlib.suppress(OSError):  # of a folder that cannot be written
        os.utime(path)


def _delete_unused(place: Path) -> None:
    """Delete what no process has read for three months, if its name is one that we give."""
    for path in place.iterdir():
        with contextlib.suppress(OSError):  # another process may have deleted it
            if _OUR_NAMES.fullmatch(path.name) and time.time() - path.stat().st_mtime > _UNUSED:
                path.unlink()


@contextlib.contextmanager
def _locked(path: Path) -> Iterator[None]:
    import filelock

    # the lock belongs to the operating system, which releases it however the process ends
    with filelock.FileLock(path.with_suffix(".lock"), timeout=_PATIENCE):
        yield


def _clear(path: Path) -> None:
    """Remove what killed writers left, and a device, pipe or link in the place of the file.

    The lock says that no writer is at work. A folder stays: its removal fails, as it should.
    """
    for left in path.parent.glob(f".{path.name}.*.part"):
        left.unlink(missing_ok=True)
    if path.is_symlink() or not path.is_file():
        path.unlink(missing_ok=True)
