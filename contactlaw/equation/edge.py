"""How the edge of a plate acts on a contact near it: the memory of the plate's own response.

Under a force f that begins at time 0, an endless thin plate moves with a speed in proportion to the
force. Near a straight edge the wave that the edge sends back is added:

    v = beta [f + coupling * sum_k c_k z_k],    dz_k/dt = p_k (f - z_k)/tau,    tau = s^2/b,

with s the distance from the edge and b = sqrt(D/(rho2 H)), the plate's bending stiffness over its
mass. The sum stands for the exact response, a function of t/tau for each kind of edge, and for a
free one of the plate's Poisson's ratio. Rates p_k and weights c_k are fitted to it, so that the
work on the plate is within 0.7 % for forces that last from tau/12 to 500 tau
(`validation.derivations.edges`). `coupling` is the mobility of a thin plate over that of the
contact: what returns is a bending wave, however thick the plate is.

The six z are three blocks of two, which is what a real plate's rates come in: real ones, p and p',
or the real and imaginary part of a complex one, p + i p'.

Legend: f contact force, beta mobility, z memory, h step, as in `contactlaw.equation.motion`.
"""

from __future__ import annotations

import math
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel

Array = NDArray[np.float64]

Edge = Literal["free", "supported", "clamped"]
"""Kinds of edges: nothing holds the plate there; it cannot move; nor turn."""
KINDS: tuple[str, ...] = get_args(Edge)


class Memory(NamedTuple):
    """Forces on the plate, each averaged over the recent past with one of the rates."""

    x1: Any
    y1: Any
    x2: Any
    y2: Any
    x3: Any
    y3: Any


NO_MEMORY = Memory(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
"""The memory at first touch."""


class Edges(NamedTuple):
    """Edges near impacts; the response is common to them."""

    response: Array  # as `response_of` gives it
    coupling: Array  # mobility of a thin plate over that of the contact, at most 1
    rate: Array  # T_H/tau
    again: Array  # set to 1 where the plate comes back to the sphere after the contact, else to 0


def part(edges: Edges | None, some: Any) -> Edges | None:
    """Edges of some of the impacts."""
    if edges is None:
        return None
    return Edges(edges.response, edges.coupling[some], edges.rate[some], edges.again[some])


# For each kind of edge, rates p_k as (p, p', 0) for two real ones or (p, p, p') for a complex one,
# and weights c_k as polynomials in the plate's Poisson's ratio.
_RATES: dict[str, tuple[tuple[float, float, float], ...]] = {
    "free": ((0.009434, 0.10964, 0.0), (0.76355, 2.69136, 0.0), (0.002451, 0.002451, 8.19199)),
    "supported": ((0.03586, 0.3141, 0.0), (1.91749, 3.8872, 0.0), (0.14573, 0.14573, 11.0897)),
    "clamped": (
        (0.69704, 3.25559, 0.0),
        (0.006734, 0.006734, 27.3786),
        (6.34824, 6.34824, 9.79214),
    ),
}
_WEIGHTS: dict[str, tuple[tuple[float, ...], ...]] = {
    "free": (
        (0.44433, 0.25086, 0.51938), (0.92002, 0.5498, 0.96337), (1.47074, 0.32874, 0.50994),
        (-0.73378, -0.38702, -0.32928), (0.05824, 0.05638, 0.02052), (0.06, 0.05905, 0.03048),
    ),
    "supported": (
        (-0.05901,), (-0.37726,), (-2.1663,), (1.63319,), (-0.02744,), (-0.15132,),
    ),
    "clamped": (
        (-0.08695,), (-1.85306,), (-0.04968,), (0.06865,), (0.98979,), (-0.27811,),
    ),
}  # fmt: skip


def response_of(kind: str, poissons_ratio: float) -> Array:
    """Response of a plate near an edge, in units of tau: rates of the three blocks, weights."""
    rates = [(p, second, turn, turn or second) for p, second, turn in _RATES[kind]]
    weights = [np.polynomial.Polynomial(c)(poissons_ratio) for c in _WEIGHTS[kind]]
    return np.array([*np.ravel(rates), *weights])


@kernel
def near(edges: Edges | None, n: int, unit: float) -> Array | None:
    """Response in the law's scale, whose time is `unit` times that of Hertz's scale."""
    if edges is None:
        return None
    scaled = edges.response.copy()
    scaled[:12] *= edges.rate[n] / unit
    scaled[12:] *= edges.coupling[n]
    return scaled


@kernel
def at_touch(response: Array | None) -> Memory | None:
    """Memory at first touch; None for an endless plate."""
    if response is None:
        return None
    return NO_MEMORY


@kernel(inline=True)
def drive(response: Array | None, f: float, memory: Memory | None) -> float:
    """Speed of the plate over its mobility."""
    if response is None or memory is None:
        return f
    r, m = response, memory
    first = r[12] * m.x1 + r[13] * m.y1 + r[14] * m.x2
    return float(f + (first + r[15] * m.y2 + r[16] * m.x3 + r[17] * m.y3))


@kernel(inline=True)
def remember(response: Array | None, f: float, memory: Memory | None, pace: float) -> Memory | None:
    """Change of the memory per ds, from dt/ds."""
    if response is None or memory is None:
        return None
    r, m = response, memory
    return Memory(
        pace * (r[0] * (f - m.x1) + r[2] * m.y1),
        pace * (r[3] * f - r[2] * m.x1 - r[1] * m.y1),
        pace * (r[4] * (f - m.x2) + r[6] * m.y2),
        pace * (r[7] * f - r[6] * m.x2 - r[5] * m.y2),
        pace * (r[8] * (f - m.x3) + r[10] * m.y3),
        pace * (r[11] * f - r[10] * m.x3 - r[9] * m.y3),
    )


@kernel(inline=True)
def moved(
    m: Memory | None, w1: float, k1: Memory | None, w2: float, k2: Memory | None, w3: float,
    k3: Memory | None, w4: float, k4: Memory | None, w5: float, k5: Memory | None,
) -> Memory | None:  # fmt: skip
    """Memory at a stage or at the end of a step, from the stages before."""
    if m is None or k1 is None or k2 is None or k3 is None or k4 is None or k5 is None:
        return None
    return Memory(
        m.x1 + (w1 * k1.x1 + w2 * k2.x1 + w3 * k3.x1 + w4 * k4.x1 + w5 * k5.x1),
        m.y1 + (w1 * k1.y1 + w2 * k2.y1 + w3 * k3.y1 + w4 * k4.y1 + w5 * k5.y1),
        m.x2 + (w1 * k1.x2 + w2 * k2.x2 + w3 * k3.x2 + w4 * k4.x2 + w5 * k5.x2),
        m.y2 + (w1 * k1.y2 + w2 * k2.y2 + w3 * k3.y2 + w4 * k4.y2 + w5 * k5.y2),
        m.x3 + (w1 * k1.x3 + w2 * k2.x3 + w3 * k3.x3 + w4 * k4.x3 + w5 * k5.x3),
        m.y3 + (w1 * k1.y3 + w2 * k2.y3 + w3 * k3.y3 + w4 * k4.y3 + w5 * k5.y3),
    )


@kernel
def _path(response: Array, memory: Memory, t: float) -> float:
    """Displacement of the plate over its mobility, at a time after the contact has ended."""
    r, z = response, (memory.x1, memory.y1, memory.x2, memory.y2, memory.x3, memory.y3)
    path = 0.0
    for k in range(3):
        x, y, w, v = z[2 * k], z[2 * k + 1], r[12 + 2 * k], r[13 + 2 * k]
        a, second, turn = r[4 * k], r[4 * k + 1], r[4 * k + 2]
        if turn == 0.0:
            path -= w * x * math.expm1(-a * t) / a + v * y * math.expm1(-second * t) / second
        else:
            rate = complex(a, turn)
            gone = complex(x, y) * (1.0 - np.exp(-rate * t)) / rate
            path += w * gone.real + v * gone.imag
    return path


@kernel
def look_back(
    edges: Edges | None, n: int, response: Array | None, memory: Memory | None, u: float,
    mobility: float,
) -> None:  # fmt: skip
    """Note whether the plate comes back to a sphere that has left it with the speed -u."""
    if edges is None or response is None or memory is None:
        return
    fastest, slowest = 0.0, math.inf
    for k in range(3):
        fastest = max(fastest, response[4 * k], response[4 * k + 1])
        slowest = min(slowest, response[4 * k], response[4 * k + 1])
    edges.again[n] = 0.0
    t = 0.1 / fastest
    while t < 10.0 / slowest:
        if mobility * _path(response, memory, t) < u * t:
            edges.again[n] = 1.0
        t *= 1.2
