"""Answers from the table: impacts are looked up, and `Border` handles those outside it."""

from __future__ import annotations

import functools
import inspect
import math
import os
import threading
import warnings
from collections.abc import Callable
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from contactlaw import laws
from contactlaw._jit import direct, enable_caching, switched_off
from contactlaw.answers.backend import OutsideTableError, refuse_to_yield, too_fast, too_thin
from contactlaw.answers.solver import RTOL, Solver, histories, slid, solved
from contactlaw.equation import outcome
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import History, Outcome
from contactlaw.laws import Law
from contactlaw.physical.arguments import check, scalars
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.history import ForceHistory, with_units
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.rebound import Rebound, rebound
from contactlaw.physical.scaling import log_overload, yield_share
from contactlaw.physical.validity import Validity
from contactlaw.table import cache, file, grid, lookup, shapes, slides
from contactlaw.table.certificate import bounds
from contactlaw.table.grid import Settings
from contactlaw.table.nodes import Table

Array = NDArray[np.float64]
Flags = NDArray[np.int64]
Outside = Literal["raise", "solve", "clamp"]
TableArgument = Table | Settings | str | os.PathLike[str] | None  # what users may give as a table

# These fields begin at zero at yield, where large relative errors do no harm.
_NEXT_TO_YIELD = {"residual_compression", "plastic_fraction"}


class Border:
    """What to do with impacts outside a table; counts those that got the value at its border."""

    def __init__(self, outside: Outside) -> None:
        if outside not in ("raise", "solve", "clamp"):
            raise ValueError(f"outside: must be 'raise', 'solve' or 'clamp', got {outside!r}")
        self.outside = outside
        self.clamped = 0
        self.lock = threading.Lock()

    def look_up(self, law: Law, table: Array, units: Numbers) -> tuple[Outcome, Flags]:
        """Look outcomes up, and flag with Validity.CLAMPED those that were taken at the border.

        Inelasticity and yield ratio of these are the border's.
        """
        out = outcome.at(units.inelasticity, units.yield_ratio)
        flags = np.zeros(out.inelasticity.size, dtype=np.int64)
        if lookup.fields(table, False, out):
            beyond = np.isnan(out.restitution)
            flags[beyond] = self.complete(law, table, out, beyond)
        return out, flags

    def complete(self, law: Law, table: Array, out: Outcome, beyond: NDArray[np.bool_]) -> int:
        """Fill in the outcomes that are beyond the table; return their flag."""
        if self.outside == "raise":
            n = int(np.argmax(beyond))
            lam, y = float(out.inelasticity[n]), float(out.yield_ratio[n])
            limit = lookup.lam_max(table)
            if lam > limit:
                raise OutsideTableError(n, too_thin(lam, limit))
            chi = math.exp(lookup.log_elastic_compression(table, lam)) / y
            raise OutsideTableError(n, too_fast(chi, lookup.chi_max(table)))
        found = outcome.part(out, beyond)
        if self.outside == "solve":
            places = np.flatnonzero(beyond)
            found = solved(law.data, found.inelasticity, found.yield_ratio, RTOL, places)
        else:
            lookup.fields(table, True, found)
        for values, completed in zip(out, found, strict=True):
            values[beyond] = completed
        if self.outside == "solve":
            return 0
        with self.lock:
            self.clamped += found.restitution.size
        return int(Validity.CLAMPED)


class Tabulated:
    """Looks impacts up; the table, the law's own if none is given, is made when first needed."""

    on_plate: ClassVar[Callable[..., float]] = staticmethod(lookup.restitution_on_plate)

    def __init__(self, bodies: SphereOnPlate, given: TableArgument, border: Border) -> None:
        self.bodies, self.given, self.border = bodies, given, border
        # the constants of the pair that kernels take
        known = bodies.constants
        self.c_lam = known.plate.inelasticity
        self.c_chi = log_overload(known, known.yield_compression)

    @functools.cached_property
    def table(self) -> Table:
        """The table that serves the law."""
        return table_for(self.bodies.law, self.given)

    @functools.cached_property
    def packed(self) -> Array:
        """The table as kernels read it, with the corrections of the pair's plates."""
        return lookup.with_plate(self.table.packed, self.bodies.constants.plate)

    @functools.cached_property
    def slides(self) -> Array:
        """The tangential rebounds of the pair, as kernels read them; once they take seconds."""
        return cache.cached_slides(self.table, self.bodies.pair.tangential_ratio)

    @functools.cached_property
    def restitution(self) -> Callable[[float, float, float], float]:
        """COR of one impact, whose arguments have to be floats; NaN outside the table."""
        return functools.partial(python_entries()[0], self.packed, self.c_lam, self.c_chi)

    @property
    def largest_inelasticity(self) -> float:
        """Largest lambda of the table; for the law's own, known before the table is made."""
        if self.given is None:
            return grid.largest_inelasticity(_law_with_table(self.bodies.law))
        return lookup.lam_max(self.table.packed)

    def table_of(self, law: Law) -> Table:
        """Find the table for another law, as for two spheres; this one if it fits that law."""
        own = self.given is not None and (law == self.bodies.law or self.table.law.follows(law))
        return self.table if own else table_for(law, None)

    def restitutions(self, speed: Array, radius: Array, thickness: Array) -> Array:
        """COR of impacts; they are checked only if the kernel has no answer for one of them."""
        out = np.empty(speed.size)
        if lookup.restitutions(self.packed, self.c_lam, self.c_chi, speed, radius, thickness, out):
            check(speed=speed, radius=radius, thickness=thickness)
            out = self._outcomes(Impacts(speed, radius, thickness, None))[0].restitution
        return out

    def rebounds(self, impacts: Impacts) -> Rebound:
        """Everything about impacts."""
        return self._rebounds(impacts)[0]

    def oblique(self, impacts: Impacts, psi: Array) -> tuple[Rebound, Array]:
        """Everything about the normal part, and the change of the sliding speed [mu V0]."""
        normal, found = self._rebounds(impacts)
        # without the compiler a table takes hours to make, and an integration a fifth of a second
        changes, inside = np.empty_like(psi), self._inside(found) & (not switched_off())
        if inside.all():
            slides.changes(self.slides, found, psi, changes)
            return normal, changes
        if inside.any():
            part = np.empty(np.count_nonzero(inside))
            slides.changes(self.slides, outcome.part(found, inside), psi[inside], part)
            changes[inside] = part
        changes[~inside] = slid(self.bodies, outcome.part(found, ~inside), psi[~inside])
        return normal, changes

    def _rebounds(self, impacts: Impacts) -> tuple[Rebound, Outcome]:
        found, flags, unclamped, time = self._outcomes(impacts)
        return rebound(self.bodies, impacts, time, unclamped, found, flags), found

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        normal, found = self._rebounds(impacts)
        units = self.bodies.numbers(self.bodies.impact(impacts))
        contacts = self._shapes(found, samples)
        return with_units(contacts, units, found.inelasticity, impacts.shape, normal.flags)

    def yield_speeds(self, impacts: Impacts) -> Array:
        """Speeds [m/s] from which sphere or plate yields; inf where neither does."""
        if impacts.mass is not None:
            return Solver(self.bodies, RTOL, extent(self.bodies.law)).yield_speeds(impacts)
        radius, thickness = impacts.radius, impacts.thickness
        out = np.full(radius.size, math.inf)
        share = yield_share(self.bodies.pair, self.bodies.law)
        if share < math.inf:
            c_chi = log_overload(self.bodies.constants, share)
            lookup.yield_speeds(self.packed, self.c_lam, c_chi, radius, radius / thickness, out)
            if np.isnan(out).any():
                refuse_to_yield(impacts, np.isnan(out), lookup.lam_max(self.packed))
        return out

    def curve(self, radius: Array, thickness: Array) -> Callable[[float], float]:
        """COR of one sphere on one plate, as a function of speed [m/s]."""
        at_one = Impacts(np.ones(1), radius, thickness, None)
        r = radius.item()
        constants = self.packed, self.c_lam, self.c_chi, r, r / thickness.item()
        look_up = functools.partial(self.border.look_up, self.bodies.law)
        return curve(constants, self.bodies, at_one, look_up)

    def _outcomes(self, impacts: Impacts) -> tuple[Outcome, Flags, tuple[Array, Array], Array]:
        """Outcomes, their flags, inelasticity and yield ratio before clamping, and T_H [s]."""
        v, r, h = impacts.speed, impacts.radius, impacts.thickness
        if impacts.mass is not None:
            units = self.bodies.numbers(self.bodies.impact(impacts))
            found, flags = self.border.look_up(self.bodies.law, self.packed, units)
            return found, flags, (units.inelasticity, units.yield_ratio), units.time
        found, root = outcome.empty(v.size), np.empty(v.size)
        flags = np.zeros(v.size, dtype=np.int64)
        beyond = lookup.outcomes(self.packed, self.c_lam, self.c_chi, v, r, h, found, root)
        unclamped = found.inelasticity, found.yield_ratio
        if beyond:
            outside = np.isnan(found.restitution)
            part = Impacts(v[outside], r[outside], h[outside], None)
            units = self.bodies.numbers(self.bodies.impact(part))
            found.inelasticity[outside] = units.inelasticity
            found.yield_ratio[outside] = units.yield_ratio
            unclamped = unclamped[0].copy(), unclamped[1].copy()
            law = self.bodies.law
            flags[outside] = self.border.complete(law, self.packed, found, outside)
        return found, flags, unclamped, self.bodies.constants.time * r / root

    def _inside(self, found: Outcome) -> NDArray[np.bool_]:
        """Which outcomes the table reaches, rather than those that were integrated."""
        lam, chi = found.inelasticity, found.elastic_compression / found.yield_ratio
        # a clamped impact lies on the border, give or take a rounding error
        within = (lam <= lookup.lam_max(self.packed) * (1 + 1e-9)) & (
            chi <= lookup.chi_max(self.packed) * (1 + 1e-9)
        )
        return np.asarray(within)

    def _shapes(self, found: Outcome, samples: int) -> History:
        """Contacts over time on Hertz's scale, integrated where they are outside the table."""
        inside = self._inside(found)
        law, packed = self.bodies.law, cache.cached_shapes(self.table).packed_shapes
        out = outcome.history(inside.size, samples)
        if inside.all():
            shapes.sample(law.data, packed, found, out)
            return out
        part = outcome.history(int(np.count_nonzero(inside)), samples)
        shapes.sample(law.data, packed, outcome.part(found, inside), part)
        beyond = histories(law.data, outcome.part(found, ~inside), samples)
        for values, ours, others in zip(out, part, beyond, strict=True):
            values[inside], values[~inside] = ours, others
        return out


@functools.cache
def python_entries() -> tuple[Callable[..., float], Callable[..., float]]:
    """Python's entries of `restitution_on_plate` and `restitution`; each argument a float."""
    return (
        direct(lookup.restitution_on_plate, "float64(float64[::1], f8, f8, f8, f8, f8)"),
        direct(lookup.restitution, "float64(float64[::1], f8, f8, f8, f8, f8)"),
    )


def curve(
    constants: tuple[Array, float, float, float, float],
    bodies: SphereOnPlate,
    impacts: Impacts,
    look_up: Callable[[Array, Numbers], tuple[Outcome, Flags]],
) -> Callable[[float], float]:
    """COR as a function of speed [m/s], from a packed table, constants of two bodies, R and R/H."""
    (table, c_lam, c_chi, radius, ratio), at = constants, python_entries()[1]

    def restitution(speed: float) -> float:
        if not isinstance(speed, float):  # the entry would take "5" and True for numbers
            speed = scalars(speed=speed)[0].item()
        value = at(table, c_lam, c_chi, speed, radius, ratio)
        if value != value:  # NaN; half the time of a call of isnan
            (v,) = scalars(speed=speed)
            units = bodies.numbers(bodies.impact(impacts)._replace(speed=v))
            return float(look_up(table, units)[0].restitution[0])
        return value

    return restitution


def extent(law: Law) -> Settings:
    """Extent of a law's own table, which is known before the table is made."""
    return grid.on_demand(_law_with_table(law))


@functools.cache
def _default(law: Law) -> Table:
    """Table that ships with the package, or that of the user's cache."""
    return file.packaged(law) or cache.cached(law)


def _law_with_table(law: Law) -> Law:
    """Law whose table serves this law: for Hertz's, the edge chi = 1 of the packaged one of MYC."""
    return law if law.yields or not law.is_hertz else laws.law("myc")


def table_for(law: Law, table: TableArgument) -> Table:
    """Table that serves a law: the user's, or the law's own."""
    enable_caching()
    served = _law_with_table(law)
    if table is None:
        table = _default(served)
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
        raise ValueError(
            f"table: it belongs to law {table.law.name!r}, the model needs one of {served.name!r}: "
            f"leave it out, or contactlaw table build --law {served.family}, with --sphere and "
            "--plate if the law takes numbers from them"
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
