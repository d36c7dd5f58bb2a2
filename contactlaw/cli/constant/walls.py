"""One COR for each wall of a machine, one per thickness, as text or CSV."""

import math
import textwrap
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from contactlaw._errors import ArgumentError
from contactlaw._readable import in_unit
from contactlaw.answers.constant import Constant, Keep
from contactlaw.cli.constant.records import Recorded
from contactlaw.cli.parts import wording
from contactlaw.cli.parts.table import Column, Table, wrapped
from contactlaw.model import ImpactModel

_MOST = 100  # walls of different thickness; in an engine, each takes a type of its own
_COLUMNS = (
    Column("plates", title="plates", shown=""),
    Column("thickness", "m", "thickness", "mm", 1e3, digits="g"),
    Column("impacts", title="impacts", digits=".0f"),
    Column("keep"),
    Column("restitution", title="COR", digits=".4f"),
    Column("spread"),
    Column("energy_error", title="energy error", shown="%", scale=100.0, digits="z.2f"),
    Column("rebound_error", title="height error", shown="%", scale=100.0, digits=".3g"),
    Column("mean"),
    Column("mean_energy_error"),
)


class Wall(NamedTuple):
    """A wall, and one COR for all impacts on it."""

    plates: str  # numbers of its plates in the record, "" if it has none
    thickness: float
    best: Constant

    @property
    def name(self) -> str:
        """Name of the wall in the comments of an engine's lines."""
        name = "half-space" if math.isinf(self.thickness) else f"plate of {in_unit(self.thickness, 'm')}"
        return f"{name}, in the record {self.plates}" if self.plates else name


def walls(model: ImpactModel, recorded: Recorded, keep: Keep, plate: Callable[[float], Any]) -> list[Wall]:
    """Find one COR for all impacts on plates of one thickness; walls are sorted by it."""
    thicknesses = np.unique(recorded.thickness)
    if thicknesses.size > _MOST:
        reason = f"{thicknesses.size} different ones, {_MOST} is the most: round them to those of walls"
        raise ArgumentError("thickness", None, reason)
    found = []
    for thickness in thicknesses.tolist():
        on_it = recorded.thickness == thickness
        v, r, w = (column[on_it] for column in (recorded.speed, recorded.radius, recorded.weights))
        mass, plates = (None if column is None else column[on_it] for column in (recorded.mass, recorded.plate))
        numbers = "" if plates is None else ", ".join(map(str, np.unique(plates).tolist()))
        with wording.naming_impact(v, r, thickness):
            best = model.constant(v, r, plate(thickness), keep, w, mass)
        found.append(Wall(textwrap.shorten(numbers, 12, placeholder=" ..."), thickness, best))
    return found


def table(found: list[Wall], keep: Keep, asked: dict[str, Any]) -> Table:
    """Rows of the walls with their CORs and errors."""
    best = [wall.best for wall in found]
    values: dict[str, Any] = {column.name: [getattr(one, column.name, keep) for one in best] for column in _COLUMNS}
    values["plates"], values["thickness"], _ = zip(*found, strict=True)
    return Table(
        [column for column in _COLUMNS if column.name != "plates" or any(values["plates"])],
        values,
        asked,
        np.array([sum(one.flags) for one in best]),
        sum((Counter(one.flags) for one in best), Counter()),
        sum(one.impacts for one in best),
    )


def meaning(keep: Keep) -> str:
    """Say what a constant keeps."""
    keeps = {"energy": "takes the same energy", "momentum": "gets the same momentum"}[keep]
    return f"COR: with it the wall {keeps} in total as with the COR of each impact."


def explained(found: list[Wall], keep: Keep) -> Iterator[str]:
    """Lines for a terminal below the table: what its columns mean."""
    yield from wrapped(meaning(keep))
    yield "energy error: relative error of the energy that the wall takes in total."
    yield "height error: for 95 % of beads the rebound height is wrong by less than this."
    errors = sorted(wall.best.mean_energy_error for wall in found)
    ends = dict.fromkeys(f"{100.0 * error:z.2f}" for error in (errors[0], errors[-1]))
    yield from wrapped(f"With the plain mean of the CORs the energy error would be {' to '.join(ends)} %.")
