"""The COR of a model as compiled functions: for loops of numba, near an edge and far from any, and for C."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from contactlaw import _jit
from contactlaw._arrays import Array
from contactlaw._jit import in_memory, kernel
from contactlaw.answers.tabulated import TableLookup
from contactlaw.equation import near_edge
from contactlaw.equation.edge import Edges
from contactlaw.equation.force import at_strength
from contactlaw.equation.notes import Notes
from contactlaw.equation.numbers import Impact, PairConstants, numbers, share_of_solid
from contactlaw.equation.outcome import OK
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import check_kind
from contactlaw.physical.responses import response_of
from contactlaw.physical.scaling import coupling_of, wave_path, wave_rate
from contactlaw.table import lookup


def kernel_of(tabulated: TableLookup) -> Callable[..., float]:
    """COR as a jitted function of speed, radius, thickness and mass, which belongs to one table."""
    on_plate, packed = lookup.restitution_on_plate, in_memory(tabulated.packed)
    pair = tabulated.bodies.constants

    @kernel(entry=True)
    def cor(speed: float, radius: float, thickness: float, mass: float = math.inf) -> float:
        share = share_of_solid(pair, radius, mass)
        return on_plate(packed(), speed, radius, thickness, share)

    return cor


def c_function(tabulated: TableLookup) -> Any:
    """COR as a C function of speed, radius and thickness, which belongs to one table."""
    on_plate, packed = lookup.restitution_on_plate, in_memory(tabulated.packed)
    return _jit.c_function("f8(f8, f8, f8)", lambda v, r, h: on_plate(packed(), v, r, h, 1.0))


def kernel_near(bodies: SphereOnPlate, kind: str) -> Callable[..., float]:
    """COR near an edge as a jitted function of speed, radius, thickness, distance and mass."""
    check_kind(kind)
    pair, path, law = bodies.constants, wave_path(bodies.pair.plate), in_memory(bodies.data)
    response = in_memory(response_of(kind, bodies.pair.plate.poissons_ratio))

    @kernel(entry=True)
    def cor(speed: float, radius: float, thickness: float, edge_distance: float, mass: float = math.inf) -> float:
        impact = Impact(speed, radius, thickness, share_of_solid(pair, radius, mass))
        return _cor_near(law(), response(), pair, path, impact, edge_distance)

    return cor


# Its machine code is kept on disk, which is not possible for callers that know a law in memory.
@kernel(cache=True)
def _cor_near(
    law: Array, response: Array, pair: PairConstants, path: float, impact: Impact, edge_distance: float
) -> float:
    h = impact.thickness
    if not (lookup.is_valid(impact.speed, impact.radius, h) and edge_distance >= 0.0 and impact.mass > 0.0):
        return math.nan
    known, rate, coupling = numbers(pair, law, impact), 0.0, 1.0
    if h < math.inf:
        rate = wave_rate(path, h, edge_distance) * known.time
        coupling = coupling_of(pair, known, impact)
    own, none = at_strength(law, known.strength), np.empty((0, 0))
    notes = Notes(none, none, none, none, none)
    edges = Edges(np.atleast_2d(response), np.array([coupling]), np.array([rate]), np.empty(0))
    contact = near_edge.follow(own, known.inelasticity, known.yield_ratio, edges, near_edge.QUICK, notes, 0)
    return contact.restitution if contact.status == OK else math.nan
