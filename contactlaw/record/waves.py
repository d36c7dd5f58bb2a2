"""Impacts on a plate that still moves from the impact of another bead."""

import numpy as np

from contactlaw.physical.kind import Kind
from contactlaw.physical.scaling import wave_path
from contactlaw.physical.validity import Validity
from contactlaw.record.file import Record

_NEAREST = 9  # rows in place and time that are looked at, the row itself included
_REACH = 16.0  # square of the distance over b t up to which a wave has come in the time t
# Least motion of the plate by the other bead, over that by the own one. By superposition on a thin
# plate, of 500 pairs those beyond these two limits have a COR within 0.04 of that of one bead.
_MOVED = 0.05


def flag_shared(record: Record) -> None:
    """Set `Validity.SHARED_PLATE` in the rows of a record that knows the bodies of all rows."""
    from scipy.spatial import cKDTree

    path = np.array([wave_path(one.pair.plate) for one in record.bodies])[record.which] * record.rows["thickness"]
    some = np.flatnonzero((record.rows["kind"] == Kind.IMPACT) & (path < np.inf))
    rows, path, point = record.rows[some], path[some], record.points[some]
    time, long, force, plate = (rows[name] for name in ("time", "contact_time", "peak_force", "plate"))
    share = rows["wave_energy"] / (0.5 * rows["mass"] * rows["approach_speed"] ** 2)
    if some.size > 1:
        scale = np.sqrt(_REACH * np.median(path * long))
        at = np.column_stack((point / scale, time / np.median(long), 1e12 * plate))  # plates are far apart
        near = cKDTree(at).query(at, min(_NEAREST, some.size))[1].T
        after = np.maximum(time - time[near], 0.0)
        within = np.maximum(after, long)
        moved = share * force[near] * np.minimum(long[near], within) / (force * within)
        square = ((point - point[near]) ** 2).sum(axis=2)
        shared = (time[near] < time + long) & (square < _REACH * path * (after + long)) & (moved > _MOVED)
        shared &= (plate == plate[near]) & (near != np.arange(some.size))
        record.rows["flags"][some[shared.any(axis=0)]] |= Validity.SHARED_PLATE
