"""What a row of the impact record is: an impact, or another contact."""

import enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._arrays import Mask
from contactlaw._readable import percent


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


# What happened in contacts that are no impacts, for sentences about them.
_HAPPENED = {
    Kind.SLIDING_ON: "slid on from another wall",
    Kind.OVER_EDGE: "left over the edge of a wall",
    Kind.STRUCK: "were struck by another bead while they touched the wall",
    Kind.RESTING: "stayed as under their weight",
    Kind.IN_CLUMP: "were parts of a rigid body of unknown mass",
}
_REASON = "their COR is not that of a free impact, so they do not count as impacts"


def only_impacts(kinds: NDArray[Any]) -> tuple[Mask, str]:
    """Pick the rows of a record that are impacts; every reader of CORs and speeds does so.

    Parameters
    ----------
    kinds : array (n,)
        Column ``kind``; zeros for a record of an older version, whose rows count as impacts.

    Returns
    -------
    ndarray of bool, str
        Mask of the impacts, and a sentence about the other rows, "" if there are none.

    Examples
    --------
    >>> only_impacts(np.array([0, 2, 0, 4, 2]))[1].partition(";")[0]
    'Of 5 contacts, 40 % left over the edge of a wall and 20 % stayed as under their weight'
    """
    impacts = np.isin(kinds, (Kind.IMPACT, Kind.OF_BODY))
    others, counts = np.unique(kinds[~impacts], return_counts=True)
    if not others.size:
        return impacts, ""
    parts = [
        f"{percent(n / kinds.size)} {_HAPPENED.get(kind, 'are of an unknown kind')}"
        for kind, n in zip(others, counts, strict=True)
    ]
    what = " and ".join([", ".join(parts[:-1])] * (len(parts) > 1) + parts[-1:])
    return impacts, f"Of {kinds.size:,} contacts, {what}; {_REASON}."
