"""``contactlaw export`` (engines): source files for codes without Python: C header, LAMMPS, LIGGGHTS."""

import functools
from argparse import Namespace
from pathlib import Path
from typing import Any

from contactlaw import export
from contactlaw.cli.export.scene import Scene
from contactlaw.cli.parts import chosen, options, wording

_KINDS = {
    "header": "a C header for C, C++ and GPUs",
    "lammps": "a fix for LAMMPS's input scripts, and walls for it",
    "liggghts": "contact models for LIGGGHTS, and a script that builds them",
}


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "source files for codes without Python: C header, LAMMPS, LIGGGHTS"
    kinds = options.group(commands, "export", about, "KIND", "what to write")
    made = {}
    for kind, what in _KINDS.items():
        command = options.command(kinds, kind, f"write {what}", functools.partial(_run, kind))
        (options.add_materials if kind == "lammps" else options.add_pair)(command)
        options.add_name_of_law(command)
        if kind != "header":
            where = "folder to write into; it is made if missing"
            command.add_argument("--out", required=True, metavar="DIR", help=where)
        made[kind] = command
    header = made["header"]
    header.add_argument("--out", default="contactlaw.h", metavar="FILE", help="file to write (default: %(default)s)")
    what = "include a table of the COR, or leave it out, which keeps the law and its integration (default: %(default)s)"
    header.add_argument("--table", default="cor", choices=["cor", "none"], help=what)
    what = "begin all names with this; headers of several pairs in one program need one each (default: %(default)s)"
    header.add_argument("--prefix", default="contactlaw", metavar="NAME", help=what)
    what = "beads and walls, to write as NAME.scene (default: the sources of the fix alone, which are the same for all)"
    made["lammps"].add_argument("scene", nargs="?", metavar="NAME.toml", type=Path, help=what)
    what = "value in place of one of the file, such as shell.thickness=2mm; may be repeated (default: none)"
    made["lammps"].add_argument("--set", action="append", default=[], metavar="WALL.WORD=VALUE", help=what)


def _run(kind: str, arguments: Namespace) -> None:
    of_header = {name: word for name, word in vars(arguments).items() if name in ("table", "prefix")}
    with wording.writing("out", arguments.out, folder=kind != "header"):
        if kind != "lammps":
            getattr(export, kind)(arguments.out, chosen.model(arguments), **of_header)
        elif arguments.scene is None:
            export.lammps(arguments.out)
        else:
            walls = Scene(arguments.scene, arguments.set).arguments(arguments.materials, arguments.law)
            export.lammps(arguments.out)
            export.scene(Path(arguments.out) / f"{arguments.scene.stem}.scene", **walls)
    print(arguments.out)
