"""Answers where something comes back from the plate: these impacts are integrated.

That is near its edges, where it is curved, or lies on a foundation. All others are left as they are.
"""

import math
from collections.abc import Callable

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import in_memory, kernel
from contactlaw.equation import near_edge
from contactlaw.equation.force import at_strength
from contactlaw.equation.notes import Notes
from contactlaw.equation.numbers import Impact, PairConstants, numbers, relaxes, share_of_solid
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import check_kind
from contactlaw.physical.responses import response_of
from contactlaw.physical.scaling import wave_path, wave_rate
from contactlaw.table import lookup


def kernel_near(bodies: SphereOnPlate, kind: str) -> Callable[..., float]:
    """COR near an edge as a jitted function of speed, radius, thickness, distance and mass."""
    check_kind(kind)
    pair, path = bodies.constants, wave_path(bodies.pair.plate)
    law = in_memory(bodies.data)
    response = in_memory(response_of(kind, bodies.pair.plate.poissons_ratio))

    @kernel(entry=True)
    def cor(speed: float, radius: float, thickness: float, edge_distance: float, mass: float = math.inf) -> float:
        impact = Impact(speed, radius, thickness, share_of_solid(pair.mass, radius, mass))
        return _cor_near(law(), response(), pair, path, impact, edge_distance)

    return cor


# Its machine code is kept on disk, which is not possible for callers that know a law in memory.
@kernel(cache=True)
def _cor_near(
    law: Array, response: Array, pair: PairConstants, path: float, impact: Impact, edge_distance: float
) -> float:
    speed, radius, thickness, mass = impact
    if not (lookup.is_valid(speed, radius, thickness) and edge_distance >= 0.0 and mass > 0.0):
        return math.nan
    known = numbers(pair, law, impact)
    rate = wave_rate(path, thickness, edge_distance) * known.time if thickness < math.inf else 0.0
    ratio = radius / thickness
    root = pair.time * radius / known.time  # lambda of a thin plate follows from it
    thin = pair.plate.inelasticity * root * (ratio * ratio) * mass / known.inelasticity
    thin = 1.0 if relaxes(pair.plate) or rate == 0.0 else thin
    y = known.yield_ratio if known.yield_ratio < math.inf else 1.0
    own = at_strength(law, known.strength)
    none = np.empty((0, 0))
    notes = Notes(none, none, none, none, none)
    one = near_edge.follow(own, response, known.inelasticity, y, min(thin, 1.0), rate, near_edge.QUICK, notes, 0)
    return one.restitution if one.ended else math.nan
