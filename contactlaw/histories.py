"""Force histories of the impacts of a record, which its materials and laws give again.

A record has neither edges nor curvature nor foundations of walls. So an impact has a history here
only if its wave took what the endless flat plate of the model takes.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, Places
from contactlaw._errors import ArgumentError
from contactlaw.model import ImpactModel
from contactlaw.physical.kind import Kind
from contactlaw.physical.scaling import plate_mobility, wave_path
from contactlaw.record.file import Record

# Samples of a contact: third octaves down to 3e-5 of the largest one are within 3e-3 of those of 2049.
_SAMPLES = 256
_CHUNK = 512  # contacts at a time, so that what is made of them needs no more than 50 MB
# Largest difference of the wave's energy from that on a flat endless plate. In time steps of LAMMPS
# it was 0.0007; next to an edge the wave takes up to three times as much.
_ALIKE = 0.02
_NEEDED = {"time", "kind", "approach_speed", "radius", "thickness", "mass", "parcel", "wave_energy"}


class Histories(NamedTuple):
    """Impacts with a force history, n of them; forces are those of one true bead of a parcel."""

    row: Places  # of each impact in the record, shape (n,)
    time: Array  # since first touch [s], shape (n, samples)
    force: Array  # [N], shape (n, samples)
    impulse: Array  # integral of the force since first touch [N s], shape (n, samples)
    square: Array  # integral of F^2 [N2 s], shape (n,), of all true beads of the row
    mobility: Array  # that of an endless thin plate [m/(s N)], shape (n,)
    spread: Array  # sqrt(D/m) of the plate [m2/s], shape (n,)


def histories_of(record: Record) -> Iterator[Histories]:
    """Give those of some contacts on walls that have a force history, some at a time.

    Raises
    ------
    ValueError
        If the record lacks materials or a column, or none of its contacts has a force history.
    """
    rows = record.rows
    if not record.bodies or not _NEEDED <= {*(rows.dtype.names or ())}:
        raise ArgumentError("record", None, f"lacks {record.lacks}: no force is known without materials and sizes")
    known = False
    for number, (pair, law) in enumerate(record.bodies):
        some = np.flatnonzero((rows["kind"] == Kind.IMPACT) & (record.which == number))
        if not some.size:
            continue
        model = ImpactModel(pair, law, outside="solve")
        for part in np.split(some, range(_CHUNK, some.size, _CHUNK)):
            hit = rows[part]
            beads, thickness = np.maximum(hit["parcel"], 1.0) ** 3, hit["thickness"]
            contact = model.force_history(
                hit["approach_speed"], hit["radius"], thickness, _SAMPLES, mass=hit["mass"] / beads
            )
            square = contact.time[:, 1] * (contact.force**2).sum(axis=1) * beads
            expected = contact.plate_displacement[:, -1] / contact.impulse[:, -1] * square
            alike = abs(hit["wave_energy"] - expected) <= _ALIKE * expected
            plate = plate_mobility(pair.plate, thickness), wave_path(pair.plate) * thickness
            columns = part, contact.time, contact.force, contact.impulse, square, *plate
            known |= bool(alike.any())
            yield Histories(*(column[alike] for column in columns))
    if not known:
        reason = "has no impact on this wall, or on any, whose force is known: no free impact of a single bead on a "
        raise ArgumentError("record", None, f"{reason}flat wall, far from its edges")
