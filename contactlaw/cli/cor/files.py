"""The file of ``contactlaw cor --out``: all impacts of a grid, as CSV or HDF5."""

import io
from collections.abc import Mapping, Sequence
from pathlib import Path

import h5py
import numpy as np

from contactlaw import _atomic
from contactlaw._version import VERSION
from contactlaw.cli.parts.table import Table
from contactlaw.physical.validity import Validity

SUFFIXES = ".csv", ".h5", ".hdf5"
_FORMAT, _SCHEMA = "contactlaw-sweep", 1


def save(table: Table, axes: Mapping[str, Sequence[float]], outside: str, path: str) -> None:
    """Write a grid of impacts; the file appears complete or not at all.

    In ``.h5`` the axes are HDF5 dimension scales, of which the last one changes fastest from row
    to row. Each field is an array over them with its unit in the attribute ``units`` (``"1"``
    without one), and the attributes of ``flags`` have the number of each limit.
    """
    if Path(path).suffix.lower() == ".csv":
        text = io.StringIO()
        table.write_csv(text)
        _atomic.write(path, text.getvalue().encode())
        return
    image = io.BytesIO()
    with h5py.File(image, "w", libver="v110") as file:
        _fill(file, table, axes, outside)
    _atomic.write(path, image.getvalue())


def _fill(file: h5py.File, table: Table, axes: Mapping[str, Sequence[float]], outside: str) -> None:
    file.attrs.update(format=_FORMAT, schema=_SCHEMA, contactlaw_version=VERSION, **table.asked, outside=outside)
    units = {column.name: column.unit or "1" for column in table.columns} | {"flags": "1"}
    for name, values in axes.items():
        file.create_dataset(name, data=values, fletcher32=True)
        file[name].make_scale(name)
    fields = {name: table.values[name] for name in units if name not in (*axes, "flags")} | {"flags": table.flags}
    for name, values in fields.items():
        shape = tuple(map(len, axes.values()))
        field = file.create_dataset(name, data=np.reshape(values, shape), fletcher32=True)
        for axis, scale in zip(field.dims, axes, strict=True):
            axis.attach_scale(file[scale])
    for name, unit in units.items():
        file[name].attrs["units"] = unit
    file["flags"].attrs.update({str(limit.name): int(limit) for limit in Validity})
