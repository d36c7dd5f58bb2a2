"""Tables that do not ship with the package: built once, kept in the user's cache folder.

The folder is that of the platform (``~/.cache/contactlaw`` on Linux). The environment variable
``CONTACTLAW_CACHE_DIR`` names another one; ``CONTACTLAW_NO_CACHE=1`` keeps all in memory.
Files may be deleted at any time.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import inspect
import json
import os
import sys
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from pathlib import Path
from types import ModuleType

from contactlaw import _jit, laws, packing, shapes, store, table, zener
from contactlaw._version import VERSION
from contactlaw.table import Array, Settings, Table

_PATIENCE = 60.0  # [s]: a build takes a few; a lock held for longer belongs to a process that hangs


def folder() -> Path | None:
    """Folder of the cache; None if it is switched off."""
    if os.environ.get("CONTACTLAW_NO_CACHE", "").lower() not in ("", "0", "no", "off", "false"):
        return None
    chosen = os.environ.get("CONTACTLAW_CACHE_DIR")
    if chosen:
        return Path(chosen).expanduser()
    import platformdirs

    return platformdirs.user_cache_path("contactlaw", appauthor=False)


def file_name(law: str, settings: Settings) -> str:
    """Name of a table's file: the law, and a hash of all that its content depends on.

    Examples
    --------
    >>> from contactlaw.cache import file_name
    >>> from contactlaw.table import Settings
    >>> file_name("myc", Settings()) == file_name("myc", Settings(rtol=1e-11))
    False
    """
    chosen = laws.law(law)
    ingredients = {
        "law": law,
        "parameters": [chosen.yield_coefficient, *chosen.kinks],
        "settings": asdict(settings),
        "schema": store.SCHEMA,
        "version": VERSION,
        "sources": [_source(module) for module in _sources(chosen)],
    }
    digest = hashlib.sha256(json.dumps(ingredients, sort_keys=True).encode()).hexdigest()
    return f"{law}-{digest[:16]}.h5"


def _sources(law: laws.Law) -> tuple[ModuleType, ...]:
    """Modules whose edit may change a table: a number that was not raised is no excuse."""
    own = {function.__module__ for function in law.functions[:-1]}  # a law may share functions
    return _jit, laws, *(sys.modules[name] for name in sorted(own)), zener, packing, shapes, table


def _source(module: ModuleType) -> str:
    try:
        return inspect.getsource(module)
    except OSError:  # an installation without sources; the version has to do
        return module.__name__


def progress_bar(rows: Iterator[Array], total: int) -> Iterable[Array]:
    """Show a bar once a build has taken a second; nothing where stderr is no terminal."""
    from tqdm import tqdm

    bar: Iterable[Array] = tqdm(rows, "contactlaw: solving", total, delay=1, disable=None)
    return bar


@functools.cache
def cached(law: str, settings: Settings | None = None) -> Table:
    """Table of a law from the cache; built, and kept there, if it is missing or damaged.

    Whatever is wrong with the folder, there is an answer; one warning says that it was not kept.
    """
    settings = settings or Settings()
    place = folder()
    if place is None:
        return table.build(law, settings, progress=progress_bar)
    path = place / file_name(law, settings)
    built: Table | None = None
    try:
        found = _usable(path, law, settings)
        if found is not None:
            return found
        place.mkdir(parents=True, exist_ok=True)
        with _locked(path):
            # another process may have built it while this one waited
            found = _usable(path, law, settings)
            if found is not None:
                return found
            built = table.build(law, settings, progress=progress_bar)
            _sweep(path)
            store.write(built, path)
    except OSError as error:  # read-only, full, over quota, a file in its place, locked for ever
        warnings.warn(
            f"the table of law {law!r} cannot be kept in {place} ({error}), so each process builds "
            "it anew; set CONTACTLAW_CACHE_DIR to a writable folder, or CONTACTLAW_NO_CACHE=1",
            stacklevel=2,
        )
    return built or table.build(law, settings, progress=progress_bar)


def _usable(path: Path, law: str, settings: Settings) -> Table | None:
    """Table in a cache file; None where there is none, or a damaged or another one: built anew."""
    try:
        found = store.read(path)
    except (FileNotFoundError, store.DamagedTableError):
        return None
    return found if (found.law, found.settings) == (law, settings) else None


@contextlib.contextmanager
def _locked(path: Path) -> Iterator[None]:
    import filelock

    # the lock is the kernel's: it goes with its process, however that ends
    with filelock.FileLock(path.with_suffix(".lock"), timeout=_PATIENCE):
        yield


def _sweep(path: Path) -> None:
    """Remove what writers left that were killed; the lock says that none is at work."""
    for left in path.parent.glob(f".{path.name}.*.part"):
        left.unlink(missing_ok=True)
