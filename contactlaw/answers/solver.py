"""Answers from the solver: every impact is integrated, and no table is needed."""

from __future__ import annotations

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._jit import enable_caching
from contactlaw.answers.backend import OutsideTableError, Part, UnsolvedError, joined, split
from contactlaw.equation import force, outcome, zener
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import History
from contactlaw.physical.arguments import within
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.history import ForceHistory, with_units
from contactlaw.physical.impacts import Impacts, check_finite
from contactlaw.physical.rebound import Rebound, rebound
from contactlaw.physical.responses import REACH
from contactlaw.physical.scaling import edges_of
from contactlaw.table import slides
from contactlaw.table.grid import Settings

RTOL = 1e-10  # error allowed per step, by default
_CLOSE = 512  # samples, at least, from which the path of a sphere is integrated
_FEW = 8  # impacts near edges that take less time as Python than the compiler does


class Solver:
    """Integrates impacts; those outside a table of the given extent are refused as by a lookup.

    `contactlaw.answers.tabulated.TableLookup` looks impacts up, and may replace it.
    """

    def __init__(self, bodies: SphereOnPlate, rtol: float = RTOL, extent: Settings | None = None) -> None:
        if not isinstance(rtol, float) or not 1e-13 <= rtol <= 1e-6:
            raise ArgumentError("rtol", rtol, "must be a float between 1e-13 and 1e-6")
        self.bodies, self.rtol, self.extent = bodies, rtol, extent
        enable_caching()

    def far(self, impacts: Impacts) -> list[Part]:
        """Outcomes on plates from which nothing comes back."""
        return self.integrated(impacts)

    def integrated(self, impacts: Impacts) -> list[Part]:
        """Outcomes by integration, also near edges, on curved walls and on foundations."""
        bodies, count = self.bodies, impacts.speed.size
        impact = bodies.impact(impacts)
        units = bodies.numbers(impact)
        lam, y, s = units.inelasticity, units.yield_ratio, units.strength
        for n in np.flatnonzero(s > force.strongest(bodies.data))[:1].tolist():
            reason = "the strength of a pair with a rate of strain is known up to (V0/R)(V_Y/V0)^0.3 = 1e9 per second"
            raise UnsolvedError(n, f"V0/R = {impacts.speed[n] / impacts.radius[n]:.3g} /s", reason)
        edges = edges_of(bodies.pair.plate, bodies.constants, units, impact, impacts)
        if self.extent is not None:
            self.refuse_outside(self.extent, units)
        found = outcome.at(lam, y, s)
        status, n = zener.solve_all(bodies.data, self.rtol, found, edges is not None and count <= _FEW, edges)
        if status != zener.OK:
            raise UnsolvedError(n, f"lambda = {lam[n]:.6g}, d_Y/(V0 T_H) = {y[n]:.6g}", zener.MESSAGES[status])
        if impacts.frequency is not None:
            angle = found.contact_time * units.time * impacts.frequency
            within("thickness", angle, 0.0, REACH, "swings [rad] of a curved wall or foundation in the contact")
        return [Part(impacts, units.time, (lam, y), found, np.zeros(count, np.int64), edges)]

    def refuse_outside(self, extent: Settings, units: Numbers) -> None:
        """Refuse the first impact that is outside a table of this extent."""
        lam, thinnest, fastest = units.inelasticity, extent.largest_inelasticity, extent.largest_overload
        chi = zener.elastic_compression(self.bodies.data, lam, units.strength) / units.yield_ratio
        for n in np.flatnonzero((lam > thinnest) | (chi > fastest))[:1].tolist():
            reason = f"its overload chi = {chi[n]:.9g} is above {fastest:g}: the impact is too fast"
            if lam[n] > thinnest:
                reason = f"its inelasticity lambda = {lam[n]:.9g} is above {thinnest:g}: the plate is too thin"
            raise OutsideTableError(n, reason)

    def parts(self, impacts: Impacts) -> list[Part]:
        """Outcomes of all impacts, in one part or several."""
        near = impacts.remember
        if near is None:
            return self.far(impacts)
        return split(impacts, near, self.integrated, lambda some: self.far(some.forgetting))

    def rebounds(self, impacts: Impacts) -> Rebound:
        """Everything about impacts."""
        return self.together(self.parts(impacts), impacts)

    def together(self, parts: list[Part], impacts: Impacts) -> Rebound:
        """Everything about impacts whose outcomes were found in parts."""
        return Rebound(**joined([(part.places, vars(rebound(self.bodies, *part[:-1]))) for part in parts], impacts))

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        if not (isinstance(samples, int | np.integer) and 2 <= samples <= 1_000_000):
            raise ArgumentError("samples", samples, "must be an integer from 2 to 1 000 000")
        columns, parts = [], self.parts(impacts)
        for part in parts:
            units = self.bodies.numbers(self.bodies.impact(part.impacts))
            contacts, path = self.contacts(part, samples)
            found = with_units(contacts, units, part.outcome.inelasticity, part.impacts.shape, path)
            columns.append((part.places, found._asdict()))
        together = ForceHistory(**joined(columns, impacts))
        together.flags = self.together(parts, impacts).flags
        check_finite(self.bodies.pair, impacts, *(np.ravel(values.sum(axis=-1)) for values in together))
        return together

    def slid(self, part: Part, psi: Array) -> Array:
        """Change of sliding speeds psi [mu V0], by integration."""
        kappa = self.bodies.pair.tangential_ratio
        after = slides.after(self.bodies.data, part.outcome, kappa, psi[:, None], edges=part.edges)
        return np.asarray(psi - after[:, 0])

    def contacts(self, part: Part, samples: int) -> tuple[History, Array | None]:
        """Contacts over time on Hertz's scale, by integration, and near edges the displacement of the plate.

        The plate is where the sphere would be without compression. The path of the sphere is the
        integral of its speed, by Simpson's rule between samples that are close.
        """
        every = 1 if part.edges is None else -(-_CLOSE // (samples - 1))
        out = outcome.history(part.outcome.contact_time, every * (samples - 1) + 1)
        zener.histories(self.bodies.data, part.outcome, RTOL, out, part.edges)
        if part.edges is None:
            return out, None
        from scipy.integrate import cumulative_simpson

        path = cumulative_simpson(1.0 - out.impulse, x=out.time, initial=0.0) - out.compression
        return History(*(values[:, ::every] for values in out)), path[:, ::every]
