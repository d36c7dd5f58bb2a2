"""How the edge of a plate acts on a contact near it: the memory of the plate's own response.

Under a force f that begins at time 0, an endless thin plate moves with a speed in proportion to the
force. Near an edge the wave that the edge sends back is added:

    v = beta [f + coupling * sum_k c_k z_k],    dz_k/dt = p_k (f - z_k)/tau,    tau = s^2/b,

with s the distance from the edge and b = sqrt(D/(rho2 H)), D the plate's bending stiffness. The sum
stands for the exact response, a function of t/tau for each kind of edge; that of a free one depends
on the plate's Poisson's ratio, and on its curvature if it is the rim of a hole. Twelve rates p_k
and weights c_k are fitted to it by `validation.derivations.edges`. In time steps each contact keeps
its z_k. `coupling` is the mobility of a thin plate over that of the contact: what returns is a
bending wave, however thick the plate is.

The z come in blocks of two, which have two real rates p and p', or the real and the imaginary part
of a complex one, p + i p'.

Legend: f contact force, beta mobility, z memory, h step, as in `contactlaw.equation.motion`.
"""

import math
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel

Edge = Literal["free", "supported", "clamped"]
"""Kinds of edges: nothing holds the plate there; it cannot move; nor turn."""
KINDS: tuple[str, ...] = get_args(Edge)
SIZE = 18  # of half of a response, six numbers: their rates, four for each block, and weights
LONGEST = 50.0  # [T_H]; contacts that end take up to 25 for lambda up to 1
_AT_ONCE = 2 * SIZE  # place of the number that `near` adds
_QUICK = 120.0, 500.0  # rates [1/T_H] that follow the force at once, at rtol 1e-6 and 1e-10


class Memory(NamedTuple):
    """Six forces on the plate, each averaged over the recent past with one of the rates."""

    x1: Any
    y1: Any
    x2: Any
    y2: Any
    x3: Any
    y3: Any


class Memories(NamedTuple):
    """The whole memory."""

    first: Memory
    second: Memory


NO_MEMORY = Memories(Memory(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), Memory(0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
"""The memory at first touch."""


class Edges(NamedTuple):
    """Edges near impacts."""

    response: Array  # (impacts, 2 SIZE), as `contactlaw.physical.responses` gives it
    coupling: Array  # mobility of a thin plate over that of the contact, at most 1
    rate: Array  # T_H/tau
    again: Array  # set to 1 where the plate comes back to the sphere after the contact, else to 0


def part(edges: Edges | None, some: Any) -> Edges | None:
    """Edges of some of the impacts."""
    return None if edges is None else Edges(*(values[some] for values in edges))


@kernel
def near(edges: Edges | None, n: int, unit: float, rtol: float) -> Array | None:
    """Response in the law's scale, whose time is `unit` times that of Hertz's scale.

    A last number has been added: what follows the force at once. It stands for all rates that
    explicit steps would have to follow for little; the finer the steps, the fewer these are.
    """
    if edges is None:
        return None
    scaled, given = np.zeros(2 * SIZE + 1), edges.response[n]
    scaled[_AT_ONCE] = 1.0
    quick = min(_QUICK[0] * (1e-6 / rtol) ** 0.175, _QUICK[1])
    for block in range(6):
        at = SIZE * (block // 3) + 4 * (block % 3)
        weight = SIZE * (block // 3) + 12 + 2 * (block % 3)
        first, second = edges.coupling[n] * given[weight], edges.coupling[n] * given[weight + 1]
        turns = given[at + 2] > 0.0
        if edges.rate[n] * max(given[at], given[at + 1], given[at + 2]) > quick:
            scaled[_AT_ONCE] += first if turns else first + second
        else:
            scaled[at : at + 4] = given[at : at + 4] * (edges.rate[n] / unit)
            scaled[weight], scaled[weight + 1] = first, second
    return scaled


@kernel
def at_touch(response: Array | None) -> Memories | None:
    """Memory at first touch; None for an endless plate."""
    return None if response is None else NO_MEMORY


@kernel(inline=True)
def weighted(r: Array, m: Memories) -> float:
    """Sum over the memory with the weights of the response."""
    return _half(r, 0, m.first) + _half(r, SIZE, m.second)


@kernel(inline=True)
def _half(r: Array, at: int, m: Memory) -> float:
    first = r[at + 12] * m.x1 + r[at + 13] * m.y1 + r[at + 14] * m.x2
    return float(first + r[at + 15] * m.y2 + r[at + 16] * m.x3 + r[at + 17] * m.y3)


@kernel(inline=True)
def drive(response: Array | None, f: float, memory: Memories | None) -> float:
    """Speed of the plate over its mobility."""
    if response is None or memory is None:
        return f
    return float(response[_AT_ONCE] * f + weighted(response, memory))


@kernel
def _change(r: Array, at: int, f: float, m: Memory, pace: float) -> Memory:
    return Memory(
        pace * (r[at] * (f - m.x1) + r[at + 2] * m.y1),
        pace * (r[at + 3] * f - r[at + 2] * m.x1 - r[at + 1] * m.y1),
        pace * (r[at + 4] * (f - m.x2) + r[at + 6] * m.y2),
        pace * (r[at + 7] * f - r[at + 6] * m.x2 - r[at + 5] * m.y2),
        pace * (r[at + 8] * (f - m.x3) + r[at + 10] * m.y3),
        pace * (r[at + 11] * f - r[at + 10] * m.x3 - r[at + 9] * m.y3),
    )


@kernel(inline=True)
def remember(response: Array | None, f: float, memory: Memories | None, pace: float) -> Memories | None:
    """Change of the memory per ds, from dt/ds."""
    if response is None or memory is None:
        return None
    return Memories(_change(response, 0, f, memory.first, pace), _change(response, SIZE, f, memory.second, pace))


@kernel
def _moved(
    m: Memory,
    w1: float,
    k1: Memory,
    w2: float,
    k2: Memory,
    w3: float,
    k3: Memory,
    w4: float,
    k4: Memory,
    w5: float,
    k5: Memory,
) -> Memory:
    return Memory(
        m.x1 + (w1 * k1.x1 + w2 * k2.x1 + w3 * k3.x1 + w4 * k4.x1 + w5 * k5.x1),
        m.y1 + (w1 * k1.y1 + w2 * k2.y1 + w3 * k3.y1 + w4 * k4.y1 + w5 * k5.y1),
        m.x2 + (w1 * k1.x2 + w2 * k2.x2 + w3 * k3.x2 + w4 * k4.x2 + w5 * k5.x2),
        m.y2 + (w1 * k1.y2 + w2 * k2.y2 + w3 * k3.y2 + w4 * k4.y2 + w5 * k5.y2),
        m.x3 + (w1 * k1.x3 + w2 * k2.x3 + w3 * k3.x3 + w4 * k4.x3 + w5 * k5.x3),
        m.y3 + (w1 * k1.y3 + w2 * k2.y3 + w3 * k3.y3 + w4 * k4.y3 + w5 * k5.y3),
    )


@kernel(inline=True)
def moved(
    m: Memories | None,
    w1: float,
    k1: Memories | None,
    w2: float,
    k2: Memories | None,
    w3: float,
    k3: Memories | None,
    w4: float,
    k4: Memories | None,
    w5: float,
    k5: Memories | None,
) -> Memories | None:
    """Memory at a stage or at the end of a step, from the stages before."""
    if m is None or k1 is None or k2 is None or k3 is None or k4 is None or k5 is None:
        return None
    return Memories(
        _moved(m.first, w1, k1.first, w2, k2.first, w3, k3.first, w4, k4.first, w5, k5.first),
        _moved(m.second, w1, k1.second, w2, k2.second, w3, k3.second, w4, k4.second, w5, k5.second),
    )


@kernel
def longest(edges: Edges | None) -> float:
    """Time up to which contacts are followed [T_H]; a sphere that then presses stays."""
    return math.inf if edges is None else LONGEST


@kernel
def settles(edges: Edges | None, n: int, stays: bool, possible: bool) -> bool:
    """Whether the plate takes what is left: of a sphere that stays, or of an impossible rebound.

    A sphere that stays is flagged as struck again.
    """
    if edges is None:
        return False
    if stays:
        edges.again[n] = 1.0
    return stays or not possible


@kernel
def _path(r: Array, at: int, memory: Memory, t: float) -> float:
    """Displacement of the plate over its mobility, at a time after the contact has ended."""
    z = memory.x1, memory.y1, memory.x2, memory.y2, memory.x3, memory.y3
    path = 0.0
    for k in range(3):
        x, y, w, v = z[2 * k], z[2 * k + 1], r[at + 12 + 2 * k], r[at + 13 + 2 * k]
        a, second, turn = r[at + 4 * k], r[at + 4 * k + 1], r[at + 4 * k + 2]
        if turn == 0.0 and a > 0.0:
            path -= w * x * math.expm1(-a * t) / a + v * y * math.expm1(-second * t) / second
        elif turn > 0.0:
            rate = complex(a, turn)
            gone = complex(x, y) * (1.0 - np.exp(-rate * t)) / rate
            path += w * gone.real + v * gone.imag
    return path


@kernel
def look_back(
    edges: Edges | None,
    n: int,
    response: Array | None,
    memory: Memories | None,
    u: float,
    mobility: float,
    duration: float,
) -> None:
    """Note whether the plate comes back to a sphere that has left it with the speed -u.

    It is looked for within 300 durations of the contact.
    """
    if edges is None or response is None or memory is None:
        return
    edges.again[n] = 0.0
    t = 0.01 * duration
    while t < 300.0 * duration:
        path = _path(response, 0, memory.first, t) + _path(response, SIZE, memory.second, t)
        if mobility * path < u * t:
            edges.again[n] = 1.0
        t *= 1.2
