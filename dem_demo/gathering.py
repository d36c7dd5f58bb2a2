"""New impacts of all ranks, once each: a record that grows gets what it does not have yet."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray


class Walls(Protocol):
    """What contactlaw attached to an engine on one rank."""

    def collisions(self) -> NDArray[np.void]:
        """All impacts that ended on this rank so far, in that order."""
        ...


class Gathering:
    """Gathers what has ended since the last time.

    An impact may begin before another one and end after it: a table sorted by time would grow in
    its middle.

    Parameters
    ----------
    communicator : mpi4py.MPI.Comm
        Of the ranks.
    walls : Walls
        Of this rank.
    """

    def __init__(self, communicator: Any, walls: Walls) -> None:
        self._communicator, self._walls, self._told = communicator, walls, 0

    def take(self) -> NDArray[np.void] | None:
        """Return the new impacts by time, beads counted from 0: on rank 0, None on the others."""
        own = self._walls.collisions()
        parts = self._communicator.gather(own[self._told :])
        self._told = own.size
        if parts is None:
            return None
        rows: NDArray[np.void] = np.concatenate(parts)
        rows["bead"] -= 1
        return rows[np.lexsort((rows["bead"], rows["time"]))]
