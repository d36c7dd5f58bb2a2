"""The user's cache folder, where contactlaw keeps tables and compiled code.

The folder is that of the platform (``~/.cache/contactlaw`` on Linux). The environment variable
``CONTACTLAW_CACHE_DIR`` names another one; ``CONTACTLAW_NO_CACHE=1`` keeps all in memory.
Files may be deleted at any time.
"""

from __future__ import annotations

import os
from pathlib import Path


def folder() -> Path | None:
    """Folder of the cache; None if it is switched off.

    Raises
    ------
    RuntimeError
        If it would be in the user's home folder and there is none, as in a container whose user
        has no entry in the list of users.
    """
    if os.environ.get("CONTACTLAW_NO_CACHE", "").lower() not in ("", "0", "no", "off", "false"):
        return None
    chosen = os.environ.get("CONTACTLAW_CACHE_DIR")
    if chosen:
        return Path(chosen).expanduser()
    import platformdirs

    # without a home folder old versions of platformdirs leave the ~: raise, or it becomes a folder
    return platformdirs.user_cache_path("contactlaw", appauthor=False).expanduser()
