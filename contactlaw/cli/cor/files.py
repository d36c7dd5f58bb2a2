"""The file of ``contactlaw cor --out``: all impacts of a grid, as CSV or HDF5."""

import io
from collections.abc import Mapping, Sequence
from pathlib import Path

import h5py
import numpy as np

from contactlaw import _atomic
from contactlaw._version import VERSION
from contactlaw.cli.parts.table import Column, Table
from contactlaw.physical.validity import Validity

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
        about = {"format": _FORMAT, "schema": _SCHEMA, "contactlaw_version": VERSION}
        file.attrs.update(**about, **table.asked, outside=outside)
        shape = [len(values) for values in axes.values()]
        for name, unit, *_ in [*table.columns, Column("flags")]:  # the axes come first
            values = axes[name] if name in axes else np.reshape(table.values[name], shape)
            field = file.create_dataset(name, data=values, fletcher32=True)
            field.attrs["units"] = unit or "1"
            if name in axes:
                field.make_scale(name)
                continue
            for axis, scale in zip(field.dims, axes, strict=True):
                axis.attach_scale(file[scale])
        file["flags"].attrs.update({str(limit.name): int(limit) for limit in Validity})
    _atomic.write(path, image.getvalue())
