"""Answers from the table: impacts are looked up, and `Border` handles those outside it."""

from __future__ import annotations

import functools
import inspect
import math
import os
import threading
import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Literal, NamedTuple, NoReturn

import numpy as np

from contactlaw import laws
from contactlaw._arrays import Array, Integers, Mask
from contactlaw._errors import ArgumentError
from contactlaw._jit import direct, enable_caching, switched_off
from contactlaw.answers.backend import OutsideTableError, refuse_to_yield, renumbered, too_fast, too_thin
from contactlaw.answers.solver import RTOL, Solver, histories, refuse_rates, slid, solved
from contactlaw.equation import outcome
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import Outcome
from contactlaw.laws import Law
from contactlaw.physical.arguments import check, scalars
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.history import ForceHistory, with_units
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.rebound import Rebound, rebound
from contactlaw.physical.scaling import yield_share
from contactlaw.physical.strengths import with_strengths
from contactlaw.physical.validity import Validity
from contactlaw.table import cache, file, grid, lookup, shapes, slides
from contactlaw.table.certificate import bounds
from contactlaw.table.grid import Settings
from contactlaw.table.lookup import NO_MASSES, STRETCH
from contactlaw.table.table import Table

Outside = Literal["raise", "solve", "clamp"]
TableArgument = Table | Settings | str | os.PathLike[str] | None  # what users may give as a table

# These fields begin at zero at yield, where large relative errors do no harm.
_NEXT_TO_YIELD = {"residual_compression", "plastic_fraction"}


class Border:
    """What to do with impacts outside a table; counts those that got the value at its border."""

    def __init__(self, outside: Outside) -> None:
        if outside not in ("raise", "solve", "clamp"):
            raise ArgumentError("outside", outside, "must be 'raise', 'solve' or 'clamp'")
        self.outside = outside
        self.clamped = 0
        self.lock = threading.Lock()

    def look_up(self, law: Array, table: Array, units: Numbers) -> tuple[Outcome, Integers]:
        """Look outcomes up, and flag with Validity.CLAMPED those that were taken at the border.

        The dimensionless numbers of these are the border's.
        """
        out = outcome.at(units.inelasticity, units.yield_ratio, units.strength)
        flags = np.zeros(out.inelasticity.size, dtype=np.int64)
        if not lookup.fields(table, False, out):
            return out, flags
        beyond = np.flatnonzero(np.isnan(out.restitution))
        found = outcome.part(out, beyond)
        if self.outside == "raise":
            with renumbered(beyond):
                _refuse(table, found)
        elif self.outside == "solve":
            numbers = found.inelasticity, found.yield_ratio
            found = solved(law, *numbers, RTOL, beyond, strength=found.strength)
        else:
            lookup.fields(table, True, found)
            flags[beyond] = int(Validity.CLAMPED)
            with self.lock:
                self.clamped += beyond.size
        for values, completed in zip(out, found, strict=True):
            values[beyond] = completed
        return out, flags


def _refuse(table: Array, beyond: Outcome) -> NoReturn:
    """Say why the first of some impacts is outside a table."""
    numbers = beyond.inelasticity, beyond.yield_ratio, beyond.strength
    lam, y, s = (float(one[0]) for one in numbers)
    axes = lookup.axes_of(table)
    limit, most = axes.x_max * STRETCH / (1.0 - axes.x_max), lookup.strongest(table, axes)
    if lam > limit:
        raise OutsideTableError(0, too_thin(lam, limit))
    if math.exp(s) > most:
        times = f"{math.exp(s):.4g} times stronger, above {most:.4g}"
        raise OutsideTableError(0, f"its rate makes the bodies {times}")
    border = outcome.part(beyond, slice(1))
    lookup.fields(table, True, border)
    elastic = border.elastic_compression.item()
    raise OutsideTableError(0, too_fast(elastic / y, elastic / border.yield_ratio.item()))


class TableLookup:
    """Looks impacts up; the table, the law's own if none is given, is made when first needed."""

    def __init__(self, bodies: SphereOnPlate, given: TableArgument, border: Border) -> None:
        self.bodies, self.given, self.border = bodies, given, border

    @functools.cached_property
    def law(self) -> Law:
        """The law of the table, with all strengths that it has."""
        return with_strengths(self.bodies.pair, self.bodies.law)

    @functools.cached_property
    def table(self) -> Table:
        """The table that serves the law."""
        return table_for(self.law, self.given)

    @functools.cached_property
    def instead(self) -> Solver | None:
        """The solver in place of a table that takes minutes to build without the compiler."""
        ships = self.given is not None or file.packaged(_law_with_table(self.bodies.law))
        if ships or self.border.outside == "clamp" or not switched_off():
            return None
        limits = extent(self.bodies.law) if self.border.outside == "raise" else None
        return Solver(self.bodies, extent=limits)

    @functools.cached_property
    def packed(self) -> Array:
        """The table as kernels read it, with the constants of the pair."""
        return lookup.with_plate(self.table.packed, self.bodies.constants)

    @functools.cached_property
    def shapes(self) -> Array:
        """The shapes of force histories, which a first one takes a second to add to the table."""
        found = cache.cached_shapes(self.table).histories
        assert found is not None
        return found

    @functools.cached_property
    def slides(self) -> Array:
        """The tangential rebounds of the pair, as kernels read them; once they take seconds."""
        return cache.cached_slides(self.table, self.bodies.pair.tangential_ratio)

    @functools.cached_property
    def restitution(self) -> Callable[[float, float, float], float]:
        """COR of one impact, whose arguments have to be floats; NaN outside the table."""
        return functools.partial(python_entries()[0], self.packed)

    @property
    def largest_inelasticity(self) -> float:
        """Largest lambda of the table; for the law's own, known before the table is made."""
        if self.given is None:
            return grid.largest_inelasticity(_law_with_table(self.bodies.law))
        return self.table.settings.largest_inelasticity

    def given_for(self, law: Law) -> Table | None:
        """Table that the user gave, if it fits another law, too, as that of two spheres."""
        fits = self.given is not None and (law == self.law or self.table.law.follows(law))
        return self.table if fits else None

    def restitutions(self, impacts: Impacts) -> Array:
        """COR of impacts; sizes are checked only if the kernel has no answer for one of them."""
        v, r, h = impacts.speed, impacts.radius, impacts.thickness
        out = np.empty(v.size)
        mass = NO_MASSES if impacts.mass is None else self.bodies.impact(impacts).mass
        if lookup.restitutions(self.packed, v, r, h, mass, out):
            check(speed=v, radius=r, thickness=h)
            out = self._looked_up(impacts).outcome.restitution
        return out

    def rebounds(self, impacts: Impacts) -> Rebound:
        """Everything about impacts."""
        if self.instead is not None:
            return self.instead.rebounds(impacts)
        return self._rebound(impacts, self._looked_up(impacts))

    def oblique(self, impacts: Impacts, psi: Array) -> tuple[Rebound, Array]:
        """Everything about the normal part, and the change of the sliding speed [mu V0]."""
        known = self._looked_up(impacts)
        found, changes = known.outcome, np.empty_like(psi)
        # without the compiler a table takes hours to make, and an integration a fifth of a second
        inside = ~known.integrated & (not switched_off())
        for some in map(np.flatnonzero, (inside, ~inside)):
            if not some.size:
                continue
            part = outcome.part(found, some)
            if inside[some[0]]:
                changes[some] = self._changes(part, psi[some])
            else:
                changes[some] = slid(self.bodies, part, psi[some])
        return self._rebound(impacts, known), changes

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        known = self._looked_up(impacts)
        found, contacts = known.outcome, outcome.history(impacts.speed.size, samples)
        for some in map(np.flatnonzero, (~known.integrated, known.integrated)):
            if not some.size:
                continue
            part = outcome.part(found, some)
            if known.integrated[some[0]]:
                own = histories(self.bodies.data, part, samples)
            else:
                own = outcome.history(some.size, samples)
                shapes.sample(self.bodies.data, self.shapes, part, own)
            for values, more in zip(contacts, own, strict=True):
                values[some] = more
        units = self.bodies.numbers(self.bodies.impact(impacts))
        flags = self._rebound(impacts, known).flags
        return with_units(contacts, units, found.inelasticity, impacts.shape, flags)

    def yield_speeds(self, impacts: Impacts) -> Array:
        """Speeds [m/s] from which sphere or plate yields; inf where neither does."""
        rated = self.bodies.constants.plate.rate.slope > 0.0
        if impacts.mass is not None or rated or self.instead is not None:
            given = extent(self.bodies.law) if self.given is None else self.table.settings
            return Solver(self.bodies, RTOL, given).yield_speeds(impacts)
        out = np.full(impacts.radius.size, math.inf)
        share = yield_share(self.bodies.pair, self.bodies.law)
        if share < math.inf:
            scale = (self.bodies.constants.time / share) ** 0.25
            lookup.yield_speeds(self.packed, scale, impacts.radius, impacts.thickness, out)
            if np.isnan(out).any():
                refuse_to_yield(impacts, np.isnan(out), self.table.settings.largest_inelasticity)
        return out

    def curve(self, impacts: Impacts) -> Callable[[float], float]:
        """COR as a function of speed [m/s] of the sphere and the plate of one impact."""
        at, table, mass = python_entries()[1], self.packed, self.bodies.impact(impacts).mass
        known = impacts.radius.item(), impacts.thickness.item(), mass.item()

        def restitution(speed: float) -> float:
            if not isinstance(speed, float):  # the entry would take "5" and True for numbers
                speed = scalars(speed=speed)[0].item()
            value = at(table, speed, *known)
            if value != value:  # NaN; half the time of a call of isnan
                one = replace(impacts, speed=scalars(speed=speed)[0])
                return float(self._looked_up(one).outcome.restitution[0])
            return value

        return restitution

    def _changes(self, found: Outcome, psi: Array) -> Array:
        changes = np.empty_like(psi)
        slides.changes(self.slides, found, psi, changes)
        return changes

    def _looked_up(self, impacts: Impacts) -> _LookedUp:
        v, r, h = impacts.speed, impacts.radius, impacts.thickness
        mass = NO_MASSES if impacts.mass is None else self.bodies.impact(impacts).mass
        found, root = outcome.empty(v.size), np.empty(v.size)
        flags, integrated = np.zeros(v.size, dtype=np.int64), np.zeros(v.size, dtype=np.bool_)
        lam, y = found.inelasticity, found.yield_ratio
        if lookup.outcomes(self.packed, v, r, h, mass, found, root):
            lam, y = lam.copy(), y.copy()
            beyond = np.flatnonzero(np.isnan(found.restitution))
            part = impacts.part(beyond)
            units = self.bodies.numbers(self.bodies.impact(part))
            lam[beyond], y[beyond] = units.inelasticity, units.yield_ratio
            with renumbered(beyond, part.mass):
                if self.border.outside == "solve":
                    refuse_rates(self.bodies, part, units)
                looked, flags[beyond] = self.border.look_up(self.bodies.data, self.packed, units)
            for values, completed in zip(found, looked, strict=True):
                values[beyond] = completed
            integrated[beyond] = self.border.outside == "solve"
        time = self.bodies.constants.time * r / root
        return _LookedUp(found, flags, (lam, y), time, integrated)

    def _rebound(self, impacts: Impacts, known: _LookedUp) -> Rebound:
        found = known.outcome, known.flags
        return rebound(self.bodies, impacts, known.time, known.unclamped, *found, interpolated=True)


class _LookedUp(NamedTuple):
    """Outcomes of impacts, and what belongs to them."""

    outcome: Outcome
    flags: Integers
    unclamped: tuple[Array, Array]  # inelasticity and yield ratio before clamping
    time: Array  # T_H [s]
    integrated: Mask  # those beyond the table


@functools.cache
def python_entries() -> tuple[Callable[..., float], Callable[..., float]]:
    """Python's entries of `solid_on_plate` and `restitution_on_plate`; each argument a float."""
    return (
        direct(lookup.solid_on_plate, "float64(float64[::1], f8, f8, f8)"),
        direct(lookup.restitution_on_plate, "float64(float64[::1], f8, f8, f8, f8)"),
    )


def extent(law: Law) -> Settings:
    """Extent of a law's own table, which is known before the table is made."""
    return grid.on_demand(_law_with_table(law))


def _law_with_table(law: Law) -> Law:
    """Law whose table serves this law: for Hertz's, the edge chi = 1 of the packaged one of MYC."""
    return law if law.yields or not law.is_hertz else laws.law("myc")


def table_for(law: Law, table: TableArgument) -> Table:
    """Table that serves a law: the user's, or the law's own."""
    enable_caching()
    served = _law_with_table(law)
    if table is None:
        table = file.packaged(served) or cache.cached(served)
    elif isinstance(table, Settings):
        table = cache.cached(served, table)
    elif isinstance(table, str | os.PathLike):
        table = file.read(table)
    elif not isinstance(table, Table):
        raise TypeError(f"table: expected a Table, Settings or the path of a file, got {table!r}")
    exceeded = table.exceeded
    if exceeded.keys() - _NEXT_TO_YIELD:
        warnings.warn(
            f"the table is less accurate than contactlaw promises; its largest errors {exceeded} "
            f"are above {bounds(table.law)}: take finer Settings",
            stacklevel=_stack_level(),
        )
    if not table.law.follows(served):
        raise ArgumentError(
            "table",
            None,
            f"it belongs to law {table.law.name!r}, the model needs one of {served.name!r} (data "
            f"{table.law.key} and {served.key}; laws of one name differ in their rates): leave it "
            f"out, or contactlaw table build --law {served.family}, with --sphere and --plate if "
            "the law takes numbers from them",
        )
    return table


def _stack_level() -> int:
    """Count the frames up to the user's line, for a warning."""
    level, frame = 0, inspect.currentframe()
    while frame:
        package = frame.f_globals.get("__name__", "").partition(".")[0]
        if package not in ("contactlaw", "functools"):
            break
        level, frame = level + 1, frame.f_back
    return level
