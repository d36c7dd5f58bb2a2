"""Outcomes in parts, each found in one way, and the errors of impacts that have none."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array, Integers, Mask, Places
from contactlaw.equation.edge import Edges
from contactlaw.equation.outcome import Outcome
from contactlaw.physical.impacts import Impacts


class Part(NamedTuple):
    """Impacts whose outcomes were found in one way, and these outcomes on Hertz's scale."""

    impacts: Impacts
    time: Array  # T_H [s]
    numbers: tuple[Array, Array]  # inelasticity and yield ratio; the outcome's are a border's where it is clamped
    outcome: Outcome
    flags: Integers
    edges: Edges | None = None
    interpolated: bool = False
    places: Any = slice(None)  # of these among all impacts of the question


Ask = Callable[[Impacts], list[Part]]


def split(impacts: Impacts, which: Mask, ask: Ask, ask_others: Ask) -> list[Part]:
    """Outcomes of impacts of two kinds."""
    if which.all() or not which.any():
        return (ask if which.any() else ask_others)(impacts)
    parts = []
    for places, some in ((np.flatnonzero(which), ask), (np.flatnonzero(~which), ask_others)):
        with renumbered(places):
            parts += [one._replace(places=places[one.places]) for one in some(impacts.part(places))]
    return parts


def joined(columns: list[tuple[Any, dict[str, Any]]], impacts: Impacts) -> dict[str, Any]:
    """Put answers of parts of the impacts together; each has its places and its columns."""
    if len(columns) == 1:
        return columns[0][1]
    whole: dict[str, Any] = {}
    for places, named in columns:
        for name, values in named.items():
            shape = impacts.speed.size, *values.shape[1:]
            whole.setdefault(name, np.empty(shape, values.dtype))[places] = values
    return {name: values.reshape(*(impacts.shape or ()), *values.shape[1:]) for name, values in whole.items()}


class OutsideTableError(ValueError):
    """An impact that the table does not reach.

    Attributes
    ----------
    impact : int
        Index of the impact in the arguments.
    reason : str
        Which limit of the table it exceeds, and by how much.
    """

    def __init__(self, impact: int, reason: str) -> None:
        super().__init__(impact, reason)  # the arguments as given: pickle needs them
        self.impact, self.reason = impact, reason

    def __str__(self) -> str:
        return (
            f"speed, radius, thickness: impact {self.impact} is outside the table, "
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


@contextmanager
def renumbered(some: Places) -> Iterator[None]:
    """Make errors about one of some impacts name it by its number among all."""
    try:
        yield
    except (OutsideTableError, UnsolvedError) as error:
        impact, *rest = error.args
        raise type(error)(int(some[impact]), *rest) from None
