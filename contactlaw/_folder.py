"""The user's cache folder, where contactlaw keeps tables and compiled code.

The folder is that of the platform (``~/.cache/contactlaw`` on Linux). The environment variable
``CONTACTLAW_CACHE_DIR`` names another one; ``CONTACTLAW_NO_CACHE=1`` keeps all in memory.
Files may be deleted at any time.
"""

import contextlib
import functools
import os
import stat
import warnings
from pathlib import Path


def folder() -> Path | None:
    """Folder of the cache; None if it is switched off, or others may write into it.

    Raises
    ------
    FileNotFoundError
        If it would be in the user's home folder and there is none, as in a container whose user
        has no entry in the list of users.
    """
    if os.environ.get("CONTACTLAW_NO_CACHE", "").lower() not in ("", "0", "no", "off", "false"):
        return None
    chosen = os.environ.get("CONTACTLAW_CACHE_DIR")
    try:
        if not chosen:
            import platformdirs

            # without a home folder old versions of platformdirs leave the ~: expanding it raises
            chosen = platformdirs.user_cache_dir("contactlaw", appauthor=False)
        path = Path(chosen).expanduser()
    except RuntimeError as error:
        raise FileNotFoundError(str(error)) from error
    return path if is_private(path) else None


@functools.cache
def is_private(path: Path, sticky: bool = False) -> bool:
    """Whether only this user and root may write into a folder, if there is one; otherwise warn."""
    with contextlib.suppress(OSError):  # there is none yet, or whoever makes it says what is wrong
        found = path.stat()
        # Into a sticky one, as /tmp, others can only put files of theirs beside those of this user.
        others = 0 if sticky and found.st_mode & stat.S_ISVTX else found.st_mode & 0o022
        if os.name != "nt" and (others or found.st_uid not in (0, os.geteuid())):
            warnings.warn(
                f"the cache folder {path} is not used, so each process computes and compiles anew: "
                "others may write into it, and cached code is executed. If you trust what is in "
                f"it, `chmod go-w {path}`; if it is not yours, name a folder of your own in "
                "CONTACTLAW_CACHE_DIR, or in NUMBA_CACHE_DIR if you set that",
                stacklevel=3,
            )
            return False
    return True
