"""The load of many impacts on a plate over time, as a sensor samples it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.physical.arguments import broadcast, positive, within
from contactlaw.physical.plates import check_contact

if TYPE_CHECKING:
    from contactlaw import ImpactModel


_SAMPLES = 65  # samples of one contact, with cubics between them
_CHUNK = 4096  # contacts at a time, so that their histories need no more than 10 MB
_LONGEST_CONTACT = 10.0  # [s]: of a sphere of 1 km
_LONGEST = 1_000_000_000  # samples of a signal; beyond, the rate is in the wrong unit


class LoadSignal(NamedTuple):
    """Load on a plate at even times.

    Attributes
    ----------
    time
        Middle of each sampling interval [s].
    force
        Mean force over the interval [N].
    """

    time: Array
    force: Array


def load_signal(
    times: ArrayLike,
    speed: ArrayLike,
    radius: ArrayLike,
    thickness: ArrayLike,
    *,
    model: ImpactModel,
    rate: float,
    duration: float | None = None,
) -> LoadSignal:
    """Superpose the force histories of recorded impacts on a plate.

    Parameters
    ----------
    times : array_like
        When each impact begins [s], in any order. Load before 0 and after `duration` is left
        out.
    speed, radius, thickness : array_like
        As in `ImpactModel.restitution`, for each impact.
    model : ImpactModel
        Model that gives the force histories.
    rate : float
        Samples per second [1/s].
    duration : float, optional
        Length of the signal [s], rounded up to whole samples; by default it ends with the last
        contact.

    Returns
    -------
    LoadSignal
        Each sample is the mean force over its interval, as an integrating sensor or one behind an
        anti-aliasing filter gives it: contacts of microseconds lose none of their momentum at any
        rate.

    Raises
    ------
    ValueError
        A rate or a duration that is not positive, a time that is not finite, and what
        `ImpactModel.force_history` refuses.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> load = cl.load_signal([1e-4, 3e-4], [5.0, 8.0], 0.9e-3, 1e-3, model=model, rate=1e4)
    >>> load.force.round(3)
    array([0.   , 0.255, 0.   , 0.404])
    """
    from scipy.interpolate import CubicHermiteSpline

    start, v, r, h, _ = broadcast(times=times, speed=speed, radius=radius, thickness=thickness)
    check_contact(thickness, model.pair.given[1])
    within("times", start, -1e300, 1e300, "[s]")
    rate = positive("rate", rate, "1/s")
    if duration is None:
        ends = start + np.ravel(model.lookup(v, r, h).contact_time)
        duration = max(float(ends.max(initial=0.0)), 1.0 / rate)
    duration = positive("duration", duration, "s")
    if duration * rate > _LONGEST:
        raise ArgumentError("duration", duration, f"must be at most {_LONGEST} samples at rate {rate:g} /s")
    force = np.zeros(math.ceil(duration * rate * (1.0 - 1e-12)))  # 0.07 s at 100 /s are 7 samples
    during = np.flatnonzero((start > -_LONGEST_CONTACT) & (start < duration))
    for part in np.split(during, range(_CHUNK, during.size, _CHUNK)):
        contacts = model.force_history(v[part], r[part], h[part], samples=_SAMPLES)
        columns = start[part], contacts.time, contacts.force, contacts.impulse
        for begin, time, push, impulse in zip(*columns, strict=True):
            first = max(math.floor(begin * rate), 0)
            last = min(math.ceil((begin + time[-1]) * rate), force.size)
            # the mean force over an interval is the impulse in it over its length
            since = np.clip(np.arange(first, last + 1) / rate - begin, 0.0, time[-1])
            passed = CubicHermiteSpline(time, impulse, push)(since)
            force[first:last] += np.diff(passed) * rate
    return LoadSignal(np.arange(0.5, force.size) / rate, force)
