"""Answers from the solver: every impact is integrated, and no table is needed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactlaw.answers.backend import (
    OutsideTableError,
    SphereOnPlate,
    UnsolvedError,
    refuse_to_yield,
    too_fast,
    too_thin,
)
from contactlaw.equation import edge, outcome, zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import History, Outcome
from contactlaw.laws import Law
from contactlaw.physical.history import ForceHistory, with_units
from contactlaw.physical.rebound import Impacts, Rebound, rebound
from contactlaw.physical.scaling import ContactConstants, edges_of, scales, yield_share
from contactlaw.table import slides
from contactlaw.table.grid import Settings

Array = NDArray[np.float64]
Places = NDArray[np.intp]  # indices of impacts in the flat arrays that the user gave

RTOL = 1e-10  # error allowed per step, by default
_FEW = 8  # impacts near edges that take less time as Python than the compiler does
_CLOSE = 512  # samples between which the path of a sphere is a cubic
_CONVERGED = 1e-9  # largest size of ln(largest compression/d_Y) at the yield speed found
_ROUNDS = 30
_SLOPES = 0.5, 1.0  # bounds of d ln(compression)/d ln(speed); elastic impacts have 2/3 to 4/5


@dataclass(frozen=True, eq=False)
class Solver:
    """Integrates impacts; those outside a table of the given extent are refused as by a lookup."""

    bodies: SphereOnPlate
    rtol: float = RTOL
    extent: Settings | None = None

    def rebounds(self, impacts: Impacts) -> Rebound:
        """Everything about impacts."""
        return self._solved(impacts)[0]

    def oblique(self, impacts: Impacts, psi: Array) -> tuple[Rebound, Array]:
        """Everything about the normal part, and the change of the sliding speed [mu V0]."""
        normal, found, edges = self._solved(impacts)
        return normal, slid(self.bodies, found, psi, edges)

    def _solved(self, impacts: Impacts) -> tuple[Rebound, Outcome, Edges | None]:
        contact = self.bodies.contact(impacts)
        units = scales(contact, impacts.speed)
        edges = edges_near(self.bodies, contact, units, impacts)
        few = edges is not None and impacts.speed.size <= _FEW
        found = within(self.bodies.law, units, self.rtol, self.extent, few, edges)
        flags = np.zeros(impacts.speed.size, dtype=np.int64)
        unclamped = units.inelasticity, units.yield_ratio
        return rebound(
            self.bodies.pair, self.bodies.law.data, self.bodies.limits, impacts, units.time,
            contact.mass, unclamped, found, flags, edges,
        ), found, edges  # fmt: skip

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        normal, found, edges = self._solved(impacts)
        units = scales(self.bodies.contact(impacts), impacts.speed)
        contacts, path = histories_and_path(self.bodies.law, found, samples, edges)
        return with_units(contacts, units, found.inelasticity, impacts.shape, normal.flags, path)

    def yield_speeds(self, radius: Array, thickness: Array) -> Array:
        """Speeds [m/s] from which sphere or plate yields; inf where neither does."""
        share = yield_share(self.bodies.pair, self.bodies.law)
        if math.isinf(share):
            return np.full(radius.size, math.inf)
        found = [
            self._yield_speed(share, radius[n : n + 1], thickness[n : n + 1])
            for n in range(radius.size)
        ]
        speed, lam = np.array(found).reshape(-1, 2).T
        if self.extent is not None:
            limit = self.extent.largest_inelasticity
            beyond = lam > limit
            if beyond.any():
                refuse_to_yield(radius, thickness, beyond, limit)
        return speed

    def _yield_speed(self, share: float, radius: Array, thickness: Array) -> tuple[float, float]:
        """Speed at which the largest compression is d_Y = share R, and lambda there.

        By the secant method in logarithms, in which the compression is nearly linear in the speed.
        It starts at the yield speed on a half-space, which is the lowest of all plates.
        """
        contact = self.bodies.contact(Impacts(np.ones(1), radius, thickness, None))
        contact = contact._replace(yield_compression=share * radius)
        thinnest = math.inf if self.extent is None else 2.0 * self.extent.largest_inelasticity
        log_speed = 1.25 * math.log(float(scales(contact, np.ones(1)).yield_ratio[0]))
        log_speed -= 0.5 * math.log(1.25)  # 1.25 ln w_m of a half-space
        slope, last, gap = 0.75, math.nan, 0.0
        for _ in range(_ROUNDS):
            units = scales(contact, np.array([math.exp(log_speed)]))
            lam, y = float(units.inelasticity[0]), float(units.yield_ratio[0])
            if lam > thinnest:
                break
            one = zener.solve(self.bodies.law.data, lam, y, self.rtol)
            if one.status != zener.OK:
                raise UnsolvedError(0, f"lambda = {lam:.6g}", zener.MESSAGES[one.status])
            before, gap = gap, math.log(one.peak_compression / y)
            if abs(gap) < _CONVERGED:
                break
            if last == last:
                slope = min(max((gap - before) / (log_speed - last), _SLOPES[0]), _SLOPES[1])
            last, log_speed = log_speed, log_speed - gap / slope
        else:
            raise UnsolvedError(0, f"lambda = {lam:.6g}", "no speed was found at which it yields")
        return math.exp(log_speed), lam


def within(
    law: Law, units: Numbers, rtol: float, extent: Settings | None, few: bool = False,
    edges: Edges | None = None,
) -> Outcome:  # fmt: skip
    """Integrate impacts up to the first one that is outside the extent, which is refused."""
    lam, y = units.inelasticity, units.yield_ratio
    if extent is None:
        return solved(law, lam, y, rtol, few=few, edges=edges)
    thin = extent.largest_inelasticity
    beyond = int(np.argmax(np.append(lam > thin, True)))
    inner = edge.part(edges, slice(beyond))
    found = solved(law, lam[:beyond], y[:beyond], rtol, few=few, edges=inner)
    chi = found.elastic_compression / found.yield_ratio
    for n in np.flatnonzero(chi > extent.largest_overload)[:1].tolist():
        raise OutsideTableError(n, too_fast(chi[n], extent.largest_overload))
    if beyond < lam.size:
        raise OutsideTableError(beyond, too_thin(lam[beyond], thin))
    return found


def solved(
    law: Law,
    lam: Array,
    y: Array,
    rtol: float,
    places: Places | None = None,
    few: bool = False,
    edges: Edges | None = None,
) -> Outcome:
    """Outcomes at inelasticities and yield ratios, by integration.

    If these are only some of the user's impacts, `places` has their indices, for errors.
    A few impacts need no compiled integrator, if their last digits do not matter.
    """
    out = outcome.at(lam, y)
    status, n = zener.solve_all(law.data, rtol, out, few, edges)
    if status != zener.OK:
        where = f"lambda = {out.inelasticity[n]:.6g}, d_Y/(V0 T_H) = {out.yield_ratio[n]:.6g}"
        raise UnsolvedError(int(n if places is None else places[n]), where, zener.MESSAGES[status])
    return out


def edges_near(
    bodies: SphereOnPlate, contact: ContactConstants, units: Numbers, impacts: Impacts
) -> Edges | None:
    """Edges near impacts, as the equation has them; None where there are none."""
    if impacts.edge_distance is None or impacts.hole_radius is None:
        return None
    near = impacts.thickness, impacts.edge, impacts.edge_distance, impacts.hole_radius
    return edges_of(bodies.pair.plate, contact, units, *near)


def slid(bodies: SphereOnPlate, found: Outcome, psi: Array, edges: Edges | None = None) -> Array:
    """Change of the sliding speeds psi in impacts with these outcomes [mu V0], by integration."""
    kappa = bodies.pair.tangential_ratio
    changed: Array = psi - slides.after(bodies.law, found, kappa, psi[:, None], edges=edges)[:, 0]
    return changed


def histories(law: Law, found: Outcome, samples: int) -> History:
    """Contacts over time on Hertz's scale, by integration."""
    return histories_and_path(law, found, samples, None)[0]


def histories_and_path(
    law: Law, found: Outcome, samples: int, edges: Edges | None
) -> tuple[History, Array | None]:
    """Contacts over time on Hertz's scale, and near edges the displacement of the plate.

    The plate is where the sphere would be without compression. The path of the sphere is the
    integral of its speed, between samples that are close, by the cubic through speeds and forces.
    """
    every = 1 if edges is None else -(-_CLOSE // (samples - 1))
    out = outcome.history(found.inelasticity.size, every * (samples - 1) + 1)
    zener.histories(law.data, found, RTOL, out, edges)
    if edges is None:
        return out, None
    step, u, f = out.time[:, 1:2], 1.0 - out.impulse, out.force
    moved = 0.5 * step * (u[:, 1:] + u[:, :-1]) + step * step / 12.0 * (f[:, 1:] - f[:, :-1])
    path = np.pad(np.cumsum(moved, axis=1), ((0, 0), (1, 0))) - out.compression
    return History(*(values[:, ::every] for values in out)), path[:, ::every]
