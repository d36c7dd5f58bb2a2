"""Answers from the solver: every impact is integrated, and no table is needed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.answers.backend import (
    Backend,
    OutsideTableError,
    Part,
    UnsolvedError,
    refuse_to_yield,
    renumbered,
    too_fast,
    too_thin,
)
from contactlaw.equation import force, outcome, zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import Outcome
from contactlaw.physical.arguments import within
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.responses import REACH
from contactlaw.physical.scaling import edges_of, numbers_of, swings_of, yield_share
from contactlaw.table.grid import Settings

RTOL = 1e-10  # error allowed per step, by default
_FEW = 8  # impacts near edges that take less time as Python than the compiler does
_CONVERGED = 1e-9  # largest size of ln(largest compression/d_Y) at the yield speed found
_ROUNDS = 30
_SLOPES = 0.5, 1.0  # bounds of d ln(compression)/d ln(speed); elastic impacts have 2/3 to 4/5


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

    def yield_speeds(self, impacts: Impacts) -> Array:
        """Speeds [m/s] from which sphere or plate yields; inf where neither does.

        There the largest compression is that of first flow. They are found by the secant method in
        logarithms, in which the compression is nearly linear in the speed. It starts at the yield
        speed on a half-space, which is the lowest of all plates.
        """
        laws, constants, impact = self.bodies.data, self.bodies.constants, self.bodies.impact(impacts)
        share, rated = yield_share(self.bodies.pair, self.bodies.law), constants.plate.rate.slope > 0.0
        found = np.full(impacts.speed.size, math.inf)
        if math.isinf(share):
            return found
        if not rated:
            constants = constants._replace(yield_compression=share)
        at_one = numbers_of(constants, laws, impact._replace(speed=np.ones_like(found)))
        log_speed = 1.25 * np.log(at_one.yield_ratio) - 0.5 * math.log(1.25)  # 1.25 ln w_m of a half-space
        limit = math.inf if self.extent is None else self.extent.largest_inelasticity
        slope, last, gap = np.full_like(found, 0.75), np.full_like(found, math.nan), np.zeros_like(found)
        never = np.zeros(found.size, dtype=np.bool_)
        for _ in range(_ROUNDS):
            units = numbers_of(constants, laws, impact._replace(speed=np.exp(log_speed)))
            lam, y, s = units.inelasticity, units.yield_ratio, units.strength
            thin = lam > 2.0 * limit
            hit = solved(laws, np.where(thin, 0.0, lam), y, self.rtol, strength=s)
            onset = np.log([force.scale_at(laws, one, force.LOG_ONSET) / force.growth_at(laws, one) for one in s])
            never |= rated & (onset >= -math.log(share))  # the strength has outgrown the load
            before, gap = gap, np.log(hit.compression_ratio * hit.elastic_compression / y) - onset
            gap[thin | never] = 0.0
            if np.abs(gap).max(initial=0.0) < _CONVERGED:
                break
            step = log_speed - last
            moved = np.divide(gap - before, step, out=slope, where=np.abs(step) > 0.0)
            slope = np.clip(moved, *_SLOPES)
            last, log_speed = log_speed, log_speed - gap / slope
        else:
            n = int(np.abs(gap).argmax())
            raise UnsolvedError(n, f"lambda = {lam[n]:.6g}", "no speed was found at which it yields")
        if (lam > limit)[~never].any():
            refuse_to_yield(impacts, (lam > limit) & ~never, limit)
        return np.where(never, math.inf, np.exp(log_speed))


def solved_within(
    law: Array, units: Numbers, rtol: float, extent: Settings | None, few: bool = False, edges: Edges | None = None
) -> Outcome:
    """Integrate impacts up to the first one that is outside the extent, which is refused."""
    lam, y, s = units.inelasticity, units.yield_ratio, units.strength
    if extent is None:
        return solved(law, lam, y, rtol, few=few, edges=edges, strength=s)
    thin = extent.largest_inelasticity
    beyond = int(np.argmax(np.append(lam > thin, True)))
    inner = None if edges is None else outcome.part(edges, slice(beyond))
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
