"""``contactlaw export`` (engines): source files for codes without Python: C header, LAMMPS, LIGGGHTS."""

import argparse
from typing import Any

from contactlaw import export
from contactlaw.cli.parts import chosen, options, wording
from contactlaw.model import ImpactModel


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "source files for codes without Python: C header, LAMMPS, LIGGGHTS"
    kinds = options.group(commands, "export", about, "KIND", "what to write")
    header = options.command(kinds, "header", "write a C header for C, C++ and GPUs", _header)
    lammps = options.command(
        kinds, "lammps", "write a fix for LAMMPS's input scripts, and a script that builds it", _lammps
    )
    liggghts = options.command(
        kinds, "liggghts", "write contact models for LIGGGHTS, and a script that builds them", _liggghts
    )
    for command in (header, lammps, liggghts):
        options.add_pair(command, action="append" if command is lammps else "store")
        options.add_name_of_law(command)
    for command in (lammps, liggghts):
        command.add_argument("--out", required=True, metavar="DIR", help="folder to write into; it is made if missing")
    header.add_argument("--out", default="contactlaw.h", metavar="FILE", help="file to write (default: %(default)s)")
    what = "include a table of the COR, or leave it out, which keeps the law and its integration (default: %(default)s)"
    header.add_argument("--table", default="cor", choices=["cor", "none"], help=what)
    what = "begin all names with this; headers of several pairs in one program need one each (default: %(default)s)"
    header.add_argument("--prefix", default="contactlaw", metavar="NAME", help=what)
    lammps.epilog = "Repeat --sphere or --plate for beads or walls of several materials."


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
