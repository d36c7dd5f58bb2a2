"""Pages of runs, and their parts; a page needs no other file and no network."""

from __future__ import annotations

import base64
import html
from collections.abc import Callable, Mapping, Sequence
from importlib import resources
from string import Template
from types import ModuleType

from contactlaw.reporting.gallery import Picture
from contactlaw.reporting.limits import Limit


def template(package: str, name: str) -> Template:
    """Read a file in the folder of a package."""
    return Template((resources.files(package) / name).read_text(encoding="utf-8"))


def whole(body: str, *, title: str, heading: str, lede: str, facts: str, partial: str = "") -> str:
    """Write a page; all arguments are HTML: facts in one line, a note on a partial run."""
    style = template(__package__, "page.css").template
    return template(__package__, "page.html").substitute(
        body=body, title=title, heading=heading, lede=lede, facts=facts, partial=partial,
        style=style,
    )  # fmt: skip


def partial(progress: str, reason: str) -> str:
    """Paragraph that says how far a partial run has come; empty for a complete run."""
    if not reason:
        return ""
    return f"<p class='partial'><b>Partial: {html.escape(progress)}.</b> {html.escape(reason)}</p>"


def exceeded(found: Sequence[Limit], marked: str) -> str:
    """List the limits that impacts exceed; `marked` says how the figures mark such impacts."""
    if not found:
        return "<p>All impacts on plates are inside every limit of the model.</p>"
    rows = "".join(
        f"<dt>{limit.impacts} {html.escape(limit.name)}</dt><dd>{html.escape(limit.meaning)}</dd>"
        for limit in found
    )
    return (
        f"<p>Impacts outside a limit of the model are counted here{marked}. Their numbers deserve "
        f"less trust.</p><dl>{rows}</dl>"
    )


def shown(module: Callable[[str], ModuleType], pictures: Mapping[str, Picture]) -> str:
    """Show figures, with the docstrings of their modules for captions."""
    return "".join(_figure(module(name), name, picture) for name, picture in pictures.items())


def _figure(module: ModuleType, name: str, picture: Picture) -> str:
    caption, _, rest = str(module.__doc__).strip().partition("\n\n")
    wide, narrow = (f"data:image/png;base64,{_base64(png)}" for png in picture)
    text, more = (html.escape(" ".join(part.split())) for part in (caption, rest))
    return (
        f"<figure id='{name}'><picture><source media='(max-width: 640px)' srcset='{narrow}'>"
        f"<img alt='{text}' src='{wide}'></picture><figcaption>{text} {more}</figcaption></figure>"
    )


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode("ascii")


def made(created: str, versions: Mapping[str, str]) -> str:
    """Say when a run was made, and by which versions."""
    programs = ", ".join(f"{name} {text}" for name, text in sorted(versions.items()))
    return html.escape(f"{created}; {programs}")


def row(names: Sequence[str], cells: Sequence[str]) -> str:
    """Row of a table; on a phone, each cell has the name of its column."""
    parts = (
        f"<td data-name='{html.escape(name)}'>{html.escape(cell)}</td>"
        for name, cell in zip(names, cells, strict=True)
    )
    return f"<tr>{''.join(parts)}</tr>"
