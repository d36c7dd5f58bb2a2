"""What a row of the impact record is: an impact, or another contact."""

import enum


class Kind(enum.IntEnum):
    """What a row of the record is; a coefficient of restitution has a meaning for impacts only."""

    IMPACT = 0  # a bead arrived in free flight, hit one wall or bead, and left it again
    SLIDING_ON = 1  # it was on a wall already and slid or rolled on to this one
    OVER_EDGE = 2  # it left because the wall ended under it
    STRUCK = 3  # something else struck it, or pressed on it, while it was in contact; or the plate
    # came back from its edge and gave it more energy than it took
    RESTING = 4  # it stayed in contact far longer than an impact lasts, as under its weight
