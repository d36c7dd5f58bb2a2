"""``contactlaw export``: source files for codes that do not run Python: header, lammps, liggghts."""

import argparse
from typing import Any

from contactlaw import export
from contactlaw.cli.parts import chosen, options, wording
from contactlaw.model import ImpactModel


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "source files for codes that do not run Python: header, lammps, liggghts"
    kinds = options.group(commands, "export", about, "KIND", "what to write")
    header = options.command(kinds, "header", "the law and a table of COR as one file for C, C++ and GPUs", _header)
    options.add_pair(header)
    options.add_name_of_law(header)
    header.add_argument("--out", default="contactlaw.h", metavar="FILE", help="file to write (default: %(default)s)")
    header.add_argument(
        "--table",
        default="cor",
        choices=["cor", "none"],
        help="with a table of COR, or without: law and integration alone (default: %(default)s)",
    )
    header.add_argument(
        "--prefix",
        default="contactlaw",
        metavar="NAME",
        help="what its names begin with, as in steel_on_glass: several pairs in "
        "one source file need one each (default: %(default)s)",
    )
    lammps = options.command(kinds, "lammps", "a fix for LAMMPS's input scripts, with a build script", _lammps)
    options.add_pair(lammps, action="append")
    options.add_name_of_law(lammps)
    lammps.add_argument("--out", required=True, metavar="DIR", help="folder to write into, made if need be")
    lammps.epilog = "Give --sphere or --plate again for beads or walls of several materials."
    liggghts = options.command(kinds, "liggghts", "contact models for LIGGGHTS, with a build script", _liggghts)
    options.add_pair(liggghts)
    options.add_name_of_law(liggghts)
    liggghts.add_argument("--out", required=True, metavar="DIR", help="folder to write into, made if need be")


def _header(arguments: argparse.Namespace) -> None:
    with wording.writing("out", arguments.out):
        model = ImpactModel(chosen.pair(arguments), law=arguments.law)
        export.header(arguments.out, model, arguments.table, prefix=arguments.prefix)
    print(arguments.out)


def _lammps(arguments: argparse.Namespace) -> None:
    with wording.writing("out", arguments.out, folder=True):
        export.lammps(arguments.out, chosen.models(arguments))
    print(arguments.out)


def _liggghts(arguments: argparse.Namespace) -> None:
    with wording.writing("out", arguments.out, folder=True):
        model = ImpactModel(chosen.pair(arguments), law=arguments.law)
        export.liggghts(arguments.out, model)
    print(arguments.out)
