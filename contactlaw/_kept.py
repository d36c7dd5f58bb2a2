"""Where compiled code is kept, and the fingerprint of the sources that it was compiled from.

Machine code goes into a folder whose name is a hash of the kernels' sources, numba's version and
the CPU: numba itself notices an edit only in a function's own file, and would keep the old code of
functions that it calls in other files. Laws are data, so no kernel takes a function from outside.
"""

import contextlib
import functools
import hashlib
import re
import shutil
import sys
import time
import warnings
from pathlib import Path
from typing import Any

import numba
from llvmlite import binding as llvm

from contactlaw import _folder

config: Any = numba.config
_UNUSED = 30 * 86400.0  # [s] after which unused code of another version is deleted
_MARKER = "last_use_by_contactlaw"  # file in each folder of ours; its time says when that was


@functools.cache
def code_folder() -> Path | None:
    """Folder of the machine code, made if missing: in NUMBA_CACHE_DIR if set, else in ours."""
    try:
        home = Path(config.CACHE_DIR) if config.CACHE_DIR else _folder.folder()
        if home is None:
            return None
        # a process may change its working folder, and numba does not expand ~
        home = home.expanduser().absolute()
        folder = home / f"contactlaw-{fingerprint()}"
        is_new = not folder.is_dir()
        if is_new:
            home.mkdir(0o700, parents=True, exist_ok=True)
            folder.mkdir(0o700, exist_ok=True)
        if not (_folder.is_private(home, sticky=True) and _folder.is_private(folder)):
            return None
        (folder / _MARKER).touch(0o600)  # records the time of use; raises if we may not write
        if is_new:
            _delete_unused(folder)
            if sys.stderr is not None and sys.stderr.isatty():
                print(
                    f"contactlaw: the first use of this version compiles it, for about half a minute; kept in {home}",
                    file=sys.stderr,
                )
        return folder
    except OSError as error:
        warn_once(str(error))
        return None


def _delete_unused(folder: Path) -> None:
    """Delete this user's machine code of other versions, if no process has used it for a month.

    A folder with the name of ours, but without the marker, is a user's or that of an old version.
    """
    for other in folder.parent.glob("contactlaw-" + 16 * "[0-9a-f]"):
        with contextlib.suppress(OSError):  # no marker, or another process has just deleted it
            used = (other / _MARKER).stat()
            if time.time() - used.st_mtime > _UNUSED and used.st_uid == folder.stat().st_uid:
                shutil.rmtree(other, ignore_errors=True)  # not what a link leads to


@functools.cache
def fingerprint() -> str:
    """Hash of all that machine code and tables depend on: kernels, numba's settings, the CPU."""
    features = llvm.get_host_cpu_features().flatten()
    known = numba.__version__, llvm.get_host_cpu_name(), features, config.BOUNDSCHECK
    digest = hashlib.sha256(repr(known).encode())
    for path, text in _sources().items():
        digest.update(path.encode() + text)
    return digest.hexdigest()[:16]


def _sources() -> dict[str, bytes]:
    """Every file of a folder that has a kernel, or from which one of these folders imports."""
    package = Path(__file__).parent
    paths = sorted(package.rglob("*.py"))
    texts = {path.relative_to(package): path.read_bytes() for path in paths}
    home = {path: Path(path.parts[0]).stem.encode() for path in texts}
    kernels = {home[path] for path, text in texts.items() if b"@kernel" in text}
    imports = re.compile(rb"^ *from contactlaw(?:\.| import )(\w+)", re.M)
    used = [imports.findall(text) for path, text in texts.items() if home[path] in kernels]
    kernels = kernels.union(*used)
    return {path.as_posix(): text for path, text in texts.items() if home[path] in kernels}


@functools.cache
def warn_once(reason: str) -> None:
    warnings.warn(
        f"numba cannot keep compiled code on disk ({reason}), so each process compiles it anew; "
        "set NUMBA_CACHE_DIR to a writable folder with some megabytes left",
        stacklevel=2,
    )
