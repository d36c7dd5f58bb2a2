"""The impact record of all engines: its columns, their units, and how a model fills them."""

from __future__ import annotations

import enum
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._arrays import Array, Rows
from contactlaw.equation.losses import DESCRIPTIONS
from contactlaw.equation.outcome import FIELDS
from contactlaw.physical.kind import Kind as Kind  # for readers of a record
from contactlaw.physical.kind import only_impacts as only_impacts
from contactlaw.physical.validity import Validity

if TYPE_CHECKING:
    from contactlaw import Rebound


class Column(NamedTuple):
    """One column of the record.

    Attributes
    ----------
    name : str
        Name of the column, in arrays and in files.
    kind : str
        Type of the numbers, as numpy abbreviates it.
    unit : str
        SI unit, ``"1"`` for a number without one.
    description : str
        Meaning of the number.
    """

    name: str
    kind: str
    unit: str
    description: str


def _named(values: type[enum.IntEnum] | type[enum.IntFlag]) -> str:
    return ", ".join(f"{one.value} {one.name}".lower().replace("_", " ") for one in values)


COLUMNS = (
    Column("time", "f8", "s", "first touch; of an impact within one step, the end of that step"),
    Column("bead", "i8", "1", "number of the bead"),
    Column("plate", "i8", "1", "number of the plate, -1: bead on bead"),
    Column("other", "i8", "1", "number of the other bead, -1: bead on plate"),
    Column("x", "f8", "m", "contact point"),
    Column("y", "f8", "m", "contact point"),
    Column("z", "f8", "m", "contact point, 0 in two dimensions"),
    Column("approach_speed", "f8", "m/s", "normal speed of approach"),
    Column("restitution", "f8", "1", "coefficient of restitution"),
    Column("sliding_speed", "f8", "m/s", "speed of the contact point along the wall before"),
    Column("kind", "i8", "1", f"what happened: {_named(Kind)}"),
    Column("sliding_speed_after", "f8", "m/s", "the same afterwards; below 0 if it has turned round"),
    *(Column(f"spin_{axis}", "f8", "rad/s", "spin of the bead afterwards") for axis in "xyz"),
    *(Column(name, "f8", FIELDS[name].unit, FIELDS[name].words) for name in ("contact_time", "peak_force")),
    *(Column(f"{channel}_energy", "f8", "J", f"energy {what}") for channel, what in DESCRIPTIONS._asdict().items()),
    Column("scheme_energy", "f8", "J", "energy lost to the engine's time steps, or gained from them"),
    Column("friction_energy", "f8", "J", "energy taken by friction, of translation and spin"),
    Column("wall_work", "f8", "J", "work of a moving wall on the bead during the contact"),
    Column("radius", "f8", "m", "radius of the bead"),
    Column("mass", "f8", "kg", "mass of the bead, or of all true beads of a parcel"),
    Column("parcel", "f8", "1", "radius of the simulated bead over that of the true ones, 1: true bead"),
    Column("material", "i8", "1", "number of the bead's material, from 0: atom type less 1"),
    Column("thickness", "f8", "m", "thickness of the plate, inf: half-space, 0: bead on bead"),
    Column("triangle", "i8", "1", "number of the mesh's triangle, -1: the plate is no mesh"),
    Column("wall_start", "f8", "s", "time at which walls that move were where they were given"),
    Column("run", "i8", "1", "number of the run: microseconds from 1970 to its start, 0: not known"),
    Column("run_start", "f8", "s", "time from which on the run has rows; that of the restart from which it goes on"),
    Column("flags", "i8", "1", f"limits that the impact exceeds, 0 or a sum of: {_named(Validity)}"),
)
IMPACT = np.dtype([(column.name, column.kind) for column in COLUMNS])
_NAMES = tuple(column.name for column in COLUMNS)
_LATER = "wall_start", "run", "run_start"  # which files of older versions lack
# The columns of a record whose model gives a COR and nothing else.
OBSERVED = _NAMES[: _NAMES.index("sliding_speed_after")]


def typed(columns: Mapping[str, NDArray[Any]]) -> Rows:
    """Give the columns of a record from a file the types of `IMPACT`; refuse what has no such.

    Files of older versions get the run 0, which is not known; their walls began to move at time 0.
    """
    names = [name for name in _NAMES if name in (*columns, *_LATER)]
    rows = np.zeros(columns["time"].size, [(name, IMPACT[name]) for name in names])
    for name in names:
        values = columns.get(name, rows[name])
        if values.dtype.kind not in "iuf":
            raise ValueError(f"column {name} holds values of type {values.dtype}, expected numbers")
        with np.errstate(invalid="ignore", over="ignore"):  # what is lost by it is refused
            rows[name] = values
        wrong = (rows[name] != values) & (IMPACT[name].kind == "i")
        if wrong.any():
            row = int(np.argmax(wrong))
            raise ValueError(f"{name} of row {row} is {values[row]}, expected a whole number")
    return rows


def fill(rows: Rows, rebound: Rebound, energy: Array) -> None:
    """Complete impacts whose observed columns are known.

    Parameters
    ----------
    rows : structured array (n,)
        Impacts, with the columns of `IMPACT`; changed in place.
    rebound : Rebound
        A model's results for these impacts.
    energy : array (n,)
        Kinetic energy of the normal motion before each impact [J].

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> rows = np.zeros(1, IMPACT)
    >>> fill(rows, model.lookup([5.0], radius=0.9e-3, thickness=1e-3), np.array([3.4e-5]))
    >>> f"{rows['peak_force'][0]:.1f} N, {rows['wave_energy'][0] * 1e6:.1f} uJ to the plate"
    '10.0 N, 6.5 uJ to the plate'
    """
    rows["contact_time"] = rebound.contact_time
    rows["peak_force"] = rebound.peak_force
    for channel in DESCRIPTIONS._fields:
        rows[f"{channel}_energy"] = getattr(rebound, f"{channel}_fraction") * energy
    rows["scheme_energy"] = rows["wall_work"] = 0.0
    rows["parcel"], rows["triangle"] = 1.0, -1
    rows["flags"] = rebound.flags
