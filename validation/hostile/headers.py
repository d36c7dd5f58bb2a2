"""The C header of every pair of the catalogue: it is written, small, and states a small error."""

from __future__ import annotations

import ctypes
import itertools
import re
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import contactlaw as cl

FULL = len(cl.materials()) ** 2
_LARGEST = 400_000  # bytes, as docs/c.md says
_CLOSE = 1e-5  # error of COR by the table, also as docs/c.md says


def faults(count: int, seed: int) -> Iterator[str]:
    """Write the headers of that many pairs."""
    pairs = list(itertools.product(cl.materials(), repeat=2))
    for n in np.random.default_rng(seed).permutation(len(pairs))[:count]:
        yield from of_pair(*pairs[n])


def of_pair(sphere: str, plate: str) -> Iterator[str]:
    """Write the header of one pair."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "contactlaw.h"
        try:
            cl.export.header(path, cl.ImpactModel(cl.Pair(sphere, plate)))
        except ValueError as error:
            yield f"{sphere} on {plate}: {error}"
            return
        size, text = path.stat().st_size, re.sub(r"[\s*]+", " ", path.read_text())
    promised = re.search(r"within ([\d.e-]+) of the", text)
    if size > _LARGEST:
        yield f"{sphere} on {plate}: {size} bytes"
    if not (promised and float(promised[1]) <= _CLOSE):
        yield f"{sphere} on {plate}: its certificate is {promised and promised[0]}"


def compiled(model: cl.ImpactModel, folder: Path, source: str, *options: str) -> ctypes.CDLL:
    """Compile a C source that includes the header of a model, and load it."""
    cl.export.header(folder / "contactlaw.h", model)
    (folder / "source.c").write_text(source)
    command = ["gcc", "-std=c99", *options, "-shared", "-fPIC", "source.c", "-o", "out.so", "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    return ctypes.CDLL(str(folder / "out.so"))
