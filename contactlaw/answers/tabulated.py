"""Answers from the table: impacts are looked up, and `Border` handles those outside it."""

from __future__ import annotations

import functools
import math
import os
import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Literal

import numpy as np

from contactlaw import laws
from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._jit import direct, switched_off
from contactlaw.answers.backend import OutsideTableError, Part, renumbered, split
from contactlaw.answers.solver import Solver
from contactlaw.equation import outcome
from contactlaw.equation.outcome import History
from contactlaw.laws import Law
from contactlaw.physical.arguments import check, scalars
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.strengths import with_strengths
from contactlaw.physical.validity import Validity
from contactlaw.table import cache, file, grid, lookup, shapes, slides
from contactlaw.table.certificate import bounds
from contactlaw.table.grid import Settings
from contactlaw.table.lookup import NO_MASSES
from contactlaw.table.table import Table

Outside = Literal["raise", "solve", "clamp"]
TableArgument = Table | Settings | str | os.PathLike[str] | None  # what users may give as a table

# These fields begin at zero at yield, where large relative errors do no harm.
_NEXT_TO_YIELD = {"residual_compression", "plastic_fraction"}


class TableLookup(Solver):
    """Looks impacts up; the table, the law's own if none is given, is made when first needed.

    Outside the table `outside` says what to do; `clamped` counts impacts that got the value at its border.
    """

    def __init__(self, bodies: SphereOnPlate, given: TableArgument, outside: Outside) -> None:
        super().__init__(bodies)
        if outside not in ("raise", "solve", "clamp"):
            raise ArgumentError("outside", outside, "must be 'raise', 'solve' or 'clamp'")
        self.given, self.outside = given, outside
        self.clamped = np.zeros(1, np.int64)  # an array, which models of two spheres share; numpy adds under a lock

    @functools.cached_property
    def table(self) -> Table:
        """The table that serves the law."""
        return table_for(with_strengths(self.bodies.pair, self.bodies.law), self.given)

    @functools.cached_property
    def instead(self) -> Solver | None:
        """The solver in place of a table that takes minutes to build without the compiler."""
        ships = self.given is not None or file.packaged(_law_with_table(self.bodies.law))
        if ships or self.outside == "clamp" or not switched_off():
            return None
        return Solver(self.bodies, extent=extent(self.bodies.law) if self.outside == "raise" else None)

    @functools.cached_property
    def packed(self) -> Array:
        """The table as kernels read it, with the constants of the pair."""
        return lookup.with_plate(self.table.packed, self.bodies.constants)

    @functools.cached_property
    def shapes(self) -> Array:
        """The shapes of force histories, which a first one takes a second to add to the table."""
        return cache.cached_shapes(self.table)

    @functools.cached_property
    def slides(self) -> Array:
        """The tangential rebounds of the pair, as kernels read them; once they take seconds."""
        return cache.cached_slides(self.table, self.bodies.pair.tangential_ratio)

    @functools.cached_property
    def restitution(self) -> Callable[[float, float, float, float], float]:
        """COR of one impact by speed, sizes and mass over that of a solid sphere, all floats; NaN outside the table."""
        entry = direct(lookup.restitution_on_plate, "float64(float64[::1], f8, f8, f8, f8)")
        return functools.partial(entry, self.packed)

    @property
    def largest_inelasticity(self) -> float:
        """Largest lambda of the table; for the law's own, known before the table is made."""
        if self.given is None:
            return grid.largest_inelasticity(_law_with_table(self.bodies.law))
        return self.table.settings.largest_inelasticity

    def restitutions(self, impacts: Impacts) -> Array:
        """COR of impacts; sizes are checked only if the kernel has no answer for one of them."""
        v, r, h = impacts.speed, impacts.radius, impacts.thickness
        out = np.empty(v.size)
        if lookup.restitutions(self.packed, v, r, h, self._shares(impacts), out):
            check(speed=v, radius=r, thickness=h)
            out = np.ravel(self.rebounds(impacts).restitution)
        return out

    def far(self, impacts: Impacts) -> list[Part]:
        """Look impacts up."""
        if self.instead is not None:
            return self.instead.far(impacts)
        count = impacts.speed.size
        found, root = outcome.empty(count), np.empty(count)
        flags, numbers = np.zeros(count, dtype=np.int64), (found.inelasticity, found.yield_ratio)
        sizes = impacts.speed, impacts.radius, impacts.thickness, self._shares(impacts)
        missed = lookup.outcomes(self.packed, *sizes, found, root)
        if missed:
            return split(impacts, np.isnan(found.restitution), self._beyond, self.far)
        time = self.bodies.constants.time * impacts.radius / root
        return [Part(impacts, time, numbers, found, flags, None, True)]

    def _beyond(self, impacts: Impacts) -> list[Part]:
        """Outcomes beyond the range of speeds and sizes of a lookup, and beyond the table."""
        units = self.bodies.numbers(self.bodies.impact(impacts))
        numbers, flags = (units.inelasticity, units.yield_ratio), np.zeros_like(units.time, np.int64)
        found = outcome.at(*numbers, units.strength)
        if lookup.fields(self.packed, False, found):
            beyond = np.flatnonzero(np.isnan(found.restitution))
            if self.outside == "solve":
                return self.integrated(impacts)
            if self.outside == "raise":
                with renumbered(beyond):
                    self.refuse_outside(self.table.settings, outcome.part(units, beyond))
                    raise OutsideTableError(0, "its rate makes the bodies stronger than those of the table")
            lookup.fields(self.packed, True, found)
            flags[beyond] = int(Validity.CLAMPED)
            self.clamped += beyond.size
        return [Part(impacts, units.time, numbers, found, flags, None, True)]

    def slid(self, part: Part, psi: Array) -> Array:
        """Change of sliding speeds psi [mu V0]."""
        # without the compiler a table takes hours to make, and an integration a fifth of a second
        if not part.interpolated or switched_off():
            return super().slid(part, psi)
        changes = np.empty_like(psi)
        slides.changes(self.slides, part.outcome, psi, changes)
        return changes

    def contacts(self, part: Part, samples: int) -> tuple[History, Array | None]:
        """Contacts over time on Hertz's scale."""
        if not part.interpolated:
            return super().contacts(part, samples)
        out = outcome.history(part.outcome.contact_time, samples)
        shapes.sample(self.bodies.data, self.shapes, part.outcome, out)
        return out, None

    def curve(self, impacts: Impacts) -> Callable[[float], float]:
        """COR as a function of speed [m/s] of the sphere and the plate of one impact."""
        at = self.restitution
        known = impacts.radius.item(), impacts.thickness.item(), self.bodies.impact(impacts).mass.item()

        def restitution(speed: float) -> float:
            value = at(speed, *known) if isinstance(speed, float) else math.nan  # it would take "5" for a number
            if value != value:  # NaN; half the time of a call of isnan
                one = replace(impacts, speed=scalars(speed=speed)[0])
                return self.restitutions(one).item()
            return value

        return restitution

    def _shares(self, impacts: Impacts) -> Array:
        """Masses over those of solid spheres."""
        return NO_MASSES if impacts.mass is None else self.bodies.impact(impacts).mass


def by_method(tabulated: TableLookup, method: str) -> Solver:
    """Table or solver, as the user says."""
    if method not in ("table", "solve"):
        raise ArgumentError("method", method, "must be 'table' or 'solve'")
    return tabulated if method == "table" else Solver(tabulated.bodies)


def extent(law: Law) -> Settings:
    """Extent of a law's own table, which is known before the table is made."""
    return grid.on_demand(_law_with_table(law))


def _law_with_table(law: Law) -> Law:
    """Law whose table serves this law: Hertz's is the edge chi = 1 of the packaged table of MYC."""
    return law if law.yields or not law.is_hertz else laws.law("myc")


def table_for(law: Law, table: TableArgument) -> Table:
    """Table that serves a law: the user's, or the law's own."""
    served = _law_with_table(law)
    if table is None:
        table = file.packaged(served) or cache.cached(served)
    elif isinstance(table, Settings):
        table = cache.cached(served, table)
    elif isinstance(table, str | os.PathLike):
        table = file.read(table)
    elif not isinstance(table, Table):
        raise TypeError(f"table: expected a Table, Settings or the path of a file, got {table!r}")
    exceeded = table.exceeded()
    if exceeded.keys() - _NEXT_TO_YIELD:
        warnings.warn(
            f"the table is less accurate than contactlaw promises; its largest errors {exceeded} "
            f"are above {bounds(table.law)}: take finer Settings, as in table=Settings(rows=160, columns=256)",
            stacklevel=2,
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
