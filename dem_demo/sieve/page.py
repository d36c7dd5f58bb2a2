"""index.html of a sieve: one file that needs no other and no network."""

from __future__ import annotations

import base64
import html
from collections.abc import Mapping
from importlib import resources
from string import Template

from contactlaw import ImpactModel
from dem_demo import page as common
from dem_demo.gallery import Picture
from dem_demo.sieve import figures
from dem_demo.sieve.record import Runs
from dem_demo.sieve.report import facts, limits, progress, title


def page(runs: Runs, pictures: Mapping[str, Picture], film: bytes) -> str:
    """Write the page.

    Parameters
    ----------
    runs : Runs
        As read from their files.
    pictures : mapping of Picture
        Figures by name; those that are missing are left out.
    film : bytes
        A GIF of the bed.

    Returns
    -------
    str
        HTML.
    """
    run = runs.law
    frame = (resources.files(__package__) / "page.html").read_text(encoding="utf-8")
    what, how = title(runs)
    columns = [dict(facts(one)) for one in runs.every]
    head, *names = columns[0]
    return Template(frame).substitute(
        style=common.template("page.css").template,
        what=html.escape(what),
        how=html.escape(how),
        partial=common.partial(progress(runs), runs.reason),
        film=f"data:image/gif;base64,{base64.b64encode(film).decode('ascii')}",
        head="".join(f"<th>{html.escape(text)}</th>" for text in ["", *(c[head] for c in columns)]),
        rows="".join(_row(name, columns) for name in names),
        limits=common.exceeded(limits(run), ""),
        figures=common.shown(figures.module, pictures),
        command=html.escape(run.command),
        law=html.escape(run.law),
        source=html.escape(ImpactModel(run.pair, run.law).force_law.source),
        made=common.made(run.created, run.versions),
    )


def _row(name: str, columns: list[dict[str, str]]) -> str:
    cells = [f"<td>{html.escape(name.strip())}</td>"]
    cells += [
        f"<td data-name='{html.escape(column[''])}'>{html.escape(column.get(name, ''))}</td>"
        for column in columns
    ]
    return f"<tr>{''.join(cells)}</tr>"
