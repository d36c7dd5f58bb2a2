"""The folder of a report."""

import json
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from contactlaw import _atomic, style
from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._version import VERSION
from contactlaw.record.file import Record
from contactlaw.reporting import figures, page, summary
from contactlaw.reporting.meshes import with_meshes
from contactlaw.reporting.run import Run, taken
from contactlaw.reporting.surface import EnergyMap, areas, vtk
from contactlaw.walls.mesh import Mesh

_MAP, _SERIES = "energy.vtk", ".vtk.series"


def report(record: Record, out: str | os.PathLike[str] = "report", meshes: Sequence[Mesh] = ()) -> Path:
    """Write a page about a run, with figures and, if the walls are known, an energy map.

    Parameters
    ----------
    record : Record
        The run, with all columns of `contactlaw.engines.record.IMPACT`.
    out : path-like, optional
        Folder to write into; it is made if its parent exists. Files of an earlier report in it are
        replaced, other files are left alone.
    meshes : sequence of contactlaw.walls.Mesh, optional
        Meshes of walls, in the order of their numbers, for a record that does not know them.

    Returns
    -------
    Path
        The page, index.html, which needs no other file. Beside it are its figures, summary.txt,
        record.h5, and the map, energy.vtk.

    Raises
    ------
    ValueError
        Without any contact on a wall; if the record lacks a column, has a number that cannot be, or
        does not fit the meshes.
    ImportError
        Without matplotlib; the message says how to install it.
    OSError
        If a file cannot be written; nothing is left behind then, but for record.h5, which is written
        first. An error while the page is drawn has a note that names it.
    """
    run = Run(with_meshes(record, meshes) if meshes else record)
    if not run.rows.size:
        raise ArgumentError("record", None, "has no impact on a wall yet: simulate longer")
    with _atomic.folder(out) as folder:
        run.record.save(folder / "record.h5")
    try:
        with style.applied(), _atomic.folder(out) as folder:
            modules = figures.modules()
            pictures = {name: style.png(module.draw(run)) for name, module in modules.items()}
            for name, picture in pictures.items():
                (folder / f"{name}.png").write_bytes(picture)
            (folder / "summary.txt").write_text(f"{summary.text(run)}\n", encoding="utf-8")
            if run.map is not None:
                from contactlaw.reporting.figures.places import colours

                (folder / _MAP).write_bytes(vtk(run.map, colours(run.map)))
            text = page.template(__package__, "report.html").render(
                facts=[summary.counts(run), run.left_out],
                run=run,
                summary=summary,
                figures=page.shown(modules, pictures),
                made=page.made({"contactlaw": VERSION}),
            )
            (folder / "index.html").write_text(text, encoding="utf-8")
    except Exception as error:
        kept = Path(out) / "record.h5"
        error.add_note(f"The record is in {kept}, and `contactlaw report {kept} --out {out}` draws it.")
        raise
    if run.map is None:
        (Path(out) / _MAP).unlink(missing_ok=True)  # of an earlier report
    return Path(out) / "index.html"


def add_to_series(path: str | os.PathLike[str], times: Sequence[float], new: Record, force: Array) -> None:
    """Write a map of new contacts and of the normal force on each facet [N], and the times [s] of all maps."""
    if not str(path).endswith(_SERIES):
        raise ArgumentError("path", os.fspath(path), f"must end in {_SERIES}, by which ParaView knows a list of files")
    assert new.surface is not None  # the adapter knows the walls
    corners, wall, triangle = new.surface[:3]
    area, n = areas(corners), force.size
    # Facets are the first triangles; further ones are parts of the one facet of their wall.
    order = np.argsort(wall[:n], kind="stable")
    facet = np.r_[:n, order[np.searchsorted(wall[:n], wall[n:], sorter=order)]]
    impacts, energy = (np.bincount(triangle, each, len(area)).astype(float) for each in (None, taken(new.rows)))
    found = EnergyMap(corners, impacts, energy, energy / area, (force / np.bincount(facet, area))[facet])
    names = [f"{Path(path).name.removesuffix(_SERIES)}-{one:04}.vtk" for one in range(len(times))]
    _atomic.write(Path(path).with_name(names[-1]), vtk(found))
    files = [{"name": name, "time": time} for name, time in zip(names, times, strict=True)]
    _atomic.write(path, json.dumps({"file-series-version": "1.0", "files": files}).encode())
