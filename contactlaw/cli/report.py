"""``contactlaw report`` (pages): a page with figures about recorded impacts."""

import dataclasses
import math
from argparse import Namespace
from pathlib import Path
from typing import Any

from contactlaw.cli.parts import options, wording
from contactlaw.export.scene_file import surface_of
from contactlaw.quantities import LENGTH
from contactlaw.record.file import read_record
from contactlaw.reporting.files import report
from contactlaw.reporting.run import Run
from contactlaw.walls.mesh import Mesh


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    command = options.command(commands, "report", "a page with figures about a run", _run)
    add = command.add_argument
    add(
        "files",
        nargs="+",
        metavar="FILE",
        help="record of a run, or several files of one run: written by an engine's `save` (.h5), or rows of impacts "
        "written by np.save (.npy)",
    )
    add(
        "--mesh",
        action="append",
        default=[],
        metavar="FILE",
        help="mesh of a wall (STL, PLY, OBJ), for a map of the energy if the record has no walls, as .npy files. If "
        "several walls are meshes, give the option once for each: first the mesh of the wall with the lowest number",
    )
    what = "length of one unit of the mesh: 1mm for a drawing in millimetres (default: 1 m)"
    options.add_quantity(command, "--scale", LENGTH, what, metavar="LENGTH", default=1.0)
    what = "scene of LAMMPS's fix, for the names of the walls and the map (default: the one beside the record)"
    add("--scene", metavar="FILE", help=what)
    add("--out", default="report", metavar="FOLDER", help="folder to write into (default: %(default)s)")


def _run(arguments: Namespace) -> None:
    record = read_record(*arguments.files)
    beside = [*Path(arguments.files[0]).parent.glob("*.scene")] if record.surface is None else []
    if path := arguments.scene or (beside[0] if len(beside) == 1 else None):
        record = dataclasses.replace(record, surface=surface_of(path, record.rows))
    with wording.reading(arguments.files[0]):
        Run(record)  # refuses what no report can be made of
    meshes = []
    for path in arguments.mesh:
        with wording.reading(path):
            meshes.append(Mesh.read(path, math.inf, scale=arguments.scale))
    with wording.writing("out", arguments.out, folder=True):
        print(report(record, arguments.out, meshes))
    if record.lacks:
        wording.print_message(f"the record lacks {record.lacks}")
    if record.surface is None and (record.rows["triangle"] >= 0).any():
        wording.print_message("the page has no map of the energy on the walls; for a map, add --scene or --mesh")
