"""Answers from the solver: every impact is integrated, and no table is needed."""

from __future__ import annotations

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.answers.backend import OutsideTableError, Part, UnsolvedError, joined, split, too_fast, too_thin
from contactlaw.equation import force, outcome, zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import History, Outcome, history
from contactlaw.physical.arguments import within
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.history import ForceHistory, with_units
from contactlaw.physical.impacts import Impacts, check_finite
from contactlaw.physical.rebound import Rebound, rebound
from contactlaw.physical.responses import REACH
from contactlaw.physical.scaling import edges_of, swings_of
from contactlaw.table import slides
from contactlaw.table.grid import Settings

RTOL = 1e-10  # error allowed per step, by default
_CLOSE = 512  # samples between which the path of a sphere is a cubic
_FEW = 8  # impacts near edges that take less time as Python than the compiler does


def refuse_rates(bodies: SphereOnPlate, impacts: Impacts, units: Numbers) -> None:
    """Refuse impacts at rates for which no strength is known."""
    beyond = units.strength > force.strongest(bodies.data)
    if beyond.any():
        n = int(np.argmax(beyond))
        rate = impacts.speed[n] / impacts.radius[n]
        reason = "the strength of a pair with a rate of strain is known up to (V0/R)(V_Y/V0)^0.3 = 1e9 per second"
        raise UnsolvedError(n, f"V0/R = {rate:.3g} /s", reason)


class Solver:
    """Integrates impacts; those outside a table of the given extent are refused as by a lookup.

    `contactlaw.answers.tabulated.TableLookup` looks impacts up, and may replace it.
    """

    def __init__(self, bodies: SphereOnPlate, rtol: float = RTOL, extent: Settings | None = None) -> None:
        self.bodies, self.rtol, self.extent = bodies, rtol, extent

    @classmethod
    def within(cls, bodies: SphereOnPlate, rtol: float) -> Solver:
        """Make the solver with an error per step that a user asks for."""
        if not isinstance(rtol, float) or not 1e-13 <= rtol <= 1e-6:
            raise ArgumentError("rtol", rtol, "must be a float between 1e-13 and 1e-6")
        return cls(bodies, rtol)

    def far(self, impacts: Impacts) -> list[Part]:
        """Outcomes on plates from which nothing comes back."""
        return self.integrated(impacts)

    def integrated(self, impacts: Impacts) -> list[Part]:
        """Outcomes by integration, also near edges, on curved walls and on foundations."""
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

    def _refuse_outside(self, extent: Settings, units: Numbers, impacts: Impacts) -> None:
        """Refuse the first impact that is outside a table of this extent."""
        thinnest, fastest = extent.largest_inelasticity, extent.largest_overload
        lam, s = units.inelasticity, units.strength
        chi = zener.elastic_compression(self.bodies.data, lam, s) / units.yield_ratio
        for n in np.flatnonzero((lam > thinnest) | (chi > fastest))[:1].tolist():
            reason = too_thin(lam[n], thinnest) if lam[n] > thinnest else too_fast(chi[n], fastest)
            raise OutsideTableError(n, reason, None if impacts.mass is None else float(impacts.mass[n]))

    def parts(self, impacts: Impacts) -> list[Part]:
        """Outcomes of all impacts, in one part or several."""
        near = impacts.remember
        if near is None:
            return self.far(impacts)
        return split(impacts, near, self.integrated, lambda some: self.far(some.forgetting))

    def rebounds(self, impacts: Impacts) -> Rebound:
        """Everything about impacts."""
        return self.together(self.parts(impacts), impacts)

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        if not (isinstance(samples, int | np.integer) and 2 <= samples <= 1_000_000):
            raise ArgumentError("samples", samples, "must be an integer from 2 to 1 000 000")
        columns = []
        for part in self.parts(impacts):
            units = self.bodies.numbers(self.bodies.impact(part.impacts))
            flags = self._rebound(part).flags
            lam, shape = part.outcome.inelasticity, part.impacts.shape
            contacts, path = self.contacts(part, samples)
            found = with_units(contacts, units, lam, shape, flags, path)
            columns.append((part.places, {**found._asdict(), "flags": flags}))
        whole = joined(columns, impacts)
        flags = whole.pop("flags")
        together = ForceHistory(**whole)
        together.flags = flags
        check_finite(self.bodies.pair, impacts, *(np.ravel(one.sum(axis=-1)) for one in together))
        return together

    def slid(self, part: Part, psi: Array) -> Array:
        """Change of sliding speeds psi [mu V0], by integration."""
        kappa = self.bodies.pair.tangential_ratio
        after = slides.after(self.bodies.data, part.outcome, kappa, psi[:, None], edges=part.edges)
        return np.asarray(psi - after[:, 0])

    def contacts(self, part: Part, samples: int) -> tuple[History, Array | None]:
        """Contacts over time on Hertz's scale, by integration, and near edges the displacement of the plate.

        The plate is where the sphere would be without compression. The path of the sphere is the
        integral of its speed, between samples that are close, by the cubic through speeds and forces.
        """
        every = 1 if part.edges is None else -(-_CLOSE // (samples - 1))
        out = history(part.outcome.contact_time, every * (samples - 1) + 1)
        zener.histories(self.bodies.data, part.outcome, RTOL, out, part.edges)
        if part.edges is None:
            return out, None
        step, u, f = out.time[:, 1:2], 1.0 - out.impulse, out.force
        moved = 0.5 * step * (u[:, 1:] + u[:, :-1]) + step * step / 12.0 * (f[:, 1:] - f[:, :-1])
        path = np.pad(np.cumsum(moved, axis=1), ((0, 0), (1, 0))) - out.compression
        return History(*(values[:, ::every] for values in out)), path[:, ::every]

    def _rebound(self, part: Part) -> Rebound:
        return rebound(self.bodies, *part[1:])

    def together(self, parts: list[Part], impacts: Impacts) -> Rebound:
        """Everything about impacts whose outcomes were found in parts."""
        return Rebound(**joined([(one.places, vars(self._rebound(one))) for one in parts], impacts))


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
