"""One COR for each wall of a machine, one per thickness, as a table and as lines of engines."""

import math
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from contactlaw._errors import ArgumentError
from contactlaw._version import VERSION
from contactlaw.answers.constant import Constant, constant
from contactlaw.cli.constant.records import Impacts
from contactlaw.cli.parts import wording
from contactlaw.cli.parts.table import Column, Table, wrapped
from contactlaw.engines.lammps.beads import hertz_material
from contactlaw.model import ImpactModel
from contactlaw.physical.pair import Pair

Walls = dict[float, Constant]  # one COR for all impacts on plates of each thickness [m]
_MOST = 100  # walls of different thickness; in an engine, each takes a type of its own
WIDTH = 78  # of lines that may stand behind "# "
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

_REMARKS = {
    "lammps": "To include after `pair_style granular`, and after a line for each wall that says where it is, as "
    "`variable wall1 string 'zplane 0 NULL'`. No friction: put your own after `tangential`.",
    "liggghts": "Atom type 1 is beads, the walls follow; wall on wall never happens: 1. `model hertz` reproduces this "
    "COR; it needs its moduli as property/global, and above 1 GPa `hard_particles yes`.",
}


def walls(model: ImpactModel, impacts: Impacts, plate: Callable[[float], Any]) -> Walls:
    """Find one COR for all impacts on plates of one thickness; walls are sorted by it."""
    thicknesses = np.unique(impacts["thickness"]).tolist()
    if len(thicknesses) > _MOST:
        reason = f"{len(thicknesses)} different ones, {_MOST} is the most: round them to those of walls"
        raise ArgumentError("thickness", None, reason)
    found = {}
    for thickness in thicknesses:
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
        WIDTH,
    )


def explained(found: Walls) -> Iterator[str]:
    """Lines below the table: what its columns mean."""
    yield "COR: with it the wall takes the same energy as with the COR of each impact."
    yield "energy error: relative error of the energy that the wall takes in total."
    yield "height error: for 95 % of beads the rebound height is wrong by less than this."
    errors = sorted(one.mean_energy_error for one in found.values())
    ends = dict.fromkeys(f"{100.0 * error:z.2f}" for error in (errors[0], errors[-1]))
    yield f"With the plain mean of the CORs the energy error would be {' to '.join(ends)} %."


def lines(form: str, model: ImpactModel, impacts: Impacts, found: Walls, about: list[str]) -> list[str]:
    """Lines of an engine below comments, with a COR for bead on bead and one for each wall."""
    cors = [_bead_on_bead(model, impacts), *(one.restitution for one in found.values())]
    remark = (
        f"contactlaw {VERSION}, SI units. {_REMARKS[form]} Walls are in the order of the table. Bead on bead is by the "
        "same law at the same speeds."
    )
    comments = (f"# {one}".rstrip() for one in [*about, *wrapped(remark, "", WIDTH)])
    return [*comments, *(_lammps(model.pair, cors) if form == "lammps" else _liggghts(cors))]


def _lammps(pair: Pair, cors: list[float]) -> list[str]:
    """Write ``pair_coeff`` for bead on bead, and a ``fix wall/gran`` for each wall.

    LAMMPS takes E/(2 (1 - nu^2)) of a wall as the effective modulus, whatever the bead's material
    is. The line has the E for which this is the effective modulus of the pair.
    """
    nu = pair.sphere.poissons_ratio
    moduli = [pair.sphere.youngs_modulus, *[2.0 * (1.0 - nu**2) * pair.effective_modulus] * (len(cors) - 1)]
    bead, *others = (hertz_material(*of, nu, "linear_nohistory 0 0") for of in zip(moduli, cors, strict=True))
    of_walls = (f"fix wall{n} all wall/gran granular {one} ${{wall{n}}}" for n, one in enumerate(others, 1))
    return [f"pair_coeff * * {bead}", *of_walls]


def _liggghts(cors: list[float]) -> list[str]:
    """Write the matrix of the CORs by atom types, 1 for beads, one more for each wall."""
    matrix = np.ones((len(cors), len(cors)))
    matrix[0] = matrix[:, 0] = cors
    rows = ("    " + " ".join(f"{e:.6g}" for e in row) for row in matrix)
    head = f"fix cor all property/global coefficientRestitution peratomtypepair {len(cors)}"
    return [" &\n".join([head, *rows])]


def _bead_on_bead(model: ImpactModel, impacts: Impacts) -> float:
    """One COR for beads that hit beads of their own size at the speeds of the impacts on walls."""
    v, r = impacts["speed"], impacts["radius"]
    with wording.reading("bead on bead"), wording.naming_impact(v, r, math.inf):
        rebound = model.lookup_sphere_sphere(v, r, r)
    e, flags = np.asarray(rebound.restitution), np.asarray(rebound.flags)
    return constant(v, r, impacts.get("weights", np.ones(v.size)), e, flags, "energy").restitution
