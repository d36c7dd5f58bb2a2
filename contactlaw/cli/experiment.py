"""Which drops tell something about a bead and a sheet.

``contactlaw experiment``: thicknesses, heights and numbers of drops that tell the model from one COR.
"""

import argparse
import dataclasses
import json
import math
import sys
import textwrap
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array, Integers
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


class Plan(NamedTuple):
    """Drops, in arrays of one length, and how many of each are needed; NaN: no number helps."""

    thickness: Array
    drop: Array
    speed: Array
    restitution: Array
    error: Array  # of the COR of one drop
    bounces: Array  # of one drop, whose COR the timing finds as well as the scatter allows
    sheet: Array  # least side [m]
    told: Array  # drops that tell the COR from the mean of all
    found: dict[str, Array]  # drops that find an unknown
    flags: Integers


def plan(model: ImpactModel, radius: float, thickness: Array, drop: Array, errors: dict[str, float]) -> Plan:
    """Count the drops that are needed, for every combination of thicknesses and heights.

    The COR of a drop is half of g times the time to the next bounce over the speed. The errors of
    single drops become smaller with their number; those of the law and of the other inputs do not.
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

    def drops(shift: Array, others: Array) -> Array:
        """Count the drops whose mean has, with the errors of `others`, an error as small as a shift."""
        with np.errstate(divide="ignore"):
            counts = np.ceil(error**2 / np.maximum(shift**2 - others, 0.0))
        return np.where(counts <= _MOST, np.maximum(counts, 1.0), math.nan)

    squares = {cause: np.asarray(size) ** 2 for cause, size in causes.items()}
    # Each bounce is slower by the COR, and its time shorter.
    bounces = 1.0 + np.log(np.minimum(by_time / scatter, 1.0)) / np.log(np.clip(cor, _STUCK, 1.0 - _STUCK))
    found = {
        cause: drops(np.asarray(size), np.sum([one for of, one in squares.items() if of != cause], axis=0))
        for cause, size in moved.items()
        if cause != "model"
    }
    distance = np.asarray(edge_distance(model.pair.plate, h, hit.contact_time))
    told = drops(np.abs(cor - cor.mean()) / _TOLD, squares["model"])
    sheet = np.where(np.isinf(distance), math.nan, 2.0 * distance)
    return Plan(h, fall, v, cor, error, np.minimum(bounces // 1.0, _BOUNCES), sheet, told, found, np.asarray(hit.flags))


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
    table, columns = _table(made, impacts.asked(model, radius=radius))
    if arguments.csv:
        impacts.write_csv(table, sys.stdout, columns)
    elif arguments.json:
        print(json.dumps(impacts.records(table), indent=2))
    else:
        print(*impacts.text(table, columns), "", sep="\n")
        for said in _said(made):
            print(*textwrap.wrap(said, _WIDTH), sep="\n")


def _table(made: Plan, asked: dict[str, Any]) -> tuple[ImpactTable, list[Column]]:
    """Table of the drops, as `contactlaw cor` has them."""
    shown = {
        Column("thickness", "m", "thickness", "mm", 1e3): made.thickness,
        Column("drop", "m", "drop", "cm", 1e2): made.drop,
        Column("speed", "m/s", "speed", "m/s"): made.speed,
        Column("restitution", "", "COR"): made.restitution,
        Column("error", "", "one drop", "+-"): made.error,
        Column("bounces", "", "bounces"): made.bounces,
        Column("sheet", "m", "sheet", "cm", 1e2): made.sheet,
        Column("told_by", "drops", "told by", "drops"): made.told,
    }
    for cause, counts in made.found.items():
        title = cause.replace("yield ", "").replace(" of the ", ", ")
        shown[Column(f"{cause.replace(' ', '_')}_by", "drops", title, "drops")] = counts
    return ImpactTable({one.name: values for one, values in shown.items()}, made.flags, asked), [*shown]


def _said(made: Plan) -> Iterator[str]:
    """Say what the columns mean, and which drops are the best."""
    mean, share = made.restitution.mean(), f"{100.0 * _PRECISION:g} %"
    yield (
        f"told by: drops whose mean is {_TOLD:g} standard errors from one COR for all of them, {mean:.3f}. The last "
        f"columns: drops that find a number with a standard error of {share}, if all others are known as stated. -: "
        f"more than {_MOST}, or the errors of law and materials hide it. bounces: those of one drop that are worth "
        f"timing, {_BOUNCES} at most. sheet: least side, if the bead hits its middle. An error that is not known "
        "counts as none, and that of a specified minimum as endless: give it with --sphere-error or --plate-error."
    )
    for cause, counts in made.found.items():
        n = np.lexsort((made.sheet, counts))[0]
        if np.isnan(counts[n]):
            yield f"{cause}: no drops of these find it to {share}."
            continue
        many, side = f"{counts[n]:.0f} drop{'s' * bool(counts[n] > 1)}", made.sheet[n]
        where = f"from {in_unit(made.drop[n], 'm')} onto {drawn(made.thickness[n])}"
        wide = "" if np.isnan(side) else f" (a sheet of {100.0 * side:.2g} cm)"
        yield f"{cause}: {many} {where}{wide} find it to {share}."
    if (tells := np.isfinite(made.found["thickness"])).any():
        yield f"The thickest sheet that tells its thickness: {in_unit(made.thickness[tells].max(), 'm')}."
