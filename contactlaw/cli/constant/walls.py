"""One COR for each wall of a machine, one per thickness, as a table."""

from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from contactlaw.answers.constant import Constant
from contactlaw.cli.constant.records import Impacts
from contactlaw.cli.parts import wording
from contactlaw.cli.parts.table import Column, Table
from contactlaw.model import ImpactModel

Walls = dict[float, Constant]  # one COR for all impacts on plates of each thickness [m]
_COLUMNS = (
    Column("thickness", "m", "thickness", "mm", 1e3, digits="g"),
    Column("impacts", title="impacts", digits=".0f"),
    Column("restitution", title="COR", digits=".4f"),
    Column("spread"),
    Column("energy_error", title="energy error", shown="%", scale=100.0, digits="z.2f"),
    Column("rebound_error", title="height error", shown="%", scale=100.0, digits=".3g"),
    Column("mean"),
    Column("mean_energy_error"),
)


def walls(model: ImpactModel, impacts: Impacts, plate: Callable[[float], Any]) -> Walls:
    """Find one COR for all impacts on plates of one thickness; walls are sorted by it."""
    found = {}
    for thickness in np.unique(impacts["thickness"]).tolist():
        on_it = {name: column[impacts["thickness"] == thickness] for name, column in impacts.items()}
        with wording.naming_impact(on_it["speed"], on_it["radius"], thickness):
            found[thickness] = model.constant(**on_it | {"thickness": plate(thickness)})
    return found


def table(found: Walls, asked: dict[str, Any]) -> Table:
    """Rows of the walls with their CORs and errors."""
    best = found.values()
    values = {column.name: [getattr(one, column.name) for one in best] for column in _COLUMNS[1:]}
    return Table(
        _COLUMNS,
        {"thickness": [*found]} | values,
        asked,
        np.array([sum(one.flags) for one in best]),
        sum((Counter(one.flags) for one in best), Counter()),
        sum(one.impacts for one in best),
    )


def explained(found: Walls) -> Iterator[str]:
    """Lines below the table: what its columns mean."""
    yield "COR: with it the wall takes the same energy as with the COR of each impact."
    yield "energy error: relative error of the energy that the wall takes in total."
    yield "height error: for 95 % of beads the rebound height is wrong by less than this."
    errors = sorted(one.mean_energy_error for one in found.values())
    ends = dict.fromkeys(f"{100.0 * error:z.2f}" for error in (errors[0], errors[-1]))
    yield f"With the plain mean of the CORs the energy error would be {' to '.join(ends)} %."
