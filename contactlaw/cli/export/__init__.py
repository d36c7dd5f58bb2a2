"""``contactlaw export`` (engines): source files for codes without Python: C header, LAMMPS, LIGGGHTS."""

import functools
from argparse import Namespace
from pathlib import Path
from typing import Any

from contactlaw import _atomic, export
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
            command.add_argument(
                "--out", required=True, metavar="DIR", help="folder to write into; it is made if missing"
            )
        made[kind] = command
    header = made["header"]
    header.add_argument("--out", default="contactlaw.h", metavar="FILE", help="file to write (default: %(default)s)")
    header.add_argument(
        "--table",
        default="cor",
        choices=["cor", "none"],
        help="include a table of the COR, or leave it out and keep the law and its integration (default: %(default)s)",
    )
    header.add_argument(
        "--prefix",
        default="contactlaw",
        metavar="NAME",
        help="begin all names with this; headers of several pairs in one program need one each (default: %(default)s)",
    )
    made["lammps"].add_argument(
        "scene",
        nargs="?",
        metavar="NAME.toml",
        type=Path,
        help="beads and walls, to write as NAME.scene (default: the sources of the fix alone, the same for all)",
    )
    made["lammps"].add_argument(
        "--set",
        action="append",
        default=[],
        metavar="WALL.WORD=VALUE",
        help="value in place of one of the file, such as shell.thickness=2mm; may be repeated (default: none)",
    )


def _run(kind: str, arguments: Namespace) -> None:
    of_header = {name: word for name, word in vars(arguments).items() if name in ("table", "prefix")}
    if path := getattr(arguments, "scene", None):
        scene = Scene(path, arguments.set)
        walls = scene.arguments(arguments.materials, arguments.law)
    with wording.writing("out", arguments.out, folder=kind != "header"):
        if path:
            with scene.naming(), _atomic.folder(arguments.out) as folder:
                export.scene(folder / f"{path.stem}.scene", **walls)
        if kind == "lammps":
            export.lammps(arguments.out)
        else:
            getattr(export, kind)(arguments.out, chosen.model(arguments), **of_header)
    print(arguments.out)
