"""What table and solver have in common: their methods and their errors.

`contactlaw.answers.tabulated.TableLookup` looks impacts up, `contactlaw.answers.solver.Solver`
integrates them; either can replace the other. Both are made from a `SphereOnPlate`.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array, Integers, Mask, Places
from contactlaw._errors import ArgumentError
from contactlaw.equation import zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.outcome import History, Outcome, history
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.history import ForceHistory, with_units
from contactlaw.physical.impacts import Impacts, check_finite
from contactlaw.physical.rebound import Rebound, rebound
from contactlaw.table import slides

_CLOSE = 512  # samples between which the path of a sphere is a cubic
_RTOL = 1e-10  # error allowed per step of histories


class Part(NamedTuple):
    """Impacts whose outcomes were found in one way, and these outcomes on Hertz's scale."""

    places: Any  # of these among all impacts of the question
    impacts: Impacts
    time: Array  # T_H [s]
    numbers: tuple[Array, Array]  # inelasticity and yield ratio; the outcome's are a border's where it is clamped
    outcome: Outcome
    flags: Integers
    edges: Edges | None
    interpolated: bool


Ask = Callable[[Impacts], list[Part]]


class Backend:
    """Outcomes of impacts of a sphere on plates, and what follows from them."""

    bodies: SphereOnPlate

    def far(self, impacts: Impacts) -> list[Part]:
        """Outcomes on plates from which nothing comes back."""
        raise NotImplementedError

    def near(self, impacts: Impacts) -> list[Part]:
        """Outcomes near edges, on curved walls and on foundations, from which something comes back."""
        raise NotImplementedError

    def parts(self, impacts: Impacts) -> list[Part]:
        """Outcomes of all impacts, in one part or several."""
        near = impacts.remember
        if near is None:
            return self.far(impacts)
        return split(impacts, near, self.near, lambda some: self.far(some.forgetting))

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
        whole = _joined(columns, impacts)
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
        out = history(part.impacts.speed.size, every * (samples - 1) + 1)
        zener.histories(self.bodies.data, part.outcome, _RTOL, out, part.edges)
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
        return Rebound(**_joined([(one.places, vars(self._rebound(one))) for one in parts], impacts))


def split(impacts: Impacts, which: Mask, ask: Ask, ask_others: Ask) -> list[Part]:
    """Outcomes of impacts of two kinds."""
    if which.all() or not which.any():
        return (ask if which.any() else ask_others)(impacts)
    parts = []
    for places, some in ((np.flatnonzero(which), ask), (np.flatnonzero(~which), ask_others)):
        with renumbered(places):
            parts += [one._replace(places=places[one.places]) for one in some(impacts.part(places))]
    return parts


def _joined(columns: list[tuple[Any, dict[str, Any]]], impacts: Impacts) -> dict[str, Any]:
    """Put answers of parts of the impacts together; each has its places and its columns."""
    if len(columns) == 1:
        return columns[0][1]
    whole: dict[str, Any] = {}
    for places, named in columns:
        for name, values in named.items():
            all_of_it = whole.setdefault(name, np.empty((impacts.speed.size, *values.shape[1:]), values.dtype))
            all_of_it[places] = values
    shape = impacts.shape or ()
    return {name: values.reshape(*shape, *values.shape[1:]) for name, values in whole.items()}


class OutsideTableError(ValueError):
    """An impact that the table does not reach.

    Attributes
    ----------
    impact : int
        Index of the impact in the arguments.
    reason : str
        Which limit of the table it exceeds, and by how much.
    mass : float or None
        Mass that answers at the contact [kg], if it was given.
    """

    def __init__(self, impact: int, reason: str, mass: float | None = None) -> None:
        super().__init__(impact, reason, mass)  # the arguments as given: pickle needs them
        self.impact, self.reason, self.mass = impact, reason, mass

    def __str__(self) -> str:
        heavy = "" if self.mass is None else f", mass={self.mass:g}"
        return (
            f"speed, radius, thickness{heavy}: impact {self.impact} is outside the table, "
            f'{self.reason}. ImpactModel(..., outside="solve") integrates the equation there, '
            '"clamp" takes the value at the table\'s border.'
        )


class UnsolvedError(RuntimeError):
    """An impact whose integration did not come to an end.

    Attributes
    ----------
    impact : int
        Index of the impact in the arguments.
    where, reason : str
        Its dimensionless numbers, and what happened.
    """

    def __init__(self, impact: int, where: str, reason: str) -> None:
        super().__init__(impact, where, reason)
        self.impact, self.where, self.reason = impact, where, reason

    def __str__(self) -> str:
        return f"the equation did not solve at {self.where} (element {self.impact}): {self.reason}"


def too_thin(lam: float, limit: float) -> str:
    """Say why an impact is outside a table whose largest lambda is exceeded."""
    return f"its inelasticity lambda = {_above(lam, limit)}: the plate is too thin for the bead"


def too_fast(chi: float, limit: float) -> str:
    """Say why an impact is outside a table whose largest overload is exceeded."""
    return f"its overload chi = {_above(chi, limit)}: the impact is too fast"


def _above(value: float, limit: float) -> str:
    """Write a value and its limit with four digits, or as many as tell them apart.

    Examples
    --------
    >>> _above(7.0, 6.0), _above(0.3300004, 0.33)
    ('7 is above 6', '0.3300004 is above 0.33')
    """
    pairs = ((f"{value:.{digits}g}", f"{limit:.{digits}g}") for digits in range(4, 18))
    return " is above ".join(next(pair for pair in pairs if pair[0] != pair[1]))


@contextmanager
def renumbered(some: Places) -> Iterator[None]:
    """Make errors about one of some impacts name it by its number among all."""
    try:
        yield
    except (OutsideTableError, UnsolvedError) as error:
        impact, *rest = error.args
        raise type(error)(int(some[impact]), *rest) from None
