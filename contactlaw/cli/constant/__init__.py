"""``contactlaw constant`` (engines): one COR for each wall and its errors, or a table of COR over speed."""

import functools
import sys
from argparse import Namespace
from typing import Any

import numpy as np

from contactlaw import laws, quantities
from contactlaw._errors import ArgumentError
from contactlaw.cli.constant import records, walls
from contactlaw.cli.parts import chosen, options, wording
from contactlaw.cli.parts.table import Column, Table, in_words
from contactlaw.model import ImpactModel
from contactlaw.physical.validity import explain
from contactlaw.quantities import SPEED

_ERROR = 1e-3
_FORMS = {
    "csv": "print a row for each wall in SI units, with every digit",
    "table": "print COR over speed as CSV, between the least and the largest --speed, for linear interpolation",
}


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "one COR for each wall and its errors, or a table of COR over speed"
    command = options.command(commands, "constant", about, _run)
    impacts = command.add_mutually_exclusive_group(required=True)
    impacts.add_argument(
        "files",
        nargs="*",
        default=[],
        metavar="FILE",
        help="recorded impacts of one run: files .h5, or .npy with an engine's rows, or one text table with a column "
        "speed_m/s and, optionally, radius_m, thickness_m and weight (default: impacts at --speed)",
    )
    what = "normal approach speeds [m/s], each of which is equally frequent"
    options.add_quantity(impacts, "--speed", SPEED, what, quantities.values, metavar="V")
    options.add_drop(impacts, quantities.values)
    options.add_pair(command, options.OF_RECORD)
    options.add_sizes(command, quantities.values, required=False)
    options.add_wall(command)
    options.add_law(command, default=None)
    options.add_forms(command, _FORMS)
    what = "bound the error of the COR between the rows of --table (default: %(default)g)"
    command.add_argument("--error", metavar="E", type=float, default=_ERROR, help=what)
    command.epilog = f"{options.UNITS} {options.LISTS}"


def _run(arguments: Namespace) -> None:
    chosen.take_drops(arguments)
    if arguments.error != _ERROR and arguments.form != "table":
        raise ArgumentError("error", arguments.error, "only --table takes it")
    if arguments.form == "table" and (arguments.files or len({*arguments.speed}) < 2):
        raise ValueError("--table: give the least and the largest speed, as in --speed 0.1,10, and no FILE")
    for n, recorded in enumerate(_recorded(arguments)):
        law = arguments.law or recorded.law or laws.DEFAULT
        model = ImpactModel(chosen.pair(arguments, recorded.pair), law=law, outside=arguments.outside)
        impacts = records.completed(recorded.impacts, radius=arguments.radius, thickness=arguments.thickness)
        if arguments.form == "table":
            _print_speed_table(arguments, model, impacts)
            continue
        found = walls.walls(model, impacts, functools.partial(chosen.wall, arguments, model.pair.given[1]))
        table = walls.table(found, chosen.asked(arguments, model))
        if arguments.form == "csv":
            table.write_csv(sys.stdout, head=n == 0)
            continue
        print(*[""] * (n > 0), *table.text(), "", *walls.explained(found), sep="\n")


def _print_speed_table(arguments: Namespace, model: ImpactModel, impacts: records.Impacts) -> None:
    sizes = {name: np.unique(impacts[name]).tolist() for name in ("radius", "thickness")}
    for name, values in sizes.items():
        if len(values) > 1:
            raise ArgumentError(name, None, "--table takes one value")
    (radius,), (thickness,), speed = *sizes.values(), impacts["speed"]
    ends = float(speed.min()), float(speed.max())
    with wording.naming_impact(ends, radius, thickness):
        plate = chosen.wall(arguments, model.pair.given[1], thickness)
        rows = model.speed_table(radius, plate, arguments.error, *ends)
    for flag, count in rows.flags.items():
        wording.print_warning(f"{flag.name}, {count} of {len(rows.speed)} rows: {explain(flag)[0]}")
    print(f"# {in_words(chosen.asked(arguments, model, radius=radius, thickness=thickness))}, error {rows.error:.2g}")
    Table((Column("speed", "m/s"), Column("restitution")), rows._asdict()).write_csv(sys.stdout)


def _recorded(arguments: Namespace) -> list[records.Recorded]:
    """Impacts on plates of each pair of the record that the options choose, or at the stated speeds."""
    if not arguments.files:
        return [records.Recorded({"speed": np.array(arguments.speed)})]
    found = records.read(*arguments.files)
    some, _ = chosen.of_record(arguments, dict(enumerate(one.pair for one in found)))
    return [found[n] for n in some]
