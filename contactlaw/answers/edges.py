"""Answers where something comes back from the plate: these impacts are integrated.

That is near its edges, where it is curved, or lies on a foundation. All others are left as they are.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from contactlaw._arrays import Array, Places
from contactlaw._jit import in_memory, kernel
from contactlaw.answers.backend import Backend, renumbered
from contactlaw.answers.solver import Solver
from contactlaw.equation import near_edge, zener
from contactlaw.equation.force import at_strength
from contactlaw.equation.numbers import Impact, PairConstants, numbers, relaxes, share_of_solid
from contactlaw.physical.arguments import shaped
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.history import ForceHistory
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.rebound import Rebound, shaped_flags
from contactlaw.physical.responses import response_of
from contactlaw.physical.scaling import wave_path, wave_rate
from contactlaw.table import lookup


@dataclass(frozen=True, eq=False)
class WithEdges:
    """Integrates impacts on plates that remember, and leaves all others to another backend."""

    others: Backend
    near: Solver

    def rebounds(self, impacts: Impacts) -> Rebound:
        """Everything about impacts."""
        return _merged(_each(self, impacts, lambda by, part, _: by.rebounds(part)), impacts)

    def oblique(self, impacts: Impacts, psi: Array) -> tuple[Rebound, Array]:
        """Everything about the normal part, and the change of the sliding speed [mu V0]."""
        found = _each(self, impacts, lambda by, part, some: by.oblique(part, psi[some]))
        changes = np.empty_like(psi)
        for some, (_, changed) in found:
            changes[some] = changed
        return _merged(((some, normal) for some, (normal, _) in found), impacts), changes

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        found = _each(self, impacts, lambda by, part, _: by.histories(part, samples))
        return _merged_histories(found, impacts)

    def yield_speeds(self, impacts: Impacts) -> Array:
        """Speeds [m/s] from which sphere or plate yields, far from edges."""
        return self.others.yield_speeds(impacts)


def with_edges(others: Backend, near: Solver, impacts: Impacts) -> Backend:
    """Backend for impacts of which some may be near an edge, or on a plate that swings."""
    return others if impacts.remember is None else WithEdges(others, near)


def kernel_near(bodies: SphereOnPlate, kind: str) -> Callable[..., float]:
    """COR near an edge as a jitted function of speed, radius, thickness, distance and mass."""
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
    if not (
        lookup.V_MIN <= speed <= lookup.V_MAX
        and lookup.R_MIN <= radius <= lookup.R_MAX
        and lookup.THINNEST * radius <= thickness
        and edge_distance >= 0.0
        and mass > 0.0
    ):
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
    notes = zener.Notes(none, none, none, none, none)
    one = near_edge.follow(own, response, known.inelasticity, y, min(thin, 1.0), rate, near_edge.QUICK, notes, 0)
    return near_edge.restitution(one, y) if one.ended else math.nan


def _each(
    both: WithEdges, impacts: Impacts, answer: Callable[[Backend, Impacts, Places], Any]
) -> list[tuple[Places, Any]]:
    """Answers of the impacts from whose plate nothing comes back, and of the others."""
    near, found = impacts.remember, []
    assert near is not None
    for by, which, these in ((both.others, ~near, impacts.forgetting), (both.near, near, impacts)):
        some = np.flatnonzero(which)
        if some.size or near.size == 0:
            with renumbered(some):
                found.append((some, answer(by, these.part(some), some)))
    return found


def _merged(parts: Iterable[tuple[Places, Rebound]], impacts: Impacts) -> Rebound:
    """Put answers of some of the impacts together."""
    columns: dict[str, Any] = {}
    for some, found in parts:
        for name, values in vars(found).items():
            whole = columns.setdefault(name, np.empty(impacts.speed.size, values.dtype))
            whole[some] = values
    flags = shaped_flags(columns.pop("flags"), impacts.shape)
    named = {name: shaped(values, impacts.shape) for name, values in columns.items()}
    return Rebound(**named, flags=flags)


def _merged_histories(parts: Sequence[tuple[Places, ForceHistory]], impacts: Impacts) -> ForceHistory:
    """Put histories of some of the impacts together."""
    samples, flags = parts[0][1].time.shape[-1], np.empty(impacts.speed.size, dtype=np.int64)
    columns = np.empty((len(ForceHistory._fields), impacts.speed.size, samples))
    for some, found in parts:
        columns[:, some], flags[some] = found, found.flags
    whole = *(impacts.shape or ()), samples
    together = ForceHistory(*(values.reshape(whole) for values in columns))
    together.flags = shaped_flags(flags, impacts.shape)
    return together
