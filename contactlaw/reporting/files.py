"""The folder of a report."""

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
from contactlaw.reporting.surface import vtk
from contactlaw.walls.mesh import Mesh

_MAP = "energy.vtk"


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
            if run.waves[0] is None:
                del modules["spectrum"]
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
