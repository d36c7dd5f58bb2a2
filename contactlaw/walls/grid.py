"""A grid over the facets of a frame, by which those near a bead are found.

A cell lists all facets that a bead may touch whose centre is in the cell and whose radius is at
most the grid's reach. For a larger bead the cells around are read too.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import as_python, enable_caching, kernel, switched_off
from contactlaw.walls.facet import on_facet

Floats = NDArray[np.float64]

GRID: list[tuple[Any, ...]] = [
    ("origin", "f8", 3),
    ("per_length", "f8"),
    ("cells", "i8", 3),
    ("starts", "i8"),
    ("entries", "i8"),
    ("entry_count", "i8"),  # addresses of the lists
    ("busy", "i8"),
    ("cell_count", "i8"),  # address of a bit per cell, set if its list has facets
    ("reach", "f8"),
    ("low", "f8", 3),
    ("high", "f8", 3),  # low, high: box around the facets
]

_SMALL = 10_000  # facets times cells that Python fills in 0.1 s; the compiler takes 1.5 s
_MOST = 1 << 20  # cells of a large grid, up to twice as many by rounding; 8 bytes each
_FEW = 27  # most cells of a block that is not halved; a facet smaller than a cell has 27 around it
_DEEPEST = 64  # most blocks still to do; halving the largest grid, of 2^21 cells, takes some 20
MARGIN = 1.1  # factor on the reach: a cell still lists a facet in the step after a bead left it


class FacetGrid:
    """Lists of facets by cell.

    Parameters
    ----------
    facets : structured array
        Facets in order.
    boxes : ndarray, shape (n, 2, 3)
        Lowest and highest coordinates of each facet [m].
    first : int
        Number of the first facet.
    largest : float
        Largest radius of beads that find all they touch in one cell [m]; 0: not known yet.
    """

    def __init__(self, facets: Any, boxes: Floats, first: int, largest: float) -> None:
        extent = float(np.median(np.linalg.norm(boxes[:, 1] - boxes[:, 0], axis=1)))
        self.low, self.high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
        self.reach = MARGIN * (largest if largest > 0.0 else 0.5 * extent)
        low = self.low - self.reach
        size = self.high + self.reach - low
        cell = max(self.reach, float((np.prod(size) / _MOST) ** (1.0 / 3.0)))
        cells = np.maximum(np.ceil(size / cell), 1.0).astype(np.int64)
        while np.prod(cells.astype(float)) > 2 * _MOST:  # as of a slab less than a cell thick
            cell *= 1.1
            cells = np.maximum(np.ceil(size / cell), 1.0).astype(np.int64)
        self.origin, self.per_length, self.cells = low, 1.0 / cell, cells
        enable_caching()
        counts = np.zeros(int(cells.prod()) + 1, np.int64)
        nothing = np.empty(0, np.int32)
        # The same one for both: with another one's rounding, a list might not have room for all.
        fill_lists = _fill_lists
        if len(facets) * counts.size < _SMALL or switched_off():
            fill_lists, facets = as_python(_fill_lists), facets.view(np.recarray)
        fill_lists(facets, boxes, low, cell, cells, self.reach, counts, nothing)
        self.starts = np.cumsum(counts)
        self.busy = np.packbits(counts[1:] > 0, bitorder="little")
        self.entries = np.empty(int(self.starts[-1]), np.int32)
        ends = self.starts[:-1].copy()
        fill_lists(facets, boxes, low, cell, cells, self.reach, ends, self.entries)
        self.entries += first

    def fill(self, row: Any) -> None:
        """Write the grid into a row of FRAME."""
        row["origin"], row["per_length"], row["cells"] = self.origin, self.per_length, self.cells
        row["starts"], row["entries"] = self.starts.ctypes.data, self.entries.ctypes.data
        row["entry_count"], row["reach"] = self.entries.size, self.reach
        row["low"], row["high"] = self.low, self.high
        row["busy"], row["cell_count"] = self.busy.ctypes.data, self.starts.size - 1


@kernel
def _within(facet: Any, p: Any, most: float) -> bool:
    """Whether a point is no farther from a facet than `most`."""
    return bool(on_facet(facet, (p[0], p[1], p[2]), most).x >= 0.0)


@kernel
def _halve(block: Any, other: Any) -> None:
    """Halve a block of cells along its longest side; the other half is written into `other`."""
    axis = 0
    for k in range(3):
        other[k, 0], other[k, 1] = block[k, 0], block[k, 1]
        if block[k, 1] - block[k, 0] > block[axis, 1] - block[axis, 0]:
            axis = k
    cut = (block[axis, 0] + block[axis, 1]) // 2
    block[axis, 1], other[axis, 0] = cut, cut + 1


@kernel(cache=True)
def _fill_lists(
    facets: Any, boxes: Floats, low: Floats, cell: float, cells: Any, reach: float, ends: Any, entries: Any
) -> None:
    """Count the facets of each cell in `ends`, one index on, or write them if `entries` has room.

    The box around a long thin facet that lies across the axes holds nearly all cells, and the facet
    is near few of them. So a block of many cells is halved, and left out if the facet is not near.
    """
    writing = entries.size > 0
    half = 0.5 * math.sqrt(3.0) * cell
    middle = np.empty(3)
    blocks = np.empty((_DEEPEST, 3, 2), np.int64)  # blocks still to do: first and last cell of each
    for n in range(len(facets)):
        for k in range(3):
            small, large = boxes[n, 0, k], boxes[n, 1, k]
            blocks[0, k, 0] = max(int(math.floor((small - reach - low[k]) / cell)), 0)
            blocks[0, k, 1] = min(int(math.floor((large + reach - low[k]) / cell)), cells[k] - 1)
        left = 1
        while left > 0:
            block = blocks[left - 1]
            count, square = 1, 0
            for k in range(3):
                middle[k] = low[k] + 0.5 * (block[k, 0] + block[k, 1] + 1) * cell
                count *= block[k, 1] - block[k, 0] + 1
                square += (block[k, 1] - block[k, 0] + 1) ** 2
            if count > _FEW:
                if _within(facets[n], middle, reach + 0.5 * math.sqrt(square) * cell):
                    _halve(block, blocks[left])
                    left += 1
                else:
                    left -= 1
                continue
            left -= 1
            for i in range(block[0, 0], block[0, 1] + 1):
                for j in range(block[1, 0], block[1, 1] + 1):
                    for k in range(block[2, 0], block[2, 1] + 1):
                        middle[0], middle[1], middle[2] = (
                            low[0] + (i + 0.5) * cell,
                            low[1] + (j + 0.5) * cell,
                            low[2] + (k + 0.5) * cell,
                        )
                        if not _within(facets[n], middle, reach + half):
                            continue
                        at = (i * cells[1] + j) * cells[2] + k
                        if writing:
                            entries[ends[at]] = n
                            ends[at] += 1
                        else:
                            ends[at + 1] += 1
