"""The folder of a report."""

import datetime
import os
from collections.abc import Sequence
from pathlib import Path

from contactlaw import _atomic, style
from contactlaw._errors import ArgumentError
from contactlaw._version import VERSION
from contactlaw.record.file import Record
from contactlaw.reporting import figures, page, summary
from contactlaw.reporting.meshes import with_meshes
from contactlaw.reporting.run import Run
from contactlaw.reporting.surface import ply, vtk
from contactlaw.walls.mesh import Mesh

_MAPS = "energy.vtk", "energy.ply"


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
        record.h5, and the map as energy.vtk and energy.ply.

    Raises
    ------
    ValueError
        Without any contact on a wall; if the record lacks a column, has a number that cannot be, or
        does not fit the meshes.
    ImportError
        Without matplotlib; the message says how to install it.
    OSError
        If a file cannot be written; nothing is left behind then.
    """
    run = Run(with_meshes(record, meshes) if meshes else record)
    if not run.rows.size:
        raise ArgumentError("record", None, "has no impact on a wall yet: simulate longer")
    with style.applied(), _atomic.folder(out) as folder:
        pictures = {name: figures.draw(name, run) for name in figures.names()}
        for name, picture in pictures.items():
            (folder / f"{name}.png").write_bytes(picture)
        (folder / "summary.txt").write_text(f"{summary.text(run)}\n", encoding="utf-8")
        run.record.save(folder / "record.h5")
        if run.map is not None:
            from contactlaw.reporting.figures.places import colours

            shown = colours(run.map)
            for name, form in zip(_MAPS, (vtk, ply), strict=True):
                (folder / name).write_bytes(form(run.map, shown))
        (folder / "index.html").write_text(_page(run, pictures), encoding="utf-8")
    if run.map is None:
        for name in _MAPS:  # of an earlier report
            (Path(out) / name).unlink(missing_ok=True)
    return Path(out) / "index.html"


def _page(run: Run, pictures: dict[str, bytes]) -> str:
    made = datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
    return page.template(__package__, "report.html").render(
        subject=run.subject,
        facts=[summary.counts(run), *[run.left_out] * bool(run.left_out)],
        run=run,
        summary=summary,
        figures=page.shown(figures.module, pictures),
        map=run.map is not None,
        made=page.made(made, {"contactlaw": VERSION}),
    )
