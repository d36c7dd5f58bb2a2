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

# Contact time; peak force and approach of an elastic impact, with F = d^1.5, unit mass and speed
ELASTIC_TIME = 1.25**0.4 * math.sqrt(math.pi) * math.gamma(0.4) / math.gamma(0.9) * 0.8
ELASTIC_PEAK = 1.25**0.6, 1.25**0.4


class Rebound(NamedTuple):
    """Outcome of an impact with unit stiffness, mass and speed."""

    restitution: float
    contact_time: float
    peak_force: float
    peak_approach: float
    last_approach: float  # at which the force ends


def power_law(loss: float, time: float = ELASTIC_TIME) -> Callable[[Array], Array]:
    """Integral of a relaxation modulus with a constant tan delta; |E| is 1 at 1/(2 times)."""
    alpha = 2.0 / math.pi * math.atan(loss)
    factor = (math.pi / time) ** -alpha / math.gamma(2.0 - alpha)
    return lambda t: np.asarray(factor * t ** (1.0 - alpha))


def wave(mobility: float, loss: float = 0.0) -> Callable[[Array], Array]:
    """Displacement of a thin plate after a unit impulse; its mobility goes as the modulus^-0.5."""
    beta = math.atan(loss) / math.pi
    factor = mobility * (math.pi / ELASTIC_TIME) ** beta / math.gamma(1.0 + beta)
    return lambda t: np.asarray(factor * t**beta)


def rebound(
    relaxed: Callable[[Array], Array], steps: int = 4000, plate: Callable[[Array], Array] = np.zeros_like
) -> Rebound:
    """Let a unit mass hit at unit speed; the force is F = d^1.5 if the relaxation modulus is 1.

    Parameters
    ----------
    relaxed : callable
        Integral of the relaxation modulus over time, from zero to each of the times given.
    steps : int, optional
        Number of time steps in the contact time of an elastic impact. Errors fall with its square,
        or in proportion if the modulus has a dashpot without a spring, or the plate moves.
    plate : callable, optional
        Displacement of the plate at times after a unit impulse; by default it is held.

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
    moved = dt * plate(dt * (0.5 + np.arange(weight.size)))
    approach, forces = np.zeros(weight.size), np.zeros(weight.size)
    place = 0.0
    speed, force, peak, first = 1.0, 0.0, 0.0, 1.0
    for n in range(1, weight.size):
        speed -= dt * force
        place += dt * speed
        approach[n] = place - moved[:n][::-1] @ forces[:n]
        aged, way = weight[:n][::-1], approach[: n + 1].copy()
        # Each step of the growing contact has added a ring. This is the present pressure in each.
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
        forces[n] = force
    share = before / (before - first)
    end = approach[n - 1] + share * (approach[n] - approach[n - 1])
    return Rebound(-speed, (n - 1 + share) * dt, peak, float(approach.max()), float(end))
