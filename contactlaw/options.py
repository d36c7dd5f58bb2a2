"""The options of the command line, and what its help says of them."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from contactlaw import laws, quantities
from contactlaw._version import VERSION
from contactlaw.quantities import LENGTH, SPEED, Quantity

Reader = Callable[[str, Quantity], Any]

_UNITS = (
    "Quantities are numbers in SI units, or carry one of their own: 0.9mm, 500um, 50nm, 36km/h."
)
_LISTS = (
    "Several are a list, 1,5,10, or a range start:stop:count, 0.1:10:50, with logarithmic steps "
    "0.1:10:50log; every combination of speeds, radii and thicknesses is an impact."
)


def parser() -> argparse.ArgumentParser:
    """Make the parser of ``contactlaw``.

    What it returns has the name of the command among its attributes.

    Examples
    --------
    >>> parser().parse_args(["table", "info", "--law", "myc"]).command
    'table info'
    """
    made = argparse.ArgumentParser(
        prog="contactlaw", description="Restitution of beads that hit thin plates."
    )
    made.add_argument("--version", action="version", version=f"%(prog)s {VERSION}",
                      help="print the version and exit")  # fmt: skip
    commands = made.add_subparsers(required=True, metavar="COMMAND", help="what to do")

    cor = _command(commands, "cor", "coefficient of restitution and more, of one impact or many")
    _add_impact(cor, quantities.values)
    _add_output(cor)
    cor.epilog = f"{_UNITS} {_LISTS}"

    history = _command(commands, "history", "force over time of one impact, as CSV or a plot")
    _add_impact(history, quantities.value)
    history.add_argument("--samples", type=int, default=256, metavar="N",
                         help="number of times (default: %(default)s)")  # fmt: skip
    history.add_argument("--plot", metavar="FILE", help="draw into FILE (PNG, SVG, PDF)")
    history.epilog = _UNITS

    materials = _command(commands, "materials", "the catalogue, with the source of each number")
    materials.add_argument("name", nargs="?", metavar="NAME", help="one material, and its sources")
    materials.add_argument("--json", action="store_true", help="print all fields, in SI units")

    about = "lookup tables: build, info, check"
    tables = commands.add_parser("table", help=about, description=_sentence(about))
    _add_tables(tables.add_subparsers(required=True, metavar="ACTION", help="what to do"))

    about = "files for codes that Python cannot reach: header, liggghts"
    exports = commands.add_parser("export", help=about, description=_sentence(about))
    _add_exports(exports.add_subparsers(required=True, metavar="KIND", help="what to write"))
    return made


def _command(commands: Any, name: str, about: str) -> argparse.ArgumentParser:
    command: argparse.ArgumentParser = commands.add_parser(
        name.split()[-1], help=about, description=_sentence(about)
    )
    command.set_defaults(command=name)
    return command


def _sentence(about: str) -> str:
    return f"{about[0].upper()}{about[1:]}."


def _add_pair(command: argparse.ArgumentParser) -> None:
    """Add materials and law."""
    add = command.add_argument
    add("--sphere", required=True, metavar="NAME", help="material of the bead (see materials)")
    add("--plate", required=True, metavar="NAME", help="material of the plate")
    add("--law", default=laws.DEFAULT, metavar="LAW",
        help=f"force law: {', '.join(laws.names())} (default: %(default)s)")  # fmt: skip


def _add_impact(command: argparse.ArgumentParser, read: Reader) -> None:
    """Add the options of commands about impacts; quantities are read as one or as several."""
    _add_pair(command)
    add = command.add_argument
    add("--radius", required=True, metavar="R", type=_quantity(read, LENGTH),
        help="radius of the bead [m], or with a unit")  # fmt: skip
    add("--thickness", required=True, metavar="H", type=_quantity(read, LENGTH),
        help="thickness of the plate [m], or with a unit; inf: a half-space")  # fmt: skip
    add("--speed", required=True, metavar="V", type=_quantity(read, SPEED),
        help="normal approach speed [m/s], or with a unit")  # fmt: skip
    add("--outside", default="raise", choices=["raise", "solve", "clamp"],
        help="outside the table: refuse, integrate the equation, or take the value at its border "
        "(default: %(default)s)")  # fmt: skip
    add("--solve", action="store_true", help="integrate the equation instead of looking up")


def _quantity(read: Reader, quantity: Quantity) -> Callable[[str], Any]:
    """Read an option's value, with errors that argparse takes over."""

    def one(text: str) -> Any:
        try:
            return read(text, quantity)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None

    return one


def _add_output(command: argparse.ArgumentParser) -> None:
    add = command.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print rows of all fields in SI units, every digit")
    add("--json", action="store_true",
        help="print all fields in SI units, of several impacts a list; inf is null")  # fmt: skip
    add("--plot", metavar="FILE",
        help="draw the COR over these speeds into FILE (PNG, SVG, PDF), a curve per thickness; a "
        "single speed is where they end")  # fmt: skip


def _add_tables(actions: Any) -> None:
    info = _command(actions, "table info", "extent, settings and certificate of a table")
    check = _command(
        actions, "table check", "certify a table at fresh random points, fail above the bounds"
    )
    build = _command(actions, "table build", "solve the equation at every node of a table")
    for action in (info, check):
        action.add_argument("file", nargs="?", metavar="FILE",
                            help="a table (default: the one in use for LAW)")  # fmt: skip
    for action in (info, check, build):
        # not laws.DEFAULT, which may take numbers from a pair: this one's table ships
        action.add_argument("--law", default="myc", metavar="LAW",
                            help="force law of the table (default: %(default)s)")  # fmt: skip
        action.add_argument(
            "--sphere",
            metavar="NAME",
            help="material of the bead, for laws that take numbers from a pair",
        )
        action.add_argument("--plate", metavar="NAME", help="material of the plate, likewise")
    check.add_argument("--points", type=int, default=10_000, metavar="N",
                       help="number of points, at least 100 (default: %(default)s)")  # fmt: skip
    check.add_argument("--seed", type=int, metavar="S",
                       help="seed of the points (default: a fresh one)")  # fmt: skip
    build.add_argument("--out", metavar="FILE", help="file to write (default: LAW.h5)")


def _add_exports(kinds: Any) -> None:
    header = _command(
        kinds, "export header", "the law and a table of COR as one file in C, which C++ takes too"
    )
    _add_pair(header)
    header.add_argument("--out", default="contactlaw.h", metavar="FILE",
                        help="file to write (default: %(default)s)")  # fmt: skip
    header.add_argument("--table", default="cor", choices=["cor", "none"],
                        help="with a table of COR, or without: law and integration alone "
                        "(default: %(default)s)")  # fmt: skip
    liggghts = _command(
        kinds, "export liggghts", "a normal model for the walls of LIGGGHTS, and how it is built"
    )
    _add_pair(liggghts)
    liggghts.add_argument("--out", required=True, metavar="DIR",
                          help="folder to write into, made if need be")  # fmt: skip
