"""Tables that do not ship with the package: built once, kept in the user's cache folder.

A table is identified by the data of its law, not by the law's name: laws that differ only in their
yield compression share one. Shapes of force histories and slides are files of their own, made when a
first one is needed.
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
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any, TypeVar

from contactlaw import table as tables
from contactlaw._arrays import Array
from contactlaw._folder import folder
from contactlaw._kept import fingerprint
from contactlaw.laws import Law
from contactlaw.table import file, shapes, slides
from contactlaw.table.grid import Settings, on_demand
from contactlaw.table.table import Table

_T = TypeVar("_T")
# [s]; the lock ends with its process. The slowest table known takes 15 s of CPU, which may be
# minutes where many processes share a core: one that holds a lock for longer hangs.
_PATIENCE = 600.0
# How many tables, and shapes, stay in memory without a model that uses them, of 1 to 5 MB each.
_TABLES, _SHAPES = 16, 4
_UNUSED = 90 * 86400.0  # [s] after which a file that no process reads is deleted
_OUR_NAMES = re.compile(r"\.?(table|shapes|slides)-[0-9a-f]{24}\.(h5|lock|bin)(\.\w+\.part)?")


def file_name(kind: str, *ingredients: Any) -> str:
    """Name of a file, with a hash of all that its content depends on.

    Examples
    --------
    >>> from contactlaw.table.cache import file_name
    >>> file_name("table", "myc", 1e-9) == file_name("table", "myc", 1e-11)
    False
    """
    content = json.dumps([*ingredients, file.SCHEMA, fingerprint()])
    return f"{kind}-{hashlib.sha256(content.encode()).hexdigest()[:24]}.h5"


@functools.lru_cache(_TABLES)
def cached(law: Law, settings: Settings | None = None) -> Table:
    """Table of a law from the cache; built, and kept there, if it is missing or damaged.

    Whatever is wrong with the folder, a table is returned; a warning says that it was not kept.
    """
    settings = settings or on_demand(law)
    name = file_name("table", law.key, asdict(settings))

    def read(path: Path) -> Table:
        found = file.read(path)
        if (found.law.key, found.settings) != (law.key, settings):
            raise ValueError("it is the table of another law or of other settings")
        return dataclasses.replace(found, law=law)  # laws of one key may have other names

    return _kept(name, law, read, lambda: tables.build(law, settings), file.write)


@functools.lru_cache(_SHAPES)
def cached_shapes(table: Table) -> Array:
    """Return the shapes of force histories of a table, from the cache or built as in `cached`."""
    if table.histories is not None:
        return table.histories
    return _kept_beside(table, "shapes", lambda: shapes.build(table.law, table.grid, table.settings.rtol))


def cached_slides(table: Table, kappa: float) -> Array:
    """Tangential rebounds of a pair as kernels read them, from the cache or built as in `cached`."""
    return _kept_beside(table, "slides", lambda: slides.build(table, kappa), kappa)


def _kept_beside(table: Table, kind: str, make: Callable[[], Array], *numbers: float) -> Array:
    """Keep an array that belongs to a table."""
    name = file_name(kind, hashlib.sha256(table.packed.tobytes()).hexdigest(), *numbers)
    return _kept(
        name,
        table.law,
        lambda path: file.load(path)[0][kind],
        make,
        lambda made, path: file.store(path, {kind: made}, {"law": table.law.family}),
    )


def _kept(
    name: str, law: Law, read: Callable[[Path], _T], make: Callable[[], _T], write: Callable[[_T, Path], None]
) -> _T:
    """Read a file of the cache; if it is missing or damaged, make what belongs there and keep it."""
    import filelock

    found, place = None, None
    try:
        if place := folder():
            path = place / name
            if (found := _usable(path, law, read)) is None:
                place.mkdir(0o700, parents=True, exist_ok=True)
                # the lock belongs to the operating system, which releases it however the process ends
                with filelock.FileLock(path.with_suffix(".lock"), timeout=_PATIENCE):
                    # another process may have made it while this one waited
                    if (found := _usable(path, law, read)) is None:
                        found = make()
                        for left in place.glob(f".{name}.*.part"):  # by a writer that was killed
                            left.unlink()
                        write(found, path)
                        _delete_unused(place)
    except OSError as error:  # read-only, full, over quota, a file in its place, locked for ever
        warnings.warn(
            f"the table of law {law.family!r} cannot be kept in {place or 'a folder of this user'} ({error}), so each "
            "process builds it anew; set CONTACTLAW_CACHE_DIR to a writable folder, or CONTACTLAW_NO_CACHE=1",
            stacklevel=3,
        )
    return make() if found is None else found


def _usable(path: Path, law: Law, read: Callable[[Path], _T]) -> _T | None:
    """Content of a cache file; a damaged one is deleted."""
    try:
        found = read(path)
    except FileNotFoundError:
        return None
    except (ValueError, LookupError) as error:
        path.unlink()
        warnings.warn(
            f"the table of law {law.family!r} in the cache was damaged and is built anew ({path}: "
            f"{error.__cause__ or error}); if this comes again, something alters its files: set "
            "CONTACTLAW_CACHE_DIR to another folder",
            stacklevel=2,
        )
        return None
    with contextlib.suppress(OSError):  # of a folder that cannot be written
        os.utime(path)
    return found


def _delete_unused(place: Path) -> None:
    """Delete what no process has read for three months, if its name is one that we give."""
    for path in place.iterdir():
        with contextlib.suppress(OSError):  # another process may have deleted it
            if _OUR_NAMES.fullmatch(path.name) and time.time() - path.stat().st_mtime > _UNUSED:
                path.unlink()
