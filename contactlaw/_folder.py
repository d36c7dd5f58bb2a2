"""Where contactlaw keeps what it need not compute twice: the user's cache folder.

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
        If it is in a home folder and there is none, as of a container's user without an entry in
        the list of users.
    """
    if os.environ.get("CONTACTLAW_NO_CACHE", "").lower() not in ("", "0", "no", "off", "false"):
        return None
    chosen = os.environ.get("CONTACTLAW_CACHE_DIR")
    if chosen:
        return Path(chosen).expanduser()
    import platformdirs

    # early versions leave the ~ of a user without a home: a folder of that name would be made
    return platformdirs.user_cache_path("contactlaw", appauthor=False).expanduser()
