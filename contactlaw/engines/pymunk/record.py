"""The record of impacts that an adapter keeps: what was seen in the run, the rest on demand."""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence

import numpy as np
from numpy.lib.recfunctions import repack_fields
from numpy.typing import NDArray

from contactlaw.engines.needs import Array, ReboundModel, RestitutionModel, knows_rebounds
from contactlaw.engines.record import IMPACT, OBSERVED, fill

Plates = Sequence[tuple[RestitutionModel, float]]  # model and thickness [m], by index


class Record:
    """Impacts, added one by one and read as one array."""

    def __init__(self) -> None:
        self._seen = array("d")  # 72 bytes per impact; a list of tuples takes five times that
        self.add = self._seen.extend  # takes one tuple in the order of OBSERVED
        self._rows = np.empty(0, IMPACT)  # of the first impacts seen: those that were read already

    def read(
        self, model: RestitutionModel, radii: Sequence[float], plates: Plates
    ) -> NDArray[np.void]:
        """Structured array of all impacts; each is looked up when it is first read, and not again.

        Parameters
        ----------
        model : RestitutionModel
            That of the beads. Unless it and those of all plates are a `ReboundModel`, there are
            only the columns of OBSERVED.
        radii : sequence of float
            Of the beads, by index [m].
        plates : sequence of (model, thickness [m])
            By index. There may be more than in the last call, as with radii, but no others.
        """
        models = [m for m in (model, *(m for m, _ in plates)) if knows_rebounds(m)]
        whole = len(models) == 1 + len(plates)
        seen = np.array(self._seen[len(self._rows) * len(OBSERVED) :]).reshape(-1, len(OBSERVED))
        if len(seen):
            rows = np.zeros(len(seen), IMPACT)
            for name, column in zip(OBSERVED, seen.T, strict=True):
                rows[name] = column
            if whole:
                _complete(rows, models, np.array(radii), np.array([h for _, h in plates]))
            self._rows = np.concatenate((self._rows, rows))
        # Plates do not go: where a COR is all that is known, it is so for the rest of the run.
        return self._rows.copy() if whole else repack_fields(self._rows[list(OBSERVED)])


def _complete(
    rows: NDArray[np.void], models: Sequence[ReboundModel], radius: Array, thickness: Array
) -> None:
    """Look impacts up; the first model is that of the beads, the others are those of the plates."""
    beads, *plates = models
    on_bead = rows["other"] >= 0
    bead, other = radius[rows["bead"]], radius[rows["other"]]
    target = np.where(on_bead, other, np.append(thickness, math.nan)[rows["plate"]])
    # m1 m2/(m1 + m2), all beads being of one material; a plate counts as a mass without end
    mass = 4.0 / 3.0 * math.pi * beads.pair.sphere.density * bead**3
    mass /= 1.0 + np.where(on_bead, bead / other, 0.0) ** 3
    energy = 0.5 * mass * rows["approach_speed"] ** 2
    questions = []
    for model in {id(plate): plate for plate in plates}.values():
        own = np.array([plate is model for plate in plates] + [False])  # last: plate -1
        questions.append((model.lookup, own[rows["plate"]]))
    questions.append((beads.lookup_sphere_sphere, on_bead))
    for lookup, chosen in questions:
        if chosen.any():
            part = rows[chosen]
            fill(part, lookup(part["approach_speed"], bead[chosen], target[chosen]), energy[chosen])
            rows[chosen] = part
