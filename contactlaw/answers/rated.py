"""Answers for pairs whose strength grows with the rate of strain, see `contactlaw.physical.rate`.

An impact's answer is that of the pair without rate that is stronger by the impact's factor. The
solver makes the law of each such pair; tables are those of a few, the nodes, and answers lie
between theirs (`contactlaw.table.strengths`).
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import direct, switched_off
from contactlaw.answers.backend import (
    OutsideTableError,
    SphereOnPlate,
    UnsolvedError,
    too_fast,
    too_thin,
)
from contactlaw.answers.solver import RTOL, Solver, edges_near, histories_and_path, slid, within
from contactlaw.answers.tabulated import Border, TableArgument, Tabulated
from contactlaw.equation import outcome, zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import Extremes, Outcome
from contactlaw.laws import Law, fem
from contactlaw.laws.fem import ALONE, RATIOS
from contactlaw.physical import rate
from contactlaw.physical.arguments import check, scalars, shaped
from contactlaw.physical.flow import Flow
from contactlaw.physical.history import ForceHistory, with_units
from contactlaw.physical.rebound import Impacts, Rebound, completed, rebound, shaped_flags
from contactlaw.physical.scaling import ContactConstants, law_for_pair, pair_numbers, scales
from contactlaw.physical.validity import Validity
from contactlaw.table import cache, lookup, shapes, strengths
from contactlaw.table.grid import Settings

Array = NDArray[np.float64]
Some = NDArray[np.intp]  # indices of some impacts
# Contact of some impacts, for a pair that is stronger or for the pair itself.
Contact = Callable[[SphereOnPlate, Some], ContactConstants]

_WIDEST = 0.3  # piece of ln k, our choice: the COR errs by less than 5e-6 for it
_DEEPEST = (23.0, 40.0)  # E*/sigma_Y at which the reach of law fem changes its formula
_TRIED = 513  # places of ln k between which corners are looked for
_CLOSE = 1e-6  # in ln k: how closely the strength is found at which no body yields
_NEAR = 5e-3  # in ln k: nearer to the ends there are no corners
_PASSES = 100  # in which a yield speed converges; each leaves a tenth of the error, or less
_CONVERGED = 1e-11


def flow_of(bodies: SphereOnPlate) -> Flow | None:
    """Flow whose rate strengthens the bodies; None if nothing does."""
    return rate.rated(bodies.pair, bodies.law) if bodies.law.yields else None


def solver(bodies: SphereOnPlate, rtol: float = RTOL, extent: Settings | None = None) -> Solver:
    """Solver of a pair, with a rate of strain or without."""
    flow = flow_of(bodies)
    return Solver(bodies, rtol, extent) if flow is None else RatedSolver(bodies, rtol, extent)


def tabulated(bodies: SphereOnPlate, given: TableArgument, border: Border) -> Tabulated:
    """Tables of a pair, with a rate of strain or without."""
    rated = Tabulated if flow_of(bodies) is None else Rated
    return rated(bodies, given, border)


def stronger(bodies: SphereOnPlate, factor: float) -> SphereOnPlate:
    """Bodies without rate that are stronger by a factor; the law's numbers are not rounded."""
    pair = rate.strengthened(bodies.pair, factor)
    return SphereOnPlate(pair, law_for_pair(pair, bodies.law))


@contextmanager
def renumbered(some: Some) -> Iterator[None]:
    """Make errors about one of some impacts name it by its number among all."""
    try:
        yield
    except (OutsideTableError, UnsolvedError) as error:
        impact, *rest = error.args
        raise type(error)(int(some[impact]), *rest) from None


def merged(parts: Iterable[tuple[Some, Rebound]], impacts: Impacts) -> Rebound:
    """Put answers of some of the impacts together."""
    columns: dict[str, Any] = {}
    for some, found in parts:
        for name, values in vars(found).items():
            whole = columns.setdefault(name, np.empty(impacts.speed.size, values.dtype))
            whole[some] = values
    flags = shaped_flags(columns.pop("flags"), impacts.shape)
    named = {name: shaped(values, impacts.shape) for name, values in columns.items()}
    return Rebound(**named, flags=flags)


def merged_histories(parts: Sequence[tuple[Some, ForceHistory]], impacts: Impacts) -> ForceHistory:
    """Put histories of some of the impacts together."""
    samples, flags = parts[0][1].time.shape[-1], np.empty(impacts.speed.size, dtype=np.int64)
    columns = np.empty((len(ForceHistory._fields), impacts.speed.size, samples))
    for some, found in parts:
        columns[:, some], flags[some] = found, found.flags
    whole = *(impacts.shape or ()), samples
    together = ForceHistory(*(values.reshape(whole) for values in columns))
    together.flags = shaped_flags(flags, impacts.shape)
    return together


class Solved(NamedTuple):
    """Integrated impacts whose pair is stronger by one factor."""

    some: Some
    bodies: SphereOnPlate
    impacts: Impacts
    contact: ContactConstants
    units: Numbers
    outcome: Outcome
    edges: Edges | None

    def rebound(self) -> Rebound:
        """Everything about the impacts."""
        flags = np.zeros(self.some.size, dtype=np.int64)
        unclamped = self.units.inelasticity, self.units.yield_ratio
        return rebound(
            self.bodies.pair, self.bodies.law.data, self.bodies.limits, self.impacts,
            self.units.time, self.contact.mass, unclamped, self.outcome, flags, self.edges,
        )  # fmt: skip


def solved(
    bodies: SphereOnPlate,
    contact: Contact,
    impacts: Impacts,
    among: Some | None = None,
    rtol: float = RTOL,
    extent: Settings | None = None,
    few: bool = False,
) -> Iterator[Solved]:
    """Integrate impacts, those together whose pair is equally strong."""
    flow = flow_of(bodies)
    assert flow is not None
    among = np.arange(impacts.speed.size) if among is None else among
    factor = rate.factors(flow, impacts.speed[among], impacts.radius[among])
    # factors that differ in their last digits alone share a law
    each, which = np.unique(np.round(factor, 12), return_inverse=True)
    groups = np.split(among[np.argsort(which, kind="stable")], np.cumsum(np.bincount(which))[:-1])
    for one, some in zip(each.tolist(), groups, strict=True) if each.size else [(1.0, among)]:
        here = stronger(bodies, one)
        at, these = contact(here, some), impacts.part(some)
        units = scales(at, these.speed)
        edges = edges_near(here, at, units, these)
        with renumbered(some):
            found = within(here.law, units, rtol, extent, few, edges)
        yield Solved(some, here, these, at, units, found, edges)


def on_plates(impacts: Impacts) -> Contact:
    """Contacts of impacts on plates."""
    return lambda bodies, some: bodies.contact(impacts.part(some))


def first_yield(flow: Flow, radius: Array, at: Callable[[Array], Array]) -> Array:
    """Speeds [m/s] from which a body yields, from those of pairs that are stronger by factors.

    The strength is that at the rate of the speed, so that it rises from pass to pass.
    """
    factor = np.ones(radius.size)
    for _ in range(_PASSES):
        speed = at(factor)
        before, factor = factor, rate.factors(flow, np.where(speed < math.inf, speed, 0.0), radius)
        if (np.abs(factor - before) <= _CONVERGED * factor).all():
            break
    return speed


class RatedSolver(Solver):
    """Integrates impacts, each with the law at its rate."""

    def _parts(self, impacts: Impacts) -> Iterator[Solved]:
        contact = on_plates(impacts)
        return solved(self.bodies, contact, impacts, None, self.rtol, self.extent)

    def rebounds(self, impacts: Impacts) -> Rebound:
        """Everything about impacts."""
        return merged(((one.some, one.rebound()) for one in self._parts(impacts)), impacts)

    def oblique(self, impacts: Impacts, psi: Array) -> tuple[Rebound, Array]:
        """Everything about the normal part, and the change of the sliding speed [mu V0]."""
        changes, parts = np.empty_like(psi), []
        for one in self._parts(impacts):
            parts.append((one.some, one.rebound()))
            changes[one.some] = slid(one.bodies, one.outcome, psi[one.some], one.edges)
        return merged(parts, impacts), changes

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        parts = []
        for one in self._parts(impacts):
            contacts, path = histories_and_path(one.bodies.law, one.outcome, samples, one.edges)
            lam, flags = one.outcome.inelasticity, one.rebound().flags
            here = with_units(contacts, one.units, lam, one.impacts.shape, flags, path)
            parts.append((one.some, here))
        return merged_histories(parts, impacts)

    def yield_speeds(self, radius: Array, thickness: Array) -> Array:
        """Speeds [m/s] from which sphere or plate yields; inf where neither does."""
        flow = flow_of(self.bodies)
        assert flow is not None

        def at(factor: Array) -> Array:
            pairs = (stronger(self.bodies, one) for one in factor.tolist())
            one = [slice(n, n + 1) for n in range(radius.size)]
            return np.concatenate([
                Solver(pair, self.rtol, self.extent).yield_speeds(radius[n], thickness[n])
                for pair, n in zip(pairs, one, strict=True)
            ] or [np.empty(0)])  # fmt: skip

        return first_yield(flow, radius, at)


class Nodes:
    """Tables of rate-free pairs between which the answers of one with a rate lie.

    Parameters
    ----------
    bodies : SphereOnPlate
        The pair with the rate, and its law.
    given : Settings, optional
        Of each table, in place of its own.
    border : Border
        What to do with impacts beyond the tables.
    on_plates : bool
        Whether the bodies are sphere and plate, rather than two spheres.
    """

    def __init__(
        self, bodies: SphereOnPlate, given: TableArgument, border: Border, on_plates: bool = True
    ) -> None:
        flow = flow_of(bodies)
        assert flow is not None
        self.bodies, self.flow, self.border, self.on_plates = bodies, flow, border, on_plates
        self.given = given

    @functools.cached_property
    def knots(self) -> list[float]:
        """Ends of the pieces in ln k, between which the law is a smooth function of k.

        It is not where the bodies' strengths are alike, where the stronger one begins to yield,
        where a formula of the law's has a corner, and where the second of two strengths begins to
        grow. Pieces are narrower where one strength grows faster than k, and is no straight line in
        ln k, and where two that share the flow grow apart.
        """
        last = math.log(rate.largest_factor(self.flow))
        if not stronger(self.bodies, math.exp(last)).law.yields:  # where does that begin?
            low = 0.0
            while last - low > _CLOSE:
                middle = 0.5 * (low + last)
                yields = stronger(self.bodies, math.exp(middle)).law.yields
                low, last = (middle, last) if yields else (low, middle)
            last = low
        logs = np.linspace(0.0, last, _TRIED)
        inner: list[float] = []
        for values in np.array([self._corners(one) for one in logs]).T:
            (before,) = np.nonzero(values[:-1] * values[1:] < 0.0)
            share = values[before] / (values[before] - values[before + 1])
            inner += (logs[before] + share * (logs[1] - logs[0])).tolist()
        flows = rate.flows(self.bodies.pair)
        starts = {round(math.log(self.flow.factor(one.rate0)), 9) for one in flows}
        ends = list({0.0, last, *(one for one in starts if one < last - _CLOSE)})
        for one in sorted(inner):
            if min(abs(one - end) for end in ends) > _NEAR:
                ends.append(one)
        rates = [rate.rate_at(self.flow, math.exp(one)) for one in logs]
        grown = np.log([[one.strength * one.factor(at) for one in flows] for at in rates])
        steps = np.diff(grown, axis=0)
        width = np.maximum(logs[1], 2.0 * steps.max(axis=1) - logs[1])
        both = np.ptp(grown[1:], axis=1) < -math.log(ALONE)  # how they share the flow changes
        run = np.append(0.0, np.cumsum(width + 0.5 * both * np.ptp(steps, axis=1)))
        knots = [0.0]
        for low, high in itertools.pairwise(sorted(ends)):
            first, final = np.interp((low, high), logs, run)
            inside = np.linspace(first, final, math.ceil((final - first) / _WIDEST) + 1)[1:-1]
            knots += [*np.interp(inside, run, logs).tolist(), high]
        return knots

    def _corners(self, log_factor: float) -> list[float]:
        """Numbers that change their signs at corners of the law."""
        pair = rate.strengthened(self.bodies.pair, math.exp(log_factor))
        numbers = pair_numbers(pair, self.bodies.law.family)
        given = fem.Given(**{n: numbers[n] for n in fem.PARAMETERS if n in numbers})
        found = []
        for one in fem.comparable(given):
            ratios = [ratio for ratio in one[:2] if ratio]
            found += [math.log(ratio / at) for ratio in ratios for at in (*RATIOS, *_DEEPEST)]
            if len(ratios) == 2:
                found += [math.log(ratios[0] / ratios[1] / z) for z in (ALONE, 1.0, 1.0 / ALONE)]
        return found

    @property
    def factors(self) -> list[float]:
        """Factors of the strength at the nodes: three for a piece, and one."""
        logs = [0.0]
        for low, high in itertools.pairwise(self.knots):
            logs += [low + 0.5 * (1.0 + place) * (high - low) for place in strengths.PLACES[1:]]
        return [math.exp(one) for one in logs]

    @functools.cached_property
    def tabulated(self) -> list[Tabulated]:
        """Tables of the nodes."""
        pairs = (stronger(self.bodies, factor) for factor in self.factors)
        return [Tabulated(one, self.given, self.border) for one in pairs]

    @functools.cached_property
    def packed(self) -> Array:
        """The tables as kernels read them."""
        tables = [one.packed if self.on_plates else one.table.packed for one in self.tabulated]
        lengths = [_length(one.bodies.law) for one in self.tabulated]
        if min(table[lookup.LOG_CHI_MAX] for table in tables) < min(lengths):
            lengths = [1.0] * len(lengths)  # no table reaches the end of the law's range
        nodes = [
            strengths.Node(one.table, table, length, one.c_chi)
            for table, length, one in zip(tables, lengths, self.tabulated, strict=True)
        ]
        log_share = math.log(rate.SHARE / self.flow.rate0)
        return strengths.pack(self.flow.rate, log_share, self.knots, nodes)

    def places(self, contact: Contact, impacts: Impacts) -> tuple[strengths.Places, Numbers]:
        """Places of impacts among the tables, and their units."""
        v, at = impacts.speed, contact(self.bodies, np.arange(impacts.speed.size))
        at_one = (at.mass / at.stiffness) ** 0.4
        out, radius = strengths.empty(v.size), impacts.radius
        growth, faster = at.plate.growth, np.ones_like(v)
        if growth.modulus_power and not self.on_plates:
            # E* larger by g is as a speed, at the same rate of strain, that is g^2 larger
            shorter = growth.log_time - np.log(at_one) + 0.2 * np.log(v)
            faster = np.exp(2.0 * growth.modulus_power * shorter)
        c_lam, c_chi = at.plate.inelasticity, np.log(at_one / at.yield_compression)
        strengths.locate(self.packed, c_lam, c_chi, faster * v, faster * radius, at.ratio, out)
        time = at_one / out.root
        y = out.elastic_compression / out.overload
        return out, Numbers(out.inelasticity, y, time, v * time, at.mass * v / time, out.root)

    def outcomes(
        self, places: strengths.Places
    ) -> Iterator[tuple[Some, Array, Tabulated, Outcome]]:
        """Outcomes at the nodes: of which impacts, their weights, and of which node."""
        for piece in np.unique(places.piece).tolist():
            some = np.flatnonzero(places.piece == piece)
            for n in range(len(strengths.PLACES)):
                node = self.tabulated[3 * piece + n]
                found = outcome.at(places.inelasticity[some], places.yield_ratio[n, some])
                lookup.fields(node.table.packed, True, found)
                yield some, places.weights[n, some], node, found

    def rebounds(self, contact: Contact, impacts: Impacts) -> tuple[Rebound, strengths.Places]:
        """Everything about impacts, and their places."""
        places, units = self.places(contact, impacts)
        parts, beyond = [], ~places.inside
        flags = np.zeros(beyond.size, dtype=np.int64)
        if beyond.any():
            if self.border.outside == "raise":
                self._refuse(places, int(np.argmax(beyond)))
            elif self.border.outside == "solve":
                among = np.flatnonzero(beyond)
                integrated = solved(self.bodies, contact, impacts, among)
                parts = [(one.some, one.rebound()) for one in integrated]
            else:
                with self.border.lock:
                    self.border.clamped += int(beyond.sum())
                flags[beyond], beyond = int(Validity.CLAMPED), np.zeros_like(beyond)
        inside = np.flatnonzero(~beyond)
        if not parts or inside.size:
            parts += self._tabulated(impacts, places, units, flags, inside)
        return merged(parts, impacts), places

    def _tabulated(
        self, impacts: Impacts, places: strengths.Places, units: Numbers, flags: Some, inside: Some
    ) -> Iterator[tuple[Some, Rebound]]:
        """Answers from the tables; those of one call have the flags' limits of one node."""
        found = {name: np.zeros(flags.size) for name in (*Outcome._fields, *Extremes._fields)}
        nearest = 3 * places.piece + np.argmax(places.weights, axis=0)
        for some, weight, node, at in self.outcomes(places):
            limits = outcome.extremes(some.size)
            zener.extremes(node.bodies.law.data, at, limits)
            for name, values in {**at._asdict(), **limits._asdict()}.items():
                found[name][some] += weight * values
            # a product of two
            found["compression_ratio"][some] += (
                weight
                * at.compression_ratio
                * (at.elastic_compression / places.elastic_compression[some] - 1.0)
            )
        e = found["restitution"] = np.clip(found["restitution"], 0.0, 1.0)
        shares = found["plastic_fraction"], found["other_fraction"], found["wave_rate"]
        lost = shares[0] + shares[1] + places.inelasticity * shares[2]
        # the energies that are interpolated lack what the square of the COR has
        scale = np.divide(1.0 - e**2, lost, out=np.ones_like(lost), where=lost > 0.0)
        for share in shares:
            share *= scale
        found["inelasticity"] = places.inelasticity
        found["elastic_compression"] = places.elastic_compression
        chi = np.minimum(places.overload, places.largest)
        found["yield_ratio"] = places.elastic_compression / chi
        yielded = places.overload > 1.0
        for j, flowing in {*zip(nearest[inside].tolist(), yielded[inside].tolist(), strict=True)}:
            some = inside[(nearest[inside] == j) & (yielded[inside] == flowing)]
            at = Outcome(*(found[name][some] for name in Outcome._fields))
            extremes = Extremes(*(found[name][some] for name in Extremes._fields))
            # which share of R begins to flow depends on the strength, and is known here
            limits = self.tabulated[j].bodies.limits._replace(share=0.0 if flowing else math.inf)
            mass = units.force[some] * units.time[some] / impacts.speed[some]
            unclamped = places.unclamped[some], units.yield_ratio[some]
            yield some, completed(
                self.bodies.pair, limits, impacts.part(some), units.time[some], mass, unclamped, at,
                extremes, flags[some],
            )  # fmt: skip

    def _refuse(self, places: strengths.Places, n: int) -> None:
        lam, limit = float(places.unclamped[n]), lookup.lam_max(self.tabulated[0].packed)
        if lam > limit:
            raise OutsideTableError(n, too_thin(lam, limit))
        if places.strength[n] > self.knots[-1]:
            factor, most = math.exp(places.strength[n]), math.exp(self.knots[-1])
            raise OutsideTableError(
                n,
                f"its rate makes the bodies {factor:.4g} times stronger, above {most:.4g}",
            )
        raise OutsideTableError(n, too_fast(float(places.overload[n]), float(places.largest[n])))

    def histories(self, contact: Contact, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        places, units = self.places(contact, impacts)
        total = outcome.history(places.piece.size, samples)
        for values in total:
            values[:] = 0.0
        for some, weight, node, found in self.outcomes(places):
            one = outcome.history(some.size, samples)
            packed = cache.cached_shapes(node.table).packed_shapes
            shapes.sample(node.bodies.law.data, packed, found, one)
            for values, more in zip(total, one, strict=True):
                values[some] += weight[:, None] * more
        flags = self.rebounds(contact, impacts)[0].flags
        return with_units(total, units, places.inelasticity, impacts.shape, flags)


def _length(law: Law) -> float:
    """Ln chi of an impact on a half-space that turns at the end of a law's range."""
    w_m = zener.elastic_compression(law.data, 0.0, 1e-11, few=True)[1]
    found = zener.overload_at(law.data, 0.0, w_m, law.range[1], 1e-11, few=True)
    return math.log(float(np.ravel(found)[0]))


class Rated(Tabulated):
    """Looks impacts up between the tables of pairs without rate."""

    on_plate: ClassVar[Callable[..., float]] = staticmethod(strengths.restitution_on_plate)

    def __init__(self, bodies: SphereOnPlate, given: TableArgument, border: Border) -> None:
        if not isinstance(given, Settings | None):
            raise ValueError(
                "table: a pair with a rate of strain takes tables of several strengths, and no "
                "single one: leave it out, or give Settings for all of them"
            )
        super().__init__(bodies, given, border)
        self.nodes = Nodes(bodies, given, border)

    @functools.cached_property
    def table(self) -> Any:
        """The table of impacts that are too slow for the rate to matter."""
        return self.nodes.tabulated[0].table

    @functools.cached_property
    def packed(self) -> Array:
        """The tables as kernels read them, with the corrections of the pair's plates."""
        return self.nodes.packed

    @functools.cached_property
    def restitution(self) -> Callable[[float, float, float], float]:
        """COR of one impact, whose arguments have to be floats; NaN outside the table."""
        return functools.partial(python_entries()[0], self.packed, self.c_lam, self.c_chi)

    def restitutions(self, speed: Array, radius: Array, thickness: Array) -> Array:
        """COR of impacts; they are checked only if the kernel has no answer for one of them."""
        out, known = np.empty(speed.size), (self.packed, self.c_lam, self.c_chi)
        if strengths.restitutions(*known, speed, radius, thickness, out):
            check(speed=speed, radius=radius, thickness=thickness)
            found = self.rebounds(Impacts(speed, radius, thickness, speed.shape))
            out = np.asarray(found.restitution)
        return out

    def rebounds(self, impacts: Impacts) -> Rebound:
        """Everything about impacts."""
        if not impacts.speed.size:
            return Solver(self.bodies).rebounds(impacts)
        return self.nodes.rebounds(on_plates(impacts), impacts)[0]

    @functools.cached_property
    def slides(self) -> Array:
        """The tangential rebounds of the nodes at the knots; once they take seconds each."""
        kappa = self.bodies.pair.tangential_ratio
        ends = self.nodes.tabulated[::3]
        return strengths.pack_slides([cache.cached_slides(one.table, kappa) for one in ends])

    def oblique(self, impacts: Impacts, psi: Array) -> tuple[Rebound, Array]:
        """Everything about the normal part, and the change of the sliding speed [mu V0]."""
        if not impacts.speed.size:
            return Solver(self.bodies).oblique(impacts, psi)
        contact = on_plates(impacts)
        normal, places = self.nodes.rebounds(contact, impacts)
        v, r, h = impacts.speed, impacts.radius, impacts.thickness
        changes = np.empty_like(psi)
        integrated = ~places.inside & (self.border.outside == "solve")
        if switched_off():
            integrated[:] = True
        if not integrated.all():
            known, e = (
                (self.packed, self.slides, self.c_lam, self.c_chi),
                np.ravel(normal.restitution),
            )
            strengths.changes(*known, v, r, h, e, psi, changes)
        if integrated.any():
            for one in solved(self.bodies, contact, impacts, np.flatnonzero(integrated)):
                changes[one.some] = slid(one.bodies, one.outcome, psi[one.some])
        return normal, changes

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        if not impacts.speed.size:
            return Solver(self.bodies).histories(impacts, samples)
        return self.nodes.histories(on_plates(impacts), impacts, samples)

    def yield_speeds(self, radius: Array, thickness: Array) -> Array:
        """Speeds [m/s] from which sphere or plate yields; inf where neither does."""
        knots = np.array(self.nodes.knots)
        logs = np.log([one.yield_speeds(radius, thickness) for one in self.nodes.tabulated])

        def at(factor: Array) -> Array:
            place = np.log(factor)
            piece = np.clip(np.searchsorted(knots, place) - 1, 0, knots.size - 2)
            t = 2.0 * (place - knots[piece]) / np.diff(knots)[piece] - 1.0
            each = np.arange(radius.size)
            values = sum(
                weight * logs[3 * piece + n, each] for n, weight in enumerate(strengths.weights(t))
            )
            return np.asarray(np.exp(values))

        found = first_yield(self.nodes.flow, radius, at)
        factor = rate.factors(self.nodes.flow, found, radius)
        if (factor > math.exp(knots[-1])).any():
            n = int(np.argmax(factor))
            raise ValueError(
                f"radius: at {radius[n]:g} m the bead yields at a rate of strain beyond the tables'"
            )
        return found

    def curve(self, radius: Array, thickness: Array) -> Callable[[float], float]:
        """COR of one sphere on one plate, as a function of speed [m/s]."""
        r, h = radius.item(), thickness.item()
        known = self.packed, self.c_lam, self.c_chi
        return curve(
            known, (r, r / h), lambda v: self.rebounds(Impacts(v, radius, thickness, None))
        )


@functools.cache
def python_entries() -> tuple[Callable[..., float], Callable[..., float]]:
    """Python's entries of `restitution_on_plate` and `restitution`; each argument a float."""
    signature = "float64(float64[::1], f8, f8, f8, f8, f8)"
    return (
        direct(strengths.restitution_on_plate, signature),
        direct(strengths.restitution, signature),
    )


def curve(
    known: tuple[Array, float, float], sizes: tuple[float, float],
    rebounds: Callable[[Array], Rebound],
) -> Callable[[float], float]:  # fmt: skip
    """COR as a function of speed [m/s], from packed tables, R and R/H."""
    at, (radius, ratio) = python_entries()[1], sizes

    def restitution(speed: float) -> float:
        if not isinstance(speed, float):  # the entry would take "5" and True for numbers
            speed = scalars(speed=speed)[0].item()
        value = at(*known, speed, radius, ratio)
        if value != value:
            return float(rebounds(scalars(speed=speed)[0]).restitution)
        return value

    return restitution
