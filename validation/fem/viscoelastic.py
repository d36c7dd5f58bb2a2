"""Impact of a viscoelastic sphere on a half-space, by time steps: a reference for finite elements.

While the contact grows, the force is the hereditary integral of Hertz's over the relaxation modulus
(Lee & Radok, J. Appl. Mech. 27 (1960) 438). Once it shrinks, a point of the contact is released as
soon as its pressure has relaxed to zero (Ting, J. Appl. Mech. 33 (1966) 845): only the part of the
history counts that was over when the contact, growing, was as wide as it is now.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Hertz, F = d^1.5 and unit mass and speed: contact time and peak force (and peak approach)
ELASTIC_TIME = 1.25**0.4 * math.sqrt(math.pi) * math.gamma(0.4) / math.gamma(0.9) * 0.8
ELASTIC_PEAK = 1.25**0.6, 1.25**0.4


class Rebound(NamedTuple):
    """Outcome of an impact, in units of stiffness, mass and speed."""

    restitution: float
    contact_time: float
    peak_force: float
    peak_approach: float
    last_approach: float  # where the force ends


def rebound(relaxed: Callable[[Array], Array], steps: int = 4000) -> Rebound:
    """Impact of unit mass at unit speed; F = d^1.5 where the relaxation modulus is 1.

    Parameters
    ----------
    relaxed : callable
        Integral of the relaxation modulus from zero to the times given.
    steps : int, optional
        Steps in the contact time of an elastic impact. The errors fall with their number.

    Returns
    -------
    Rebound

    Examples
    --------
    >>> elastic = rebound(lambda time: time)
    >>> abs(elastic.restitution - 1.0) < 1e-3, abs(elastic.contact_time / ELASTIC_TIME - 1.0) < 1e-3
    (True, True)
    """
    dt = ELASTIC_TIME / steps
    weight = np.diff(relaxed(dt * np.arange(10 * steps))) / dt  # mean modulus of a step, by its age
    approach = np.zeros(weight.size)
    speed, force, peak, first = 1.0, 0.0, 0.0, 1.0
    for n in range(1, weight.size):
        speed -= dt * force
        approach[n] = approach[n - 1] + dt * speed
        aged, way = weight[:n][::-1], approach[: n + 1].copy()
        # pressure now at the points that the edge of the growing contact had reached in each step
        pressure = np.cumsum((aged * np.diff(way))[::-1])[::-1]
        before, first = first, float(pressure[0])
        if first <= 0.0:
            break
        if pressure.min() <= 0.0:
            last = int(np.argmax(pressure <= 0.0))
            share = pressure[last - 1] / (pressure[last - 1] - pressure[last])
            way[last] = way[last - 1] + share * (way[last] - way[last - 1])
            way[last + 1 :] = way[last]
        force = float(aged @ np.diff(way**1.5))
        peak = max(peak, force)
    share = before / (before - first)
    end = approach[n - 1] + share * (approach[n] - approach[n - 1])
    return Rebound(-speed, (n - 1 + share) * dt, peak, float(approach.max()), float(end))
