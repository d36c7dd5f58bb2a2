"""What a row of the impact record is: an impact, or another contact."""

import enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._arrays import Mask


class Kind(enum.IntEnum):
    """What a row of the record is; a coefficient of restitution has a meaning for impacts only."""

    IMPACT = 0  # a bead arrived in free flight, hit one wall or bead, and left it again
    SLIDING_ON = 1  # it was on a wall already and slid or rolled on to this one
    OVER_EDGE = 2  # it left because the wall ended under it
    STRUCK = 3  # something else struck it, or pressed on it, while it was in contact; or the plate
    # came back from its edge and gave it more energy than it took; it may leave faster than it came
    RESTING = 4  # it stayed in contact far longer than an impact lasts, as under its weight
    IN_CLUMP = 5  # it is a part of a rigid body of unknown mass; it was answered as if it flew alone
    OF_BODY = 6  # an impact of a rigid body, of which the bead is a part


def only_impacts(kinds: NDArray[Any]) -> tuple[Mask, str]:
    """Pick the rows of a record that are impacts; every reader of CORs and speeds does so.

    Parameters
    ----------
    kinds : array (n,)
        Column ``kind``; zeros for a record of an older version, whose rows count as impacts.

    Returns
    -------
    ndarray of bool, str
        Mask of the impacts, and which rows are none, "" if all are.

    Examples
    --------
    >>> only_impacts(np.array([0, 2, 0, 4, 2]))[1]
    '3 of 5 rows are no impacts and left out: 2 over edge, 1 resting'
    """
    found = np.isin(kinds, (Kind.IMPACT, Kind.OF_BODY))
    names = {kind.value: kind.name.lower().replace("_", " ") for kind in Kind}
    others, counts = np.unique(kinds[~found], return_counts=True)
    listed = (f"{n} {names.get(kind, 'unknown')}" for kind, n in zip(others, counts, strict=True))
    head = f"{counts.sum()} of {kinds.size} rows are no impacts and left out: "
    return found, head + ", ".join(listed) if others.size else ""
