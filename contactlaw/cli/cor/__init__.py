"""``contactlaw cor``: coefficient of restitution and more, of one impact or many."""

from __future__ import annotations

import argparse
import json
import math
import sys
from typing import Any

from contactlaw.cli.cor import curves, figure
from contactlaw.cli.parts import chosen, impacts, options, quantities
from contactlaw.physical.validity import explain


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "coefficient of restitution and more, of one impact or many"
    command = options.command(commands, "cor", about, _run)
    options.add_impact(command, quantities.values)
    add = command.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print rows of all fields in SI units, every digit")
    add("--json", action="store_true",
        help="print all fields in SI units, a list for several impacts; inf is null")  # fmt: skip
    add("--plot", metavar="FILE",
        help="draw the COR over these speeds into FILE (PNG, SVG, PDF), a curve per thickness; "
        "with a single speed, up to that")  # fmt: skip
    command.epilog = f"{options.UNITS} {options.LISTS}"


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    if arguments.plot is not None:
        with chosen.plot_file(arguments):
            _plot_cor(arguments)
        return
    values = (arguments.speed, arguments.radius, arguments.thickness)
    found = impacts.tabulate(chosen.model(arguments), *values, solve=arguments.solve)
    if arguments.csv:
        impacts.write_csv(found, sys.stdout)
    elif arguments.json:
        print(json.dumps(_as_json(impacts.records(found)), indent=2))
    elif len(found) > 1:
        print(*impacts.text(found), sep="\n")
    else:
        _print_one(found)


def _as_json(rows: list[dict[str, object]]) -> object:
    """Rows; for a single impact, one record without the speed and sizes that the user gave."""
    if len(rows) > 1:
        return rows
    known = ("speed", "radius", "thickness")
    return {name: value for name, value in rows[0].items() if name not in known}


def _print_one(found: impacts.ImpactTable) -> None:
    units = impacts.units()
    for name, (value,) in found.columns.items():
        if name == "yield_speed" and value == math.inf:
            print(f"{name:21s} none within the table")
        elif name not in ("speed", "radius", "thickness"):
            print(f"{name:21s} {value:.6g} {units[name]}".rstrip())
    flags = int(found.flags[0])
    print(f"{'flags':21s} {', '.join(impacts.flag_names(flags)) or 'none: inside every limit'}")
    for words in explain(flags):
        print(f"{'':21s} {words}")


def _plot_cor(arguments: argparse.Namespace) -> None:
    model = chosen.model(arguments)
    drawn = curves.restitution_curves(
        model, arguments.speed, arguments.radius, arguments.thickness, solve=arguments.solve
    )
    title = f"{arguments.sphere} on {arguments.plate}, law {arguments.law}"
    figure.save_restitution(drawn, title, arguments.plot)
