"""From the dimensionless numbers of impacts to outcomes: by table or by integration."""

from __future__ import annotations

import functools
import inspect
import math
import os
import warnings
from typing import Literal, NoReturn

import numpy as np
from numpy.typing import NDArray

from contactlaw import laws
from contactlaw._jit import enable_caching
from contactlaw.equation import outcome, zener
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import History, Outcome
from contactlaw.laws import Law
from contactlaw.physical.scaling import Factors
from contactlaw.physical.validity import Validity
from contactlaw.table import cache, file, grid, lookup, shapes
from contactlaw.table.certificate import bounds
from contactlaw.table.grid import Settings
from contactlaw.table.nodes import Table

Array = NDArray[np.float64]
Flags = NDArray[np.int64]
Places = NDArray[np.intp]  # of impacts in the flat arrays that the user gave
Outside = Literal["raise", "solve", "clamp"]

# begin with nothing at yield, where an error relative to them matters least
_NEXT_TO_YIELD = {"residual_compression", "plastic_fraction"}
RTOL = 1e-10  # of an integration for which the user names no other


class OutsideTableError(ValueError):
    """An impact that the table does not reach.

    Attributes
    ----------
    impact : int
        Its number among those asked for.
    reason : str
        Which limit of the table it exceeds, and by how much.
    """

    def __init__(self, impact: int, reason: str) -> None:
        super().__init__(impact, reason)  # as given, or it could not be pickled
        self.impact, self.reason = impact, reason

    def __str__(self) -> str:
        return (
            f"speed, radius, thickness: impact {self.impact} is outside the table, {self.reason}. "
            'ImpactModel(..., outside="solve") integrates the equation there, "clamp" takes the '
            "value at the table's border."
        )


class UnsolvedError(RuntimeError):
    """An impact whose integration did not come to an end.

    Attributes
    ----------
    impact : int
        Its number among those asked for.
    where, reason : str
        Its dimensionless numbers, and what happened.
    """

    def __init__(self, impact: int, where: str, reason: str) -> None:
        super().__init__(impact, where, reason)
        self.impact, self.where, self.reason = impact, where, reason

    def __str__(self) -> str:
        return f"the equation did not solve at {self.where} (element {self.impact}): {self.reason}"


@functools.cache
def _default(law: Law) -> Table:
    """Table that ships with the package, or that of the user's cache."""
    return file.packaged(law) or cache.cached(law)


def _served(law: Law) -> Law:
    """Law whose table serves: Hertz's is the edge chi = 1 of any; myc's ships."""
    return law if law.yields or not law.is_hertz else laws.law("myc")


def largest_inelasticity(law: Law) -> float:
    """Largest lambda of the table that serves a law, which is known before that is built."""
    return grid.largest_inelasticity(_served(law))


def table_for(law: Law, table: Table | Settings | str | os.PathLike[str] | None) -> Table:
    """Table that serves a law: the user's, or the packaged one."""
    enable_caching()
    served = _served(law)
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
    """How far up the user's line is, whichever question has asked for the table."""
    level, frame = 0, inspect.currentframe()
    while frame:
        package = frame.f_globals.get("__name__", "").partition(".")[0]
        if package not in ("contactlaw", "functools"):
            break
        level, frame = level + 1, frame.f_back
    return level


def with_plates(table: Table, made: Factors) -> Array:
    """Put the plates of a pair into the array of a table that kernels look up in."""
    return lookup.with_plate(table.packed, made.plate)


def _coordinates(units: Numbers) -> Outcome:
    """Room for the outcomes of impacts, with their inelasticities and yield ratios."""
    return outcome.at(*np.broadcast_arrays(units.inelasticity, units.yield_ratio, units.time)[:2])


def solved(law: Law, units: Numbers, rtol: float, places: Places | None = None) -> Outcome:
    """Outcomes by integration.

    Errors name the impact by its number in the user's arrays where these are only some of those.
    """
    out = _coordinates(units)
    status, n = zener.solve_all(law.data, rtol, out)
    if status != zener.OK:
        where = f"lambda = {out.inelasticity[n]:.6g}, d_Y/(V0 T_H) = {out.yield_ratio[n]:.6g}"
        raise UnsolvedError(int(n if places is None else places[n]), where, zener.MESSAGES[status])
    return out


def tabulated(law: Law, table: Array, units: Numbers, outside: Outside) -> tuple[Outcome, Flags]:
    """Outcomes by table, and beside them Validity.CLAMPED where its border was taken.

    There, inelasticity and yield ratio are those of the border.
    """
    out = _coordinates(units)
    clamped = np.zeros(out.inelasticity.size, dtype=np.int64)
    if lookup.fields(table, False, out):
        beyond = np.isnan(out.restitution)
        clamped[beyond] = complete(law, table, units, outside, beyond, out)
    return out, clamped


def complete(
    law: Law,
    table: Array,
    units: Numbers,
    outside: Outside,
    beyond: NDArray[np.bool_],
    out: Outcome,
) -> int:
    """Fill in the outcomes that are beyond the table; return their flag."""
    if outside == "raise":
        n = int(np.argmax(beyond))
        _refuse(table, float(out.inelasticity[n]), float(out.yield_ratio[n]), n)
    if outside == "solve":
        shape = out.inelasticity.shape
        part = Numbers(*(np.broadcast_to(value, shape)[beyond] for value in units))
        found = solved(law, part, RTOL, np.flatnonzero(beyond))
    else:
        found = outcome.part(out, beyond)
        lookup.fields(table, True, found)
    for values, completed in zip(out, found, strict=True):
        values[beyond] = completed
    return int(Validity.CLAMPED) if outside == "clamp" else 0


def too_thin(lam: float, limit: float) -> str:
    """Say why an impact is outside a table whose largest lambda is exceeded."""
    return (
        f"its inelasticity lambda = {lam:.4g} is above {limit:.4g}: the plate is too thin for "
        "the bead"
    )


def _refuse(table: Array, lam: float, y: float, n: int) -> NoReturn:
    limit = lookup.lam_max(table)
    if lam > limit:
        what = too_thin(lam, limit)
    else:
        chi = math.exp(lookup.log_elastic_compression(table, lam)) / y
        limit = lookup.chi_max(table)
        what = f"its overload chi = {chi:.4g} is above {limit:.4g}: the impact is too fast"
    raise OutsideTableError(n, what)


def histories_by_table(law: Law, table: Table, found: Outcome, samples: int) -> History:
    """Contacts over time on Hertz's scale, integrated where they are off the table."""
    lam, chi = found.inelasticity, found.elastic_compression / found.yield_ratio
    # a clamped impact lies on the border, give or take a rounding error
    inside = (lam <= lookup.lam_max(table.packed) * (1 + 1e-9)) & (
        chi <= lookup.chi_max(table.packed) * (1 + 1e-9)
    )
    packed = cache.cached_shapes(table).packed_shapes
    out = outcome.history(lam.size, samples)
    if inside.all():
        shapes.sample(law.data, packed, found, out)
        return out
    part = outcome.history(int(np.count_nonzero(inside)), samples)
    shapes.sample(law.data, packed, outcome.part(found, inside), part)
    beyond = histories_by_solver(law, outcome.part(found, ~inside), samples)
    for values, ours, others in zip(out, part, beyond, strict=True):
        values[inside], values[~inside] = ours, others
    return out


def histories_by_solver(law: Law, found: Outcome, samples: int) -> History:
    """Contacts over time on Hertz's scale, by integration."""
    out = outcome.history(found.inelasticity.size, samples)
    zener.histories(law.data, found, RTOL, out)
    return out
