"""Which drops tell something about a bead and a sheet.

``contactlaw experiment``: thicknesses, heights and numbers of drops that tell the model from one COR.
"""

import argparse
import dataclasses
import json
import math
import sys
import textwrap
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array
from contactlaw._readable import drawn, in_unit
from contactlaw.cli.parts import chosen, impacts, options, wording
from contactlaw.cli.parts.impacts import Column, ImpactTable
from contactlaw.model import ImpactModel
from contactlaw.physical import flight
from contactlaw.physical.arguments import within
from contactlaw.physical.pair import Pair
from contactlaw.physical.validity import edge_distance
from contactlaw.quantities import LENGTH, SHARE, TIME

_RADIUS = 2e-3  # [m] of a bead, where none is given
_TOLD = 3.0  # standard errors by which a COR is told from another
_PRECISION = 0.05  # relative standard error to which an unknown is to be found
_ERRORS = {  # quantity, help, default, least and largest
    "timing_error": (TIME, "standard error of the time of a bounce [s] (default: 1 ms)", 1e-3, 1e-7, 0.1),
    "height_error": (LENGTH, "standard error of the height of a drop [m] (default: 2 mm)", 2e-3, 1e-6, 1.0),
    "scatter": (SHARE, "standard deviation of the COR from drop to drop (default: 0.02)", 0.02, 1e-4, 0.5),
}
_BOUNCES = 20  # of one drop, the most that a row of a table of measurements has
_STUCK = 1e-6  # least COR, and least loss, that count for the number of bounces
_MOST = 100  # drops of one kind; more are not worth while, and errors that drops share dominate
_WIDTH = 110  # of a line of text
_COLUMNS = (
    Column("thickness", "m", "thickness", "mm", 1e3),
    Column("drop", "m", "drop", "cm", 1e2),
    Column("speed", "m/s", "speed", "m/s"),
    Column("restitution", "", "COR"),
    Column("error", "", "one drop", "+-"),
    Column("bounces", "", "bounces"),
    Column("sheet", "m", "sheet", "cm", 1e2),
    Column("told_by", "drops", "told by", "drops"),
)


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "thicknesses, heights and numbers of drops that tell the model from one COR"
    command = options.command(commands, "experiment", about, _run)
    options.add_pair(command)
    options.add_radius(command, "the bead", quantities.value, known=" (default: 2 mm)")
    several: Any = {"read": quantities.values, "metavar": "H"}
    what = "thicknesses of sheets [m], or with a unit (default: 1 to 20 mm)"
    thicknesses = 1e-3, 2e-3, 3e-3, 5e-3, 1e-2, 2e-2
    options.add_quantity(command, "--thickness", LENGTH, what, default=thicknesses, **several)
    what = "heights of drops [m], or with a unit (default: 10 cm, 30 cm, 1 m)"
    options.add_quantity(command, "--drop", LENGTH, what, default=(0.1, 0.3, 1.0), **several)
    for name, (quantity, what, default, *_) in _ERRORS.items():
        options.add_quantity(command, f"--{name.replace('_', '-')}", quantity, what, default=default, metavar="E")
    options.add_errors(command, ())
    options.add_name_of_law(command)
    add = command.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print rows in SI units, every digit")
    add("--json", action="store_true", help="print rows in SI units; what no number of drops finds is null")
    command.set_defaults(outside="solve")
    command.epilog = f"{options.UNITS} Several are a list, 1mm,2mm, or a range start:stop:count."


def plan(model: ImpactModel, radius: float, thickness: Array, drop: Array, errors: dict[str, float]) -> ImpactTable:
    """Count the drops that are needed, for every combination of thicknesses and heights.

    The COR of a drop is half of g times the time to the next bounce over the speed. The errors of
    single drops become smaller with their number; those of the law and of the other inputs do not.
    Columns are the COR's `error` of one drop, `bounces` of one drop that the timing finds as well as
    the scatter allows, the least side of a `sheet`, drops that tell the COR from the mean of all,
    and behind these drops that find each unknown; NaN: no number helps.
    """
    timing_error, height_error, scatter = (errors[name] for name in _ERRORS)
    h, fall = (one.ravel() for one in np.meshgrid(thickness, drop, indexing="ij"))
    v = flight.of_height(fall, radius, model.pair.sphere.density).down
    with wording.naming_impact(v, radius, h):
        hit = model.solve(v, radius, h)
        causes = model.uncertainty(v, radius, h).restitution.causes
        moved = _moved(model).uncertainty(v, radius, h, thickness_error=_PRECISION).restitution.causes
    cor = np.asarray(hit.restitution)
    by_time, by_height = math.sqrt(2.0) * timing_error * flight.GRAVITY / (2.0 * v), 0.5 * cor * height_error / fall
    error = np.sqrt(scatter**2 + by_time**2 + by_height**2)

    def drops(shift: Array, others: Iterable[str]) -> Array:
        """Count the drops whose mean has, with the errors of other causes, an error as small as a shift."""
        left = shift**2 - sum(np.square(causes[other]) for other in others)
        with np.errstate(divide="ignore"):
            counts = np.ceil(error**2 / np.maximum(left, 0.0))
        return np.where(counts <= _MOST, np.maximum(counts, 1.0), math.nan)

    # Each bounce is slower by the COR, and its time shorter.
    bounces = 1.0 + np.log(np.minimum(by_time / scatter, 1.0)) / np.log(np.clip(cor, _STUCK, 1.0 - _STUCK))
    moved.pop("model")
    sizes = {cause: (np.asarray(size), causes.keys() - {cause}) for cause, size in moved.items()}
    found = {f"{cause.replace(' ', '_')}_by": drops(*size) for cause, size in sizes.items()}
    distance = np.asarray(edge_distance(model.pair.plate, h, hit.contact_time))
    told = drops(np.abs(cor - cor.mean()) / _TOLD, ["model"])
    sheet = np.where(np.isinf(distance), math.nan, 2.0 * distance)
    values = h, fall, v, cor, error, np.minimum(bounces // 1.0, _BOUNCES), sheet, told
    named = {column.name: one for column, one in zip(_COLUMNS, values, strict=True)}
    return ImpactTable(named | found, np.asarray(hit.flags), impacts.asked(model, radius=radius))


def _moved(model: ImpactModel) -> ImpactModel:
    """Model whose strengths and loss factors have the wanted error, and nothing else has one."""
    bodies = []
    for body in model.pair.given:
        strength = "yield_strength" if body.yield_strength is not None else "hardness"
        names = [strength] * (body.strength is not None) + ["loss_factor"] * (body.loss_factor is not None)
        bodies.append(dataclasses.replace(body, uncertainty=dict.fromkeys(names, _PRECISION)))
    return ImpactModel(Pair(*bodies), model.force_law)


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    radius = _RADIUS if arguments.radius is None else arguments.radius
    within("drop", np.array(arguments.drop), 1e-3, 100.0, "m")
    errors = {name: getattr(arguments, name) for name in _ERRORS}
    for name, size in errors.items():
        within(name, np.array([size]), *_ERRORS[name][3:], "")
    model = chosen.model(arguments)
    made = plan(model, radius, np.array(arguments.thickness), np.array(arguments.drop), errors)
    causes = {name: name.removesuffix("_by").replace("_", " ") for name in [*made.columns][len(_COLUMNS) :]}
    titles = (cause.replace("yield ", "").replace(" of the ", ", ") for cause in causes.values())
    columns = *_COLUMNS, *(Column(name, "drops", title, "drops") for name, title in zip(causes, titles, strict=True))
    if arguments.csv:
        impacts.write_csv(made, sys.stdout, columns)
    elif arguments.json:
        print(json.dumps(impacts.records(made), indent=2))
    else:
        print(*impacts.text(made, columns), "", sep="\n")
        for said in _said(made.columns, causes):
            print(*textwrap.wrap(said, _WIDTH), sep="\n")


def _said(made: dict[str, Array], causes: dict[str, str]) -> Iterator[str]:
    """Say what the columns mean, and which drops are the best."""
    mean, share = made["restitution"].mean(), f"{100.0 * _PRECISION:g} %"
    yield (
        f"told by: drops whose mean is {_TOLD:g} standard errors from one COR for all of them, {mean:.3f}. The last "
        f"columns: drops that find a number with a standard error of {share}, if all others are known as stated. -: "
        f"more than {_MOST}, or the errors of law and materials hide it. bounces: those of one drop that are worth "
        f"timing, {_BOUNCES} at most. sheet: least side, if the bead hits its middle. An error that is not known "
        "counts as none, and an unknown excess over a specified minimum as endless: give --sphere-error, --plate-error."
    )
    for name, cause in causes.items():
        counts = made[name]
        n = np.lexsort((made["sheet"], counts))[0]
        if np.isnan(counts[n]):
            yield f"{cause}: no drops of these find it to {share}."
            continue
        many, side = f"{counts[n]:.0f} drop{'s' * bool(counts[n] > 1)}", made["sheet"][n]
        where = f"from {in_unit(made['drop'][n], 'm')} onto {drawn(made['thickness'][n])}"
        wide = "" if np.isnan(side) else f" (a sheet of {100.0 * side:.2g} cm)"
        yield f"{cause}: {many} {where}{wide} find it to {share}."
    if (tells := np.isfinite(made["thickness_by"])).any():
        yield f"The thickest sheet that tells its thickness: {in_unit(made['thickness'][tells].max(), 'm')}."
