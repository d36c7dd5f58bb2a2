"""The memory of a plate near an edge, in steps; see `contactlaw.equation.edge`.

The numbers z of a contact follow the force by the trapezoidal rule. It is stable however short tau
is, and implicit in the force F' at the end of the step: z' = z0 + q F'.
"""

from typing import NamedTuple

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation.edge import SIZE, Memories, Memory, weighted


class Recalled(NamedTuple):
    """What the memory adds in a step, of which the force at its end is not known yet."""

    known: float  # sum of c z0
    per_force: float  # sum of c q
    memory: Memories  # z0
    gain: Memories  # q


@kernel(inline=True)
def _block(r: Array, at: int, x: float, y: float, f: float, half: float) -> tuple[float, float, float, float]:
    """Two numbers of the memory, and their gains, after a step of 2 half/tau; f is F before it."""
    a, s, b, d = half * r[at], half * r[at + 1], half * r[at + 2], half * r[at + 3]
    u, v = x - a * x + b * y + a * f, y - b * x - s * y + d * f
    per = 1.0 / ((1.0 + a) * (1.0 + s) + b * b)
    return (
        per * ((1.0 + s) * u + b * v),
        per * ((1.0 + a) * v - b * u),
        per * ((1.0 + s) * a + b * d),
        per * ((1.0 + a) * d - b * a),
    )


@kernel
def recalled(r: Array, m: Memories, force: float, half: float) -> Recalled:
    """Compute what a contact's memory adds in a step of 2 half/tau, from the force before it."""
    first, per_first = _half(r, 0, m.first, force, half)
    second, per_second = _half(r, SIZE, m.second, force, half)
    new, gain = Memories(first, second), Memories(per_first, per_second)
    return Recalled(weighted(r, new), weighted(r, gain), new, gain)


@kernel
def _half(r: Array, at: int, m: Memory, force: float, half: float) -> tuple[Memory, Memory]:
    x1, y1, a1, b1 = _block(r, at, m.x1, m.y1, force, half)
    x2, y2, a2, b2 = _block(r, at + 4, m.x2, m.y2, force, half)
    x3, y3, a3, b3 = _block(r, at + 8, m.x3, m.y3, force, half)
    return Memory(x1, y1, x2, y2, x3, y3), Memory(a1, b1, a2, b2, a3, b3)


@kernel
def remembered(step: Recalled, force: float) -> Memories:
    """Memory at the end of a step, from the force there."""
    z, q = step.memory, step.gain
    return Memories(_after(z.first, q.first, force), _after(z.second, q.second, force))


@kernel(inline=True)
def _after(z: Memory, q: Memory, force: float) -> Memory:
    return Memory(
        z.x1 + q.x1 * force,
        z.y1 + q.y1 * force,
        z.x2 + q.x2 * force,
        z.y2 + q.y2 * force,
        z.x3 + q.x3 * force,
        z.y3 + q.y3 * force,
    )


@kernel
def comes_back(
    response: Array, memory: Memories, coupling: float, pace: float, u: float, mobility: float, duration: float
) -> bool:
    """Whether the plate comes back to a sphere that has left it with the speed -u.

    It is looked for within 300 durations of the contact; `pace` is 1/tau in the units of u. Steps
    grow with the time, as fast as what the plate remembers slows down.
    """
    t, step, path, speed = 0.0, 1e-3 * duration, 0.0, weighted(response, memory)
    while pace > 0.0 and t < 300.0 * duration:
        later = recalled(response, memory, 0.0, 0.5 * pace * step)
        path += 0.5 * step * (speed + later.known)
        memory, speed, t = later.memory, later.known, t + step
        if mobility * coupling * path < u * t:
            return True
        step = max(step, 0.2 * t)
    return False
