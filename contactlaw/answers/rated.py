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
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import direct, switched_off
from contactlaw.answers.backend import OutsideTableError, UnsolvedError, too_fast, too_thin
from contactlaw.answers.solver import RTOL, Solver, integrate, slid
from contactlaw.answers.tabulated import Border, TableArgument, Tabulated
from contactlaw.answers.tabulated import extent as tables_extent
from contactlaw.equation import outcome, zener
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import STORED, Outcome
from contactlaw.laws import Law
from contactlaw.physical import rate
from contactlaw.physical.arguments import check, scalars, shaped
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.flow import Flow
from contactlaw.physical.history import ForceHistory, with_units
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.law import law_for_pair
from contactlaw.physical.rebound import Rebound, rebound, shaped_flags
from contactlaw.physical.scaling import without_plate
from contactlaw.physical.strengths import knots
from contactlaw.physical.validity import Validity
from contactlaw.table import cache, lookup, shapes, strengths
from contactlaw.table.grid import Settings

Array = NDArray[np.float64]
Some = NDArray[np.intp]  # indices of some impacts

_WIDEST = 0.3  # piece of ln k, our choice: the COR errs by less than 5e-6 for it


def flow_of(bodies: SphereOnPlate) -> Flow | None:
    """Flow whose rate strengthens the bodies; None if nothing does."""
    return rate.rated(bodies.pair, bodies.law) if bodies.law.yields else None


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
        self, bodies: SphereOnPlate, given: Settings | None, border: Border, on_plates: bool = True
    ) -> None:
        flow = flow_of(bodies)
        assert flow is not None
        self.bodies, self.flow, self.border, self.on_plates = bodies, flow, border, on_plates
        self.given = given

    @functools.cached_property
    def knots(self) -> list[float]:
        """Ends of the pieces in ln k."""
        return knots(self.bodies.pair, _WIDEST, rate.FASTEST)[0]

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

    def places(self, impacts: Impacts) -> tuple[strengths.Places, Numbers]:
        """Places of impacts among the tables, and their units."""
        known, each = self.bodies.constants, self.bodies.impact(impacts)
        if not self.on_plates:
            known = without_plate(known)
        v, radius = each.speed, each.radius
        at_one = known.time * radius * each.mass**0.4
        out, growth, faster = strengths.empty(v.size), known.plate.growth, np.ones_like(v)
        if growth.modulus_power and not self.on_plates:
            # E* larger by g is as a speed, at the same rate of strain, that is g^2 larger
            shorter = growth.log_time - np.log(at_one) + 0.2 * np.log(v)
            faster = np.exp(2.0 * growth.modulus_power * shorter)
        c_lam, c_chi = known.plate.inelasticity, np.log(at_one / (known.yield_compression * radius))
        ratio = radius / each.thickness
        strengths.locate(self.packed, c_lam, c_chi, faster * v, faster * radius, ratio, out)
        time = at_one / out.root
        y = out.elastic_compression / out.overload
        force = self.bodies.mass(impacts) * v / time
        return out, Numbers(
            out.inelasticity, y, time, v * time, force, out.root, out.strength
        )  # fmt: skip

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

    def rebounds(self, impacts: Impacts) -> tuple[Rebound, strengths.Places]:
        """Everything about impacts, and their places."""
        places, units = self.places(impacts)
        found, flags = self._interpolated(places), np.zeros(places.inside.size, dtype=np.int64)
        beyond = np.flatnonzero(~places.inside)
        if beyond.size:
            if self.border.outside == "raise":
                self._refuse(places, int(beyond[0]))
            elif self.border.outside == "solve":
                with renumbered(beyond):
                    integrated = integrate(self.bodies, impacts.part(beyond))
                for values, exact in zip(found, integrated.outcome, strict=True):
                    values[beyond] = exact
            else:
                with self.border.lock:
                    self.border.clamped += beyond.size
                flags[beyond] = int(Validity.CLAMPED)
        unclamped = places.unclamped, units.yield_ratio
        return rebound(self.bodies, impacts, units.time, unclamped, found, flags), places

    def _interpolated(self, places: strengths.Places) -> Outcome:
        """Outcomes between those of the nodes."""
        found = Outcome(*np.zeros((len(Outcome._fields), places.inside.size)))
        for some, weight, _, at in self.outcomes(places):
            largest = at.compression_ratio * at.elastic_compression
            at = at._replace(compression_ratio=largest / places.elastic_compression[some])
            for name in STORED:
                getattr(found, name)[some] += weight * getattr(at, name)
        np.clip(found.restitution, 0.0, 1.0, out=found.restitution)
        found.inelasticity[:], found.strength[:] = places.inelasticity, places.strength
        found.elastic_compression[:] = places.elastic_compression
        chi = np.minimum(places.overload, places.largest)
        found.yield_ratio[:] = places.elastic_compression / chi
        return found

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

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        places, units = self.places(impacts)
        total = outcome.history(places.piece.size, samples)
        for values in total:
            values[:] = 0.0
        for some, weight, node, found in self.outcomes(places):
            one = outcome.history(some.size, samples)
            packed = cache.cached_shapes(node.table).packed_shapes
            shapes.sample(node.bodies.law.data, packed, found, one)
            for values, more in zip(total, one, strict=True):
                values[some] += weight[:, None] * more
        flags = self.rebounds(impacts)[0].flags
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
        return self.nodes.rebounds(impacts)[0]

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
        normal, places = self.nodes.rebounds(impacts)
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
            some = np.flatnonzero(integrated)
            found = integrate(self.bodies, impacts.part(some))
            changes[some] = slid(self.bodies, found.outcome, psi[some])
        return normal, changes

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        if not impacts.speed.size:
            return Solver(self.bodies).histories(impacts, samples)
        return self.nodes.histories(impacts, samples)

    def yield_speeds(self, impacts: Impacts) -> Array:
        """Speeds [m/s] from which sphere or plate yields; inf where neither does."""
        extent = self.nodes.given or tables_extent(self.bodies.law)
        return Solver(self.bodies, RTOL, extent).yield_speeds(impacts)

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
