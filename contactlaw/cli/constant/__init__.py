"""``contactlaw constant`` (engines): one COR for each wall and its errors, or a table of COR over speed."""

import argparse
import functools
import sys
from typing import Any

from contactlaw import laws, quantities
from contactlaw._errors import ArgumentError
from contactlaw.cli.constant import records, walls
from contactlaw.cli.constant.lines import lines
from contactlaw.cli.parts import chosen, options, wording
from contactlaw.cli.parts.table import Column, Table, in_words
from contactlaw.model import ImpactModel
from contactlaw.physical.validity import explain
from contactlaw.quantities import SPEED

_ERROR = 1e-3
_FORMS = {
    "csv": "print a row for each wall in SI units, with every digit",
    "lammps": "print pair_coeff and fix wall/gran of LAMMPS",
    "liggghts": "print fix property/global of LIGGGHTS",
    "yade": "print betan of YADE",
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
        "speed_m/s and, optionally, radius_m, thickness_m, weight and plate (default: impacts at --speed)",
    )
    what = "normal approach speeds [m/s], each of which is equally frequent"
    options.add_quantity(impacts, "--speed", SPEED, what, quantities.values, metavar="V")
    options.add_drop(impacts, quantities.values)
    options.add_pair(command, options.OF_RECORD)
    options.add_sizes(command, quantities.values, required=False)
    options.add_wall(command)
    options.add_law(command, default=None)
    command.add_argument(
        "--keep",
        default="energy",
        choices=["energy", "momentum"],
        help="keep the energy that the wall takes in total, or the momentum that it gets (default: %(default)s)",
    )
    output = command.add_mutually_exclusive_group()
    for form, what in _FORMS.items():
        output.add_argument(f"--{form}", action="store_const", const=form, dest="form", default="text", help=what)
    what = f"bound the error of the COR between the rows of --table (default: {_ERROR:g})"
    command.add_argument("--error", metavar="E", type=float, help=what)
    command.epilog = (
        f"{options.UNITS} {options.LISTS} If the record has a column plate, --thickness may have a value "
        "for each plate, in the order of their numbers."
    )


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    if arguments.form == "table":
        _print_speed_table(arguments)
        return
    if arguments.error is not None:
        raise ArgumentError("error", arguments.error, "only --table takes it")
    for_engine = arguments.form in ("lammps", "liggghts", "yade")
    for n, recorded in enumerate(_recorded(arguments, single=for_engine)):
        law = arguments.law or recorded.law or laws.DEFAULT
        model = ImpactModel(chosen.pair(arguments, recorded.pair), law=law, outside=arguments.outside)
        plate = functools.partial(chosen.wall, arguments, model.pair.given[1])
        found = walls.walls(model, recorded, arguments.keep, plate)
        table = walls.table(found, arguments.keep, chosen.asked(arguments, model))
        if for_engine:
            print(*lines(arguments.form, model, recorded, found, arguments.keep), sep="\n")
        elif arguments.form == "csv":
            table.write_csv(sys.stdout, head=n == 0)
        else:
            print(*[""] * (n > 0), *table.text(), "", *walls.explained(found, arguments.keep), sep="\n")


def _print_speed_table(arguments: argparse.Namespace) -> None:
    if arguments.files or len({*arguments.speed}) < 2:
        raise ValueError("--table: give the least and the largest speed, as in --speed 0.1,10, and no FILE")
    for name in ("radius", "thickness"):
        if len(getattr(arguments, name) or ()) != 1:
            raise ArgumentError(name, None, "--table takes one value")
    (radius,), (thickness,) = arguments.radius, arguments.thickness
    ends, error = (min(arguments.speed), max(arguments.speed)), _ERROR if arguments.error is None else arguments.error
    arguments.law = arguments.law or laws.DEFAULT
    model = chosen.model(arguments)
    with wording.naming_impact(ends, radius, thickness):
        plate = chosen.wall(arguments, model.pair.given[1], thickness)
        rows = model.speed_table(radius, plate, error, *ends)
    for flag, count in rows.flags.items():
        wording.print_warning(f"{flag.name}, {count} of {len(rows.speed)} rows: {explain(flag)[0]}")
    print(f"# {in_words(chosen.asked(arguments, model, radius=radius, thickness=thickness))}, error {rows.error:.2g}")
    columns = Column("speed", "m/s"), Column("restitution")
    Table(columns, {"speed": rows.speed, "restitution": rows.restitution}).write_csv(sys.stdout)


def _recorded(arguments: argparse.Namespace, single: bool) -> list[records.Recorded]:
    """Impacts of each pair, or every combination of the given speeds, radii and thicknesses."""
    sizes = (arguments.radius, arguments.thickness)
    if not arguments.files:
        return [records.combined(arguments.speed, *sizes)]
    first, found = arguments.files[0], records.read(*arguments.files)
    for left_out in dict.fromkeys(one.left_out for one in found if one.left_out):
        wording.print_warning(f"{first}: {left_out}")
    names = ", ".join(f"{one.pair.sphere.name} on {one.pair.plate.name}" for one in found if one.pair)
    for role in ("sphere", "plate") if len(found) > 1 else ():
        if name := getattr(arguments, role):
            found = [one for one in found if one.pair and getattr(one.pair, role).name == name]
            if not found:
                raise ArgumentError(role, name, f"the record has {names}")
    if single and len(found) > 1:
        reason = "and these lines are for one: choose it by --sphere and --plate"
        raise ValueError(f"{first}: has impacts of several pairs, {names}, {reason}")
    with wording.reading(first):
        for one in found:
            records.check_sphere(one, chosen.pair(arguments, one.pair).sphere)
    return [records.completed(one, *sizes) for one in found]
