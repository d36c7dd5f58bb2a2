"""The options of the command line, and what its help says of them."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable
from typing import Any

from contactlaw import laws
from contactlaw._version import VERSION
from contactlaw.command import quantities
from contactlaw.command.quantities import LENGTH, SPEED, Quantity
from contactlaw.fitting.unknowns import UNKNOWNS

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

    sweep = _command(commands, "sweep", "all fields and flags over a grid, as a file")
    _add_impact(sweep, quantities.values)
    sweep.add_argument("--out", required=True, metavar="FILE",
                       help="file to write: .csv, or .h5 with the grid's axes")  # fmt: skip
    sweep.epilog = f"{_UNITS} {_LISTS}"

    _add_constant(_command(commands, "constant", "one COR for each wall, and what it gets wrong"))
    about = "COR over speed in the fewest rows that straight lines may join"
    _add_speed_table(_command(commands, "speed-table", about))

    about = "strengths, sizes and more from measured rebounds, with their errors"
    _add_fit(_command(commands, "fit", about))

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


_NEGATIVE = re.compile(r"-(?:\.?\d|inf)")


def joined(words: Iterable[str]) -> list[str]:
    """Join an option with a negative quantity that follows it.

    argparse takes -1 for a number and -1mm for an option, whose name is then missing. Whether a
    quantity may be negative is for its reader to say.

    Examples
    --------
    >>> joined(["cor", "--thickness", "-1mm", "--csv"])
    ['cor', '--thickness=-1mm', '--csv']
    """
    found: list[str] = []
    for word in words:
        if found and _NEGATIVE.match(word) and re.fullmatch("--[a-z-]+", found[-1]):
            found[-1] += f"={word}"
        else:
            found.append(word)
    return found


def _command(commands: Any, name: str, about: str) -> argparse.ArgumentParser:
    command: argparse.ArgumentParser = commands.add_parser(
        name.split()[-1], help=about, description=_sentence(about)
    )
    command.set_defaults(command=name)
    return command


def _sentence(about: str) -> str:
    return f"{about[0].upper()}{about[1:]}."


def _add_impact(command: argparse.ArgumentParser, read: Reader) -> None:
    """Add the options of commands about impacts; quantities are read as one or as several."""
    _add_pair(command)
    _add_sizes(command, read)
    command.add_argument("--speed", required=True, metavar="V", type=reader_of(read, SPEED),
                         help="normal approach speed [m/s], or with a unit")  # fmt: skip
    _add_law(command)
    command.add_argument(
        "--solve", action="store_true", help="integrate the equation instead of looking up"
    )


_OF_RECORD = " (default: that of the record)"


def _add_pair(command: argparse.ArgumentParser, required: bool = True) -> None:
    """Add materials; what is not required has a record that may know it."""
    add, known = command.add_argument, "" if required else _OF_RECORD
    add("--sphere", required=required, metavar="NAME",
        help=f"material of the bead, see materials{known}")  # fmt: skip
    add("--plate", required=required, metavar="NAME", help=f"material of the plate{known}")


def _add_sizes(command: argparse.ArgumentParser, read: Reader, required: bool = True) -> None:
    add, known = command.add_argument, "" if required else _OF_RECORD
    add("--radius", required=required, metavar="R", type=reader_of(read, LENGTH),
        help=f"radius of the bead [m], or with a unit{known}")  # fmt: skip
    add("--thickness", required=required, metavar="H", type=reader_of(read, LENGTH),
        help=f"thickness of the plate [m], or with a unit; inf: a half-space{known}")  # fmt: skip


def _add_name_of_law(command: argparse.ArgumentParser, default: str | None = laws.DEFAULT) -> None:
    stated = default or f"that of the record, or {laws.DEFAULT}"
    command.add_argument("--law", default=default, metavar="LAW",
        help=f"force law: {', '.join(laws.names())} (default: {stated})")  # fmt: skip


def _add_law(command: argparse.ArgumentParser, default: str | None = laws.DEFAULT) -> None:
    """Add the law, and what to do outside its table."""
    _add_name_of_law(command, default)
    command.add_argument("--outside", default="raise", choices=["raise", "solve", "clamp"],
        help="outside the table: refuse, integrate the equation, or take the value at its border "
        "(default: %(default)s)")  # fmt: skip


def _add_constant(command: argparse.ArgumentParser) -> None:
    _add_pair(command, required=False)
    _add_sizes(command, quantities.values, required=False)
    add = command.add_mutually_exclusive_group(required=True).add_argument
    add(
        "--speed",
        metavar="V",
        type=reader_of(quantities.values, SPEED),
        help="normal approach speeds [m/s], or with a unit, one as frequent as the other",
    )
    add(
        "--record",
        metavar="FILE",
        help="impacts that have happened: rain.h5 or sieve.h5 of dem-demo, an engine's record "
        "(.npy), or CSV with a column speed_m/s, and perhaps radius_m, thickness_m, weight and "
        "plate",
    )
    _add_law(command, default=None)
    command.add_argument(
        "--keep",
        default="energy",
        choices=["energy", "momentum"],
        help="what the wall takes in all as with each impact's own COR (default: %(default)s)",
    )
    add = command.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print a row per wall in SI units, every digit")
    add("--lammps", action="store_true", help="print pair_coeff and fix wall/gran of LAMMPS")
    add("--liggghts", action="store_true", help="print fix property/global of LIGGGHTS")
    add("--yade", action="store_true", help="print betan of YADE")
    command.epilog = (
        f"{_UNITS} Several are a list or a range, as in `contactlaw cor`. Where a record has a "
        "column plate, --thickness may have a value for each plate, in their order."
    )


def _add_speed_table(command: argparse.ArgumentParser) -> None:
    _add_pair(command)
    _add_sizes(command, quantities.value)
    speed = reader_of(quantities.value, SPEED)
    add = command.add_argument
    add("--slowest", default=0.1, metavar="V", type=speed,
        help="first speed [m/s], or with a unit (default: %(default)s)")  # fmt: skip
    add("--fastest", default=10.0, metavar="V", type=speed,
        help="last speed, likewise (default: %(default)s)")  # fmt: skip
    add(
        "--error",
        default=1e-3,
        metavar="E",
        type=float,
        help="largest error in COR of straight lines between rows (default: %(default)s)",
    )
    _add_law(command)
    add("--csv", action="store_true", help="print the two columns alone, every digit")
    command.epilog = _UNITS


def _add_fit(command: argparse.ArgumentParser) -> None:
    add = command.add_argument
    add(
        "data",
        metavar="FILE",
        help="CSV with a row per rebound: speed_m/s, one at least of COR, contact_time_us and "
        "peak_force_N, each perhaps with its standard error (COR_error), and perhaps radius_mm "
        "and thickness_mm",
    )
    _add_pair(command)
    length = reader_of(quantities.value, LENGTH)
    add("--radius", metavar="R", type=length,
        help="radius of all beads [m], or with a unit")  # fmt: skip
    add("--thickness", metavar="H", type=length,
        help="thickness of all plates [m], or with a unit; inf: a half-space")  # fmt: skip
    add("--unknown", required=True, metavar="NAME", type=_names,
        help=f"what to find, up to three: {', '.join(UNKNOWNS)}")  # fmt: skip
    add(
        "--prior",
        action="append",
        default=[],
        metavar="NAME=ERROR",
        type=_prior,
        help="standard error of one of these that is given, as density=20kg/m3; may be repeated "
        "(default: all that is given is exact)",
    )
    _add_name_of_law(command)
    add = command.add_mutually_exclusive_group().add_argument
    add("--json", action="store_true", help="print all of it in SI units")
    add("--plot", metavar="FILE",
        help="draw data, fit, its band and residuals into FILE (PNG, SVG, PDF)")  # fmt: skip
    command.epilog = _UNITS


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip().replace("-", "_") for name in text.split(","))


def _prior(text: str) -> tuple[str, float]:
    """Read a name and a standard error, in the unit of what it is of.

    Examples
    --------
    >>> _prior("density=20kg/m3")
    ('density', 20.0)
    """
    name, _, size = text.partition("=")
    name = name.strip().replace("-", "_")
    if name not in UNKNOWNS or not size:
        raise argparse.ArgumentTypeError(
            f"got {text!r}, expected NAME=ERROR with a NAME of {', '.join(UNKNOWNS)}"
        )
    kinds = {"Pa": quantities.STRESS, "kg/m3": quantities.DENSITY, "m": LENGTH}
    error: float = reader_of(quantities.value, kinds[UNKNOWNS[name].unit])(size)
    return name, error


def reader_of(read: Reader, quantity: Quantity) -> Callable[[str], Any]:
    """Make of a reader of quantities one for an option, with errors that argparse takes over."""

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
    _add_name_of_law(header)
    header.add_argument("--out", default="contactlaw.h", metavar="FILE",
                        help="file to write (default: %(default)s)")  # fmt: skip
    header.add_argument("--table", default="cor", choices=["cor", "none"],
                        help="with a table of COR, or without: law and integration alone "
                        "(default: %(default)s)")  # fmt: skip
    liggghts = _command(
        kinds, "export liggghts", "a normal model for the walls of LIGGGHTS, and how it is built"
    )
    _add_pair(liggghts)
    _add_name_of_law(liggghts)
    liggghts.add_argument("--out", required=True, metavar="DIR",
                          help="folder to write into, made if need be")  # fmt: skip
