"""Bytes of the files that users name."""

import math
from pathlib import Path

LARGEST_PIPE = 1e9  # [bytes] our choice
LARGEST_TEXT = 4e6  # [bytes] of materials and measurements, our choice; the catalogue has 28e3


def content_of(path: Path, largest: float = math.inf, pipe: bool = False) -> bytes:
    """Bytes of a file; a device may have no end, and a pipe makes the reader wait for a writer."""
    if pipe and path.is_fifo():
        most = int(min(largest, LARGEST_PIPE))
        with path.open("rb") as file:
            content = file.read(most + 1)
        if len(content) > most:
            raise ValueError(f"it has more than {most} bytes, the most of such a pipe")
        return content
    if not path.is_file() and (path.exists() or path.is_symlink()):
        raise ValueError("it is no regular file, nor a link to one")
    if (size := path.stat().st_size) > largest:
        raise ValueError(f"it has {size} bytes, and no such file more than {largest:.9g}")
    return path.read_bytes()
