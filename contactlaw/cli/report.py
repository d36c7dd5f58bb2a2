"""``contactlaw report`` (pages): a page with figures about recorded impacts."""

import csv
import dataclasses
import io
import itertools
from argparse import Namespace
from pathlib import Path
from typing import Any

from contactlaw import _atomic
from contactlaw._escaped import cell
from contactlaw.cli.parts import options, wording
from contactlaw.export.scene_file import surface_of
from contactlaw.record.file import read_record
from contactlaw.reporting.files import report
from contactlaw.reporting.run import Run, WallRow
from contactlaw.spectrum import EDGES, Spectrum


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
        "--scene",
        metavar="FILE",
        help="scene of LAMMPS's fix, for the names of the walls and the map (default: the one that lies beside the "
        "record or in a folder there)",
    )
    add(
        "--spectrum",
        metavar="FILE.csv",
        help="power that the impacts feed into each wall, and spectrum of their forces, in third octaves",
    )
    add("--out", default="report", metavar="FOLDER", help="folder to write into (default: %(default)s)")


def _run(arguments: Namespace) -> None:
    if arguments.spectrum:
        wording.check_suffix("spectrum", arguments.spectrum, (".csv",))
    record = read_record(*arguments.files)
    if path := arguments.scene or (_scene_beside(arguments.files[0]) if record.surface is None else None):
        record = dataclasses.replace(record, surface=surface_of(path, record.rows))
    with wording.reading(arguments.files[0]):
        run = Run(record)  # refuses what no report can be made of
        spectrum, reason = run.waves if arguments.spectrum else (None, "")
        if reason:
            raise ValueError(reason)
    with wording.writing("out", arguments.out, folder=True):
        if spectrum:
            with wording.writing("spectrum", arguments.spectrum):
                _atomic.write(arguments.spectrum, _bands(run.walls, spectrum).encode())
        print(report(record, arguments.out))
    if record.lacks:
        wording.print_message(f"the record lacks {record.lacks}")
    if record.surface is None and arguments.files[0].endswith(".npy"):
        wording.print_message(
            "the page has neither names of walls nor a map of the energy: no scene lies beside the record or in "
            "a folder there, or several do; add --scene FILE; in Python, save the record as .h5"
        )


def _bands(walls: list[WallRow], spectrum: Spectrum) -> str:
    """CSV with a row for each band of each wall."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["wall", "from_Hz", "to_Hz", "power_W", "force_N2/Hz"])
    for wall, power, force in zip(walls, spectrum.power, spectrum.force, strict=True):
        writer.writerows(zip(itertools.repeat(cell(wall.name)), EDGES[:-1], EDGES[1:], power, force, strict=False))
    return text.getvalue()


def _scene_beside(record: str) -> Path | None:
    """Scene in the folder of a record, or else in a folder there; None if there is none or several."""
    for pattern in "*.scene", "*/*.scene":
        if scenes := [*Path(record).parent.glob(pattern)]:
            return scenes[0] if len(scenes) == 1 else None
    return None
