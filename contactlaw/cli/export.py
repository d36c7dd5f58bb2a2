"""``contactlaw export`` (engines): source files for codes without Python: C header, LAMMPS, LIGGGHTS."""

import argparse
import functools
from typing import Any

from contactlaw import export
from contactlaw.cli.parts import chosen, options, wording

_KINDS = {
    "header": "a C header for C, C++ and GPUs",
    "lammps": "a fix for LAMMPS's input scripts, and a script that builds it",
    "liggghts": "contact models for LIGGGHTS, and a script that builds them",
}


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "source files for codes without Python: C header, LAMMPS, LIGGGHTS"
    kinds = options.group(commands, "export", about, "KIND", "what to write")
    made = {}
    for kind, what in _KINDS.items():
        command = options.command(kinds, kind, f"write {what}", functools.partial(_run, kind))
        options.add_pair(command, action="append" if kind == "lammps" else "store")
        options.add_name_of_law(command)
        command.set_defaults(outside="raise")
        made[kind] = command
    for kind in ("lammps", "liggghts"):
        where = "folder to write into; it is made if missing"
        made[kind].add_argument("--out", required=True, metavar="DIR", help=where)
    header = made["header"]
    header.add_argument("--out", default="contactlaw.h", metavar="FILE", help="file to write (default: %(default)s)")
    what = "include a table of the COR, or leave it out, which keeps the law and its integration (default: %(default)s)"
    header.add_argument("--table", default="cor", choices=["cor", "none"], help=what)
    what = "begin all names with this; headers of several pairs in one program need one each (default: %(default)s)"
    header.add_argument("--prefix", default="contactlaw", metavar="NAME", help=what)
    made["lammps"].epilog = "Repeat --sphere or --plate for beads or walls of several materials."


def _run(kind: str, arguments: argparse.Namespace) -> None:
    of_header = {name: word for name, word in vars(arguments).items() if name in ("table", "prefix")}
    with wording.writing("out", arguments.out, folder=kind != "header"):
        model: Any = (chosen.models if kind == "lammps" else chosen.model)(arguments)
        getattr(export, kind)(arguments.out, model, **of_header)
    print(arguments.out)
