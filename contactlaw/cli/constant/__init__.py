"""``contactlaw constant``: one COR for each wall, and its errors."""

import argparse
import sys
from typing import Any

from contactlaw import laws, quantities
from contactlaw._errors import ArgumentError
from contactlaw.cli.constant import lines, records, walls
from contactlaw.cli.parts import chosen, options, wording
from contactlaw.cli.parts.impacts import asked, in_words
from contactlaw.model import ImpactModel
from contactlaw.quantities import SPEED


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "one COR for each wall, and its errors"
    command = options.command(commands, "constant", about, _run)
    options.add_pair(command, options.OF_RECORD)
    options.add_sizes(command, quantities.values, required=False)
    group = command.add_mutually_exclusive_group(required=True)
    what = "normal approach speeds [m/s], or with a unit; all are equally frequent"
    options.add_quantity(group, "--speed", SPEED, what, quantities.values, metavar="V")
    options.add_drop(group, quantities.values)
    group.add_argument(
        "--record",
        metavar="FILE",
        nargs="+",
        help="recorded impacts: files of one run (.h5), an engine's rows (.npy), or CSV with a "
        "column speed_m/s and, optionally, radius_m, thickness_m, weight and plate",
    )
    options.add_law(command, default=None)
    command.add_argument(
        "--keep",
        default="energy",
        choices=["energy", "momentum"],
        help="what the constant gets right in total: the energy that beads lose on the wall, or the "
        "momentum that they give it (default: %(default)s)",
    )
    add = command.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print a row per wall in SI units, every digit")
    add("--lammps", action="store_true", help="print pair_coeff and fix wall/gran of LAMMPS")
    add("--liggghts", action="store_true", help="print fix property/global of LIGGGHTS")
    add("--yade", action="store_true", help="print betan of YADE")
    command.epilog = (
        f"{options.UNITS} Several are a list or a range, as in `contactlaw cor`. Where a record "
        "has a column plate, --thickness may have a value for each plate, in their order."
    )


def _run(arguments: argparse.Namespace) -> None:
    formats = {"lammps": lines.lammps, "liggghts": lines.liggghts, "yade": lines.yade}
    write = next((write for name, write in formats.items() if getattr(arguments, name)), None)
    for n, recorded in enumerate(_recorded(arguments, single=write is not None)):
        law = arguments.law or recorded.law or laws.DEFAULT
        pair = chosen.pair(arguments, recorded.pair)
        model = ImpactModel(pair, law=law, outside=arguments.outside)
        found = walls.walls(model, recorded, arguments.keep)
        if write is not None:
            print(*list(write(model, found, arguments.keep)), sep="\n")
        elif arguments.csv:
            walls.write_csv(found, arguments.keep, sys.stdout, asked(model), head=n == 0)
        else:
            print(*[""] * (n > 0), in_words(asked(model)), *walls.text(found, arguments.keep), sep="\n")


def _recorded(arguments: argparse.Namespace, single: bool) -> list[records.Recorded]:
    """Impacts of each pair, or every combination of the given speeds, radii and thicknesses."""
    chosen.check_quantities(arguments)
    sizes = (arguments.radius, arguments.thickness)
    if arguments.record is None:
        return [records.combined(arguments.speed, *sizes)]
    found = records.read(*arguments.record)
    if found[0].left_out:
        wording.print_warning(f"{arguments.record[0]}: {found[0].left_out}")
    if len(found) > 1:
        found = _of_names(arguments, found)
    if single and len(found) > 1:
        pairs = [one.pair for one in found if one.pair]
        names = ", ".join(f"{one.sphere.name} on {one.plate.name}" for one in pairs)
        raise ValueError(
            f"{arguments.record[0]}: has impacts of several pairs, {names}, and these lines are "
            "for one: choose it by --sphere and --plate"
        )
    with wording.reading(arguments.record[0]):
        for one in found:
            records.check_sphere(one, chosen.pair(arguments, one.pair).sphere)
    return [records.completed(one, *sizes) for one in found]


def _of_names(arguments: argparse.Namespace, found: list[records.Recorded]) -> list[records.Recorded]:
    """Impacts of the materials that --sphere and --plate name; of all if none of these is given."""
    for role in ("sphere", "plate"):
        name = getattr(arguments, role)
        if name is not None:
            known = sorted({getattr(one.pair, role).name for one in found if one.pair})
            if name not in known:
                raise ArgumentError(role, name, f"the record has {', '.join(known)}")
            found = [one for one in found if one.pair and getattr(one.pair, role).name == name]
    return found
