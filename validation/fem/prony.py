"""A body of constant loss factor as springs and dashpots, for finite elements (a Prony series).

Where tan delta is the same at all frequencies, the complex modulus is a power of i times the
frequency, with the exponent alpha = 2 delta/pi. Branches of a spring and a dashpot, side by side
with one spring, follow it over the frequencies of an impact. All moduli relax alike: Poisson's
ratio is constant.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from contactlaw.physical.materials import Material

Array = NDArray[np.float64]

# The series follows the modulus from 1/50 to 50 times the frequency of the impact. Up to tan delta
# 0.4 it is within 4 % of tan delta from 1/30 to 30 times, and within 0.1 % of a Hertz impact's COR.
_BRANCHES, _WIDTH = 6, 50.0


class Prony(NamedTuple):
    """Moduli of the branches, and of all springs together, over Young's modulus; times [s]."""

    moduli: Array
    times: Array
    whole: float


NO_LOSS = Prony(np.empty(0), np.empty(0), 1.0)


def modulus(body: Material, omega: Array) -> Array:
    """Complex Young's modulus over that at the body's own frequency, at angular ones [rad/s]."""
    assert body.loss_factor is not None
    loss, frequency = body.loss_factor
    exponent = 2.0 / math.pi * math.atan(loss)
    return np.asarray((1j * omega / (2.0 * math.pi * frequency)) ** exponent)


def series(body: Material, contact_time: float) -> Prony:
    """Branches that follow a body's modulus about the frequency of an impact of this length [s].

    Examples
    --------
    >>> import contactlaw as cl
    >>> lossy = cl.Material("lossy", 3e9, 0.35, 1200, loss_factor=(0.1, 1e4))
    >>> found, omega = series(lossy, 5e-5), 2 * math.pi * np.array([2e3, 1e4, 5e4])
    >>> bool(abs(response(found, omega) / modulus(lossy, omega) - 1).max() < 5e-3)
    True
    """
    if body.loss_factor is None:
        return NO_LOSS
    centre = math.pi / contact_time
    omega = centre * np.geomspace(1.0 / _WIDTH, _WIDTH, 200)
    times = np.geomspace(_WIDTH, 1.0 / _WIDTH, _BRANCHES) / centre
    wanted = modulus(body, omega)
    branches = _branches(times, omega) / abs(wanted)[:, None]
    columns = np.hstack([branches, 1.0 / abs(wanted)[:, None]])
    target = wanted / abs(wanted)
    found, _ = nnls(np.vstack([columns.real, columns.imag]), np.append(target.real, target.imag))
    used = found[:-1] > 0.0
    return Prony(found[:-1][used], times[used], float(found.sum()))


def response(found: Prony, omega: Array) -> Array:
    """Complex modulus of a series over Young's modulus, at angular frequencies [rad/s]."""
    elastic = found.whole - found.moduli.sum()
    return np.asarray(_branches(found.times, omega) @ found.moduli + elastic)


def _branches(times: Array, omega: Array) -> Array:
    turned = 1j * omega[:, None] * times
    return np.asarray(turned / (1.0 + turned))
