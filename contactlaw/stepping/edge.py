"""The memory of a plate near an edge, step by step; see `contactlaw.equation.edge`.

The numbers z of a contact follow the force as in `contactlaw.equation.recall`. The edge adds
alpha dt sum(c (z + z'))/2 to the displacement of the plate, alpha that of a thin one.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel, tuple_of
from contactlaw.equation import recall
from contactlaw.equation.edge import KINDS, NO_MEMORY, Memories
from contactlaw.equation.edge import weighted as weighted_sum
from contactlaw.equation.recall import Recalled
from contactlaw.physical.materials import Material
from contactlaw.physical.responses import RIMS, response_of
from contactlaw.physical.scaling import SOFT_RIM, from_rim, share_of, wave_path, wave_rate


class EdgeEcho(NamedTuple):
    """An edge near a contact, or edges near as many contacts as the arrays are long."""

    response: Any  # as `contactlaw.physical.responses.response_of` gives it
    rate: Any  # 1/tau [1/s]; 0 for a contact that is far from edges


NOTHING = Recalled(0.0, 0.0, NO_MEMORY, NO_MEMORY)
REACH = 10.0  # square of the distance over b t beyond which an edge changes nothing


def edge_echo(
    plate: Material, thickness: Array, kind: str, distance: Array | None, hole_radius: Array | None, time: Array
) -> EdgeEcho | None:
    """Edges at these distances [m] from contacts with this T_H [s]; None where no plate has any."""
    if distance is None or hole_radius is None:
        return None
    distance = from_rim(wave_path(plate), thickness, distance, hole_radius, time)
    share = share_of(distance, hole_radius, thickness)
    with np.errstate(invalid="ignore", over="ignore"):  # of an endless half-space
        rate = np.where(distance < math.inf, wave_rate(wave_path(plate), thickness, distance), 0.0)
    return EdgeEcho(response_of(kind, plate.poissons_ratio, share, "steps"), rate)


@kernel
def place_of(kind: int, distance: float, hole: float, thickness: float) -> int:
    """Place of the nearest share among `responses_of`; the kind is its number in `KINDS`.

    Most neighbours differ by a quarter in the radius, so that the COR errs by up to 1 %.
    """
    if kind != 0 or not hole < math.inf or not distance < math.inf:
        return kind
    share = distance / (distance + hole + SOFT_RIM * thickness)
    if share < 0.5 * RIMS[0]:
        return kind
    place = 0
    for n in range(1, len(RIMS)):
        if share > 0.5 * (RIMS[n - 1] + RIMS[n]):
            place = n
    return len(KINDS) + place


@kernel
def weighted(near: EdgeEcho | None, m: Memories) -> float:
    """Speed that the edge adds, over the mobility of a thin plate [N]."""
    if near is None:
        return 0.0
    return weighted_sum(near.response, m)


@kernel
def recalled(near: EdgeEcho | None, m: Memories, force: float, step: float) -> Recalled:
    """Say what the memory adds at both ends of a step [s], from the force at its beginning."""
    if near is None:
        return NOTHING
    if near.rate == 0.0:
        return NOTHING
    after = recall.recalled(near.response, m, force, 0.5 * step * near.rate)
    return tuple_of(Recalled, after, known=weighted(near, m) + after.known)
