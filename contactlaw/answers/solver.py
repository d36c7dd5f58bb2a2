"""Answers from the solver: every impact is integrated, and no table is needed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.answers.backend import (
    Backend,
    OutsideTableError,
    Part,
    UnsolvedError,
    renumbered,
    too_fast,
    too_thin,
)
from contactlaw.equation import edge, force, outcome, zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import Outcome
from contactlaw.physical.arguments import within
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.responses import REACH
from contactlaw.physical.scaling import edges_of, swings_of
from contactlaw.table.grid import Settings

RTOL = 1e-10  # error allowed per step, by default
_FEW = 8  # impacts near edges that take less time as Python than the compiler does


def refuse_rates(bodies: SphereOnPlate, impacts: Impacts, units: Numbers) -> None:
    """Refuse impacts at rates for which no strength is known."""
    beyond = units.strength > force.strongest(bodies.data)
    if beyond.any():
        n = int(np.argmax(beyond))
        rate = impacts.speed[n] / impacts.radius[n]
        reason = "the strength of a pair with a rate of strain is known up to (V0/R)(V_Y/V0)^0.3 = 1e9 per second"
        raise UnsolvedError(n, f"V0/R = {rate:.3g} /s", reason)


@dataclass(frozen=True, eq=False)
class Solver(Backend):
    """Integrates impacts; those outside a table of the given extent are refused as by a lookup."""

    bodies: SphereOnPlate
    rtol: float = RTOL
    extent: Settings | None = None

    @classmethod
    def within(cls, bodies: SphereOnPlate, rtol: float) -> Solver:
        """Make the solver with an error per step that a user asks for."""
        if not isinstance(rtol, float) or not 1e-13 <= rtol <= 1e-6:
            raise ArgumentError("rtol", rtol, "must be a float between 1e-13 and 1e-6")
        return cls(bodies, rtol)

    def far(self, impacts: Impacts) -> list[Part]:
        """Integrate impacts."""
        bodies, count, edges = self.bodies, impacts.speed.size, None
        impact = bodies.impact(impacts)
        units = bodies.numbers(impact)
        refuse_rates(bodies, impacts, units)
        if impacts.edge is not None:
            edges = edges_of(bodies.pair.plate, bodies.constants, units, impact, impacts.edge)
        elif impacts.frequency is not None and impacts.wall is not None:
            swing = impacts.wall, impacts.frequency
            edges = swings_of(bodies.pair.plate, bodies.constants, units, impact, *swing)
        few = edges is not None and count <= _FEW
        with renumbered(np.arange(count), impacts.mass):
            found = solved_within(bodies.data, units, self.rtol, self.extent, few, edges)
        if impacts.frequency is not None:
            angle = found.contact_time * units.time * impacts.frequency
            within("thickness", angle, 0.0, REACH, "swings [rad] of a curved wall or foundation in the contact")
        known, flags = (units.inelasticity, units.yield_ratio), np.zeros(count, dtype=np.int64)
        return [Part(slice(None), impacts, units.time, known, found, flags, edges, False)]

    near = far


def solved_within(
    law: Array, units: Numbers, rtol: float, extent: Settings | None, few: bool = False, edges: Edges | None = None
) -> Outcome:
    """Integrate impacts up to the first one that is outside the extent, which is refused."""
    lam, y, s = units.inelasticity, units.yield_ratio, units.strength
    if extent is None:
        return solved(law, lam, y, rtol, few=few, edges=edges, strength=s)
    thin = extent.largest_inelasticity
    beyond = int(np.argmax(np.append(lam > thin, True)))
    inner = edge.part(edges, slice(beyond))
    found = solved(law, lam[:beyond], y[:beyond], rtol, few=few, edges=inner, strength=s[:beyond])
    chi = found.elastic_compression / found.yield_ratio
    for n in np.flatnonzero(chi > extent.largest_overload)[:1].tolist():
        raise OutsideTableError(n, too_fast(chi[n], extent.largest_overload))
    if beyond < lam.size:
        raise OutsideTableError(beyond, too_thin(lam[beyond], thin))
    return found


def solved(
    law: Array,
    lam: Array,
    y: Array,
    rtol: float,
    few: bool = False,
    edges: Edges | None = None,
    strength: Array | float = 0.0,
) -> Outcome:
    """Outcomes at inelasticities, yield ratios and strengths, by integration.

    A few impacts need no compiled integrator, if their last digits do not matter.
    """
    out = outcome.at(lam, y, strength)
    status, n = zener.solve_all(law, rtol, out, few, edges)
    if status != zener.OK:
        where = f"lambda = {out.inelasticity[n]:.6g}, d_Y/(V0 T_H) = {out.yield_ratio[n]:.6g}"
        raise UnsolvedError(int(n), where, zener.MESSAGES[status])
    return out
