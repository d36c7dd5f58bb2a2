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

from typing import Any, Literal, NamedTuple, get_args

from contactlaw._arrays import Array
from contactlaw._jit import kernel

Edge = Literal["free", "supported", "clamped"]
"""Kinds of edges: nothing holds the plate there; it cannot move; nor turn."""
KINDS: tuple[str, ...] = get_args(Edge)
SIZE = 18  # of half of a response, six numbers: their rates, four for each block, and weights
LONGEST = 50.0  # [T_H]; contacts that end take up to 25 for lambda up to 1


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
    again: Array  # set to 1 where the plate comes back to the sphere after the contact, else to 0; may have no entry


@kernel(inline=True)
def weighted(r: Array, m: Memories) -> float:
    """Sum over the memory with the weights of the response."""
    return _half(r, 0, m.first) + _half(r, SIZE, m.second)


@kernel(inline=True)
def _half(r: Array, at: int, m: Memory) -> float:
    first = r[at + 12] * m.x1 + r[at + 13] * m.y1 + r[at + 14] * m.x2
    return float(first + r[at + 15] * m.y2 + r[at + 16] * m.x3 + r[at + 17] * m.y3)
