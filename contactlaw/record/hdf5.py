"""Reading of HDF5 files that other programs may have written: every part is checked.

h5py answers what a file does not have with KeyError, TypeError, OSError or RuntimeError, and takes
the memory that a dataset's shape asks for before it looks at what is stored: 15 kB may ask for
hundreds of gigabytes. Every refusal here is a ValueError with the part's name, what it is and what
was expected.
"""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw._arrays import Integers

LARGEST = 100_000_000  # rows of a column: a day's run of 10,000 beads has a hundredth of it


@contextmanager
def opened(content: bytes) -> Iterator[h5py.File]:
    """Open a file that is in memory; what h5py cannot read of it is a ValueError."""
    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            yield file
    except ValueError:  # a refusal, which has its message already
        raise
    except Exception as error:
        raise ValueError(f"no HDF5 file, or a damaged one: {error}") from None


def group(parent: h5py.Group, name: str) -> h5py.Group:
    """Return a group within another."""
    return _member(parent, name, h5py.Group)


def numbers(parent: h5py.Group, name: str, size: int | None = None) -> NDArray[Any]:
    """Read a column of numbers, of `size` rows if that is given and of `LARGEST` at most."""
    dataset = _member(parent, name, h5py.Dataset)
    where = f"dataset {dataset.name[1:]}"
    is_column = dataset.ndim == 1 and dataset.dtype.kind in "iuf" and dataset.size <= LARGEST
    if not (is_column and size in (None, dataset.size)):
        rows = f"{LARGEST} rows at most" if size is None else f"{size} rows as in the other columns"
        what = f"has the shape {dataset.shape} and the type {dataset.dtype}"
        raise ValueError(f"{where} {what}, expected a column of numbers, {rows}")
    try:
        found = np.asarray(dataset[()])  # limits of numbers would overflow in two bytes
        return found.astype(np.float64) if found.dtype.kind == "f" else found
    except Exception as error:
        raise ValueError(f"{where} is damaged: {error}") from None


def indices(parent: h5py.Group, name: str, count: int, size: int | None = None) -> Integers:
    """Read a column of whole numbers from 0 to `count` - 1, or -1 for none."""
    found = numbers(parent, name, size)
    # not (...) also for NaN
    wrong = np.flatnonzero(~((found >= -1) & (found < count) & (found == np.floor(found))))
    if wrong.size:
        raise ValueError(
            f"dataset {parent.name[1:]}/{name} has {found[wrong[0]]} in row {wrong[0]}, expected a "
            f"whole number from 0 to {count - 1}, or -1 for none"
        )
    return found.astype(np.int64)


def _member(parent: h5py.Group, name: str, kind: type) -> Any:
    found = parent.get(name)
    if not isinstance(found, kind):
        raise ValueError(f"it has no {kind.__name__.lower()} {parent.name}/{name}".replace(" //", " /"))
    return found
