"""Bytes of the files that users name."""

import math
from pathlib import Path

LARGEST_TEXT = 4e6  # [bytes] of materials and measurements, our choice; the catalogue has 28e3


def content_of(path: Path, largest: float = math.inf) -> bytes:
    """Bytes of a file; a pipe would make the reader wait, and a device may have no end."""
    if not path.is_file() and (path.exists() or path.is_symlink()):
        raise ValueError("it is no regular file, nor a link to one")
    if (size := path.stat().st_size) > largest:
        raise ValueError(f"it has {size} bytes, and no such file more than {largest:.9g}")
    return path.read_bytes()
