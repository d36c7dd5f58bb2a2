"""The record of impacts that an adapter keeps: what was seen in the run, the rest on demand."""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.lib.recfunctions import repack_fields
from numpy.typing import NDArray

from contactlaw.engines.record import IMPACT, OBSERVED, fill

Array = NDArray[np.float64]


class Record:
    """Impacts, added one by one and read as one array."""

    def __init__(self) -> None:
        self._seen = array("d")  # 72 bytes per impact; a list of tuples takes five times that
        self.add = self._seen.extend  # takes one tuple in the order of OBSERVED
        self._rows = np.empty(0, IMPACT)  # of the first impacts seen: those that were read already

    def read(
        self, model: Any, radii: Sequence[float], plates: Sequence[tuple[Any, float]]
    ) -> NDArray[np.void]:
        """Structured array of all impacts; each is looked up when it is first read, and not again.

        Parameters
        ----------
        model : ImpactModel
            That of the beads. Without ``lookup`` and ``lookup_sphere_sphere``, here and in every
            plate's model, there are only the columns of OBSERVED.
        radii : sequence of float
            Of the beads, by index [m].
        plates : sequence of (model, thickness [m])
            By index. There may be more than in the last call, as with radii, but no others.
        """
        models = {id(m): m for m in (model, *(m for m, _ in plates))}
        whole = hasattr(model, "lookup_sphere_sphere")
        whole = whole and all(hasattr(m, "lookup") for m in models.values())
        seen = np.array(self._seen[len(self._rows) * len(OBSERVED) :]).reshape(-1, len(OBSERVED))
        if len(seen):
            rows = np.zeros(len(seen), IMPACT)
            for name, column in zip(OBSERVED, seen.T, strict=True):
                rows[name] = column
            if whole:
                _complete(rows, model, np.array(radii), plates)
            self._rows = np.concatenate((self._rows, rows))
        # Plates do not go: where a COR is all that is known, it is so for the rest of the run.
        return self._rows.copy() if whole else repack_fields(self._rows[list(OBSERVED)])


def _complete(
    rows: NDArray[np.void], model: Any, radius: Array, plates: Sequence[tuple[Any, float]]
) -> None:
    """Ask the models of the plates for impacts on them, that of the beads for bead on bead."""
    on_bead = rows["other"] >= 0
    bead, other = radius[rows["bead"]], radius[rows["other"]]
    thickness = np.array([h for _, h in plates] + [math.nan])[rows["plate"]]  # last: bead on bead
    target = np.where(on_bead, other, thickness)
    # m1 m2/(m1 + m2), all beads being of one material; a plate counts as a mass without end
    mass = 4.0 / 3.0 * math.pi * model.pair.sphere.density * bead**3
    mass /= 1.0 + np.where(on_bead, bead / other, 0.0) ** 3
    energy = 0.5 * mass * rows["approach_speed"] ** 2
    questions = []
    for each in {id(m): m for m, _ in plates}.values():
        own = np.array([m is each for m, _ in plates] + [False])
        questions.append((each.lookup, own[rows["plate"]]))
    questions.append((model.lookup_sphere_sphere, on_bead))
    for lookup, chosen in questions:
        if chosen.any():
            part = rows[chosen]
            fill(part, lookup(part["approach_speed"], bead[chosen], target[chosen]), energy[chosen])
            rows[chosen] = part
