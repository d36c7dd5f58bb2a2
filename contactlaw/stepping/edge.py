"""The memory of a plate near an edge, step by step; see `contactlaw.equation.edge`.

The six numbers z of a contact follow the force by the trapezoidal rule, as the plate does. It is
stable however short tau is, and implicit in the force F' at the end of the step: z' = z0 + q F'.
The edge adds alpha dt sum(c (z + z'))/2 to the displacement of the plate, alpha that of a thin one.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation.edge import KINDS, NO_MEMORY, Memory
from contactlaw.equation.edge import weighted as weighted_sum
from contactlaw.physical.materials import Material
from contactlaw.physical.responses import RIMS, response_of
from contactlaw.physical.scaling import share_of, wave_path

Array = NDArray[np.float64]


class Near(NamedTuple):
    """An edge near a contact, or edges near as many contacts as the arrays are long."""

    response: Any  # as `contactlaw.physical.responses.response_of` gives it
    rate: Any  # 1/tau [1/s]; 0 for a contact that is far from edges


class Recalled(NamedTuple):
    """What the memory adds in a step, of which the force at its end is not known yet."""

    known: float  # sum of c (z + z0)
    per_force: float  # sum of c q
    memory: Memory  # z0
    gain: Memory  # q


REACH = 10.0  # square of the distance over b t beyond which an edge changes nothing
_NEAREST = 1e-3  # of the thickness; nearer than that a contact is at the edge itself


def near_edge(
    plate: Material, thickness: Array, kind: str, distance: Array | None, hole_radius: Array | None
) -> Near | None:
    """Edges at these distances [m] from contacts; None where no plate has any."""
    if distance is None or hole_radius is None:
        return None
    share = share_of(distance, hole_radius)
    return Near(
        response_of(kind, plate.poissons_ratio, share, "steps"), rate_of(plate, thickness, distance)
    )


def rate_of(plate: Material, thickness: Any, distance: Any) -> Any:
    """1/tau [1/s] of contacts at these distances from edges [m]; 0 without an edge."""
    with np.errstate(invalid="ignore", over="ignore"):  # of an endless half-space
        share = np.maximum(distance / thickness, _NEAREST)
        rate = wave_path(plate) / (share * share * thickness)
    return np.where(distance < math.inf, rate, 0.0)


@kernel
def rate_at(path: float, thickness: float, distance: float) -> float:
    """1/tau [1/s] of a contact, as by `rate_of`, from the plate's `wave_path` [m/s]."""
    share = max(distance / thickness, _NEAREST)
    return path / (share * share * thickness)


@kernel
def place_of(kind: int, distance: float, hole: float) -> int:
    """Place among the responses in steps of the nearest share; the kind is its number in `KINDS`.

    Most neighbours differ by a quarter in the radius, so that the COR errs by up to 1 %.
    """
    if kind != 0 or not hole < math.inf or not distance < math.inf:
        return kind
    share = distance / (distance + hole)
    if share < 0.5 * RIMS[0]:
        return kind
    place = 0
    for n in range(1, len(RIMS)):
        if share > 0.5 * (RIMS[n - 1] + RIMS[n]):
            place = n
    return len(KINDS) + place


@kernel
def _block(
    r: Any, k: int, x: float, y: float, f: float, half: float
) -> tuple[float, float, float, float]:
    """Two numbers of the memory, and their gains, after a step of 2 half/tau; f is F before it."""
    a, s, b, d = half * r[4 * k], half * r[4 * k + 1], half * r[4 * k + 2], half * r[4 * k + 3]
    u, v = x - a * x + b * y + a * f, y - b * x - s * y + d * f
    per = 1.0 / ((1.0 + a) * (1.0 + s) + b * b)
    return (
        per * ((1.0 + s) * u + b * v), per * ((1.0 + a) * v - b * u),
        per * ((1.0 + s) * a + b * d), per * ((1.0 + a) * d - b * a),
    )  # fmt: skip


@kernel
def weighted(near: Near | None, m: Memory) -> float:
    """Speed that the edge adds, over the mobility of a thin plate [N]."""
    if near is None:
        return 0.0
    return weighted_sum(near.response, 0, m)


@kernel
def recalled(near: Near | None, m: Memory, force: float, step: float) -> Recalled:
    """Say what the memory adds in a step [s], from the force at its beginning."""
    if near is None:
        return Recalled(0.0, 0.0, NO_MEMORY, NO_MEMORY)
    if near.rate == 0.0:
        return Recalled(0.0, 0.0, NO_MEMORY, NO_MEMORY)
    r, half = near.response, 0.5 * step * near.rate
    x1, y1, a1, b1 = _block(r, 0, m.x1, m.y1, force, half)
    x2, y2, a2, b2 = _block(r, 1, m.x2, m.y2, force, half)
    x3, y3, a3, b3 = _block(r, 2, m.x3, m.y3, force, half)
    new, gain = Memory(x1, y1, x2, y2, x3, y3), Memory(a1, b1, a2, b2, a3, b3)
    return Recalled(weighted(near, m) + weighted(near, new), weighted(near, gain), new, gain)


@kernel
def remembered(found: Recalled, force: float) -> Memory:
    """Memory at the end of a step, from the force there."""
    z, q = found.memory, found.gain
    return Memory(
        z.x1 + q.x1 * force, z.y1 + q.y1 * force, z.x2 + q.x2 * force, z.y2 + q.y2 * force,
        z.x3 + q.x3 * force, z.y3 + q.y3 * force,
    )  # fmt: skip
