"""``contactlaw speed-table``: COR over speed in the fewest rows for linear interpolation."""

import argparse
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw.answers.speed_table import SpeedTable
from contactlaw.cli.parts import chosen, options, wording
from contactlaw.cli.parts.impacts import aligned, asked, explained, in_words
from contactlaw.quantities import SPEED


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "COR over speed in the fewest rows for linear interpolation"
    command = options.command(commands, "speed-table", about, _run)
    options.add_pair(command)
    options.add_sizes(command, quantities.value)
    options.add_wall(command)
    for option, which, speed in (("--slowest", "first", 0.1), ("--fastest", "last", 10.0)):
        what = f"{which} speed [m/s], or with a unit (default: %(default)s)"
        options.add_quantity(command, option, SPEED, what, default=speed, metavar="V")
    add = command.add_argument
    add(
        "--error",
        default=1e-3,
        metavar="E",
        type=float,
        help="largest error in COR of straight lines between rows (default: %(default)s)",
    )
    options.add_law(command)
    add("--csv", action="store_true", help="print a comment and the two columns, every digit")
    command.epilog = options.UNITS


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    ends = (arguments.slowest, arguments.fastest)
    with wording.naming_impact(ends, arguments.radius, arguments.thickness):
        model = chosen.model(arguments)
        plate = chosen.wall(arguments, model.pair.given[1], arguments.thickness)
        found = model.speed_table(arguments.radius, plate, arguments.error, *ends)
    given = asked(model, radius=arguments.radius, thickness=arguments.thickness)
    given["plate"] = chosen.plate_in_words(arguments, given["plate"])
    if arguments.csv:
        print(f"# {in_words(given)}")
        print("speed_m/s,restitution")
        np.savetxt(sys.stdout, np.column_stack(found[:2]), fmt="%.17g", delimiter=",")
    else:
        print(in_words(given), *text(found), sep="\n")


def text(found: SpeedTable) -> Iterator[str]:
    """Lines for a terminal: rows of COR over speed, their error, and the meaning of the flags."""
    rows = [(f"{v:.6g}", f"{e:.4g}", "") for v, e in zip(found.speed, found.restitution, strict=True)]
    yield from aligned(list(zip(("speed", "COR", ""), ("[m/s]", "[-]", ""), *rows, strict=True)))
    yield ""
    yield f"{len(rows)} rows, straight lines between them within {found.error:.2g} in COR"
    yield from explained(found.flags, len(rows))
