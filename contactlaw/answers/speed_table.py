"""COR over speed as a table that engines interpolate: few rows for an error."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, Places
from contactlaw._errors import ArgumentError
from contactlaw.physical.arguments import check, number, within
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.validity import Validity, count_flags

_CHOICE = 4000  # speeds that may become rows: 0.1 % apart over two decades
_FINER = 4  # speeds between two neighbouring ones at which the error is measured
_ROUNDS = 10


class SpeedTable(NamedTuple):
    """COR over normal approach speed.

    Its rows are some of 4000 logarithmically spaced speeds: each is the farthest one that a straight
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
    slowest, fastest = (number(n, v) for n, v in zip(("slowest", "fastest"), ends, strict=True))
    error = number("error", error)
    within("error", np.array([error]), 1e-5, 0.1, "[-], in COR")
    check(slowest=np.array([slowest]), fastest=np.array([fastest]))
    if not slowest < fastest:
        raise ArgumentError("slowest", slowest, f"must be below the fastest speed, {fastest!r}")
    lookup(np.array([slowest, fastest]))  # refuses a range that leaves the table
    speed = np.geomspace(slowest, fastest, _CHOICE)
    between = np.arange(1, _FINER + 1) / (_FINER + 1)
    probe = np.ravel(speed[:-1, None] + np.diff(speed)[:, None] * between)
    e, there = (np.asarray(lookup(v).restitution) for v in (speed, probe))
    allowed = error
    for _ in range(_ROUNDS):
        rows = longest_lines(speed, e, allowed)
        measured = float(np.abs(np.interp(probe, speed[rows], e[rows]) - there).max())
        if measured <= error:
            flags = np.asarray(lookup(speed[rows]).flags)
            return SpeedTable(speed[rows], e[rows], measured, count_flags(flags))
        allowed = max(allowed - 1.01 * (measured - error), 0.0)
    reason = f"too small from {slowest:g} to {fastest:g} m/s: narrow the range, or raise it"
    raise ArgumentError("error", error, reason)


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
