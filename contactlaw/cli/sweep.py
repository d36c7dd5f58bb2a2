"""``contactlaw sweep``: all fields and flags over a grid, as a file."""

import argparse
import io
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import h5py

from contactlaw import _atomic, quantities
from contactlaw._version import VERSION
from contactlaw.cli.parts import chosen, impacts, options, wording
from contactlaw.cli.parts.impacts import ImpactTable, explained, tabulate, units, write_csv
from contactlaw.model import ImpactModel
from contactlaw.physical.validity import Validity, count_flags

_FORMAT, _SCHEMA = "contactlaw-sweep", 1
_AXES = ("radius", "thickness", "speed")  # from row to row, speeds change fastest
_SUFFIXES = (".csv", ".h5", ".hdf5")


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "all fields and flags over a grid, as a file"
    command = options.command(commands, "sweep", about, _run)
    options.add_impact(command, quantities.values)
    command.add_argument(
        "--out", required=True, metavar="FILE", help="file to write: .csv, or .h5 with the grid's axes"
    )
    command.epilog = f"{options.UNITS} {options.LISTS}"


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    with wording.writing("out", arguments.out):
        wording.check_suffix("out", arguments.out, _SUFFIXES)
        axes = (arguments.speed, arguments.radius, arguments.thickness)
        model = chosen.model(arguments)
        found = tabulate(model, *axes, solve=arguments.solve)
        save(found, model, axes, arguments.out)
    flags = explained(count_flags(found.flags), len(found))
    print(f"{arguments.out}: {len(found)} impacts, {impacts.in_words(found.asked)}", *flags, sep="\n")


def save(table: ImpactTable, model: ImpactModel, axes: Sequence[Sequence[float]], path: str | os.PathLike[str]) -> None:
    """Write a grid of impacts; the file appears complete or not at all.

    In ``.h5``, radius, thickness and speed are the axes (HDF5 dimension scales), each field is an
    array over them with its unit in the attribute ``units`` (``"1"`` without one), and the
    attributes of ``flags`` have the number of each limit.
    """
    wording.check_suffix("out", path, _SUFFIXES)
    if Path(path).suffix.lower() == ".csv":
        text = io.StringIO()
        write_csv(table, text)
        _atomic.write(path, text.getvalue().encode())
        return
    image = io.BytesIO()
    with h5py.File(image, "w", libver="v110") as file:
        _fill(file, table, model, dict(zip(("speed", "radius", "thickness"), axes, strict=True)))
    _atomic.write(path, image.getvalue())


def _fill(file: h5py.File, table: ImpactTable, model: ImpactModel, axes: dict[str, Sequence[float]]) -> None:
    file.attrs.update(
        format=_FORMAT,
        schema=_SCHEMA,
        contactlaw_version=VERSION,
        sphere=model.pair.sphere.name,
        plate=model.pair.plate.name,
        law=model.law,
        outside=model.outside,
    )
    for name in _AXES:
        file.create_dataset(name, data=axes[name], fletcher32=True)
        file[name].attrs["units"] = units()[name]
        file[name].make_scale(name)
    shape = tuple(len(axes[name]) for name in _AXES)
    for name, values in {**table.columns, "flags": table.flags}.items():
        if name not in _AXES:
            field = file.create_dataset(name, data=values.reshape(shape), fletcher32=True)
            field.attrs["units"] = units().get(name) or "1"
            for axis, scale in zip(field.dims, _AXES, strict=True):
                axis.attach_scale(file[scale])
    file["flags"].attrs.update({str(limit.name): int(limit) for limit in Validity})
