"""``contactlaw constant``: one COR for each wall, and its errors."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from contactlaw import laws
from contactlaw.cli.constant import lines, records, walls
from contactlaw.cli.parts import chosen, options, quantities, wording
from contactlaw.cli.parts.impacts import asked, in_words
from contactlaw.cli.parts.options import reader_of
from contactlaw.cli.parts.quantities import SPEED
from contactlaw.model import ImpactModel


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "one COR for each wall, and its errors"
    command = options.command(commands, "constant", about, _run)
    options.add_pair(command, options.OF_RECORD)
    options.add_sizes(command, quantities.values, required=False)
    add = command.add_mutually_exclusive_group(required=True).add_argument
    add(
        "--speed",
        metavar="V",
        type=reader_of(quantities.values, SPEED),
        help="normal approach speeds [m/s], or with a unit; all are equally frequent",
    )
    add(
        "--record",
        metavar="FILE",
        help="recorded impacts: a file of dem-demo, such as rain.h5, an engine's record (.npy), or "
        "CSV with a column speed_m/s and, optionally, radius_m, thickness_m, weight and plate",
    )
    options.add_law(command, default=None)
    command.add_argument(
        "--keep",
        default="energy",
        choices=["energy", "momentum"],
        help="what the wall takes in total as with each impact's own COR (default: %(default)s)",
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
    recorded = _recorded(arguments)
    pair = chosen.pair(arguments, recorded.pair)
    law = arguments.law or recorded.law or laws.DEFAULT
    model = ImpactModel(pair, law=law, outside=arguments.outside)
    found = walls.walls(model, recorded, arguments.keep)
    formats = {"lammps": lines.lammps, "liggghts": lines.liggghts, "yade": lines.yade}
    write = next((write for name, write in formats.items() if getattr(arguments, name)), None)
    if write is not None:
        print(*list(write(model, found, arguments.keep)), sep="\n")
    elif arguments.csv:
        walls.write_csv(found, arguments.keep, sys.stdout, asked(model))
    else:
        print(in_words(asked(model)), *walls.text(found, arguments.keep), sep="\n")


def _recorded(arguments: argparse.Namespace) -> records.PlannedImpacts:
    """Impacts of the record, or every combination of the given speeds, radii and thicknesses."""
    chosen.check_quantities(arguments)
    sizes = (arguments.radius, arguments.thickness)
    if arguments.record is None:
        return records.combined(arguments.speed, *sizes)
    found = records.read(arguments.record)
    if found.left_out:
        wording.print_warning(f"{arguments.record}: {found.left_out}")
    sphere = chosen.pair(arguments, found.pair).sphere
    with wording.reading(arguments.record):
        records.check_sphere(found, sphere)
    return records.completed(found, *sizes)
