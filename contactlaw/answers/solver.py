"""Answers from the solver: every impact is integrated, and no table is needed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.answers.backend import Backend, OutsideTableError, Part, UnsolvedError, too_fast, too_thin
from contactlaw.equation import force, outcome, zener
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
        if self.extent is not None:
            self._refuse_outside(self.extent, units, impacts)
        few = edges is not None and count <= _FEW
        numbers = units.inelasticity, units.yield_ratio
        found = solved(bodies.data, *numbers, self.rtol, few=few, edges=edges, strength=units.strength)
        if impacts.frequency is not None:
            angle = found.contact_time * units.time * impacts.frequency
            within("thickness", angle, 0.0, REACH, "swings [rad] of a curved wall or foundation in the contact")
        flags = np.zeros(count, dtype=np.int64)
        return [Part(slice(None), impacts, units.time, numbers, found, flags, edges, False)]

    near = far

    def _refuse_outside(self, extent: Settings, units: Numbers, impacts: Impacts) -> None:
        """Refuse the first impact that is outside a table of this extent."""
        thinnest, fastest = extent.largest_inelasticity, extent.largest_overload
        lam, s = units.inelasticity, units.strength
        chi = zener.elastic_compression(self.bodies.data, lam, s) / units.yield_ratio
        for n in np.flatnonzero((lam > thinnest) | (chi > fastest))[:1].tolist():
            reason = too_thin(lam[n], thinnest) if lam[n] > thinnest else too_fast(chi[n], fastest)
            raise OutsideTableError(n, reason, None if impacts.mass is None else float(impacts.mass[n]))


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
