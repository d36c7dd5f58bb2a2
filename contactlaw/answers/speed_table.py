"""COR over speed as a table that engines interpolate: few rows for an error."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, Places
from contactlaw._errors import ArgumentError
from contactlaw.physical.arguments import number, scalars, within
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.validity import Validity, count_flags

_APART = 1e-4  # relative distance of the speeds that may become rows


class SpeedTable(NamedTuple):
    """COR over normal approach speed.

    Its rows are some of the speeds that are 1e-4 apart: each is the farthest one that a straight
    line from the row before reaches within the wanted error.

    Attributes
    ----------
    speed, restitution
        Rows: speeds [m/s], rising, and the CORs there [-].
    error
        Largest error of straight lines between the rows [-].
    flags
        Number of rows that exceed each `Validity` limit; limits that none exceeds are left out.
    """

    speed: Array
    restitution: Array
    error: float
    flags: dict[Validity, int]


def speed_table(lookup: Callable[[Array], Rebound], error: float, ends: tuple[float, float]) -> SpeedTable:
    """Choose the rows, as `contactlaw.ImpactModel.speed_table` says, from impacts at any speeds."""
    within("error", np.array([number("error", error)]), 1e-5, 0.1, "[-], in COR")
    slowest, fastest = (one.item() for one in scalars(slowest=ends[0], fastest=ends[1]))
    if not slowest < fastest:
        raise ArgumentError("slowest", slowest, f"must be below the fastest speed, {fastest!r}")
    speed = np.geomspace(slowest, fastest, 2 + int(math.log(fastest / slowest) / _APART))
    hits = lookup(speed)
    e = np.asarray(hits.restitution)
    rows = longest_lines(speed, e, error)
    measured = float(np.abs(np.interp(speed, speed[rows], e[rows]) - e).max())
    return SpeedTable(speed[rows], e[rows], measured, count_flags(np.asarray(hits.flags)[rows]))


def longest_lines(x: Array, y: Array, error: float) -> Places:
    """Points, ends included, between which straight lines miss no point by more than the error.

    From each point the longest line is taken. A line to another point may be drawn if its slope is
    within those to all points up to there, moved up and down by the error. Where the curvature
    changes sign another choice may have fewer points.

    Parameters
    ----------
    x, y : ndarray (n,)
        Points, x rising.
    error : float
        Largest error of y.

    Returns
    -------
    ndarray of int
        Which of the points.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 11)
    >>> longest_lines(x, np.abs(x - 0.5), 0.01)
    array([ 0,  5, 10])
    """
    rows = [0]
    while (start := rows[-1]) < x.size - 1:
        run, rise = x[start + 1 :] - x[start], y[start + 1 :] - y[start]
        low = np.maximum.accumulate((rise - error) / run)
        high = np.minimum.accumulate((rise + error) / run)
        drawn = np.flatnonzero((low <= rise / run) & (rise / run <= high))
        rows.append(start + 1 + int(drawn[-1]))
    return np.array(rows)
